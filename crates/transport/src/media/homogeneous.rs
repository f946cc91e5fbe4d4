//! `homogeneous`: the same coefficients everywhere; transmittance is exp(-sigma_t d) (Beer-Lambert).

use super::MediumProperties;
use crate::{TransportError, error::check};
use tyndall_scatter::phase::PhaseFunction;
use tyndall_spectral::{Curve, Emission, LambdaRange, Spectrum, Wavelengths};

/// Parameters: coefficients \[1/m\], source radiance \[W m^-2 sr^-1 nm^-1\], phase function.
#[derive(Clone, Debug)]
pub struct Homogeneous {
    /// Absorption coefficient.
    pub sigma_a: Curve,
    /// Scattering coefficient.
    pub sigma_s: Curve,
    /// Source radiance, if the medium emits.
    pub le: Option<Emission>,
    /// Distribution of scattered directions.
    pub phase: PhaseFunction,
}

impl Homogeneous {
    /// Refuses coefficients that are negative or not finite anywhere on `range` \[nm\].
    pub fn new(
        sigma_a: Curve,
        sigma_s: Curve,
        le: Option<Emission>,
        phase: PhaseFunction,
        range: LambdaRange,
    ) -> Result<Self, TransportError> {
        for (what, curve) in [("sigma_a", &sigma_a), ("sigma_s", &sigma_s)] {
            for value in [curve.min_value(range), curve.max_value(range)] {
                check(value >= 0.0 && value.is_finite(), what, "finite and >= 0 1/m", f64::from(value))?;
            }
        }
        Ok(Self { sigma_a, sigma_s, le, phase })
    }

    /// The properties at the wavelengths `w`.
    #[inline(always)]
    pub fn at<const N: usize>(&self, w: &Wavelengths<N>) -> MediumProperties<'_, N> {
        MediumProperties {
            sigma_a: self.sigma_a.sample(w),
            sigma_s: self.sigma_s.sample(w),
            le: self.le.as_ref().map_or(Spectrum::ZERO, |e| e.sample(w)),
            phase: &self.phase,
        }
    }
}
