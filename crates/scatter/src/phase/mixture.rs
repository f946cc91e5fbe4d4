//! Several species in one medium: `p = sum_k sigma_s_k p_k / sum_k sigma_s_k` per lane.

use super::{PhaseFunction, PhaseSample};
use tyndall_base::vec::Vec3;
use tyndall_spectral::{Spectrum, Wavelengths};

/// Most species a medium may hold.
pub const MAX_SPECIES: usize = 4;

/// The scattering of a medium at one point: a few `(sigma_s_k [1/m], phase function)`.
#[derive(Clone, Copy, Debug)]
pub struct Mixture<'m, const N: usize> {
    species: [(Spectrum<N>, &'m PhaseFunction); MAX_SPECIES],
    len: usize,
    sigma_s: Spectrum<N>,
}

impl<'m, const N: usize> Mixture<'m, N> {
    /// A point that does not scatter.
    pub const NONE: Self = Self {
        species: [(Spectrum::ZERO, &PhaseFunction::Isotropic); MAX_SPECIES],
        len: 0,
        sigma_s: Spectrum::ZERO,
    };

    /// One species.
    #[inline(always)]
    pub fn single(sigma_s: Spectrum<N>, phase: &'m PhaseFunction) -> Self {
        let mut all = Self::NONE;
        all.species[0] = (sigma_s, phase);
        Self { len: 1, sigma_s, ..all }
    }

    /// Adds a species. Media refuse more than [`MAX_SPECIES`] when they are built.
    ///
    /// # Panics
    /// When it is full.
    #[inline(always)]
    pub fn push(&mut self, sigma_s: Spectrum<N>, phase: &'m PhaseFunction) {
        self.species[self.len] = (sigma_s, phase);
        self.len += 1;
        self.sigma_s += sigma_s;
    }

    /// Total scattering coefficient \[1/m\] per lane.
    #[inline(always)]
    pub fn sigma_s(&self) -> Spectrum<N> {
        self.sigma_s
    }

    /// The species.
    #[inline(always)]
    pub fn species(&self) -> &[(Spectrum<N>, &'m PhaseFunction)] {
        &self.species[..self.len]
    }

    /// Phase function of the mixture \[1/sr\] per lane: also each lane's density. Zero in a lane that does not scatter.
    #[inline(always)]
    pub fn eval(&self, wo: Vec3, wi: Vec3, lambda: &Wavelengths<N>) -> Spectrum<N> {
        match self.species() {
            [] => Spectrum::ZERO,
            [(sigma_s, phase)] => scatters(sigma_s, phase.eval(wo, wi, lambda)),
            several => several
                .iter()
                .fold(Spectrum::ZERO, |sum, (sigma_s, phase)| sum + *sigma_s * phase.eval(wo, wi, lambda))
                .safe_div(self.sigma_s),
        }
    }

    /// Draws `wi`; `uc` chooses the species by the hero's `sigma_s`. `None` where the hero does not scatter: the path
    /// ends, as its density for every lane with `sigma_s = 0` says.
    #[inline(always)]
    pub fn sample(&self, wo: Vec3, uc: f32, u: [f32; 2], lambda: &Wavelengths<N>) -> Option<PhaseSample<N>> {
        if let [(sigma_s, phase)] = self.species() {
            let s = phase.sample(wo, u, lambda);
            return (sigma_s.hero() > 0.0).then(|| PhaseSample { wi: s.wi, p: scatters(sigma_s, s.p) });
        }
        let wi = self.choose(uc)?.sample(wo, u, lambda).wi;
        let p = self.eval(wo, wi, lambda);
        (p.hero() > 0.0).then_some(PhaseSample { wi, p })
    }

    /// A species with probability proportional to the hero's `sigma_s`.
    #[inline]
    fn choose(&self, uc: f32) -> Option<&'m PhaseFunction> {
        let mut left = uc * self.sigma_s.hero();
        let mut scattering = self.species().iter().filter(|(sigma_s, _)| sigma_s.hero() > 0.0);
        // rounding may leave a remainder: it belongs to the last species that scatters
        let mut last = None;
        scattering
            .find(|(sigma_s, phase)| {
                last = Some(*phase);
                left -= sigma_s.hero();
                left < 0.0
            })
            .map(|(_, phase)| *phase)
            .or(last)
    }

    /// `<cos theta>` of the mixture at lane `k`, 0 where it does not scatter.
    pub fn mean_cosine(&self, lambda: &Wavelengths<N>, k: usize) -> f32 {
        let moment: f32 =
            self.species().iter().map(|(s, phase)| s[k] * phase.mean_cosine(lambda.lambda[k])).sum();
        if self.sigma_s[k] > 0.0 { moment / self.sigma_s[k] } else { 0.0 }
    }
}

/// `p` in the lanes that scatter, zero in the others.
#[inline(always)]
fn scatters<const N: usize>(sigma_s: &Spectrum<N>, p: Spectrum<N>) -> Spectrum<N> {
    Spectrum::from_fn(|k| if sigma_s[k] > 0.0 { p[k] } else { 0.0 })
}
