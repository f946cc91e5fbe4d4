//! SWC, stratified wavelength clusters (G. F. Evans, M. D. McCool, "Stratified wavelength clusters for efficient spectral
//! Monte Carlo rendering", Graphics Interface 1999), extended to media.
//!
//! A stratified set of N wavelengths shares one path as long as its decisions suit all of them; there is no spectral
//! multiple importance sampling. Where the wavelengths must part, the set splits into lane masks, which go on alone:
//!
//! - *Free flight.* One number gives the optical distance. Wavelengths whose extinctions agree to 25 % fly together by the
//!   first of them, with weight `T_k / T_first` (between 0.8 and 1.25 the weight's second moment is below 1.07); every such cluster
//!   collides or gets through on its own. All that get through go on as one, each cluster that collides becomes a
//!   piece.
//! - *Dispersion.* Before a smooth boundary whose index differs between its wavelengths every wavelength parts.
//! - *Directions* are drawn at the wavelength of a lane chosen at random, and weighted by the mean density of the piece's
//!   lanes at that vertex, so that no lane's weight can explode.
//!
//! Pieces wait on a stack of [`STACK`]. When it is full, a roulette between the new piece and the last one keeps one of
//! them with probability in proportion to the lanes that it stands for and weights it by the inverse: the mean stays.

use crate::{
    connect::{self, Last, Vertex, extinction},
    observer::{self, Event, PathObserver},
    settings::Settings,
    weight::exp,
};
use tyndall_base::{Vec3, warp};
use tyndall_geometry::{Hit, Ray};
use tyndall_scatter::bsdf::{Bsdf, BsdfFlags};
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::{Interaction, MediumId, Scene, media::MediumProperties, sampler::PathSampler};

/// Pieces that may wait.
pub const STACK: usize = 8;
/// Extinctions within this factor of each other fly together.
const ALIKE: f32 = 1.25;
/// First dimension of the roulette between pieces.
const DICE: u32 = 1 << 28;
/// First dimension after a boundary; flights behind it have no place among those of a vertex.
const CROSSING: u32 = 1 << 24;
/// Boundaries that a path may cross; more means a cycle of rounding.
const MAX_CROSSINGS: u32 = 10_000;

/// Radiance along `ray` per lane; `first` is the random number of the first flight.
#[inline(never)]
pub fn li<const N: usize>(
    scene: &Scene,
    settings: &Settings,
    ray: Ray,
    first: f32,
    w: &Wavelengths<N>,
    sampler: &mut PathSampler,
    seen: &mut impl PathObserver<N>,
) -> Spectrum<N> {
    let mut lane = [0; N];
    for k in 0..N {
        lane[k] = k as u8;
    }
    let mut piece = Piece {
        w: *w,
        ray,
        from: ray.o,
        medium: scene.camera_medium,
        flight: warp::sample_exponential(first, 1.0),
        beta: Spectrum::ONE,
        lane,
        active: u32::MAX >> (32 - N as u32),
        stands_for: N as f32,
        depth: 0,
        last: None,
        eta: 1.0,
        crossings: 0,
        sampler: sampler.clone(),
    };
    let mut dice = sampler.clone();
    dice.seek(DICE);
    let stack = [const { None }; STACK];
    let mut walk = Walk { scene, settings, stack, waiting: 0, dice, l: Spectrum::ZERO };
    loop {
        while walk.step(&mut piece, seen) {}
        if walk.waiting == 0 {
            return walk.l;
        }
        walk.waiting -= 1;
        piece = walk.stack[walk.waiting].take().expect("a piece waits below the top of the stack");
    }
}

/// Wavelengths that still share a path. Lanes are permuted: the one that decides stands first.
#[derive(Clone, Debug)]
struct Piece<const N: usize> {
    w: Wavelengths<N>,
    ray: Ray,
    /// Where the ray took its direction.
    from: Vec3,
    medium: MediumId,
    /// Optical distance to the next collision.
    flight: f32,
    beta: Spectrum<N>,
    /// The lane of the pixel's set that each lane is.
    lane: [u8; N],
    /// Lanes that belong to this piece.
    active: u32,
    /// Lanes that it won its place on the stack for, its own among them.
    stands_for: f32,
    depth: u32,
    last: Option<Last>,
    /// Squared relative index of refraction along the path.
    eta: f32,
    crossings: u32,
    sampler: PathSampler,
}

impl<const N: usize> Piece<N> {
    #[inline(always)]
    fn has(&self, k: usize) -> bool {
        self.active >> k & 1 == 1
    }

    fn lanes(&self) -> f32 {
        self.active.count_ones() as f32
    }

    /// `value` in the lanes of the piece, 0 elsewhere.
    #[inline(always)]
    fn only(&self, value: Spectrum<N>) -> Spectrum<N> {
        Spectrum::from_fn(|k| if self.has(k) { value[k] } else { 0.0 })
    }

    /// Mean over the piece's lanes.
    #[inline(always)]
    fn mean(&self, value: Spectrum<N>) -> f32 {
        self.only(value).sum() / self.lanes()
    }

    /// Keeps these lanes.
    #[inline(always)]
    fn keep(&mut self, mask: u32) {
        self.active &= mask;
        self.beta = self.only(self.beta);
    }

    /// Lane `k` decides from now on.
    #[inline(always)]
    fn lead(&mut self, k: usize) {
        self.w.lambda.swap(0, k);
        self.w.pdf.swap(0, k);
        self.w.line.swap(0, k);
        self.beta.0.swap(0, k);
        self.lane.swap(0, k);
        let (a, b) = (self.active & 1, self.active >> k & 1);
        if a != b {
            self.active ^= 1 | 1 << k;
        }
    }

    /// A lane chosen with `u` decides from now on.
    #[inline(always)]
    fn lead_random(&mut self, u: f32) {
        let mut left = (u * self.lanes()) as u32;
        for k in 0..N {
            if self.has(k) {
                if left == 0 {
                    return self.lead(k);
                }
                left -= 1;
            }
        }
        let first = self.active.trailing_zeros() as usize;
        self.lead(first);
    }

    #[inline(always)]
    fn go(&mut self, o: Vec3, d: Vec3, medium: MediumId) {
        if d != self.ray.d {
            self.from = o;
        }
        self.ray = Ray { time: self.ray.time, ..Ray::new(o, d) };
        self.medium = medium;
    }

    /// Roulette on the greatest weight, and the next flight.
    #[inline(always)]
    fn survives(&mut self, settings: &Settings) -> bool {
        self.flight = warp::sample_exponential(self.sampler.next_1d(), 1.0);
        if self.beta.is_zero() || self.depth <= settings.roulette_depth {
            return !self.beta.is_zero();
        }
        let q = self.beta.max_lane() * self.eta / settings.roulette_threshold;
        if q >= 1.0 {
            return true;
        }
        self.beta *= 1.0 / q;
        self.sampler.next_1d() < q
    }
}

struct Walk<'s, const N: usize> {
    scene: &'s Scene,
    settings: &'s Settings,
    stack: [Option<Piece<N>>; STACK],
    waiting: usize,
    /// Numbers that no piece uses.
    dice: PathSampler,
    l: Spectrum<N>,
}

impl<'s, const N: usize> Walk<'s, N> {
    /// One segment of a piece; false when it ends.
    #[inline(always)]
    fn step<O: PathObserver<N>>(&mut self, piece: &mut Piece<N>, seen: &mut O) -> bool {
        let hit = self.scene.intersect(&piece.ray);
        let d = hit.as_ref().map_or(f32::INFINITY, |h| h.t);
        if let Some(m) = self.scene.medium(piece.medium).and_then(|m| m.homogeneous(&piece.w)) {
            self.fly(piece, &m, d, seen);
            if piece.active == 0 {
                return false;
            }
        }
        match hit {
            Some(hit) => self.surface(piece, &hit, seen),
            None => {
                let far = piece.ray.o + piece.ray.d;
                self.watch(piece, Event::Escape, far, Vec3::ZERO, f32::INFINITY, Spectrum::ZERO, seen);
                self.add(
                    piece,
                    connect::sky(self.scene, piece.from, piece.ray.d, piece.last, &piece.w),
                    seen,
                );
                false
            }
        }
    }

    /// A flight over at most `d`: clusters that collide scatter and wait, the rest of the piece gets through.
    #[inline(always)]
    fn fly<O: PathObserver<N>>(
        &mut self,
        piece: &mut Piece<N>,
        m: &MediumProperties<'s, N>,
        d: f32,
        seen: &mut O,
    ) {
        let sigma_t = m.sigma_t();
        let (mut left, mut through) = (piece.active, 0u32);
        let mut ratio = Spectrum::ONE;
        let start = piece.clone();
        while left != 0 {
            let first = left.trailing_zeros() as usize;
            let s = sigma_t[first];
            let mut cluster = 0u32;
            for k in 0..N {
                let alike = sigma_t[k] <= ALIKE * s && s <= ALIKE * sigma_t[k];
                cluster |= u32::from(left >> k & 1 == 1 && alike) << k;
            }
            left &= !cluster;
            // no extinction is no collision, over any way
            let collides = s > 0.0 && start.flight < s * d;
            let t = if collides { start.flight / s } else { d };
            let over_first = exp((sigma_t - Spectrum::splat(s)) * -t);
            for k in 0..N {
                if cluster >> k & 1 == 1 && s > 0.0 {
                    ratio[k] = if collides { over_first[k] / s } else { over_first[k] };
                }
            }
            if collides {
                let mut part = start.clone();
                part.keep(cluster);
                part.beta *= ratio;
                self.scatter(part, m, t, seen);
            } else {
                through |= cluster;
            }
        }
        piece.keep(through);
        piece.beta *= ratio;
        piece.flight = warp::sample_exponential(piece.sampler.next_1d(), 1.0);
    }

    /// A collision at distance `t`; the weight lacks sigma_s.
    fn scatter<O: PathObserver<N>>(
        &mut self,
        mut piece: Piece<N>,
        m: &MediumProperties<'s, N>,
        t: f32,
        seen: &mut O,
    ) {
        let p = piece.ray.at(t);
        self.watch(&piece, Event::Medium, p, Vec3::ZERO, t, m.sigma_s.safe_div(m.sigma_t()), seen);
        self.add(&piece, m.sigma_a * m.le, seen);
        if piece.depth >= self.settings.max_depth {
            return;
        }
        piece.depth += 1;
        piece.sampler.seek_vertex(piece.depth - 1);
        piece.beta *= m.sigma_s;
        let u = piece.sampler.next_1d();
        piece.lead_random(u);
        let (wo, medium, time) = (-piece.ray.d, piece.medium, piece.ray.time);
        if self.settings.light_sampling {
            let (at, w) = (piece.clone(), piece.w);
            let eval = |wi: Vec3| {
                let phase = m.phase.eval(wo, wi, &w);
                (phase, at.mean(phase))
            };
            self.direct(&mut piece, &Vertex { p, time, spawn: |_| (p, medium), eval }, seen);
        }
        let u = piece.sampler.next_2d();
        let s = m.phase.sample(wo, [u.x, u.y], &piece.w);
        let pdf = piece.mean(s.p);
        piece.beta *= s.p * (1.0 / pdf);
        piece.last = self.settings.light_sampling.then_some(Last { p, pdf });
        piece.from = p;
        piece.ray = Ray { time: piece.ray.time, ..Ray::new(p, s.wi) };
        if piece.survives(self.settings) {
            self.push(piece);
        }
    }

    #[inline(always)]
    fn surface<O: PathObserver<N>>(&mut self, piece: &mut Piece<N>, hit: &Hit, seen: &mut O) -> bool {
        let isect = self.scene.interaction(&piece.ray, hit);
        let s = &isect.surface;
        self.add(piece, connect::emitted(self.scene, &piece.ray, hit, &isect, piece.last, &piece.w), seen);
        let medium = piece.medium;
        if isect.material.is_interface() {
            self.watch(piece, Event::Boundary, s.p, s.ng, hit.t, Spectrum::ONE, seen);
            piece.go(s.origin(piece.ray.d), piece.ray.d, isect.medium_towards(piece.ray.d, medium));
            piece.crossings += 1;
            piece.sampler.seek(CROSSING + piece.crossings);
            return piece.crossings <= MAX_CROSSINGS;
        }
        let material = &self.scene.materials[isect.material.index()];
        if piece.depth >= self.settings.max_depth || !parts(piece, &material.shade(s, &piece.w).1) {
            return self.bounce(piece, &isect, hit.t, seen);
        }
        for k in 0..N {
            let mut alone = piece.clone();
            alone.keep(1 << k);
            if piece.has(k) && self.bounce(&mut alone, &isect, hit.t, seen) {
                self.push(alone);
            }
        }
        false
    }

    /// Reflection or refraction; false when the piece ends.
    #[inline(always)]
    fn bounce<O: PathObserver<N>>(
        &mut self,
        piece: &mut Piece<N>,
        isect: &Interaction<'_>,
        t: f32,
        seen: &mut O,
    ) -> bool {
        let (s, medium, time) = (&isect.surface, piece.medium, piece.ray.time);
        let material = &self.scene.materials[isect.material.index()];
        if O::WANTS_VERTICES {
            self.watch(piece, Event::Surface, s.p, s.ng, t, material.albedo(s, &piece.w), seen);
        }
        if piece.depth >= self.settings.max_depth {
            return false;
        }
        piece.depth += 1;
        piece.sampler.seek_vertex(piece.depth - 1);
        let u = piece.sampler.next_1d();
        piece.lead_random(u);
        let (frame, bsdf) = material.shade(s, &piece.w);
        let wo = frame.to_local(-piece.ray.d);
        if self.settings.light_sampling && !bsdf.is_delta() {
            let at = piece.clone();
            let spawn = |wi: Vec3| (s.origin(wi), isect.medium_towards(wi, medium));
            let eval = |wi: Vec3| {
                let wi = frame.to_local(wi);
                (bsdf.eval(wo, wi) * wi.z.abs(), at.mean(bsdf.pdf(wo, wi)))
            };
            self.direct(piece, &Vertex { p: s.p, time, spawn, eval }, seen);
        }
        let uc = piece.sampler.next_1d();
        let u = piece.sampler.next_2d();
        let Some(b) = bsdf.sample(wo, uc, [u.x, u.y]) else { return false };
        let pdf = piece.mean(b.pdf);
        piece.beta *= b.f * (b.wi.z.abs() / pdf);
        piece.eta *= b.eta * b.eta;
        let sampled = self.settings.light_sampling && !b.flags.contains(BsdfFlags::DELTA);
        piece.last = sampled.then_some(Last { p: s.p, pdf });
        let wi = frame.from_local(b.wi);
        piece.go(s.origin(wi), wi, isect.medium_towards(wi, medium));
        piece.survives(self.settings)
    }

    /// Puts a piece on the stack, or plays for a place on it.
    #[inline(always)]
    fn push(&mut self, mut piece: Piece<N>) {
        piece.stands_for = piece.lanes();
        if self.waiting < STACK {
            self.stack[self.waiting] = Some(piece);
            self.waiting += 1;
            return;
        }
        let Some(top) = &mut self.stack[STACK - 1] else { return };
        let all = piece.stands_for + top.stands_for;
        let share = piece.stands_for / all;
        if self.dice.next_1d() < share {
            piece.beta *= 1.0 / share;
            piece.stands_for = all;
            *top = piece;
        } else {
            top.beta *= 1.0 / (1.0 - share);
            top.stands_for = all;
        }
    }

    #[inline(always)]
    fn direct<O: PathObserver<N>, S, F>(&mut self, piece: &mut Piece<N>, vertex: &Vertex<S, F>, seen: &mut O)
    where
        S: Fn(Vec3) -> (Vec3, MediumId),
        F: Fn(Vec3) -> (Spectrum<N>, f32),
    {
        let w = piece.w;
        let value = vertex.sample(self.scene, |id| extinction(self.scene, id, &w), &w, &mut piece.sampler);
        self.add(piece, value, seen);
    }

    /// Adds light of a piece to the lanes it has in the pixel's set.
    #[inline(always)]
    fn add<O: PathObserver<N>>(&mut self, piece: &Piece<N>, l: Spectrum<N>, seen: &mut O) {
        let value = self.in_order(piece, piece.beta * l);
        seen.contribution(piece.depth, &value);
        self.l += value;
    }

    #[inline(always)]
    fn in_order(&self, piece: &Piece<N>, value: Spectrum<N>) -> Spectrum<N> {
        let mut out = Spectrum::ZERO;
        for k in 0..N {
            if piece.has(k) {
                out[usize::from(piece.lane[k])] = value[k];
            }
        }
        out
    }

    #[inline(always)]
    fn watch<O: PathObserver<N>>(
        &self,
        piece: &Piece<N>,
        event: Event,
        p: Vec3,
        n: Vec3,
        distance: f32,
        albedo: Spectrum<N>,
        seen: &mut O,
    ) {
        if O::WANTS_VERTICES {
            let (depth, medium) = (piece.depth, piece.medium);
            let (albedo, throughput) = (self.in_order(piece, albedo), self.in_order(piece, piece.beta));
            seen.vertex(&observer::Vertex { event, p, n, distance, depth, medium, albedo, throughput });
        }
    }
}

/// Whether a surface parts the piece's wavelengths: a smooth boundary sends them different ways, or its value is known
/// for one of them only.
#[inline(always)]
fn parts<const N: usize>(piece: &Piece<N>, bsdf: &Bsdf<'_, N>) -> bool {
    if bsdf.wants_hero_only() {
        return true;
    }
    let Bsdf::Dielectric(b) = bsdf else { return false };
    let first = b.eta[piece.active.trailing_zeros() as usize];
    bsdf.is_delta() && (0..N).any(|k| piece.has(k) && b.eta[k] != first)
}
