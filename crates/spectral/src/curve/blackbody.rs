//! Thermal radiation: Planck's law.
//!
//! `L(lambda, T) = 2 h c^2 / lambda^5 / (exp(h c / (lambda k T)) - 1)`, in W m^-2 sr^-1 nm^-1 with lambda in nm and T in K.
//! Source: M. Planck, Annalen der Physik 309(3), 1901; constants: CODATA 2018 (exact since the 2019 SI).

use tyndall_base::math;

use crate::error::{SpectralError, require};
use crate::spectrum::Spectrum;
use crate::wavelengths::Wavelengths;

/// `h c / k` \[um K\].
pub const SECOND_RADIATION_CONSTANT: f64 = 14387.768775039337;
/// Wien's displacement constant `lambda_max T` \[um K\].
pub const WIEN_DISPLACEMENT: f64 = 2897.771955185172;
/// `2 h c^2` in W m^-2 sr^-1 nm^-1 um^5.
const FIRST_RADIATION_CONSTANT_L: f64 = 1.191042972397188e5;

/// A black body of one temperature, absolute or scaled to a maximum of 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blackbody {
    kelvin: f32,
    /// `h c / (k T)` \[um\].
    c2_over_t: f32,
    /// `2 h c^2` in the unit of the result.
    c1: f32,
}

impl Blackbody {
    /// Spectral radiance in W m^-2 sr^-1 nm^-1 at `kelvin` > 0.
    pub fn absolute(kelvin: f32) -> Result<Self, SpectralError> {
        require(kelvin > 0.0 && kelvin.is_finite(), "temperature [K]", "> 0", f64::from(kelvin))?;
        let c2_over_t = (SECOND_RADIATION_CONSTANT / f64::from(kelvin)) as f32;
        Ok(Self { kelvin, c2_over_t, c1: FIRST_RADIATION_CONSTANT_L as f32 })
    }

    /// The same shape with the value 1 at the maximum over wavelength (Wien's displacement law), as pbrt-v4 has it.
    pub fn normalized(kelvin: f32) -> Result<Self, SpectralError> {
        let body = Self::absolute(kelvin)?;
        let peak = planck(f64::from(kelvin), body.peak_nm());
        Ok(Self { c1: (FIRST_RADIATION_CONSTANT_L / peak) as f32, ..body })
    }

    /// Temperature \[K\].
    pub fn kelvin(&self) -> f32 {
        self.kelvin
    }

    /// Wavelength of the maximum \[nm\].
    pub fn peak_nm(&self) -> f64 {
        1e3 * WIEN_DISPLACEMENT / f64::from(self.kelvin)
    }

    /// Value at `lambda` \[nm\].
    #[inline(always)]
    pub fn eval(&self, lambda: f32) -> f32 {
        let inverse = 1e3 / lambda;
        self.c1 * fifth_power(inverse) / exp_m1(self.c2_over_t * inverse)
    }

    /// Values at the wavelengths of a path.
    #[inline(always)]
    pub fn sample<const N: usize>(&self, w: &Wavelengths<N>) -> Spectrum<N> {
        Spectrum::from_fn(|k| self.eval(w.lambda[k]))
    }
}

/// Planck's law in double precision: W m^-2 sr^-1 nm^-1 at `kelvin` > 0 and `lambda_nm` > 0.
pub fn planck(kelvin: f64, lambda_nm: f64) -> f64 {
    let inverse = 1e3 / lambda_nm;
    let square = inverse * inverse;
    FIRST_RADIATION_CONSTANT_L * square * square * inverse
        / math::f64::exp_m1(SECOND_RADIATION_CONSTANT * inverse / kelvin)
}

/// Planck's law at the wavelengths of a path for a temperature that varies in space: W m^-2 sr^-1 nm^-1, and 0 for
/// `kelvin <= 0`.
#[inline(always)]
pub fn planck_sample<const N: usize>(kelvin: f32, w: &Wavelengths<N>) -> Spectrum<N> {
    let c2_over_t = SECOND_RADIATION_CONSTANT as f32 / kelvin;
    let value = |lambda: f32| {
        let inverse = 1e3 / lambda;
        FIRST_RADIATION_CONSTANT_L as f32 * fifth_power(inverse) / exp_m1(c2_over_t * inverse)
    };
    if kelvin > 0.0 { Spectrum::from_fn(|k| value(w.lambda[k])) } else { Spectrum::ZERO }
}

/// `exp(x) - 1` for `x >= 0`: the series where the subtraction would lose digits.
#[inline(always)]
fn exp_m1(x: f32) -> f32 {
    let series = x * (1.0 + x / 2.0 * (1.0 + x / 3.0 * (1.0 + x / 4.0 * (1.0 + x / 5.0 * (1.0 + x / 6.0)))));
    let direct = math::exp(x) - 1.0;
    if x < 0.3 { series } else { direct }
}

#[inline(always)]
fn fifth_power(x: f32) -> f32 {
    let square = x * x;
    square * square * x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normalized_has_its_maximum_one_at_the_peak() {
        for kelvin in [1000.0f32, 2856.0, 6500.0, 25000.0] {
            let body = Blackbody::normalized(kelvin).unwrap();
            let peak = body.peak_nm() as f32;
            assert!((body.eval(peak) - 1.0).abs() < 2e-6, "{kelvin}: {}", body.eval(peak));
            assert!(body.eval(peak * 0.99) < 1.0 && body.eval(peak * 1.01) < 1.0);
        }
    }

    #[test]
    fn single_and_double_precision_agree() {
        for kelvin in [800.0f32, 1500.0, 5000.0, 40000.0] {
            let body = Blackbody::absolute(kelvin).unwrap();
            for lambda in [300.0f32, 400.0, 555.0, 830.0, 2500.0] {
                let exact = planck(f64::from(kelvin), f64::from(lambda));
                let got = f64::from(body.eval(lambda));
                assert!((got / exact - 1.0).abs() < 2e-5, "{kelvin} K, {lambda} nm: {got} {exact}");
            }
        }
    }

    #[test]
    fn stefan_boltzmann() {
        let kelvin = 3000.0;
        let integral: f64 = (0..200_000).map(|i| planck(kelvin, 100.0 + 0.5 + f64::from(i))).sum();
        let sigma = 5.670374419e-8;
        let expected = sigma * kelvin * kelvin * kelvin * kelvin / std::f64::consts::PI;
        assert!((integral / expected - 1.0).abs() < 2e-5, "{integral} {expected}");
    }

    #[test]
    fn cold_is_dark_and_nonsense_is_refused() {
        let w =
            Wavelengths { lambda: [500.0, 600.0], pdf: [1.0; 2], line: [crate::wavelengths::CONTINUUM; 2] };
        assert_eq!(planck_sample(0.0, &w), Spectrum::ZERO);
        assert_eq!(planck_sample(3.0, &w), Spectrum::ZERO);
        assert!(Blackbody::absolute(0.0).is_err() && Blackbody::normalized(f32::NAN).is_err());
    }
}
