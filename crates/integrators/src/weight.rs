//! The weight of a path over its wavelengths, and every division by a density.
//!
//! Spectral multiple importance sampling in path space (Wilkie et al. 2014; Miller, Georgiev, Jarosz 2019): a path is
//! drawn with the hero's densities; the estimate for lane k is
//!
//! ```text
//! beta_k L_k / mean_j( sum over techniques of r_j ),   beta_k = f_k / p_hero,   r_j = p_j / p_hero
//! ```
//!
//! where `f_k` is the path's contribution at wavelength k and `p_j` the density with which wavelength j would have
//! drawn the same path. `r_u` belongs to the path as it was drawn (emitters met by chance); `r_l` to the same path
//! whose last vertex was chosen on a light; `r_e` to the path whose last two vertices were chosen by equiangular
//! sampling. Other heuristics over techniques divide by something else made of the `mean_j(r_j)` of each ([`Heuristic`]).
//! All are zero-safe: a lane that cannot be drawn has `r = 0`, and a path that no lane can draw is dead.

use tyndall_spectral::Spectrum;

/// Exponents beyond this are cut, so that no product leaves the range of f32.
const EXPONENT_LIMIT: f32 = 80.0;

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct PathWeight<const N: usize> {
    /// Throughput over the hero's density.
    pub beta: Spectrum<N>,
    /// Rescaled density of the path as drawn.
    pub r_u: Spectrum<N>,
    /// Rescaled density of the path with its end on a light, without the light's own density.
    pub r_l: Spectrum<N>,
    /// Rescaled density of the path with its last scattering and end drawn by equiangular sampling, without that
    /// technique's own density.
    pub r_e: Spectrum<N>,
}

impl<const N: usize> PathWeight<N> {
    /// The weight at the camera.
    pub const START: Self =
        Self { beta: Spectrum::ONE, r_u: Spectrum::ONE, r_l: Spectrum::ZERO, r_e: Spectrum::ZERO };

    /// A scattering with throughput `f` (cosine included) drawn with per-lane densities `pdf`; false when dead.
    #[inline(always)]
    #[must_use]
    pub fn scatter(&mut self, f: Spectrum<N>, pdf: Spectrum<N>, delta: bool) -> bool {
        let hero = pdf.hero();
        if hero.is_nan() || hero <= 0.0 {
            return false;
        }
        let inv = 1.0 / hero;
        self.beta *= f * inv;
        if delta {
            (self.r_l, self.r_e) = (Spectrum::ZERO, Spectrum::ZERO);
        } else {
            self.r_l = self.r_u * inv;
            self.r_e *= inv;
        }
        self.r_u *= pdf * inv;
        self.renormalise();
        !self.beta.is_zero()
    }

    /// Goes on with the hero's wavelength alone: a surface has no value for the others. Their densities go with them,
    /// so that the hero carries the weight of all.
    #[inline(never)]
    pub fn keep_hero(&mut self) {
        let hero = Spectrum::from_fn(|k| if k == 0 { 1.0 } else { 0.0 });
        for w in [&mut self.beta, &mut self.r_u, &mut self.r_l, &mut self.r_e] {
            *w *= hero;
        }
    }

    /// An event of free flight: contribution `f` per lane, lanes' densities `pdf`, both already over the hero's.
    #[inline(always)]
    pub fn fly(&mut self, f_over_hero: Spectrum<N>, pdf_over_hero: Spectrum<N>) {
        self.beta *= f_over_hero;
        self.r_u *= pdf_over_hero;
    }

    /// A null collision that the lane `pilot` decided: coefficient `sigma_n` per lane, and what the techniques that choose a light would have put
    /// there, `competing`; false when the hero cannot have made it.
    #[inline(always)]
    #[must_use]
    pub fn null(&mut self, pilot: usize, sigma_n: Spectrum<N>, competing: Spectrum<N>) -> bool {
        let hero = sigma_n[pilot];
        if hero.is_nan() || hero <= 0.0 {
            return false;
        }
        let inv = 1.0 / hero;
        self.fly(sigma_n * inv, sigma_n * inv);
        self.compete(competing * inv);
        true
    }

    /// What the techniques that choose a light have in place of an event of flight, over the hero's density.
    #[inline(always)]
    pub fn compete(&mut self, density_over_hero: Spectrum<N>) {
        self.r_l *= density_over_hero;
        self.r_e *= density_over_hero;
    }

    /// Survived a roulette with probability `q`, the same for all lanes.
    #[inline(always)]
    pub fn survive(&mut self, q: f32) {
        self.beta *= 1.0 / q;
    }

    /// Throughput that the lanes agree on: `beta / mean(r_u)`.
    #[inline(always)]
    pub fn throughput(&self) -> Spectrum<N> {
        divide(self.beta, self.r_u)
    }

    /// Keeps the numbers in range: all weights share one arbitrary factor.
    #[inline(always)]
    fn renormalise(&mut self) {
        let m = self.r_u.mean();
        if !(1e-6..=1e6).contains(&m) && m > 0.0 {
            let s = 1.0 / m;
            for w in [&mut self.beta, &mut self.r_u, &mut self.r_l, &mut self.r_e] {
                *w *= s;
            }
        }
    }
}

/// `value / mean(r)`, zero where no technique reaches.
#[inline(always)]
pub fn divide<const N: usize>(value: Spectrum<N>, r: Spectrum<N>) -> Spectrum<N> {
    let m = r.mean();
    if m > 0.0 { value * (1.0 / m) } else { Spectrum::ZERO }
}

/// How techniques that reach the same light are combined; within each, wavelengths are by the balance heuristic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heuristic {
    /// By densities (Veach 1997, eq. 9.8): `value / sum of mean(r)`.
    Balance,
    /// By their squares (eq. 9.13): `value mean(own) / sum of mean(r)^2`. Better where a technique of small density would add
    /// its noise to a good one.
    Power,
    /// By densities, of which light sampling's counts half: shadow rays estimate their transmittance, and that noise is not in
    /// the density.
    Tracked,
}

impl Heuristic {
    /// What the density of light sampling is multiplied by, wherever it enters a weight.
    #[inline(always)]
    pub fn trust(self) -> f32 {
        if self == Self::Tracked { 0.5 } else { 1.0 }
    }
}

/// `value` as the technique of the densities `own` brings it, where `others` could have; zero where no lane can be drawn.
#[inline(always)]
pub fn combine<const N: usize, const K: usize>(
    heuristic: Heuristic,
    value: Spectrum<N>,
    own: Spectrum<N>,
    others: [Spectrum<N>; K],
) -> Spectrum<N> {
    let own = own.mean();
    if own <= 0.0 || own.is_nan() {
        return Spectrum::ZERO;
    }
    let mut sum = 1.0;
    for r in others {
        // squares of ratios stay in range where those of densities do not
        let ratio = r.mean() / own;
        sum += if heuristic == Heuristic::Power { ratio * ratio } else { ratio };
    }
    value * (1.0 / own / sum)
}

/// `exp(x)` per lane with the exponent cut to the range that products of f32 bear.
#[inline(always)]
pub fn exp<const N: usize>(x: Spectrum<N>) -> Spectrum<N> {
    let cut = x.map(|v| {
        let v = if v > EXPONENT_LIMIT { EXPONENT_LIMIT } else { v };
        if v < -EXPONENT_LIMIT { -EXPONENT_LIMIT } else { v }
    });
    Spectrum(tyndall_base::math::exp_n(cut.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_over_zero_is_dead_not_nan() {
        let mut w = PathWeight::<4>::START;
        assert!(!w.scatter(Spectrum::ZERO, Spectrum::ZERO, false));
        assert!(w.throughput().is_finite());
        let none = divide(Spectrum::<4>::ONE, Spectrum::ZERO);
        assert!(none.is_zero());
    }

    #[test]
    fn only_estimated_transmittance_lessens_trust() {
        let trust = [Heuristic::Balance, Heuristic::Power, Heuristic::Tracked].map(Heuristic::trust);
        assert!(trust == [1.0, 1.0, 0.5]);
    }

    /// What a technique brings, times how often it does, adds up to the value, whatever the heuristic.
    #[test]
    fn parts_of_all_techniques_add_up() {
        let techniques = [Spectrum([3.0, 1.0]), Spectrum([0.5, 0.1]), Spectrum([0.0, 7.0])];
        let value = Spectrum([2.0, 5.0]);
        // the second is light sampling
        for heuristic in [Heuristic::Balance, Heuristic::Power, Heuristic::Tracked] {
            let trust = [1.0, heuristic.trust(), 1.0];
            let counts = |i: usize| techniques[i] * trust[i];
            let mut sum = Spectrum::ZERO;
            for own in 0..3 {
                let others = [1, 2].map(|k| counts((own + k) % 3));
                let brings = combine(heuristic, value * trust[own], counts(own), others);
                sum += brings * techniques[own].mean();
            }
            assert!((sum[0] / 2.0 - 1.0).abs() < 1e-6 && (sum[1] / 5.0 - 1.0).abs() < 1e-6, "{sum:?}");
        }
        let huge = combine(Heuristic::Power, value, Spectrum([1e10; 2]), [Spectrum([1e20; 2])]);
        assert!(huge.is_finite() && huge[0] > 0.0, "{huge:?}");
        assert!(combine(Heuristic::Power, value, Spectrum::ZERO, [value]).is_zero());
    }

    #[test]
    fn a_lane_that_cannot_be_drawn_stays_zero() {
        let mut w = PathWeight::<4>::START;
        assert!(w.scatter(Spectrum([0.5, 0.0, 0.5, 0.5]), Spectrum([1.0, 0.0, 1.0, 1.0]), true));
        let t = w.throughput();
        assert!(t[1] == 0.0 && (t[0] - 0.5 / 0.75).abs() < 1e-6, "{t:?}");
    }

    /// In the mean over who is the hero, a path of the hero alone gives what a path of all gives.
    #[test]
    fn the_hero_alone_carries_the_weight_of_all() {
        let mut w = PathWeight::<4>::START;
        w.keep_hero();
        let t = w.throughput();
        assert!(t[0] == 4.0 && t[1] == 0.0 && t.mean() == 1.0, "{t:?}");
    }

    #[test]
    fn weights_do_not_depend_on_the_common_factor() {
        let mut w = PathWeight::<2>::START;
        w.fly(Spectrum([1e-5, 2e-5]), Spectrum([1e-9, 3e-9]));
        let before = w.throughput();
        assert!(w.scatter(Spectrum::ONE, Spectrum::ONE, false));
        let after = w.throughput();
        assert!((before[1] / after[1] - 1.0).abs() < 1e-5);
    }

    #[test]
    fn long_flights_stay_finite() {
        let x = exp(Spectrum::<8>([-1e30, -200.0, -1.0, 0.0, 1.0, 79.0, 200.0, 1e30]));
        assert!(x.is_finite() && x[0] > 0.0, "{x:?}");
    }
}
