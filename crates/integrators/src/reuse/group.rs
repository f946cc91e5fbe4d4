//! The paths of one group.

use super::{CELLS, MEMBERS, cell_side, company::Company, end::Shared};
use crate::{
    glow,
    pixel::{Begin, PixelPass},
    volpath::{Site, Walk},
    weight::{PathWeight, divide},
};
use tyndall_base::{Vec3, hash};
use tyndall_film::{Guide, Patch, PixelBounds, WorkUnit};
use tyndall_geometry::Ray;
use tyndall_scatter::phase::PhaseFunction;
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
    /// The first scattering and the throughput there, if others' paths may begin there.
    from: Option<(Site<'s, N>, Spectrum<N>)>,
    /// What the pixel gets.
    l: Spectrum<N>,
}

/// Fills what no ray fills.
const NOWHERE: Ray = Ray { o: Vec3::ZERO, d: Vec3::ZERO, t_max: 0.0, time: 0.0 };

/// Room for the paths of a group.
type Members<'s, const N: usize> = [Option<Member<'s, N>>; MEMBERS];

impl PixelPass {
    /// A unit of work with paths shared.
    #[inline(always)]
    pub(crate) fn run_shared<const N: usize>(&self, unit: &WorkUnit, guide: &Guide, out: &mut Patch) {
        let mut values = vec![0.0; self.channels.len()];
        let cell = cell_side(self.resolution);
        for square in unit.window.tiles(CELLS * cell) {
            for sample in unit.samples.clone() {
                let seed = self.seed as u32;
                let deal = hash::hash4(seed, sample, square.x0, square.y0);
                for group in 0..(cell * cell) as usize {
                    self.group::<N>(&square, (sample, group, deal), (unit, guide), &mut values, out);
                }
            }
        }
    }

    /// Sample number `sample` of the pixels of a square that `deal` gives to the group, for those that take it. All send
    /// their paths, whoever takes them, so that a pixel's sample does not depend on when and where others take theirs.
    #[inline(always)]
    fn group<const N: usize>(
        &self,
        square: &PixelBounds,
        (sample, group, deal): (u32, usize, u32),
        (unit, guide): (&WorkUnit, &Guide),
        values: &mut [f32],
        out: &mut Patch,
    ) {
        let cell = cell_side(self.resolution);
        let (kind, (x0, y0)) = (self.settings.sampler, (square.x0, square.y0));
        let mut common = PathSampler::of_group(kind, self.seed, x0, y0, sample, self.replicates);
        let (u, time) = (common.next_1d(), common.next_1d());
        let w = self.wavelengths.sample::<N>(u);
        let takes = |(x, y)| guide.samples_for(x, y, &unit.samples).contains(&sample);
        let pixels =
            |k| Some(pixel_of(square, (deal, cell), k, group)).filter(|&(x, y)| square.contains(x, y));
        if guide.counts.is_some() && !(0..MEMBERS).filter_map(pixels).any(takes) {
            return;
        }
        let mut members: Members<'_, N> = [const { None }; MEMBERS];
        for k in 0..MEMBERS {
            if let Some((x, y)) = pixels(k) {
                out.mark(x, y, sample);
                members[k] = Some(self.set_out((x, y), sample, (u, time), &w));
            }
        }
        for k in 0..MEMBERS {
            let Some(member) = &members[k] else { continue };
            out.mark(member.pixel.0, member.pixel.1, sample);
            self.go_on(&mut members, k, &w);
        }
        let response = self.channels.prepare(&w);
        for member in members.iter().flatten() {
            let (x, y) = member.pixel;
            if !takes((x, y)) {
                continue;
            }
            self.channels.respond_prepared(&(member.l * member.exposure), &response, values);
            out.add_sample(x, y, sample, member.filter, values);
        }
    }

    /// Follows a path to its second scattering.
    #[inline(always)]
    fn set_out<'s, const N: usize>(
        &'s self,
        pixel: (u32, u32),
        sample: u32,
        (u, time): (f32, f32),
        w: &'s Wavelengths<N>,
    ) -> Member<'s, N> {
        let (scene, settings) = (&*self.scene, &self.settings);
        let Begin { ray, exposure, filter, spectrum, mut sampler } =
            self.begin(pixel.0, pixel.1, sample, Some(time));
        let start = (PathWeight::START, scene.camera_medium);
        let mut walk = Walk::new(scene, settings, start, ray, spectrum.y, w);
        walk.lamp = glow::lamp(scene, settings, &mut sampler);
        walk.pilot = lane_of::<N>(spectrum.x, u);
        walk.anew = true;
        let (mut site, mut from) = (None, None);
        if exposure != 0.0 {
            // twice the same call would be compiled twice
            for scatterings in 1..=2 {
                walk.follow(&mut site, scatterings, &mut sampler, &mut ());
                let Some(at) = site.as_ref().filter(|_| scatterings == 1) else { break };
                walk.part();
                if at.may_begin(w) {
                    from = Some((*at, walk.weight.beta));
                    walk.company = MEMBERS;
                }
            }
        }
        walk.company = 0;
        Member { pixel, exposure, filter, walk, sampler, site, from, l: Spectrum::ZERO }
    }

    /// Follows path `k` to its end; all members get their part.
    #[inline(always)]
    fn go_on<'s, const N: usize>(&self, members: &mut Members<'s, N>, k: usize, w: &Wavelengths<N>) {
        let Some(mut member) = members[k].take() else { return };
        let company = self.company(members, k, &mut member, w);
        let Member { walk, site, sampler, l: gets, .. } = &mut member;
        let Some((mut company, own)) = company else {
            if site.is_some() {
                walk.follow(site, u32::MAX, sampler, &mut ());
            }
            *gets += walk.l;
            members[k] = Some(member);
            return;
        };
        let before = walk.restart(company.through * own, company.density * own);
        // a phase function sends each member another part of what scatters
        let sends = match site {
            Some(Site::Medium(at)) if !matches!(at.inside.phase, PhaseFunction::Isotropic) => Some(*at),
            _ => None,
        };
        let goes_on = match &sends {
            Some(at) => {
                *site = None;
                walk.scatter_medium(at, &mut company, sampler, &mut ())
            }
            None => true,
        };
        if goes_on {
            walk.follow(site, u32::MAX, sampler, &mut ());
        }
        let l = walk.l;
        *gets += before;
        members[k] = Some(member);
        let give = |i: usize, part| {
            if let Some(member) = &mut members[i] {
                member.l += part;
            }
        };
        match &sends {
            Some(at) => company.deal_from(at, l, w, give),
            None => company.deal(l, give),
        }
    }

    /// Who shares what path `k`, `member`, goes on from, and one over the density of that point as drawn.
    #[inline(always)]
    fn company<'s, const N: usize>(
        &self,
        members: &Members<'s, N>,
        k: usize,
        member: &mut Member<'s, N>,
        w: &Wavelengths<N>,
    ) -> Option<(Company<N>, f32)> {
        let (Some(at), Some((from, _))) = (&member.site, &member.from) else { return None };
        let shared = Shared::new(&member.walk, from, at)?;
        let scene = (&*self.scene, &self.settings);
        // one query for all rays to the point
        let (mut aims, mut fan, mut n) = ([const { None }; MEMBERS], [NOWHERE; MEMBERS], 0);
        for i in 0..MEMBERS {
            if let Some(Member { from: Some((from, beta)), .. }) = &members[i]
                && let Some(aim) = shared.aim(from, *beta, w)
            {
                fan[n] = aim.ray;
                n += 1;
                aims[i] = Some(aim);
            }
        }
        let mut obstacles = [Obstacles::BLOCKED; MEMBERS];
        self.scene.obstacles_fan(&fan[..n], &mut obstacles[..n]);
        let (mut company, mut n) = (Company::empty(), 0);
        for i in 0..MEMBERS {
            if i == k {
                company.join(i, shared.own_link(&member.walk));
            } else if let (Some(aim), Some(Member { from: Some((from, beta)), .. })) = (&aims[i], &members[i])
            {
                let Obstacles { blocked, boundaries } = obstacles[n];
                n += 1;
                if blocked {
                    continue;
                }
                if let Some(link) = shared.link(scene, (from, *beta), aim, boundaries, w, &mut member.sampler)
                {
                    company.join(i, link);
                }
            }
        }
        Some((company, 1.0 / shared.own))
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
fn pixel_of(square: &PixelBounds, (deal, cell): (u32, u32), k: usize, group: usize) -> (u32, u32) {
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
    let (column, row) = (k as u32 % CELLS, k as u32 / CELLS);
    (at(square.x0, column, pick % 2), at(square.y0, row, pick / 2))
}

/// The lane that lies in the same N-th of the wavelengths as `v`, where lane 0 was drawn by `u`.
#[inline(always)]
fn lane_of<const N: usize>(v: f32, u: f32) -> usize {
    let part = |u: f32| (u * N as f32) as usize;
    (part(v) + N - part(u)) % N
}
