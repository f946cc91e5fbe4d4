//! `volpath`: path tracing through surfaces and media with spectral multiple importance sampling.
//!
//! Distances are drawn from the hero's transmittance, collisions carry the albedo as a weight, shadow rays the exact
//! transmittance; lights are met by chance, by light sampling and by equiangular sampling, combined by the power
//! heuristic over techniques and the balance heuristic over wavelengths (see [`crate::weight`]). Media that vary in space
//! are crossed by null collisions (see [`crate::tracking`]).

mod ahead;
mod division;
mod scatter;
mod site;
mod varying;

use ahead::Ahead;
pub(crate) use scatter::Audience;
pub(crate) use site::{MediumSite, Scatters, Site, SurfaceSite};

use crate::{
    direct::Rival,
    equiangular::{Division, Segment},
    glow,
    medium::Inside,
    observer::{Event, PathObserver, Vertex},
    settings::Settings,
    steer::Steering,
    weight::{Heuristic, PathWeight, combine, divide},
};
use tyndall_base::{Vec3, warp};
use tyndall_geometry::{Hit, Ray};
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::{Interaction, LightId, MediumId, Scene, media::Medium, sampler::PathSampler};

/// Boundaries without a material that a path may cross between two scatterings; more means a cycle of rounding.
const MAX_CROSSINGS: u32 = 10_000;

/// Radiance along `ray` per lane; `first` is the random number of the first flight.
#[inline(always)]
pub fn li<const N: usize>(
    scene: &Scene,
    settings: &Settings,
    ray: Ray,
    first: f32,
    w: &Wavelengths<N>,
    sampler: &mut PathSampler,
    seen: &mut impl PathObserver<N>,
) -> Spectrum<N> {
    li_from(scene, settings, (PathWeight::START, scene.camera_medium, 0), ray, first, w, sampler, seen)
}

/// The same with another weight, whose lanes of density zero are carried by the others, in another medium than those
/// at the camera, and without the light of fewer than `order` scatterings.
#[inline(always)]
pub fn li_from<const N: usize>(
    scene: &Scene,
    settings: &Settings,
    (weight, medium, order): (PathWeight<N>, MediumId, u32),
    ray: Ray,
    first: f32,
    w: &Wavelengths<N>,
    sampler: &mut PathSampler,
    seen: &mut impl PathObserver<N>,
) -> Spectrum<N> {
    let mut walk = Walk::new(scene, settings, (weight, medium), ray, first, w);
    walk.lamp = glow::lamp(scene, settings, sampler);
    walk.from = order;
    walk.follow(&mut None, u32::MAX, sampler, seen);
    walk.l
}

/// The state of a path.
pub(crate) struct Walk<'s, const N: usize> {
    pub scene: &'s Scene,
    settings: &'s Settings,
    w: &'s Wavelengths<N>,
    pub ray: Ray,
    /// What lies ahead on the ray, where the path passed a boundary.
    ahead: Option<Ahead>,
    /// Whether boundaries may be passed by; see [`Ahead::of`].
    certain: bool,
    /// The last scattering, from which densities of light sampling are measured.
    previous: Vec3,
    /// Normal of the surface there, zero in a medium.
    facing: Vec3,
    /// The half of the sphere that it takes light from; see [`SurfaceSite::half`].
    half: Vec3,
    medium: MediumId,
    inside: Option<Inside<'s, N>>,
    pub weight: PathWeight<N>,
    /// How light that the path meets by chance is combined with what the last scattering sampled.
    heuristic: Heuristic,
    /// The equiangular technique of the last scattering.
    pub rival: Option<Rival>,
    /// The point whose glow attracts the path.
    pub lamp: Option<Vec3>,
    /// Optical distance to the next collision at the wavelength of the lane `pilot`; one number serves all boundaries on
    /// the way.
    flight: f32,
    /// The same where the path scattered last.
    drawn: f32,
    /// The lane whose extinction decides where flights end: the hero, but for paths that are shared (see [`crate::reuse`])
    /// before they scatter first.
    pub pilot: usize,
    /// Scatterings so far.
    pub depth: u32,
    crossings: u32,
    /// Squared relative index of refraction along the path: undoes the compression of radiance in roulette.
    eta_scale: f32,
    /// Some scattering was not specular.
    scattered_widely: bool,
    /// The pixels whose flights share the next segment's light with equiangular samples; 0 where they do not.
    pub company: usize,
    /// How often the last scattering sampled each light; 0 where it drew one.
    each: u32,
    /// How the light that the last scattering sent was divided, if it was.
    divided: Option<Division>,
    /// The hero is drawn anew at the first scattering, so that densities before and after it are apart.
    pub anew: bool,
    /// Scatterings in media that vary are sites as those in others: they may be shared.
    pub open: bool,
    /// Light of fewer scatterings than this is left to others.
    pub from: u32,
    /// What the path brought so far.
    pub l: Spectrum<N>,
}

/// What one segment leads to.
#[expect(clippy::large_enum_variant, reason = "lives on the stack of one path")]
enum Step<'s, const N: usize> {
    /// The path goes on, through a boundary or from a scattering within a medium that varies.
    On,
    /// It scatters here.
    Site(Site<'s, N>),
    /// It ends.
    End,
}

impl<'s, const N: usize> Walk<'s, N> {
    /// A path along `ray`; `first` is the random number of the first flight.
    #[inline(always)]
    pub fn new(
        scene: &'s Scene,
        settings: &'s Settings,
        (weight, medium): (PathWeight<N>, MediumId),
        ray: Ray,
        first: f32,
        w: &'s Wavelengths<N>,
    ) -> Self {
        Self {
            scene,
            settings,
            w,
            ray,
            ahead: None,
            certain: scene.has_boundaries,
            previous: ray.o,
            facing: Vec3::ZERO,
            half: Vec3::ZERO,
            medium,
            inside: Inside::of(scene, medium, w),
            weight,
            heuristic: Heuristic::Balance,
            rival: None,
            lamp: None,
            flight: warp::sample_exponential(first, 1.0),
            drawn: 0.0,
            pilot: 0,
            depth: 0,
            crossings: 0,
            eta_scale: 1.0,
            scattered_widely: false,
            company: 0,
            each: 0,
            divided: None,
            anew: false,
            open: false,
            from: 0,
            l: Spectrum::ZERO,
        }
    }

    /// Follows the path from `site`, or from where it starts, until it ends or is about to scatter for the time number
    /// `until`: then `site` says where.
    #[inline(always)]
    pub fn follow(
        &mut self,
        site: &mut Option<Site<'s, N>>,
        until: u32,
        sampler: &mut PathSampler,
        seen: &mut impl PathObserver<N>,
    ) {
        loop {
            if let Some(at) = site {
                let goes_on = match at {
                    Site::Medium(at) => self.scatter_medium(at, &mut (), sampler, seen),
                    Site::Surface(at) => self.scatter_surface(at, &mut (), sampler, seen),
                };
                if !goes_on {
                    break;
                }
            }
            let mut ended = false;
            *site = loop {
                match self.segment(sampler, seen) {
                    Step::On => {}
                    Step::Site(at) => break Some(at),
                    Step::End => {
                        ended = true;
                        break None;
                    }
                }
            };
            if ended || self.depth == until {
                return;
            }
        }
        *site = None;
    }

    /// One segment, to where the path scatters or passes.
    #[inline(always)]
    fn segment(&mut self, sampler: &mut PathSampler, seen: &mut impl PathObserver<N>) -> Step<'s, N> {
        let ahead = match self.ahead.take() {
            Some(ahead) => ahead,
            None => Ahead::of(self.scene, &self.ray, &mut self.certain),
        };
        let t_max = ahead.distance();
        if let Some(medium) = self.inside.and_then(|inside| inside.varying) {
            if let Some(step) = self.travel(medium, t_max, sampler, seen) {
                return step;
            }
        } else if let Some(inside) = self.inside {
            self.emission(&inside, t_max, seen);
            if inside.only_absorbs(self.settings) {
                self.absorb(&inside, t_max);
            } else {
                let segment = self.equiangular(&inside, t_max, sampler, seen);
                if let Some(t) = self.collision(&inside, t_max) {
                    return self.collide(inside, t, segment, sampler, seen).map_or(Step::End, Step::Site);
                }
                self.pass(&inside, t_max);
            }
        }
        if let Some(hit) = ahead.boundary() {
            return if self.pass_by(ahead, &hit, seen) { Step::On } else { Step::End };
        }
        match ahead.met {
            None => {
                self.escape(seen);
                Step::End
            }
            Some(hit) => self.surface(&ahead, &hit, sampler, seen),
        }
    }

    /// The path's wavelengths.
    #[inline(always)]
    pub fn w(&self) -> &'s Wavelengths<N> {
        self.w
    }

    /// Optical distance since the last scattering, at the hero's wavelength.
    #[inline(always)]
    pub fn flown(&self) -> f32 {
        self.drawn - self.flight
    }

    /// Adds `value / mean(r)` to the pixel.
    #[inline(always)]
    fn add(&mut self, value: Spectrum<N>, r: Spectrum<N>, seen: &mut impl PathObserver<N>) {
        let value = self.counted(self.depth, divide(value, r), seen);
        self.l += value;
    }

    /// Adds light that the path met by chance, which the techniques `others` could have sampled.
    #[inline(always)]
    fn met(&mut self, le: Spectrum<N>, others: [Spectrum<N>; 2], seen: &mut impl PathObserver<N>) {
        let value = combine(self.heuristic, self.weight.beta * le, self.weight.r_u, others);
        self.l += self.counted(self.depth, value, seen);
    }

    /// What of `value`, light of `order` scatterings, belongs to the pixel.
    #[inline(always)]
    fn counted(&self, order: u32, value: Spectrum<N>, seen: &mut impl PathObserver<N>) -> Spectrum<N> {
        seen.contribution(order, &value);
        if order < self.from { Spectrum::ZERO } else { value }
    }

    /// What the medium emits along the segment, in closed form.
    #[inline(always)]
    fn emission(&mut self, inside: &Inside<'s, N>, t_max: f32, seen: &mut impl PathObserver<N>) {
        if !inside.le.is_zero() {
            self.add(self.weight.beta * inside.emitted(t_max), self.weight.r_u, seen);
        }
    }

    /// Distance of the collision on this segment, or `None` when the flight gets through.
    #[inline(always)]
    fn collision(&mut self, inside: &Inside<'s, N>, t_max: f32) -> Option<f32> {
        let hero = inside.sigma_t[self.pilot];
        let tau = hero * t_max;
        // 0 * infinity: no extinction over an unbounded segment is no collision
        if self.flight >= tau || hero <= 0.0 {
            if hero > 0.0 {
                self.flight -= tau;
            }
            return None;
        }
        Some(self.flight / hero)
    }

    /// The segment was crossed through a medium that only absorbs.
    #[inline(always)]
    fn absorb(&mut self, inside: &Inside<'s, N>, t_max: f32) {
        if t_max == f32::INFINITY {
            self.weight.beta *= inside.sigma_t.map(|s| if s > 0.0 { 0.0 } else { 1.0 });
        } else {
            self.weight.beta *= inside.transmittance(t_max);
        }
    }

    /// The segment was crossed without a collision.
    #[inline(always)]
    fn pass(&mut self, inside: &Inside<'s, N>, t_max: f32) {
        if t_max == f32::INFINITY && inside.sigma_t.max_lane() > 0.0 {
            // lanes with extinction see nothing through an unbounded medium; others pass
            let open = inside.sigma_t.map(|s| if s > 0.0 { 0.0 } else { 1.0 });
            self.weight.fly(open, open);
            return;
        }
        if t_max == f32::INFINITY {
            return;
        }
        let pilot = inside.sigma_t[self.pilot];
        let ratio = inside.transmittance_over(pilot, t_max);
        self.weight.fly(ratio, ratio);
        // light and equiangular samples do not draw this flight: their density lacks the hero's probability of it
        let lost = if self.settings.exact_transmittance {
            Spectrum::splat(crate::weight::exp(Spectrum([pilot * t_max])).hero())
        } else {
            ratio
        };
        self.weight.r_l *= lost;
        self.weight.r_e *= lost;
    }

    /// A collision at distance `t`; `None` where the path ends.
    #[inline(always)]
    fn collide(
        &mut self,
        inside: Inside<'s, N>,
        t: f32,
        segment: Option<Segment>,
        sampler: &mut PathSampler,
        seen: &mut impl PathObserver<N>,
    ) -> Option<Site<'s, N>> {
        let p = self.ray.at(t);
        self.watch(Event::Medium, p, Vec3::ZERO, t, inside.sigma_s.safe_div(inside.sigma_t), seen);
        if self.depth >= self.settings.max_depth {
            return None;
        }
        self.depth += 1;
        sampler.seek_vertex(self.depth - 1);
        // analog absorption, where it is asked for: the hero's albedo decides
        if !self.settings.survival {
            let albedo = inside.sigma_s.hero() / inside.sigma_t.hero();
            if sampler.next_1d() >= albedo {
                return None;
            }
        }
        let before = self.weight.r_u;
        let coefficient = inside.collision_coefficient(self.settings);
        let (hero, pilot) = (coefficient[self.pilot], inside.sigma_t[self.pilot]);
        let ratio = inside.transmittance_over(pilot, t) * (1.0 / hero);
        self.weight.fly(inside.sigma_s * ratio, coefficient * ratio);
        if self.weight.beta.is_zero() {
            return None;
        }
        // the equiangular technique could have put a vertex here without this flight
        let to_hero = crate::weight::exp(Spectrum([pilot * t])).hero() / hero;
        self.flight = 0.0;
        self.weight.r_e = if segment.is_some() { before * to_hero } else { Spectrum::ZERO };
        self.rival = segment.map(|segment| Rival { segment, t });
        self.divided = self.division(&inside, self.depth - 1);
        self.at(p, Vec3::ZERO);
        self.scattered_widely = true;
        let steering = Steering::in_medium((self.scene, self.settings), self.lamp, p, &inside, self.w);
        Some(Site::Medium(MediumSite { p, wo: -self.ray.d, medium: self.medium, inside, steering }))
    }

    /// Light from infinity.
    #[inline(always)]
    fn escape(&mut self, seen: &mut impl PathObserver<N>) {
        let far = self.ray.o + self.ray.d;
        self.watch(Event::Escape, far, Vec3::ZERO, f32::INFINITY, Spectrum::ZERO, seen);
        for &id in self.scene.lights.infinite() {
            let light = self.scene.lights.get(id);
            let le = light.le_infinite(self.previous, self.ray.d, self.w);
            let pdf = self.pmf(id) * light.pdf_infinite_beside_chance((self.previous, self.half), self.ray.d);
            let by_light = self.weight.r_l * (self.by_light(pdf) * self.heuristic.trust());
            self.met(le, [by_light, Spectrum::ZERO], seen);
        }
    }

    /// The path scatters at `p`; `n` is the normal of a surface, zero in a medium.
    #[inline(always)]
    fn at(&mut self, p: Vec3, n: Vec3) {
        (self.previous, self.facing, self.half, self.each) = (p, n, Vec3::ZERO, 0);
        self.heuristic = Inside::heuristic(self.inside.as_ref(), self.settings);
    }

    /// Samples of the light `id` that the last scattering took, on average.
    #[inline(always)]
    fn pmf(&self, id: LightId) -> f32 {
        if self.each > 0 {
            self.each as f32
        } else {
            self.scene.lights.pmf_at(self.previous, self.facing, id)
        }
    }

    /// `pdf` where light sampling competes, else 0.
    #[inline(always)]
    fn by_light(&self, pdf: f32) -> f32 {
        if self.settings.light_sampling { pdf } else { 0.0 }
    }

    /// A surface at the end of the segment.
    #[inline(always)]
    fn surface(
        &mut self,
        ahead: &Ahead,
        hit: &Hit,
        sampler: &mut PathSampler,
        seen: &mut impl PathObserver<N>,
    ) -> Step<'s, N> {
        let (isect, t) = (self.scene.interaction(&ahead.ray, hit), hit.t - ahead.at);
        self.emitted(hit, &isect, seen);
        if isect.material.is_interface() {
            return if self.cross(&isect, t, seen) { Step::On } else { Step::End };
        }
        let material = &self.scene.materials[isect.material.index()];
        let (frame, mut bsdf) = material.shade(&isect.surface, self.w);
        if bsdf.wants_hero_only() {
            self.weight.keep_hero();
        }
        if self.settings.regularize && self.scattered_widely {
            bsdf = bsdf.regularized();
        }
        let wo = frame.to_local(-self.ray.d);
        self.watch_surface(&isect, frame.z, t, seen);
        if self.depth >= self.settings.max_depth {
            return Step::End;
        }
        self.depth += 1;
        sampler.seek_vertex(self.depth - 1);
        self.weight.r_e = Spectrum::ZERO;
        self.rival = None;
        self.divided = None;
        self.at(isect.surface.p, isect.surface.ng);
        let n = if wo.z < 0.0 { -frame.z } else { frame.z };
        let steering = Steering::on_surface(
            (self.scene, self.settings),
            self.lamp,
            isect.surface.p,
            n,
            bsdf.flags(),
            self.inside.as_ref(),
        );
        let (medium, inside) = (self.medium, self.inside);
        let site = SurfaceSite { isect, frame, bsdf, wo, medium, inside, steering };
        self.half = site.half();
        Step::Site(Site::Surface(site))
    }

    /// Light that the surface emits towards the path.
    #[inline(always)]
    fn emitted(&mut self, hit: &Hit, isect: &Interaction<'_>, seen: &mut impl PathObserver<N>) {
        let Some(id) = isect.light else { return };
        let s = &isect.surface;
        let light = self.scene.lights.get(id);
        let le = light.radiance_at(s.ng, [s.uv.x, s.uv.y], -self.ray.d, self.w);
        if le.is_zero() {
            return;
        }
        let mut others = [Spectrum::ZERO; 2];
        if self.settings.light_sampling && !(self.weight.r_l.is_zero() && self.weight.r_e.is_zero()) {
            let target = light.target(&self.scene.accel, hit, s);
            let pdf = self.pmf(id) * light.pdf_li(&self.scene.accel, self.previous, self.ray.d, &target);
            others[0] = self.weight.r_l * (pdf * self.heuristic.trust());
            if let Some(rival) = &self.rival {
                others[1] = self.weight.r_e * rival.density(self.scene, id, &target);
            }
        }
        self.met(le, others, seen);
    }

    /// Goes on through a boundary that does not bend light.
    #[inline(always)]
    fn cross(&mut self, isect: &Interaction<'_>, t: f32, seen: &mut impl PathObserver<N>) -> bool {
        self.watch(Event::Boundary, isect.surface.p, isect.surface.ng, t, Spectrum::ONE, seen);
        self.crossings += 1;
        self.go(isect, self.ray.d);
        self.crossings <= MAX_CROSSINGS
    }

    /// Passes a boundary on its way to what lies ahead.
    #[inline(never)]
    fn pass_by<O: PathObserver<N>>(&mut self, mut ahead: Ahead, hit: &Hit, seen: &mut O) -> bool {
        if O::WANTS_VERTICES {
            let s = self.scene.accel.surface(&ahead.ray, hit);
            self.watch(Event::Boundary, s.p, s.ng, hit.t - ahead.at, Spectrum::ONE, seen);
        }
        self.crossings += 1;
        ahead.pass(hit);
        self.ray.o = ahead.ray.at(ahead.at);
        let medium = self.scene.medium_behind(&ahead.ray, hit, self.medium);
        if medium != self.medium {
            self.medium = medium;
            self.inside = if matches!(self.scene.medium(medium), Some(Medium::Painted(_))) {
                let entry = self.scene.accel.surface(&ahead.ray, hit);
                Inside::entered(self.scene, medium, Some(&entry), self.w)
            } else {
                Inside::of(self.scene, medium, self.w)
            };
        }
        self.ahead = Some(ahead);
        self.crossings <= MAX_CROSSINGS
    }

    /// The path turns to another ray.
    #[inline(always)]
    fn turn(&mut self, o: Vec3, d: Vec3) {
        self.ray = Ray { time: self.ray.time, ..Ray::new(o, d) };
    }

    /// Continues from a surface along `d`, in the medium there.
    #[inline(always)]
    fn go(&mut self, isect: &Interaction<'_>, d: Vec3) {
        self.turn(isect.surface.origin(d), d);
        let medium = isect.medium_towards(d, self.medium);
        if medium != self.medium {
            self.medium = medium;
            self.inside = Inside::entered(self.scene, medium, Some(&isect.surface), self.w);
        }
    }

    /// Tells the observer of a surface.
    #[inline(always)]
    fn watch_surface<O: PathObserver<N>>(&self, isect: &Interaction<'_>, n: Vec3, t: f32, seen: &mut O) {
        if O::WANTS_VERTICES {
            let material = &self.scene.materials[isect.material.index()];
            let albedo = material.albedo(&isect.surface, self.w);
            self.watch(Event::Surface, isect.surface.p, n, t, albedo, seen);
        }
    }

    /// Tells the observer of a vertex.
    #[inline(always)]
    fn watch<O: PathObserver<N>>(
        &self,
        event: Event,
        p: Vec3,
        n: Vec3,
        distance: f32,
        albedo: Spectrum<N>,
        seen: &mut O,
    ) {
        if O::WANTS_VERTICES {
            let throughput = self.weight.throughput();
            let (depth, medium) = (self.depth, self.medium);
            seen.vertex(&Vertex { event, p, n, distance, depth, medium, albedo, throughput });
        }
    }
}
