//! A hair or fur fibre, after Chiang et al.
//!
//! The frame's x is along the fibre. Light is reflected (R), passes through (TT), is reflected once inside (TRT), or more
//! often (the rest): `f |cos| = sum_p M_p(theta) A_p N_p(phi)`, with von Mises-like lobes `M_p` along the fibre, logistic
//! lobes `N_p` round it, and attenuations `A_p` by Fresnel's equations and absorption on the way. `h` in \[-1, 1\] is
//! where the ray meets the width of the fibre, along the frame's y. Values are per solid angle on the sphere: the BSDF is divided by
//! `|cos theta_i|` of the surface's normal, which the integrator multiplies again. Sources: Marschner et al. 2003;
//! d'Eon et al. 2011; Chiang et al. 2016, *A practical and controllable hair and fur model*; constants of pbrt-v4.

use super::{BsdfFlags, BsdfSample, fresnel::fresnel_dielectric};
use std::f32::consts::{PI, TAU};
use tyndall_base::math;
use tyndall_base::vec::{Vec3, vec3};
use tyndall_spectral::Spectrum;

/// Lobes with a formula of their own; one more has the rest.
const LOBES: usize = 3;

/// A fibre at one point of its width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hair<const N: usize> {
    h: f32,
    eta: f32,
    /// Absorption over the fibre's radius per lane.
    sigma_a: Spectrum<N>,
    /// Variances along the fibre.
    v: [f32; LOBES + 1],
    /// Scale of the logistic lobe round it.
    s: f32,
    /// Sines and cosines of 1, 2 and 4 times the tilt of the scales.
    tilt: [[f32; 2]; LOBES],
}

impl<const N: usize> Hair<N> {
    /// The events it has.
    pub const FLAGS: BsdfFlags = BsdfFlags::REFLECTION.or(BsdfFlags::TRANSMISSION).or(BsdfFlags::GLOSSY);

    /// `h` in \[-1, 1\], `beta_m` and `beta_n` in \[0, 1\], the scales' `alpha` in degrees.
    pub fn new(h: f32, eta: f32, sigma_a: Spectrum<N>, beta_m: f32, beta_n: f32, alpha: f32) -> Self {
        let power = |x: f32, n: i32| (0..n).fold(1.0, |p, _| p * x);
        let square = |x: f32| x * x;
        let first = square(0.726 * beta_m + 0.812 * square(beta_m) + 3.7 * power(beta_m, 20));
        let v = [first, 0.25 * first, 4.0 * first, 4.0 * first].map(|v: f32| v.max(1e-7));
        // pi / 8 under the root, of the standard deviation of a logistic distribution
        let s = 0.626_657_07 * (0.265 * beta_n + 1.194 * square(beta_n) + 5.372 * power(beta_n, 22));
        let (sin, cos) = math::sin_cos(alpha * (PI / 180.0));
        let mut tilt = [[sin, cos]; LOBES];
        for k in 1..LOBES {
            let [s, c] = tilt[k - 1];
            tilt[k] = [2.0 * s * c, c * c - s * s];
        }
        Self { h: h.clamp(-1.0, 1.0), eta, sigma_a, v, s: s.max(1e-4), tilt }
    }

    /// Absorption that gives hair the colour `c` by multiple scattering (Chiang et al. 2016, eq. 9).
    pub fn sigma_a_of_colour(c: Spectrum<N>, beta_n: f32) -> Spectrum<N> {
        let b = |n: usize| (0..n).fold(1.0, |p: f32, _| p * beta_n);
        let scale = 5.969 - 0.215 * b(1) + 2.532 * b(2) - 10.73 * b(3) + 5.574 * b(4) + 0.245 * b(5);
        c.map(|c| {
            let root = math::ln(c.clamp(1e-4, 1.0)) / scale;
            root * root
        })
    }

    /// Attenuations of the lobes per lane.
    fn attenuations(&self, wo: Vec3) -> [Spectrum<N>; LOBES + 1] {
        let sin_o = wo.x;
        let cos_o = (1.0 - sin_o * sin_o).max(0.0).sqrt();
        let sin_t = sin_o / self.eta;
        let cos_t = (1.0 - sin_t * sin_t).max(0.0).sqrt();
        // the index seen in the plane across the fibre (Bravais)
        let etap = (self.eta * self.eta - sin_o * sin_o).max(0.0).sqrt() / cos_o.max(1e-6);
        let sin_gamma_t = self.h / etap;
        let cos_gamma_t = (1.0 - sin_gamma_t * sin_gamma_t).max(0.0).sqrt();
        let way = 2.0 * cos_gamma_t / cos_t;
        let t = self.sigma_a.map(|s| math::exp(-s * way));
        let cos_gamma_o = (1.0 - self.h * self.h).max(0.0).sqrt();
        let f = fresnel_dielectric(cos_o * cos_gamma_o, self.eta);
        let tt = t * ((1.0 - f) * (1.0 - f));
        let trt = tt * t * f;
        let rest = trt * t * f;
        [Spectrum::splat(f), tt, trt, Spectrum::from_fn(|k| rest[k] / (1.0 - t[k] * f).max(1e-6))]
    }

    /// Probabilities of the lobes for lane `k`.
    fn shares(a: &[Spectrum<N>; LOBES + 1], k: usize) -> [f32; LOBES + 1] {
        let sum: f32 = a[0][k] + a[1][k] + a[2][k] + a[3][k];
        let inv = if sum > 0.0 { 1.0 / sum } else { 0.0 };
        [a[0][k] * inv, a[1][k] * inv, a[2][k] * inv, a[3][k] * inv]
    }

    /// Sine and cosine of `theta_o`, turned by the tilt of the scales for lobe `p`.
    fn tilted(&self, p: usize, sin_o: f32, cos_o: f32) -> (f32, f32) {
        let (sin, cos) = match p {
            0 => {
                let [s, c] = self.tilt[1];
                (sin_o * c - cos_o * s, cos_o * c + sin_o * s)
            }
            1 => {
                let [s, c] = self.tilt[0];
                (sin_o * c + cos_o * s, cos_o * c - sin_o * s)
            }
            2 => {
                let [s, c] = self.tilt[2];
                (sin_o * c + cos_o * s, cos_o * c - sin_o * s)
            }
            _ => (sin_o, cos_o),
        };
        (sin, cos.abs())
    }

    /// The azimuth of a perfectly smooth fibre's lobe `p`.
    fn azimuth(&self, p: usize, gamma_o: f32, gamma_t: f32) -> f32 {
        let p = p as f32;
        2.0 * p * gamma_t - 2.0 * gamma_o + p * PI
    }

    fn gammas(&self, wo: Vec3) -> (f32, f32) {
        let cos_o = (1.0 - wo.x * wo.x).max(0.0).sqrt();
        let etap = (self.eta * self.eta - wo.x * wo.x).max(0.0).sqrt() / cos_o.max(1e-6);
        // azimuths turn from y to z: seen from behind, y is on the other hand
        let h = if wo.z < 0.0 { -self.h } else { self.h };
        (math::asin(h), math::asin((h / etap).clamp(-1.0, 1.0)))
    }

    /// See [`Bsdf::eval_pdf`](super::Bsdf::eval_pdf). Each lane's density chooses lobes by its own attenuations.
    #[inline(never)]
    pub fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Spectrum<N>, Spectrum<N>) {
        let (sin_o, sin_i) = (wo.x, wi.x);
        let cos = |s: f32| (1.0 - s * s).max(0.0).sqrt();
        let (cos_o, cos_i) = (cos(sin_o), cos(sin_i));
        let phi = math::atan2(wi.z, wi.y) - math::atan2(wo.z, wo.y);
        let a = self.attenuations(wo);
        let (gamma_o, gamma_t) = self.gammas(wo);
        let mut lobes = [0.0; LOBES + 1];
        for (p, lobe) in lobes.iter_mut().enumerate() {
            let (s, c) = self.tilted(p, sin_o, cos_o);
            let round = if p < LOBES {
                trimmed_logistic(wrap(phi - self.azimuth(p, gamma_o, gamma_t)), self.s)
            } else {
                1.0 / TAU
            };
            *lobe = longitudinal(cos_i, c, sin_i, s, self.v[p]) * round;
        }
        let mut f = Spectrum::ZERO;
        let mut pdf = [0.0; N];
        for p in 0..=LOBES {
            f += a[p] * lobes[p];
        }
        for (k, pdf) in pdf.iter_mut().enumerate() {
            let shares = Self::shares(&a, k);
            *pdf = (0..=LOBES).fold(0.0, |sum, p| sum + shares[p] * lobes[p]);
        }
        let z = wi.z.abs();
        (if z > 0.0 { f * (1.0 / z) } else { Spectrum::ZERO }, Spectrum(pdf))
    }

    /// See [`Bsdf::sample`](super::Bsdf::sample).
    #[inline(never)]
    pub fn sample(&self, wo: Vec3, uc: f32, u: [f32; 2]) -> Option<BsdfSample<N>> {
        let sin_o = wo.x;
        let cos_o = (1.0 - sin_o * sin_o).max(0.0).sqrt();
        let shares = Self::shares(&self.attenuations(wo), 0);
        let mut p = 0;
        let mut left = uc;
        while p < LOBES && left >= shares[p] {
            left -= shares[p];
            p += 1;
        }
        // what is left of the number chooses along the fibre
        let along = (left / shares[p].max(1e-9)).min(1.0 - f32::EPSILON);
        let (s, c) = self.tilted(p, sin_o, cos_o);
        let (ux, v) = (u[0].max(1e-5), self.v[p]);
        let cos_theta = 1.0 + v * math::ln(ux + (1.0 - ux) * math::exp(-2.0 / v));
        let sin_theta = (1.0 - cos_theta * cos_theta).max(0.0).sqrt();
        let (_, cos_phi) = math::sin_cos(TAU * u[1]);
        let sin_i = (-cos_theta * s + sin_theta * cos_phi * c).clamp(-1.0, 1.0);
        let cos_i = (1.0 - sin_i * sin_i).max(0.0).sqrt();
        let (gamma_o, gamma_t) = self.gammas(wo);
        let turn = if p < LOBES {
            self.azimuth(p, gamma_o, gamma_t) + sample_trimmed_logistic(along, self.s)
        } else {
            TAU * along
        };
        let (sin_phi, cos_phi) = math::sin_cos(wrap(math::atan2(wo.z, wo.y) + turn));
        let wi = vec3(sin_i, cos_i * cos_phi, cos_i * sin_phi);
        let side = if wi.z * wo.z > 0.0 { BsdfFlags::REFLECTION } else { BsdfFlags::TRANSMISSION };
        BsdfSample::smooth(self.eval_pdf(wo, wi), wi, 1.0, side | BsdfFlags::GLOSSY)
    }
}

/// To \[-pi, pi\].
fn wrap(phi: f32) -> f32 {
    phi - TAU * ((phi + PI) / TAU).floor()
}

/// The lobe along the fibre \[1/rad-like, normalised over the sphere with `N_p`\] (d'Eon et al. 2011, eq. 7).
fn longitudinal(cos_i: f32, cos_o: f32, sin_i: f32, sin_o: f32, v: f32) -> f32 {
    let a = cos_i * cos_o / v;
    let b = sin_i * sin_o / v;
    if v <= 0.1 {
        // ln I0 and sinh in logarithms, where both overflow
        math::exp(log_i0(a) - b - 1.0 / v + std::f32::consts::LN_2 + math::ln(0.5 / v))
    } else {
        let sinh = 0.5 * (math::exp(1.0 / v) - math::exp(-1.0 / v));
        math::exp(-b) * i0(a) / (sinh * 2.0 * v)
    }
}

/// Modified Bessel function of the first kind, order 0, by its series.
fn i0(x: f32) -> f32 {
    let q = 0.25 * x * x;
    let (mut term, mut sum) = (1.0, 1.0);
    for k in 1..=20 {
        term *= q / (k * k) as f32;
        sum += term;
    }
    sum
}

fn log_i0(x: f32) -> f32 {
    // asymptotic (Abramowitz & Stegun 9.7.1)
    if x > 12.0 { x + 0.5 * (-1.837_877_1 + math::ln(1.0 / x) + 0.25 / x) } else { math::ln(i0(x)) }
}

fn logistic_cdf(x: f32, s: f32) -> f32 {
    1.0 / (1.0 + math::exp(-x / s))
}

/// The logistic density on \[-pi, pi\].
fn trimmed_logistic(x: f32, s: f32) -> f32 {
    let e = math::exp(-x.abs() / s);
    let density = e / (s * (1.0 + e) * (1.0 + e));
    density / (logistic_cdf(PI, s) - logistic_cdf(-PI, s))
}

fn sample_trimmed_logistic(u: f32, s: f32) -> f32 {
    let low = logistic_cdf(-PI, s);
    let c = low + u * (logistic_cdf(PI, s) - low);
    let x = s * math::ln(c.max(1e-30) / (1.0 - c).max(1e-30));
    x.clamp(-PI, PI)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere_tests::{chi2, integrate};
    use tyndall_testkit::{Rng, Welford};

    const SIGMA: Spectrum<4> = Spectrum([0.0, 0.3, 1.2, 6.0]);

    fn fibres() -> Vec<Hair<4>> {
        [(0.3, 0.3, 0.3, 2.0), (-0.8, 0.6, 0.25, 0.0), (0.0, 0.25, 0.9, 4.0), (0.95, 1.0, 1.0, 2.0)]
            .map(|(h, m, n, alpha)| Hair::new(h, 1.55, SIGMA, m, n, alpha))
            .to_vec()
    }

    fn views() -> [Vec3; 3] {
        [vec3(0.1, 0.2, 1.0), vec3(-0.7, 0.6, 0.4), vec3(0.4, -0.8, -0.3)].map(Vec3::normalize)
    }

    /// A fibre that absorbs nothing sends out what comes in (Chiang et al. 2016, supplemental).
    #[test]
    fn white_furnace() {
        for (m, n) in [(0.2, 0.2), (0.4, 0.7), (1.0, 1.0)] {
            for wo in views() {
                let mut total = Welford::default();
                let mut rng = Rng::new(4);
                for _ in 0..30_000 {
                    let hair = Hair::new(2.0 * rng.f32() - 1.0, 1.55, Spectrum::<4>::ZERO, m, n, 2.0);
                    let s = hair.sample(wo, rng.f32(), rng.f32x2());
                    total.add(s.map_or(0.0, |s| f64::from(s.f[0] * s.wi.z.abs() / s.pdf[0])));
                }
                assert!((total.mean() - 1.0).abs() < 0.01, "{m} {n} {wo:?}: {}", total.mean());
            }
        }
    }

    /// A black fibre reflects from the side that faces the light: from where its normal halves the angle, at
    /// `h = sin(45 degrees)` for light across the view.
    #[test]
    fn the_side_that_faces_the_light_is_bright() {
        let y = vec3(0.0, 1.0, 0.0);
        for z in [1.0, -1.0] {
            let at = |h: f32| {
                let hair = Hair::new(h, 1.55, Spectrum::<4>::splat(50.0), 0.3, 0.2, 2.0);
                hair.eval_pdf(vec3(0.0, 0.0, z), (y + vec3(0.0, 0.0, 0.1 * z)).normalize()).0[0]
            };
            assert!(at(0.7) > 10.0 * at(0.0) && at(0.0) > at(-0.7), "{} {} {}", at(-0.7), at(0.0), at(0.7));
        }
    }

    #[test]
    fn lobes_are_densities_and_are_sampled_by_them() {
        for (hair, wo) in fibres().into_iter().zip(views().into_iter().cycle()) {
            {
                for lane in [0, 3] {
                    let norm = integrate(|wi| f64::from(hair.eval_pdf(wo, wi).1[lane]));
                    assert!((norm - 1.0).abs() < 0.01, "{hair:?} {wo:?}: {norm}");
                }
                let draw = |rng: &mut Rng| hair.sample(wo, rng.f32(), rng.f32x2()).map(|s| s.wi);
                let pdf = |wi: Vec3| f64::from(hair.eval_pdf(wo, wi).1[0]);
                chi2(draw, pdf, 30_000, 6).assert_ok(&format!("{hair:?}, wo {wo:?}"), 4);
            }
        }
    }

    #[test]
    fn absorption_darkens_and_colours_are_inverted() {
        let hair = fibres()[1];
        let wo = views()[0];
        let total = |k: usize| integrate(|wi| f64::from(hair.eval_pdf(wo, wi).0[k] * wi.z.abs()));
        let totals = [0, 1, 2, 3].map(total);
        assert!(totals.windows(2).all(|t| t[1] < t[0]) && totals[0] <= 1.01, "{totals:?}");
        let s = Hair::<4>::sigma_a_of_colour(Spectrum([1.0, 0.5, 0.2, 0.1]), 0.3);
        assert!(s[0] == 0.0 && s[1] < s[2] && s[2] < s[3], "{s:?}");
    }

    #[test]
    fn bessel_functions_join() {
        assert!((i0(1.0) - 1.266_066).abs() < 1e-5 && (i0(5.0) - 27.239_87).abs() < 1e-3);
        assert!((log_i0(12.01) - math::ln(i0(12.0)) - 0.01).abs() < 2e-3);
    }
}
