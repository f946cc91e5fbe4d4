//! The paths of one group.

use super::{
    Grouping, MOST,
    company::Company,
    end::{Link, Origin, Shared},
    nobody,
};
use crate::{
    glow,
    pixel::{Begin, PixelPass},
    volpath::{Site, Walk},
    weight::{PathWeight, divide},
};
use tyndall_base::{Vec3, hash};
use tyndall_film::{Guide, Patch, PixelBounds, WorkUnit};
use tyndall_geometry::Ray;
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::{sampler::PathSampler, scene::Obstacles};

/// A pixel's path.
struct Member<'s, const N: usize> {
    pixel: (u32, u32),
    exposure: f32,
    filter: f32,
    walk: Walk<'s, N>,
    sampler: PathSampler,
    /// Where the path scatters next.
    site: Option<Site<'s, N>>,
}

/// Fills what no ray fills.
const NOWHERE: Ray = Ray { o: Vec3::ZERO, d: Vec3::ZERO, t_max: 0.0, time: 0.0 };

/// First scatterings of a group, where others' paths may begin.
type Origins<'a, 's, const N: usize> = &'a [Option<Origin<'s, N>>];
/// Rays of one query.
const FAN: usize = 16;

impl PixelPass {
    /// A unit of work with paths shared.
    #[inline(always)]
    pub(crate) fn run_shared<const N: usize>(&self, unit: &WorkUnit, guide: &Guide, out: &mut Patch) {
        let mut values = vec![0.0; self.channels.len()];
        let Some(grouping) = self.grouping else { return };
        for square in unit.window.tiles(grouping.side()) {
            for sample in unit.samples.clone() {
                let seed = self.seed as u32;
                let deal = hash::hash4(seed, sample, square.x0, square.y0);
                for group in 0..(grouping.cell * grouping.cell) as usize {
                    let which = (sample, group, deal);
                    self.group::<N>((&square, grouping), which, (unit, guide), &mut values, out);
                }
            }
        }
    }

    /// Sample number `sample` of the pixels of a square that `deal` gives to the group, for those that take it. All send
    /// their paths, whoever takes them, so that a pixel's sample does not depend on when and where others take theirs.
    #[inline(always)]
    fn group<const N: usize>(
        &self,
        (square, grouping): (&PixelBounds, Grouping),
        (sample, group, deal): (u32, usize, u32),
        (unit, guide): (&WorkUnit, &Guide),
        values: &mut [f32],
        out: &mut Patch,
    ) {
        let (cell, number) = (grouping.cell, grouping.members());
        let (kind, (x0, y0)) = (self.settings.sampler, (square.x0, square.y0));
        let mut common = PathSampler::of_group(kind, self.seed, x0, y0, sample, self.replicates);
        let (u, time) = (common.next_1d(), common.next_1d());
        let w = self.wavelengths.sample::<N>(u);
        // densities at a shared point are those of all members: they must have the same lamp
        let lamp = glow::lamp(&self.scene, &self.settings, &mut common);
        let takes = |(x, y)| guide.samples_for(x, y, &unit.samples).contains(&sample);
        let pixels =
            |k| Some(pixel_of(square, (deal, grouping), k, group)).filter(|&(x, y)| square.contains(x, y));
        if guide.counts.is_some() && !(0..number).filter_map(pixels).any(takes) {
            return;
        }
        let mut members = nobody(number);
        let mut origins: Vec<Option<Origin<'_, N>>> = nobody(number);
        let mut links = Vec::with_capacity(number);
        for k in 0..number {
            if let Some((x, y)) = pixels(k) {
                out.mark(x, y, sample);
                let sampler = self.sampler(x, y, sample).within(
                    (k as u32, grouping.sharers()),
                    self.seed,
                    // one net for the pixels that lie at the same place of their cells
                    (x0 + (x - x0) % cell, y0 + (y - y0) % cell),
                    sample,
                    self.replicates,
                );
                let member = members[k].insert(self.set_out((x, y), sampler, (u, time, lamp), &w));
                origins[k] = member.reach_second(number, &w);
            }
        }
        // what the pixels get
        let mut all = [Spectrum::ZERO; MOST];
        for k in 0..number {
            let Some(member) = &mut members[k] else { continue };
            out.mark(member.pixel.0, member.pixel.1, sample);
            self.go_on(member, (&origins, &mut links), k, &w, &mut all);
        }
        let response = self.channels.prepare(&w);
        for k in 0..number {
            let Some(member) = &members[k] else { continue };
            let (x, y) = member.pixel;
            if !takes((x, y)) {
                continue;
            }
            self.channels.respond_prepared(&(all[k] * member.exposure), &response, values);
            let extra = self.refinement.of(x, y);
            if extra.paths > 0 {
                self.add_low_orders::<N>((x, y), sample, extra, values);
            }
            out.add_sample(x, y, sample, member.filter, values);
        }
    }

    /// The path of a sample, about to start.
    #[inline(always)]
    fn set_out<'s, const N: usize>(
        &'s self,
        pixel: (u32, u32),
        sampler: PathSampler,
        (u, time, lamp): (f32, f32, Option<Vec3>),
        w: &'s Wavelengths<N>,
    ) -> Member<'s, N> {
        let (scene, settings) = (&*self.scene, &self.settings);
        let Begin { ray, exposure, filter, spectrum, sampler } =
            self.begin(pixel.0, pixel.1, sampler, Some(time));
        let start = (PathWeight::START, scene.camera_medium);
        let mut walk = Walk::new(scene, settings, start, ray, spectrum.y, w);
        walk.lamp = lamp;
        walk.pilot = lane_of::<N>(spectrum.x, u);
        walk.anew = true;
        walk.from = self.refinement.of(pixel.0, pixel.1).from;
        Member { pixel, exposure, filter, walk, sampler, site: None }
    }

    /// Follows path `k`, that of `member`, to its end; `all` members get their part.
    #[inline(always)]
    fn go_on<const N: usize>(
        &self,
        member: &mut Member<'_, N>,
        (origins, links): (Origins<'_, '_, N>, &mut Vec<(usize, Link<N>)>),
        k: usize,
        w: &Wavelengths<N>,
        all: &mut [Spectrum<N>; MOST],
    ) {
        let mut company = self.company((origins, links), k, member, w);
        let Member { walk, site, sampler, .. } = member;
        let (mut sends, mut goes_on) = (None, site.is_some());
        if let Some((company, own)) = &mut company {
            all[k] += walk.restart(company.through * *own, company.density * *own);
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
            (Some((company, _)), None) => company.deal(walk.l, |i, part| all[i] += part),
            (Some((company, _)), Some(at)) => company.deal_from(at, walk.l, w, |i, part| all[i] += part),
        }
    }

    /// Who shares what path `k`, that of `member`, goes on from, and one over the density of that point as drawn.
    #[inline(always)]
    fn company<'a, const N: usize>(
        &self,
        (origins, links): (Origins<'_, '_, N>, &'a mut Vec<(usize, Link<N>)>),
        k: usize,
        member: &mut Member<'_, N>,
        w: &Wavelengths<N>,
    ) -> Option<(Company<'a, N>, f32)> {
        let (Some(at), Some(from)) = (&member.site, &origins[k]) else { return None };
        let shared = Shared::new(&member.walk, from, at)?;
        let scene = (&*self.scene, &self.settings);
        let mut company = Company::empty(links);
        for first in (0..origins.len()).step_by(FAN) {
            // one query for the rays of several members to the point
            let (mut aims, mut fan, mut n) = ([const { None }; FAN], [NOWHERE; FAN], 0);
            for i in 0..FAN {
                if first + i != k
                    && let Some(from) = &origins[first + i]
                    && let Some(aim) = shared.aim(from, w)
                {
                    fan[n] = aim.ray;
                    n += 1;
                    aims[i] = Some(aim);
                }
            }
            let mut obstacles = [Obstacles::BLOCKED; FAN];
            self.scene.obstacles_fan(&fan[..n], &mut obstacles[..n]);
            let mut n = 0;
            for i in 0..FAN {
                if first + i == k {
                    company.join(k, shared.own_link(&member.walk));
                } else if let (Some(aim), Some(from)) = (&aims[i], &origins[first + i]) {
                    let Obstacles { blocked, boundaries } = obstacles[n];
                    n += 1;
                    if blocked {
                        continue;
                    }
                    if let Some(link) = shared.link(scene, from, aim, boundaries, w, &mut member.sampler) {
                        company.join(first + i, link);
                    }
                }
            }
        }
        Some((company, 1.0 / shared.own))
    }
}

impl<'s, const N: usize> Member<'s, N> {
    /// Follows the path, one of `number`, to its second scattering; the first, if others' paths may begin there.
    #[inline(always)]
    fn reach_second(&mut self, number: usize, w: &Wavelengths<N>) -> Option<Origin<'s, N>> {
        let Self { walk, site, sampler, .. } = self;
        let mut origin = None;
        if self.exposure != 0.0 {
            // twice the same call would be compiled twice
            for scatterings in 1..=2 {
                walk.follow(site, scatterings, sampler, &mut ());
                let Some(at) = site.as_ref().filter(|_| scatterings == 1) else { break };
                walk.part();
                if at.may_begin(w) {
                    origin = Some(Origin::new(at, walk.weight.beta));
                    walk.company = number;
                }
            }
        }
        walk.company = 0;
        origin
    }
}

impl<const N: usize> Walk<'_, N> {
    /// The first scattering: the lane that led there is forgotten, so that densities of what follows are apart from those
    /// before.
    #[inline(always)]
    fn part(&mut self) {
        let r = self.weight.r_u;
        self.weight.beta = divide(self.weight.beta, r);
        self.weight.r_e = divide(self.weight.r_e, r);
        self.weight.r_u = Spectrum::ONE;
        self.pilot = 0;
        self.anew = false;
    }

    /// Goes on as a path that begins where this one is, with this weight; returns what it brought so far.
    #[inline(always)]
    fn restart(&mut self, beta: Spectrum<N>, r_u: Spectrum<N>) -> Spectrum<N> {
        self.weight = PathWeight { beta, r_u, r_l: Spectrum::ZERO, r_e: Spectrum::ZERO };
        self.rival = None;
        std::mem::replace(&mut self.l, Spectrum::ZERO)
    }
}

/// The pixel of cell `k` that belongs to `group`, by a random order of the cell's pixels.
#[inline(always)]
fn pixel_of(square: &PixelBounds, (deal, grouping): (u32, Grouping), k: usize, group: usize) -> (u32, u32) {
    let cell = grouping.cell;
    let mut pick = 0;
    if cell == 2 {
        let mut order = [0, 1, 2, 3];
        let mut bits = hash::hash2(deal, k as u32);
        for last in [3, 2, 1] {
            order.swap(last, bits as usize % (last + 1));
            bits /= 8;
        }
        pick = order[group];
    }
    let at = |x0: u32, column: u32, within: u32| x0 + cell * column + within;
    // cells along Morton's curve: those of one query are neighbours
    let bit = |i: u32| k as u32 >> i & 1;
    let (column, row) = (bit(0) | bit(2) << 1 | bit(4) << 2, bit(1) | bit(3) << 1 | bit(5) << 2);
    (at(square.x0, column, pick % 2), at(square.y0, row, pick / 2))
}

/// The lane that lies in the same N-th of the wavelengths as `v`, where lane 0 was drawn by `u`.
#[inline(always)]
fn lane_of<const N: usize>(v: f32, u: f32) -> usize {
    let part = |u: f32| (u * N as f32) as usize;
    (part(v) + N - part(u)) % N
}
