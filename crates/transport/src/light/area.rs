//! `diffuse` area light: an emitting primitive with the same radiance in all directions of its side.
//!
//! L(y, d) = Le where d leaves on the side of the surface normal (on both sides when `two_sided`), times the colour of
//! an image at the point's texture coordinates if there is one. A surface that is seen with the probability `alpha` emits
//! in that share: paths that meet it by chance see it that often, those that choose it take alpha as a weight.

use super::{LiSample, PositionSample, Target};
use crate::texture::{FloatTexture, ImageMap, TextureContext};
use std::sync::Arc;
use tyndall_base::{Vec3, vec::vec2};
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
    /// What is rare.
    pub extra: Option<Arc<AreaExtra>>,
}

/// What few area lights have.
#[derive(Clone, Debug)]
pub struct AreaExtra {
    /// Radiance by texture coordinates, instead of the mean that the light's emission then is.
    pub image: Option<ImageMap>,
    /// Probability that the surface is seen, where it varies.
    pub alpha: Option<FloatTexture>,
    /// No ray meets the surface (its alpha is 0), but it emits, as in pbrt.
    pub invisible: bool,
}

impl AreaLight {
    /// Radiance that leaves a point with normal `n` along `d`.
    #[inline(always)]
    pub fn radiance<const N: usize>(
        &self,
        n: Vec3,
        uv: [f32; 2],
        d: Vec3,
        w: &Wavelengths<N>,
    ) -> Spectrum<N> {
        if !(self.two_sided || n.dot(d) > 0.0) {
            return Spectrum::ZERO;
        }
        match &self.extra {
            None => self.emission.sample(w),
            Some(extra) => self.coloured(extra, n, uv, w),
        }
    }

    #[inline(never)]
    fn coloured<const N: usize>(
        &self,
        extra: &AreaExtra,
        n: Vec3,
        uv: [f32; 2],
        w: &Wavelengths<N>,
    ) -> Spectrum<N> {
        let Some(image) = &extra.image else { return self.emission.sample(w) };
        image.spectrum(&TextureContext { p: Vec3::ZERO, n, uv: vec2(uv[0], uv[1]) }, w)
    }

    /// The share of the surface that emits at a point: a weight for whoever chose the point.
    #[inline(always)]
    pub fn share(&self, p: Vec3, n: Vec3, uv: [f32; 2]) -> f32 {
        let alpha = self.extra.as_ref().and_then(|e| e.alpha.as_ref());
        alpha.map_or(1.0, |a| a.eval(&TextureContext { p, n, uv: vec2(uv[0], uv[1]) }).clamp(0.0, 1.0))
    }

    /// Whether light sampling alone finds it.
    #[inline(always)]
    pub fn is_invisible(&self) -> bool {
        self.extra.as_ref().is_some_and(|e| e.invisible)
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
        let uv = [s.uv.x, s.uv.y];
        let mut l = self.radiance(s.n, uv, -wi, w);
        if self.extra.is_some() {
            l *= self.share(s.p, s.n, uv);
        }
        let target =
            Target { p: s.p, rounding: s.rounding, n: s.n, pdf_area: group.pdf_area_of(self.prim, from, &s) };
        (!l.is_zero()).then_some(LiSample {
            l,
            wi,
            target: Some(target),
            pdf: s.pdf,
            delta: self.is_invisible(),
        })
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
