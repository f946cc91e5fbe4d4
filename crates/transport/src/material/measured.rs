//! `measured`: tables of a real surface.

use std::sync::Arc;
use tyndall_base::vec::vec3;
use tyndall_scatter::bsdf::{Bsdf, Measured, MeasuredTables};
use tyndall_spectral::{Spectrum, Wavelengths};

/// Parameters: see [`Measured`].
#[derive(Clone, Debug)]
pub struct MeasuredMaterial {
    /// The tables, shared by all surfaces.
    pub tables: Arc<MeasuredTables>,
}

impl MeasuredMaterial {
    /// The BSDF, the same everywhere.
    #[inline(never)]
    pub fn bsdf<const N: usize>(&self, w: &Wavelengths<N>) -> Bsdf<'_, N> {
        Bsdf::Measured(Measured { tables: &self.tables, lambda: w.lambda })
    }

    /// Reflectance at normal incidence, by 64 directions.
    pub fn albedo<const N: usize>(&self, w: &Wavelengths<N>) -> Spectrum<N> {
        let bsdf = self.bsdf(w);
        let mut sum = Spectrum::ZERO;
        for i in 0..64u8 {
            let u = [(f32::from(i % 8) + 0.5) / 8.0, (f32::from(i / 8) + 0.5) / 8.0];
            if let Some(s) = bsdf.sample(vec3(0.0, 0.0, 1.0), 0.5, u) {
                sum += s.f * (s.wi.z / s.pdf.hero());
            }
        }
        sum * (1.0 / 64.0)
    }
}
