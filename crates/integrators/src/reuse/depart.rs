//! How the paths of a group set out, and how far each goes by itself.

use super::{Grouping, end::Origin, nobody};
use crate::{
    glow,
    pixel::{Begin, PixelPass},
    volpath::{Site, Walk},
    weight::{PathWeight, divide},
};
use tyndall_base::{Vec3, hash};
use tyndall_film::PixelBounds;
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::sampler::PathSampler;

/// A pixel's path.
pub(super) struct Member<'s, const N: usize> {
    pub pixel: (u32, u32),
    pub exposure: f32,
    pub filter: f32,
    pub walk: Walk<'s, N>,
    pub sampler: PathSampler,
    /// Where the path scatters next.
    pub site: Option<Site<'s, N>>,
}

/// What all paths of a group have in common.
pub(super) struct Common<const N: usize> {
    pub w: Wavelengths<N>,
    /// The number that the wavelengths were drawn by.
    pub u: f32,
    time: f32,
    /// The point whose glow attracts the paths.
    lamp: Option<Vec3>,
}

/// The group of a square whose paths are sent: the sample's number, the group's, and how pixels are dealt to groups.
pub(super) type Which = (u32, usize, u32);

/// First scatterings of a group, where others' paths may begin.
pub(super) type Origins<'s, const N: usize> = Vec<Option<Origin<'s, N>>>;

impl PixelPass {
    /// What the paths of sample number `sample` of a square have in common.
    #[inline(always)]
    pub(super) fn common<const N: usize>(&self, square: &PixelBounds, sample: u32) -> Common<N> {
        let (kind, replicates) = (self.settings.sampler, self.replicates);
        let mut sampler = PathSampler::of_group(kind, self.seed, square.x0, square.y0, sample, replicates);
        let (u, time) = (sampler.next_1d(), sampler.next_1d());
        let w = self.wavelengths.sample::<N>(u);
        // densities at a shared point are those of all members: they must have the same lamp
        let lamp = glow::lamp(&self.scene, &self.settings, &mut sampler);
        Common { w, u, time, lamp }
    }

    /// The paths of a group, each at its second scattering; `mark` is told of each pixel.
    #[inline(always)]
    pub(super) fn depart<'s, const N: usize>(
        &'s self,
        (square, grouping): (&PixelBounds, Grouping),
        (sample, group, deal): Which,
        common: &'s Common<N>,
        mut mark: impl FnMut((u32, u32)),
    ) -> (Vec<Option<Member<'s, N>>>, Origins<'s, N>) {
        let (cell, number) = (grouping.cell, grouping.members());
        let (x0, y0) = (square.x0, square.y0);
        let mut members = nobody(number);
        let mut origins: Origins<'_, N> = nobody(number);
        for k in 0..number {
            let (x, y) = pixel_of(square, (deal, grouping), k, group);
            if !square.contains(x, y) {
                continue;
            }
            mark((x, y));
            let sampler = self.sampler(x, y, sample).within(
                (k as u32, grouping.sharers()),
                self.seed,
                // one net for the pixels that lie at the same place of their cells
                (x0 + (x - x0) % cell, y0 + (y - y0) % cell),
                sample,
                self.replicates,
            );
            let member = members[k].insert(self.set_out((x, y), sampler, common));
            origins[k] = member.reach_second(number, &common.w);
        }
        (members, origins)
    }

    /// The path of a sample, about to start.
    #[inline(always)]
    fn set_out<'s, const N: usize>(
        &'s self,
        pixel: (u32, u32),
        sampler: PathSampler,
        common: &'s Common<N>,
    ) -> Member<'s, N> {
        let scene = &*self.scene;
        let Begin { ray, exposure, filter, spectrum, sampler } =
            self.begin(pixel.0, pixel.1, sampler, Some(common.time));
        let start = (PathWeight::START, scene.camera_medium);
        let mut walk = Walk::new(scene, &self.settings, start, ray, spectrum.y, &common.w);
        walk.open = true;
        walk.lamp = common.lamp;
        walk.pilot = lane_of::<N>(spectrum.x, common.u);
        walk.anew = true;
        walk.from = self.refinement.of(pixel.0, pixel.1).from;
        Member { pixel, exposure, filter, walk, sampler, site: None }
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
    pub fn restart(&mut self, beta: Spectrum<N>, r_u: Spectrum<N>) -> Spectrum<N> {
        self.weight = PathWeight { beta, r_u, r_l: Spectrum::ZERO, r_e: Spectrum::ZERO };
        self.rival = None;
        std::mem::replace(&mut self.l, Spectrum::ZERO)
    }
}

/// The pixel of cell `k` that belongs to `group`, by a random order of the cell's pixels.
#[inline(always)]
pub(super) fn pixel_of(
    square: &PixelBounds,
    (deal, grouping): (u32, Grouping),
    k: usize,
    group: usize,
) -> (u32, u32) {
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
