//! Directions drawn towards the glow around a light.
//!
//! In a medium the light that has scattered once comes from everywhere around a lamp, with a radiance that falls as
//! about `1 / sin(theta)` with the angle from it (the airlight integral of `1 / d^2` along a ray). [`crate::steer`] mixes
//! a density that follows this glow with that of the scattering:
//!
//! ```text
//! p(w) = 1 / (4 pi |w - l|),   l the unit direction to the lamp
//! ```
//!
//! One point on one light attracts a whole path; given that point the mixture is a density like any other, so nothing
//! has to be summed over lights. Where light has been learned ([`tyndall_transport::guiding`]) nothing is assumed of it.

use crate::{medium::Inside, settings::Settings};
use tyndall_base::{Vec3, warp};
use tyndall_geometry::Frame;
use tyndall_scatter::phase::PhaseFunction;
use tyndall_spectral::Wavelengths;
use tyndall_transport::{Scene, sampler::PathSampler};

/// Share of the glow where it is clearest: near a lamp, with isotropic scattering. Flat between 0.3 and 0.7.
const SHARE: f32 = 0.5;
/// Optical distance from the lamp beyond which light has scattered too often to tell where it came from.
const CLEAR: f32 = 2.0;
/// Openness where the phase function is a table or a peak, whose mean cosine is not at hand.
const PEAKED: f32 = 0.2;
/// Keeps the density finite on the axis, where rounding decides the chord.
const MIN_CHORD: f32 = 1e-6;

/// The point whose glow attracts a path; `None` where the technique is off or has nothing to work with.
#[inline(always)]
pub fn lamp(scene: &Scene, settings: &Settings, sampler: &mut PathSampler) -> Option<Vec3> {
    if !settings.glow || scene.media.is_empty() || !scene.lights.has_local() {
        return None;
    }
    let id = scene.lights.select_local(sampler.next_1d())?.id;
    let u = sampler.next_2d();
    Some(scene.lights.get(id).sample_position(&scene.accel, [u.x, u.y])?.target.p)
}

/// The glow as seen from a point.
#[derive(Clone, Copy, Debug)]
pub struct Glow {
    /// Unit direction to the lamp.
    axis: Vec3,
    /// Probability with which directions are drawn towards it.
    share: f32,
}

impl Glow {
    /// From the point `p` of a medium. A function of the point and of all lanes alike, so that every technique and
    /// every hero agrees on it.
    #[inline(always)]
    pub fn in_medium<const N: usize>(
        lamp: Option<Vec3>,
        p: Vec3,
        inside: &Inside<'_, N>,
        w: &Wavelengths<N>,
    ) -> Option<Self> {
        Self::new(lamp?, p, inside, SHARE * openness(inside.phase, w))
    }

    /// From a point `p` of a surface in a medium, whose normal on the side of the path is `n`: for diffuse reflection
    /// of a lamp above the horizon.
    #[inline(always)]
    pub fn on_surface<const N: usize>(
        lamp: Option<Vec3>,
        p: Vec3,
        n: Vec3,
        inside: Option<&Inside<'_, N>>,
    ) -> Option<Self> {
        Self::new(lamp?, p, inside?, SHARE).filter(|g| g.axis.dot(n) > 0.0)
    }

    #[inline(always)]
    fn new<const N: usize>(lamp: Vec3, p: Vec3, inside: &Inside<'_, N>, share: f32) -> Option<Self> {
        if inside.sigma_s.is_zero() || inside.varying.is_some() {
            return None;
        }
        let to = lamp - p;
        let d2 = to.length_squared();
        if d2.is_nan() || d2 <= 0.0 {
            return None;
        }
        let d = d2.sqrt();
        let clear = (CLEAR / (inside.sigma_t.mean() * d)).min(1.0);
        Some(Self { axis: to * (1.0 / d), share: share * clear * clear })
    }

    /// Towards the unit direction `axis`.
    #[cfg(test)]
    pub(crate) fn towards(axis: Vec3, share: f32) -> Self {
        Self { axis, share }
    }

    /// Probability with which directions are drawn towards it.
    #[inline(always)]
    pub fn share(&self) -> f32 {
        self.share
    }

    /// Density of `wi` \[1/sr\].
    #[inline(always)]
    pub fn pdf(&self, wi: Vec3) -> f32 {
        warp::pdf_chord((wi - self.axis).length().max(MIN_CHORD))
    }

    /// A direction of the glow.
    #[inline(always)]
    pub fn sample(&self, u: [f32; 2]) -> Vec3 {
        Frame::from_z(self.axis).from_local(warp::sample_chord(u))
    }
}

/// 1 where a phase function leaves all directions open: the narrower it is, the more it has to say itself.
#[inline(always)]
pub fn openness<const N: usize>(phase: &PhaseFunction, w: &Wavelengths<N>) -> f32 {
    match phase {
        PhaseFunction::Isotropic | PhaseFunction::Rayleigh(_) => 1.0,
        PhaseFunction::HenyeyGreenstein(p) => 1.0 - p.g().sample(w).map(f32::abs).mean(),
        _ => PEAKED,
    }
}
