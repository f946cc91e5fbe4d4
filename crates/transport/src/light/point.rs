//! `point`: equal intensity \[W sr^-1 nm^-1\] in all directions from one point.

use super::{LiSample, Target};
use tyndall_base::Vec3;
use tyndall_spectral::{Emission, Spectrum, Wavelengths};

/// Parameters: see the module.
#[derive(Clone, Debug)]
pub struct PointLight {
    /// Position \[m\].
    pub p: Vec3,
    /// Radiant intensity.
    pub intensity: Emission,
}

impl PointLight {
    /// I / d^2 from the light's direction.
    #[inline]
    pub fn sample_li<const N: usize>(&self, from: Vec3, w: &Wavelengths<N>) -> Option<LiSample<N>> {
        towards(self.p, from, |_| self.intensity.sample(w))
    }
}

/// The sample towards a point source at `p` whose intensity along a direction is `intensity(d)`.
#[inline(always)]
pub(super) fn towards<const N: usize>(
    p: Vec3,
    from: Vec3,
    intensity: impl FnOnce(Vec3) -> Spectrum<N>,
) -> Option<LiSample<N>> {
    let to = p - from;
    let d2 = to.length_squared();
    if d2 == 0.0 {
        return None;
    }
    let wi = to * (1.0 / d2.sqrt());
    let l = intensity(-wi) * (1.0 / d2);
    let target = Some(Target::free(p));
    (!l.is_zero()).then_some(LiSample { l, wi, target, pdf: 1.0, delta: true })
}
