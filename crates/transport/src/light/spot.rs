//! `spot`: a point that emits into a cone with a smooth edge.
//!
//! I(theta) = I smoothstep(cos theta; cos_end, cos_start): full inside `start`, zero outside `end`.

use super::{LiSample, point::towards};
use crate::{TransportError, error::check};
use tyndall_base::{Vec3, math};
use tyndall_spectral::{Emission, Spectrum, Wavelengths};

/// Parameters: see the module.
#[derive(Clone, Debug)]
pub struct SpotLight {
    /// Position \[m\].
    pub p: Vec3,
    /// Unit direction of the axis.
    pub axis: Vec3,
    /// Radiant intensity on the axis \[W sr^-1 nm^-1\].
    pub intensity: Emission,
    /// Cosine of the angle beyond which nothing is emitted.
    pub cos_end: f32,
    /// Cosine of the angle within which the intensity is full.
    pub cos_start: f32,
}

impl SpotLight {
    /// `cone_angle` and `cone_delta` in degrees, as pbrt's `coneangle` and `conedeltaangle`.
    pub fn new(
        p: Vec3,
        axis: Vec3,
        intensity: Emission,
        cone_angle: f32,
        cone_delta: f32,
    ) -> Result<Self, TransportError> {
        let (angle, delta) = (f64::from(cone_angle), f64::from(cone_delta));
        check(angle > 0.0 && angle <= 180.0, "coneangle", "between 0 and 180 degrees", angle)?;
        check((0.0..=angle).contains(&delta), "conedeltaangle", "between 0 and coneangle degrees", delta)?;
        check(axis.length() > 0.0 && axis.is_finite(), "from, to", "two different points", 0.0)?;
        let cos = |degrees: f64| math::f64::cos(degrees * (std::f64::consts::PI / 180.0)) as f32;
        Ok(Self { p, axis: axis.normalize(), intensity, cos_end: cos(angle), cos_start: cos(angle - delta) })
    }

    /// See [`super::Light::sample_li`].
    #[inline]
    pub fn sample_li<const N: usize>(&self, from: Vec3, w: &Wavelengths<N>) -> Option<LiSample<N>> {
        towards(self.p, from, |d| self.intensity_along(d, w))
    }

    /// Intensity along the unit direction `d`.
    #[inline]
    pub fn intensity_along<const N: usize>(&self, d: Vec3, w: &Wavelengths<N>) -> Spectrum<N> {
        let falloff = smoothstep(d.dot(self.axis), self.cos_end, self.cos_start);
        if falloff == 0.0 { Spectrum::ZERO } else { self.intensity.sample(w) * falloff }
    }

    /// Integral of the falloff over directions \[sr\]: a smoothstep's mean over its ramp is one half.
    pub fn solid_angle(&self) -> f64 {
        let (end, start) = (f64::from(self.cos_end), f64::from(self.cos_start));
        2.0 * std::f64::consts::PI * ((1.0 - start) + 0.5 * (start - end))
    }
}

/// 0 below `a`, 1 above `b`, 3x^2 - 2x^3 between.
#[inline(always)]
fn smoothstep(v: f32, a: f32, b: f32) -> f32 {
    if a == b {
        return if v < a { 0.0 } else { 1.0 };
    }
    let x = ((v - a) / (b - a)).clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_spectral::Curve;

    #[test]
    fn solid_angle_is_the_integral_of_the_falloff() {
        let spot =
            SpotLight::new(Vec3::ZERO, Vec3::splat(1.0), Curve::ONE.into(), 40.0, 15.0).expect("valid");
        let n = 200_000;
        let sum: f64 = (0..n)
            .map(|i| {
                let cos = -1.0 + 2.0 * (f64::from(i) + 0.5) / f64::from(n);
                f64::from(smoothstep(cos as f32, spot.cos_end, spot.cos_start))
            })
            .sum();
        let integral = sum * 2.0 / f64::from(n) * 2.0 * std::f64::consts::PI;
        assert!((integral / spot.solid_angle() - 1.0).abs() < 1e-4, "{integral} {}", spot.solid_angle());
    }

    #[test]
    fn refuses_impossible_cones() {
        let new = |a, d| SpotLight::new(Vec3::ZERO, Vec3::splat(1.0), Curve::ONE.into(), a, d);
        assert!(new(-3.0, 0.0).is_err() && new(30.0, 31.0).is_err() && new(f32::NAN, 1.0).is_err());
    }
}
