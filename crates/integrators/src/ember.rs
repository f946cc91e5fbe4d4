//! Points of media that emit, chosen as lights are, and the weight of meeting them by chance.
//!
//! A path whose last scattering at `x` is followed by emission at `y`, a distance `d` away, is made in two ways: by a
//! direction of chance and a tentative collision at `y`, or by a point of the medium. Per solid angle and length:
//!
//! ```text
//! chance   p(w) prod(sigma_n T_maj) sigma_maj(y) T_maj        light   P p_V(y) d^2 prod(sigma_r T_r) T_r
//! ```
//!
//! with `P` the probability of choosing the medium among lights, `p_V` its density of points per volume (see
//! [`VolumeLight`]), and the products over the null collisions between, as flights and shadow rays have them (see
//! [`crate::tracking`]). The contribution is `beta f T sigma_a le` either way, and the balance heuristic combines techniques
//! and wavelengths.

use crate::{
    direct::{Arrival, Scatterer},
    shadow::End,
    weight::divide,
};
use tyndall_base::Vec3;
use tyndall_spectral::Spectrum;
use tyndall_transport::{
    MediumId, Scene,
    light::{Target, VolumeLight},
    sampler::PathSampler,
};

/// The medium as a light, as the last scattering of a path sees it.
#[derive(Clone, Copy, Debug)]
pub struct Ember<'s> {
    light: &'s VolumeLight,
    /// The last scattering.
    from: Vec3,
    /// Probability of choosing the medium there.
    pmf: f32,
}

impl<'s> Ember<'s> {
    /// Of the medium that a path flies through; `None` where no point of it could have been chosen from `from`, with
    /// the normal `n` (zero in a medium).
    #[inline(always)]
    pub fn of(scene: &'s Scene, medium: MediumId, from: Vec3, n: Vec3) -> Option<Self> {
        let (id, light) = scene.lights.of_medium(medium)?;
        if !light.serves(from) {
            return None;
        }
        let pmf = scene.lights.pmf_at(from, n, id);
        (pmf > 0.0).then_some(Self { light, from, pmf })
    }

    /// `P p_V d^2` \[1/(sr m)\] at the point `p`, which is `local` in the medium's own space.
    #[inline(always)]
    pub fn density(&self, p: Vec3, local: Vec3) -> f32 {
        self.pmf * self.light.pdf_at(local) * (p - self.from).length_squared()
    }
}

impl<S, F, const N: usize> Scatterer<'_, '_, S, F, N>
where
    S: Fn(Vec3) -> (Vec3, MediumId),
    F: Fn(Vec3) -> (Spectrum<N>, Spectrum<N>),
{
    /// Light of one point of `light`, which was chosen with the probability `pmf`, that the vertex scatters; `None` for none.
    #[inline]
    pub(crate) fn ember(
        &self,
        path: &Arrival<'_, N>,
        (light, pmf): (&VolumeLight, f32),
        u: [f32; 2],
        sampler: &mut PathSampler,
    ) -> Option<Spectrum<N>> {
        let more = sampler.next_2d();
        if !light.serves(self.p) {
            return None;
        }
        let y = light.sample([more.x, u[0], u[1], more.y]);
        let [emitted, majorant] = light.matter().glow_at(y.p, path.w)?;
        let to = y.p - self.p;
        let d2 = to.length_squared();
        if emitted.is_zero() || d2.is_nan() || d2 <= 0.0 {
            return None;
        }
        let wi = to * (1.0 / d2.sqrt());
        let (f, pdf) = (self.eval)(wi);
        if f.is_zero() {
            return None;
        }
        let s = self.shadow(path, wi, End::At(Target::free(y.p)), sampler)?;
        // a boundary on the way may have left the point in another medium
        if s.end != light.medium() {
            return None;
        }
        let by_light = s.r_l * (pmf * y.pdf * d2);
        let by_chance = pdf * s.r_u * majorant;
        Some(divide(path.weight.beta * f * s.t * emitted, path.weight.r_u * (by_light + by_chance)))
    }
}
