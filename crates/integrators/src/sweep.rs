//! The spectrum of a pixel at any number of wavelengths from the very same paths.
//!
//! Eight guide wavelengths draw a path as `volpath` does, with multiple importance sampling among themselves. Eight more
//! ride along: their densities count nothing, their contributions are weighted by those of the guides. The same random
//! numbers again with other passengers give the same path, so that a sample yields a spectrum whose noise is common
//! to all wavelengths: what depends on wavelength alone, such as the error of a quadrature, is seen through it.
//!
//! The settings must be without roulette, equiangular sampling, glow and guiding, which look at the passengers.

use crate::{
    pixel::PixelPass,
    settings::{Equiangular, Guiding},
    volpath,
    weight::PathWeight,
};
use tyndall_spectral::{Spectrum, Wavelengths};

/// Guides, and passengers of one path.
const GUIDES: usize = 8;
/// Both together.
const LANES: usize = 2 * GUIDES;

impl PixelPass {
    /// Radiance of sample `sample` at all `nodes` \[nm\] into `out`. The pass draws its guides: a fixed set of eight.
    ///
    /// # Panics
    /// With settings whose decisions would depend on the passengers, or `out` of another length than `nodes`.
    pub fn spectrum(&self, x: u32, y: u32, sample: u32, nodes: &[f32], out: &mut [f32]) {
        let s = &self.settings;
        let steady = s.roulette_depth == u32::MAX
            && s.equiangular == Equiangular::Off
            && !s.glow
            && s.guiding == Guiding::Off;
        assert!(steady, "passengers must not decide");
        assert_eq!(nodes.len(), out.len(), "one value a node");
        for (nodes, out) in nodes.chunks(GUIDES).zip(out.chunks_mut(GUIDES)) {
            let mut start = self.start::<GUIDES>(x, y, sample);
            let w = with_passengers(&start.w, nodes);
            let mut weight = PathWeight::<LANES>::START;
            for k in GUIDES..LANES {
                weight.r_u[k] = 0.0;
            }
            let (ray, first) = (start.ray, start.first_distance);
            let at = (weight, self.scene.camera_medium, 0);
            let l = volpath::li_from(&self.scene, s, at, ray, first, &w, &mut start.sampler, &mut ());
            // the mean of the densities was taken over all lanes, of which half count
            let share = start.exposure * (GUIDES as f32 / LANES as f32);
            for (k, o) in out.iter_mut().enumerate() {
                *o = share * l[GUIDES + k];
            }
        }
    }
}

/// The guides, then `nodes`, the last repeated.
fn with_passengers(guides: &Wavelengths<GUIDES>, nodes: &[f32]) -> Wavelengths<LANES> {
    let passenger = |k: usize| nodes[k.min(nodes.len() - 1)];
    let lambda: Spectrum<LANES> =
        Spectrum::from_fn(|k| if k < GUIDES { guides.lambda[k] } else { passenger(k - GUIDES) });
    Wavelengths::continuum(lambda.0, [guides.pdf[0]; LANES])
}
