//! The paths of one group.

use super::{
    Grouping, MOST,
    depart::{Member, Origins, Which, pixel_of},
    end::Link,
    join::Yardsticks,
    level::Level,
};
use crate::{pixel::PixelPass, settings::Lengths, volpath::Site, weight::divide};
use tyndall_base::hash;
use tyndall_film::{Guide, Patch, PixelBounds, WorkUnit};
use tyndall_spectral::{Spectrum, Wavelengths};

/// What the pixels of a group get.
pub(super) struct Shares<const N: usize> {
    pub light: [Spectrum<N>; MOST],
    /// What each would get of light 1 from everywhere if it did not share, less what it does get: zero on average.
    pub lack: [Spectrum<N>; MOST],
    wants_lack: bool,
}

impl<const N: usize> Shares<N> {
    /// Nothing yet; `wants_lack` tells whether anybody asks for that.
    #[inline(always)]
    pub fn new(wants_lack: bool) -> Self {
        let nothing = [Spectrum::ZERO; MOST];
        Self { light: nothing, lack: nothing, wants_lack }
    }
}

impl PixelPass {
    /// A unit of work with paths shared.
    #[inline(always)]
    pub(crate) fn run_shared<const N: usize>(&self, unit: &WorkUnit, guide: &Guide, out: &mut Patch) {
        let mut values = vec![0.0; self.channels.len()];
        let Some(grouping) = self.grouping else { return };
        let yardsticks = Yardsticks::of(&self.scene, &self.settings, Lengths::Coarse);
        for square in unit.window.tiles(grouping.side()) {
            for sample in unit.samples.clone() {
                let seed = self.seed as u32;
                let deal = hash::hash4(seed, sample, square.x0, square.y0);
                for group in 0..(grouping.cell * grouping.cell) as usize {
                    let which = (sample, group, deal);
                    self.group::<N>(&yardsticks, (&square, grouping), which, (unit, guide), &mut values, out);
                }
            }
        }
    }

    /// Sample number `sample` of the pixels of a square that `deal` gives to the group, for those that take it. All send
    /// their paths, whoever takes them, so that a pixel's sample does not depend on when and where others take theirs.
    #[inline(always)]
    fn group<const N: usize>(
        &self,
        yardsticks: &Yardsticks,
        (square, grouping): (&PixelBounds, Grouping),
        which: Which,
        (unit, guide): (&WorkUnit, &Guide),
        values: &mut [f32],
        out: &mut Patch,
    ) {
        let number = grouping.members();
        let takes = |(x, y)| guide.samples_for(x, y, &unit.samples).contains(&which.0);
        let pixel = |k| pixel_of(square, (which.2, grouping), k, which.1);
        let inside = |&(x, y): &(u32, u32)| square.contains(x, y);
        if guide.counts.is_some() && !(0..number).map(pixel).filter(inside).any(takes) {
            return;
        }
        let sample = which.0;
        let common = self.common::<N>(square, sample);
        let w = &common.w;
        let (mut members, origins) =
            self.depart((square, grouping), which, &common, |(x, y)| out.mark(x, y, sample));
        let mut links = Vec::with_capacity(number);
        let mut shares = Shares::new(self.level != Level::NONE);
        for k in 0..number {
            let Some(member) = &mut members[k] else { continue };
            out.mark(member.pixel.0, member.pixel.1, sample);
            self.go_on(yardsticks, member, (&origins, &mut links), k, w, &mut shares);
        }
        let (response, level) = (self.channels.prepare(w), self.level.at(common.u));
        for k in 0..number {
            let Some(member) = &members[k] else { continue };
            let (x, y) = member.pixel;
            if !takes((x, y)) {
                continue;
            }
            let l = shares.light[k] + shares.lack[k] * level;
            self.channels.respond_prepared(&(l * member.exposure), &response, values);
            let extra = self.refinement.of(x, y);
            if extra.paths > 0 {
                self.add_low_orders::<N>((x, y), sample, extra, values);
            }
            out.add_sample(x, y, sample, member.filter, values);
        }
    }

    /// Follows path `k`, that of `member`, to its end; the members get their part.
    #[inline(always)]
    pub(super) fn go_on<'s, const N: usize>(
        &'s self,
        yardsticks: &Yardsticks,
        member: &mut Member<'s, N>,
        (origins, links): (&Origins<'s, N>, &mut Vec<(usize, Link<N>)>),
        k: usize,
        w: &Wavelengths<N>,
        shares: &mut Shares<N>,
    ) {
        let mut company = self.company(yardsticks, (origins, links), k, member, w);
        let Member { walk, site, sampler, .. } = member;
        let all = &mut shares.light;
        walk.open = false;
        let (mut sends, mut goes_on) = (None, site.is_some());
        if let Some(company) = &mut company {
            let (beta, r_u) = company.start();
            if shares.wants_lack {
                let lack = &mut shares.lack;
                lack[k] += divide(walk.weight.beta, walk.weight.r_u);
                company.deal(divide(beta, r_u) * -1.0, |i, part| lack[i] += part);
            }
            all[k] += walk.restart(beta, r_u);
            // each member gets another part of what scatters
            sends = site.take_if(|at| at.tells_apart());
            match &sends {
                Some(Site::Medium(at)) => goes_on = walk.scatter_medium(at, company, sampler, &mut ()),
                Some(Site::Surface(at)) => goes_on = walk.scatter_surface(at, company, sampler, &mut ()),
                None => {}
            }
        }
        if goes_on {
            walk.follow(site, u32::MAX, sampler, &mut ());
        }
        match (&mut company, &sends) {
            (None, _) => all[k] += walk.l,
            (Some(company), None) => company.deal(walk.l, |i, part| all[i] += part),
            (Some(company), Some(at)) => company.deal_from(at, walk.l, w, |i, part| all[i] += part),
        }
    }
}
