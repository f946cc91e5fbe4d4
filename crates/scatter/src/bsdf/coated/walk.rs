//! The random walk between coat and base.
//!
//! `w` is the direction of travel, so the surface sees `-w`; `depth` below is the optical distance from the base.

use super::{Base, Coated};
use crate::bsdf::fresnel::fresnel_conductor_n;
use crate::bsdf::{Conductor, TransportMode};
use crate::phase::{henyey_greenstein as hg, versine};
use tyndall_base::{math, rng::Pcg32, vec::Vec3, warp::sample_exponential};
use tyndall_spectral::Spectrum;

/// Walks lighter than this are ended at random.
const ROULETTE: f32 = 0.25;

/// Events before that.
const ROULETTE_FROM: u32 = 3;

/// One walk.
pub(super) struct Walk<'a, const N: usize> {
    coated: &'a Coated<N>,
    rng: &'a mut Pcg32,
    weight: Spectrum<N>,
    w: Vec3,
    /// Optical distance from the base.
    height: f32,
}

/// Where a walk left the coat.
pub(super) struct End<const N: usize> {
    pub wi: Vec3,
    pub weight: Spectrum<N>,
    /// All events were single directions.
    pub specular: bool,
}

/// The way out towards a given direction, drawn backwards from there.
#[derive(Clone, Copy)]
struct Exit {
    /// Up through the medium to the coat.
    d: Vec3,
    weight: f32,
    /// Direction outside.
    wi: Vec3,
}

impl<'a, const N: usize> Walk<'a, N> {
    pub fn new(coated: &'a Coated<N>, rng: &'a mut Pcg32) -> Self {
        Self { coated, rng, weight: Spectrum::ONE, w: Vec3::ZERO, height: coated.thickness }
    }

    /// A walk from `wo` (above) to wherever it leaves; `None` where it ends inside.
    pub fn out(mut self, wo: Vec3, uc: f32, u: [f32; 2]) -> Option<End<N>> {
        let coat = &self.coated.coat;
        let mut specular = coat.is_smooth();
        let r = coat.share_reflected(wo);
        if uc < r {
            let (wi, weight) = coat.sample_reflection(wo, u)?;
            return Some(End { wi, weight: Spectrum::splat(weight / r), specular });
        }
        let (w, weight) = coat.sample_refraction(wo, u, TransportMode::Radiance)?;
        (self.w, self.weight) = (w, Spectrum::splat(weight / (1.0 - r)));
        for depth in 0..self.coated.max_depth {
            if !self.survives(depth) {
                return None;
            }
            if self.fly() {
                let (wi, _) = self.scatter();
                self.w = wi;
                specular = false;
            } else if self.w.z < 0.0 {
                let (delta, _) = self.base()?;
                specular &= delta;
            } else if let Some(end) = self.arrive(specular)? {
                return Some(end);
            }
        }
        None
    }

    /// The coat from below: leaves, or goes down again.
    fn arrive(&mut self, specular: bool) -> Option<Option<End<N>>> {
        let coat = &self.coated.coat;
        let r = coat.share_reflected(-self.w);
        let (uc, u) = (self.rng.next_f32(), self.rng.next_2d());
        if uc < r {
            let (w, weight) = coat.sample_reflection(-self.w, u)?;
            self.weight *= weight / r;
            self.w = w;
            return Some(None);
        }
        let (wi, weight) = coat.sample_refraction(-self.w, u, TransportMode::Radiance)?;
        Some(Some(End { wi, weight: self.weight * (weight / (1.0 - r)), specular }))
    }

    /// The light from `wi` that one walk from `wo` meets below the coat, both above: an estimate of the BSDF.
    pub fn towards(mut self, wo: Vec3, wi: Vec3) -> Spectrum<N> {
        let coat = &self.coated.coat;
        let u = [self.rng.next_2d(), self.rng.next_2d()];
        let entry = coat.sample_refraction(wo, u[0], TransportMode::Radiance);
        let exit = coat.sample_refraction(wi, u[1], TransportMode::Importance);
        let (Some((w, weight)), Some((down, out))) = (entry, exit) else { return Spectrum::ZERO };
        (self.w, self.weight) = (w, Spectrum::splat(weight));
        let exit = Exit { d: -down, weight: out, wi };
        let mut sum = Spectrum::ZERO;
        // density of the last direction, for weights at a rough coat; a single direction has none
        for depth in 0..self.coated.max_depth {
            if !self.survives(depth) {
                break;
            }
            let pdf = if self.fly() {
                sum += self.medium_light(&exit);
                let (wi, pdf) = self.scatter();
                self.w = wi;
                Some(pdf)
            } else if self.w.z < 0.0 {
                sum += self.base_light(&exit);
                let Some((delta, pdf)) = self.base() else { break };
                (!delta).then_some(pdf)
            } else {
                let Some((w, weight)) = self.down() else { break };
                self.weight *= weight;
                self.w = w;
                continue;
            };
            if self.w.z > 0.0 {
                sum += self.coat_light(&exit, pdf);
            }
        }
        sum
    }

    fn down(&mut self) -> Option<(Vec3, f32)> {
        let u = self.rng.next_2d();
        self.coated.coat.sample_reflection(-self.w, u)
    }

    /// Russian roulette.
    fn survives(&mut self, depth: u32) -> bool {
        let q = self.weight.max_lane();
        if depth <= ROULETTE_FROM || q >= ROULETTE {
            return q > 0.0;
        }
        self.weight *= 1.0 / q;
        self.rng.next_f32() < q
    }

    /// Transmittance of the medium from `height` to the coat.
    fn transmittance(&self, d: Vec3) -> f32 {
        math::exp(-((self.coated.thickness - self.height) / d.z.abs()))
    }

    /// Moves on; true when the medium scatters on the way. Without albedo the transmittance is a weight.
    fn fly(&mut self) -> bool {
        let end = if self.w.z < 0.0 { 0.0 } else { self.coated.thickness };
        let way = (end - self.height).abs() / self.w.z.abs();
        if self.coated.albedo.is_zero() {
            self.weight *= math::exp(-way);
            self.height = end;
            return false;
        }
        let flight = sample_exponential(self.rng.next_f32(), 1.0);
        if flight >= way {
            self.height = end;
            return false;
        }
        self.height += flight * self.w.z;
        true
    }

    /// A new direction from the medium and its density.
    fn scatter(&mut self) -> (Vec3, f32) {
        self.weight *= self.coated.albedo;
        let [u, turn] = self.rng.next_2d();
        let wi = hg::sample(self.coated.g, u).apply(-self.w, turn).normalize();
        // a direction along the layer would never leave it
        let wi = if wi.z == 0.0 { Vec3 { z: f32::MIN_POSITIVE, ..wi } } else { wi };
        (wi, hg::p(self.coated.g, versine(-self.w, wi)))
    }

    /// Scattering at the base: whether into a single direction, and the density.
    fn base(&mut self) -> Option<(bool, f32)> {
        let u = self.rng.next_2d();
        let s = match &self.coated.base {
            Base::Diffuse(b) => b.sample(-self.w, u),
            Base::Conductor(b) => b.sample(-self.w, u),
        }?;
        self.weight *= s.f * (s.wi.z.abs() / s.pdf.hero());
        self.w = s.wi;
        Some((s.flags.is_delta(), s.pdf.hero()))
    }

    /// Share of a way out that was drawn from outside, against one that was drawn with density `pdf` from inside.
    fn share(&self, exit: &Exit, pdf: f32) -> f32 {
        if self.coated.coat.is_smooth() {
            return 1.0;
        }
        let q = self.coated.coat.eval_pdf(exit.wi, -exit.d).1;
        if q + pdf > 0.0 { q / (q + pdf) } else { 0.0 }
    }

    fn base_light(&self, exit: &Exit) -> Spectrum<N> {
        let (f, pdf) = match &self.coated.base {
            Base::Diffuse(b) => (b.eval(-self.w, exit.d), b.pdf(-self.w, exit.d)),
            Base::Conductor(b) => b.eval_pdf(-self.w, exit.d),
        };
        let weight = exit.weight * self.transmittance(exit.d) * self.share(exit, pdf.hero());
        self.weight * f * weight
    }

    fn medium_light(&self, exit: &Exit) -> Spectrum<N> {
        let p = hg::p(self.coated.g, versine(-self.w, exit.d));
        let weight = exit.weight * self.transmittance(exit.d) * self.share(exit, p);
        let direct = self.weight * self.coated.albedo * (p * weight / exit.d.z);
        match &self.coated.base {
            Base::Conductor(metal) if metal.distribution.is_smooth() && self.coated.coat.is_smooth() => {
                self.mirrored(exit, direct, metal)
            }
            _ => direct,
        }
    }

    /// Between a mirror and a smooth boundary light may go to and fro before it leaves along `exit`, which no walk meets
    /// by chance: the sum over all reflections of what leaves upwards (`direct`) and of what goes down first.
    fn mirrored(&self, exit: &Exit, direct: Spectrum<N>, metal: &Conductor<N>) -> Spectrum<N> {
        let cos = exit.d.z;
        let down = Vec3 { z: -cos, ..exit.d };
        let across = math::exp(-self.coated.thickness / cos);
        let metal = fresnel_conductor_n(cos, &metal.eta, &metal.k);
        let coat = self.coated.coat.reflectance(down);
        let p = hg::p(self.coated.g, versine(-self.w, down));
        let way = math::exp(-self.height / cos) * across * exit.weight * p / cos;
        let first = self.weight * self.coated.albedo * metal * way;
        let again = metal.map(|f| 1.0 / (1.0 - f * coat * across * across));
        (direct + first) * again
    }

    /// Out along the direction the walk has taken, through a rough coat.
    fn coat_light(&self, exit: &Exit, pdf: Option<f32>) -> Spectrum<N> {
        let coat = &self.coated.coat;
        if coat.is_smooth() {
            return Spectrum::ZERO;
        }
        let (f, _) = coat.eval_pdf(-self.w, exit.wi);
        let share = pdf.map_or(1.0, |pdf| {
            let q = coat.eval_pdf(exit.wi, -self.w).1;
            if q + pdf > 0.0 { pdf / (q + pdf) } else { 0.0 }
        });
        self.weight * (f * self.transmittance(self.w) * share)
    }
}
