//! All who share what scatters at one point: how much of it each gets.

use super::end::Link;
use crate::volpath::{Audience, Scatters, Site};
use tyndall_base::Vec3;
use tyndall_spectral::{Spectrum, Wavelengths};

/// The links of one shared point.
pub(super) struct Company<'a, const N: usize> {
    /// By who reaches the point.
    links: &'a mut Vec<(usize, Link<N>)>,
    /// Sums over all links.
    through: Spectrum<N>,
    density: Spectrum<N>,
    /// Light that was sampled at the point, and where from.
    lit: (Vec3, Spectrum<N>),
    /// What the next to join gets besides, as all links together get what they do by weights that lack something.
    mended: Option<(usize, Spectrum<N>)>,
    /// One over the density that the point was drawn with; the density that weights have in its place, over it.
    drawn: f32,
    skew: f32,
    /// Where the path went on to.
    leaves: Vec3,
}

impl<'a, const N: usize> Company<'a, N> {
    /// Nobody yet; `links` is room for those who may join.
    #[inline(always)]
    pub fn empty(links: &'a mut Vec<(usize, Link<N>)>) -> Self {
        links.clear();
        let zero = Spectrum::ZERO;
        Self {
            links,
            through: zero,
            density: zero,
            lit: (Vec3::ZERO, zero),
            mended: None,
            drawn: 0.0,
            skew: 1.0,
            leaves: Vec3::ZERO,
        }
    }

    /// Member `k`, whose path drew the point with the density `own`, reaches it by `link`.
    #[inline(always)]
    pub fn begin(&mut self, k: usize, link: Link<N>, own: f32, skew: f32) {
        (self.drawn, self.skew) = (1.0 / own, skew);
        self.join(k, link);
    }

    /// The same in media that vary, by the `exact` link and the one that weights are made of; false where there is no saying.
    #[inline(always)]
    #[must_use]
    pub fn begin_by(&mut self, k: usize, exact: Link<N>, weighed: Link<N>) -> bool {
        let own = exact.density.hero();
        let skew = weighed.density.hero() / own;
        self.begin(k, Link { through: exact.through, ..weighed }, own, skew);
        own.is_normal() && skew.is_finite()
    }

    /// Throughput and density of the path that goes on from the point for all, over the density that it was drawn with.
    #[inline(always)]
    pub fn start(&self) -> (Spectrum<N>, Spectrum<N>) {
        (self.through * (self.drawn * self.skew), self.density * self.drawn)
    }

    /// The part that the path itself has in the density of the point, and what that density is over the one drawn with.
    pub fn own(&self) -> [f32; 2] {
        [self.skew / (self.density.hero() * self.drawn), self.skew]
    }

    /// The next to join gets this, too, of what the point scatters.
    #[inline(always)]
    pub fn mend(&mut self, extra: Spectrum<N>) {
        self.mended = Some((self.links.len(), extra));
    }

    /// Member `i` reaches the point by `link`.
    #[inline(always)]
    pub fn join(&mut self, i: usize, link: Link<N>) {
        self.through += link.through;
        self.density += link.density;
        self.links.push((i, link));
    }

    /// Parts of `l` for the members that `give` says, by what reaches each.
    #[inline(always)]
    pub fn deal(&self, l: Spectrum<N>, mut give: impl FnMut(usize, Spectrum<N>)) {
        let l = l.safe_div(self.through);
        for (i, link) in self.links.iter() {
            give(*i, l * link.through);
        }
        if let Some((n, extra)) = &self.mended {
            give(self.links[*n].0, l * *extra);
        }
    }

    /// The same where `at` does not scatter alike for all: `l` came by the direction that the path took, sampled light by its
    /// own.
    #[inline(always)]
    pub fn deal_from(
        &mut self,
        at: &Site<'_, N>,
        l: Spectrum<N>,
        w: &Wavelengths<N>,
        mut give: impl FnMut(usize, Spectrum<N>),
    ) {
        for (l, wi) in [(l, self.leaves), (self.lit.1, self.lit.0)] {
            if l.is_zero() {
                continue;
            }
            match at {
                Site::Medium(at) => self.deal_towards(at, wi, l, w, &mut give),
                Site::Surface(at) => self.deal_towards(at, wi, l, w, &mut give),
            }
        }
    }

    /// Parts of `l`, which came from `wi`.
    #[inline(always)]
    fn deal_towards(
        &mut self,
        at: &impl Scatters<N>,
        wi: Vec3,
        l: Spectrum<N>,
        w: &Wavelengths<N>,
        give: &mut impl FnMut(usize, Spectrum<N>),
    ) {
        let mut all = Spectrum::ZERO;
        for (_, link) in self.links.iter_mut() {
            link.sent = link.through * at.eval_from(link.wo, wi, w).0;
            all += link.sent;
        }
        let l = l.safe_div(all);
        for (i, link) in self.links.iter() {
            give(*i, l * link.sent);
        }
        if let Some((n, extra)) = &self.mended {
            let (i, link) = &self.links[*n];
            give(*i, l * *extra * at.eval_from(link.wo, wi, w).0);
        }
    }

    /// Sums over all links of what goes on to `wi`, and of its density.
    #[inline(always)]
    fn sums(&self, at: &impl Scatters<N>, wi: Vec3, w: &Wavelengths<N>) -> (Spectrum<N>, Spectrum<N>) {
        let (mut through, mut density) = (Spectrum::ZERO, Spectrum::ZERO);
        for (_, link) in self.links.iter() {
            let (f, pdf) = at.eval_from(link.wo, wi, w);
            through += link.through * f;
            density += link.density * pdf;
        }
        (through, density)
    }
}

impl<const N: usize> Audience<N> for Company<'_, N> {
    #[inline(always)]
    fn eval(
        &self,
        at: &impl Scatters<N>,
        wi: Vec3,
        _: impl FnOnce() -> (Spectrum<N>, Spectrum<N>),
        w: &Wavelengths<N>,
    ) -> (Spectrum<N>, Spectrum<N>) {
        let (through, density) = self.sums(at, wi, w);
        (through.safe_div(self.through), density.safe_div(self.density))
    }

    #[inline(always)]
    fn drawn(&mut self, wi: Vec3) {
        self.leaves = wi;
    }

    #[inline(always)]
    fn lit(&mut self, wi: Vec3, value: Spectrum<N>) -> Spectrum<N> {
        self.lit = (wi, value);
        Spectrum::ZERO
    }
}
