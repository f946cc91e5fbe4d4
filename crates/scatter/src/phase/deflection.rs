//! The scattering angle without loss of precision near forward.
//!
//! Fog sends half of the light into a fraction of a degree, where `cos theta` in `f32` has no digits left. So the
//! models here are written in `v = 1 - cos theta` (the versine), which the directions give as `|wo + wi|^2 / 2`.

use tyndall_base::math::sin_cos_turns;
use tyndall_base::vec::Vec3;

/// An angle of deflection `theta` in \[0, pi\]: 0 goes straight on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deflection {
    /// `1 - cos theta` in \[0, 2\].
    pub versine: f32,
    /// `sin theta` in \[0, 1\].
    pub sine: f32,
}

/// `1 - cos theta = 1 + wo . wi`; both directions point away from the point, so `wi = -wo` is forward.
#[inline(always)]
pub fn versine(wo: Vec3, wi: Vec3) -> f32 {
    (0.5 * (wo + wi).length_squared()).min(2.0)
}

impl Deflection {
    /// From the versine alone.
    #[inline(always)]
    pub fn from_versine(versine: f32) -> Self {
        let versine = versine.clamp(0.0, 2.0);
        Self { versine, sine: (versine * (2.0 - versine)).sqrt() }
    }

    /// The direction away from the point at this angle to `-wo`, its azimuth a fraction `turn` of the circle.
    #[inline(always)]
    pub fn apply(self, wo: Vec3, turn: f32) -> Vec3 {
        let forward = -wo;
        let (t, b) = forward.tangents();
        let (sin_phi, cos_phi) = sin_cos_turns(turn);
        forward + (t * cos_phi + b * sin_phi) * self.sine - forward * self.versine
    }
}
