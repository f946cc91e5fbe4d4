//! Directions drawn towards the glow around a light.
//!
//! In a medium the light that has scattered once comes from everywhere around a lamp, with a radiance that falls as
//! about `1 / sin(theta)` with the angle from it (the airlight integral of `1 / d^2` along a ray). A direction is drawn
//! from the phase function or BSDF, or with probability `share` from a density that follows this glow; the density of
//! the mixture enters all weights:
//!
//! ```text
//! p(w) = (1 - share) p_scatter(w) + share / (4 pi |w - l|),   l the unit direction to the lamp
//! ```
//!
//! One point on one light attracts a whole path; given that point the mixture is a density like any other, so nothing
//! has to be summed over lights.

use crate::{medium::Inside, settings::Settings};
use tyndall_base::{Vec3, warp};
use tyndall_geometry::Frame;
use tyndall_scatter::{bsdf::BsdfFlags, phase::PhaseFunction};
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::{Scene, sampler::PathSampler};

/// Share of the glow where it is clearest: near a lamp, with isotropic scattering. Flat between 0.3 and 0.7.
const SHARE: f32 = 0.5;
/// Optical distance from the lamp beyond which light has scattered too often to tell where it came from.
const CLEAR: f32 = 2.0;
/// Share where the phase function is a table or a peak, whose mean cosine is not at hand.
const PEAKED: f32 = 0.1;
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
        Self::new(lamp?, p, inside, share(inside.phase, w))
    }

    /// From a point `p` of a surface in a medium, whose normal on the side of the path is `n`: for diffuse reflection
    /// of a lamp above the horizon.
    #[inline(always)]
    pub fn on_surface<const N: usize>(
        lamp: Option<Vec3>,
        p: Vec3,
        n: Vec3,
        flags: BsdfFlags,
        inside: Option<&Inside<'_, N>>,
    ) -> Option<Self> {
        if flags != BsdfFlags::DIFFUSE | BsdfFlags::REFLECTION {
            return None;
        }
        Self::new(lamp?, p, inside?, SHARE).filter(|g| g.axis.dot(n) > 0.0)
    }

    #[inline(always)]
    fn new<const N: usize>(lamp: Vec3, p: Vec3, inside: &Inside<'_, N>, share: f32) -> Option<Self> {
        if inside.sigma_s.is_zero() {
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

    /// Density of the mixture at `wi`, where the scattering alone has `pdf`.
    #[inline(always)]
    fn mix<const N: usize>(&self, pdf: Spectrum<N>, wi: Vec3) -> Spectrum<N> {
        let chord = (wi - self.axis).length().max(MIN_CHORD);
        pdf * (1.0 - self.share) + Spectrum::splat(self.share * warp::pdf_chord(chord))
    }

    /// A direction of the glow when `u` says so; else `u` is what the scattering has left to draw from.
    #[inline(always)]
    pub fn sample(&self, u: &mut [f32; 2]) -> Option<Vec3> {
        if u[0] < self.share {
            u[0] /= self.share;
            return Some(Frame::from_z(self.axis).from_local(warp::sample_chord(*u)));
        }
        u[0] = ((u[0] - self.share) / (1.0 - self.share)).min(1.0 - 0.5 * f32::EPSILON);
        None
    }
}

/// Share for a phase function: the narrower it is, the more it has to say itself.
#[inline(always)]
fn share<const N: usize>(phase: &PhaseFunction, w: &Wavelengths<N>) -> f32 {
    match phase {
        PhaseFunction::Isotropic | PhaseFunction::Rayleigh(_) => SHARE,
        PhaseFunction::HenyeyGreenstein(p) => SHARE * (1.0 - p.g().sample(w).map(f32::abs).mean()),
        _ => PEAKED,
    }
}

/// Density of `wi` where a glow may compete with a scattering of density `pdf`.
#[inline(always)]
pub fn mixed<const N: usize>(glow: Option<&Glow>, pdf: Spectrum<N>, wi: Vec3) -> Spectrum<N> {
    glow.map_or(pdf, |g| g.mix(pdf, wi))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_base::vec::vec3;
    use tyndall_testkit::{Rng, chi2_sphere};

    #[test]
    fn directions_follow_the_density_of_the_mixture() {
        let glow = Glow { axis: vec3(1.0, 2.0, -0.5).normalize(), share: SHARE };
        let isotropic = Spectrum::<1>::splat(warp::pdf_uniform_sphere());
        let draw = |rng: &mut Rng| {
            let mut u = rng.f32x2();
            let wi = glow.sample(&mut u).unwrap_or_else(|| warp::sample_uniform_sphere(u));
            Some(wi.to_array())
        };
        let pdf = |[x, y, z]: [f32; 3]| f64::from(glow.mix(isotropic, vec3(x, y, z)).hero());
        chi2_sphere(draw, pdf, 200_000, 7).assert_ok("mixture of glow and sphere", 1);
    }
}
