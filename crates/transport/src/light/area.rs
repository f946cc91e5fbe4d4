//! `diffuse` area light: an emitting primitive with the same radiance in all directions of its side.
//!
//! L(y, d) = Le where d leaves on the side of the surface normal (on both sides when `two_sided`).

use super::{LiSample, PositionSample, Target};
use tyndall_base::Vec3;
use tyndall_geometry::{Accel, Hit, SurfacePoint};
use tyndall_spectral::{Emission, Spectrum, Wavelengths};

/// Parameters: see the module.
#[derive(Clone, Debug)]
pub struct AreaLight {
    /// The shape group of the primitive.
    pub shape: u32,
    /// The primitive in its group.
    pub prim: u32,
    /// Its area \[m^2\].
    pub area: f32,
    /// Radiance \[W m^-2 sr^-1 nm^-1\].
    pub emission: Emission,
    /// Emits on both sides.
    pub two_sided: bool,
}

impl AreaLight {
    /// Radiance that leaves a point with normal `n` along `d`.
    #[inline(always)]
    pub fn radiance<const N: usize>(
        &self,
        n: Vec3,
        _uv: [f32; 2],
        d: Vec3,
        w: &Wavelengths<N>,
    ) -> Spectrum<N> {
        if self.two_sided || n.dot(d) > 0.0 { self.emission.sample(w) } else { Spectrum::ZERO }
    }

    /// See [`super::Light::sample_li`]: a direction in the solid angle that the primitive subtends.
    #[inline]
    pub fn sample_li<const N: usize>(
        &self,
        accel: &Accel,
        from: Vec3,
        u: [f32; 2],
        w: &Wavelengths<N>,
    ) -> Option<LiSample<N>> {
        let group = accel.group(self.shape);
        let s = group.sample_solid_angle(self.prim, from, u)?;
        let wi = (s.p - from).normalize();
        if !wi.is_finite() || s.pdf.is_nan() || s.pdf <= 0.0 {
            return None;
        }
        let l = self.radiance(s.n, [s.uv.x, s.uv.y], -wi, w);
        let target =
            Target { p: s.p, rounding: s.rounding, n: s.n, pdf_area: group.pdf_area_of(self.prim, from, &s) };
        (!l.is_zero()).then_some(LiSample { l, wi, target: Some(target), pdf: s.pdf, delta: false })
    }

    /// See [`super::Light::pdf_li`].
    #[inline]
    pub fn pdf_li(&self, accel: &Accel, from: Vec3, target: &Target) -> f32 {
        accel.group(self.shape).pdf_solid_angle_at(self.prim, from, target.p, target.n, target.pdf_area)
    }

    /// See [`super::Light::sample_position`].
    #[inline]
    pub fn sample_position(&self, accel: &Accel, u: [f32; 2]) -> PositionSample {
        let s = accel.group(self.shape).sample_area(self.prim, u);
        let target = Target { p: s.p, rounding: s.rounding, n: s.n, pdf_area: s.pdf };
        PositionSample { target, uv: [s.uv.x, s.uv.y] }
    }

    /// The target at a point where a ray met the light.
    #[inline]
    pub fn target(&self, accel: &Accel, hit: &Hit, s: &SurfacePoint) -> Target {
        let pdf_area = accel.group(self.shape).pdf_area(hit, s);
        Target { p: s.p, rounding: s.rounding, n: s.ng, pdf_area }
    }

    /// 1 or 2.
    pub fn sides(&self) -> f64 {
        if self.two_sided { 2.0 } else { 1.0 }
    }
}
