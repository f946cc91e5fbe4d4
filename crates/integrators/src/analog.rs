//! `analog`: the independent judge. A photon's history run backwards, one wavelength, no weights but emission.
//!
//! Collisions, absorption and reflection are events with their own probabilities; light is met only by chance.
//! It is slow and simple on purpose, and shares no estimator with `volpath`.

use crate::observer::{Event, PathObserver, Vertex};
use tyndall_base::{Vec3, rng::Pcg32, warp};
use tyndall_geometry::Ray;
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::{
    MediumId, Scene,
    media::{Heterogeneous, Medium, MediumProperties},
    sampler::PathSampler,
    texture::TextureContext,
};

/// Radiance along `ray` at the hero's wavelength; other lanes are zero.
pub fn li<const N: usize>(
    scene: &Scene,
    max_depth: u32,
    mut ray: Ray,
    w: &Wavelengths<N>,
    sampler: &mut PathSampler,
    seen: &mut impl PathObserver<N>,
) -> Spectrum<N> {
    let mut l = Spectrum::ZERO;
    let mut medium = scene.camera_medium;
    let mut entry = TextureContext::ORIGIN; // where the path entered the medium
    let mut from = ray.o; // where the ray took its direction
    let mut depth = 0;
    let mut radiance_scale = 1.0; // radiance over n^2 is what refraction conserves
    let hero = |value: f32| Spectrum::from_fn(|k| if k == 0 { value } else { 0.0 });
    loop {
        let hit = scene.intersect(&ray);
        let t_hit = hit.as_ref().map_or(f32::INFINITY, |h| h.t);

        // a collision in the medium, if it comes before the surface
        if let Some(m) = scene.medium(medium) {
            let flight = match m {
                Medium::Homogeneous(m) => homogeneous(&m.at(w), t_hit, sampler),
                Medium::Painted(m) => homogeneous(&m.at(&entry, w), t_hit, sampler),
                Medium::Heterogeneous(m) => delta_tracking(m, &ray, t_hit, w, &mut sampler.stream()),
            };
            if let Some(collision) = flight {
                let p = ray.at(collision.t);
                watch(seen, Event::Medium, p, collision.t, depth, medium);
                if let Fate::Absorbed { le } = collision.fate {
                    // absorbed where the medium emits le
                    let value = hero(radiance_scale * le);
                    seen.contribution(depth, &value);
                    return l + value;
                }
                if depth >= max_depth {
                    break;
                }
                depth += 1;
                let (uc, u) = (sampler.next_1d(), sampler.next_2d());
                let wi = match m {
                    Medium::Homogeneous(m) => Some(m.phase.sample(-ray.d, [u.x, u.y], w).wi),
                    Medium::Painted(m) => Some(m.phase.sample(-ray.d, [u.x, u.y], w).wi),
                    Medium::Heterogeneous(m) => m.scatter(p, -ray.d, uc, [u.x, u.y], w),
                };
                let Some(wi) = wi else { break };
                from = p;
                ray = Ray { time: ray.time, ..Ray::new(p, wi) };
                continue;
            }
        }

        // light from infinity
        let Some(hit) = hit else {
            let far = scene.lights.infinite().iter();
            let sky: f32 = far.map(|&id| scene.lights.get(id).le_infinite(from, ray.d, w)[0]).sum();
            let value = hero(radiance_scale * sky);
            seen.contribution(depth, &value);
            return l + value;
        };

        // a surface: its own light, then the event
        let isect = scene.interaction(&ray, &hit);
        let s = &isect.surface;
        if let Some(id) = isect.light {
            let le = scene.lights.get(id).radiance_at(s.ng, [s.uv.x, s.uv.y], -ray.d, w);
            let value = hero(radiance_scale * le[0]);
            seen.contribution(depth, &value);
            l += value;
        }
        let wi = if isect.material.is_interface() {
            watch(seen, Event::Boundary, s.p, hit.t, depth, medium);
            ray.d
        } else {
            watch(seen, Event::Surface, s.p, hit.t, depth, medium);
            if depth >= max_depth {
                break;
            }
            depth += 1;
            let (frame, bsdf) = scene.materials[isect.material.index()].shade(s, w);
            let uc = sampler.next_1d();
            let u = sampler.next_2d();
            let Some(b) = bsdf.sample(frame.to_local(-ray.d), uc, [u.x, u.y]) else { break };
            // survival with the probability of the event; the factor of refraction is no probability
            let scale = 1.0 / (b.eta * b.eta);
            let survival = b.f[0] * b.wi.z.abs() / (b.pdf[0] * scale);
            radiance_scale *= scale * survival.max(1.0);
            if sampler.next_1d() >= survival {
                break;
            }
            frame.from_local(b.wi)
        };
        let next = isect.medium_towards(wi, medium);
        if next != medium {
            (medium, entry) = (next, TextureContext::of(s));
        }
        if !isect.material.is_interface() {
            from = s.p;
        }
        ray = Ray { time: ray.time, ..Ray::new(s.origin(wi), wi) };
    }
    l
}

/// A collision that is not null.
struct Collision {
    t: f32,
    fate: Fate,
}

enum Fate {
    Absorbed { le: f32 },
    Scattered,
}

/// The first collision before `t_max` where the coefficients are the same everywhere.
fn homogeneous<const N: usize>(
    m: &MediumProperties<'_, N>,
    t_max: f32,
    sampler: &mut PathSampler,
) -> Option<Collision> {
    let (sigma_a, sigma_s) = (m.sigma_a[0], m.sigma_s[0]);
    let t = warp::sample_exponential(sampler.next_1d(), sigma_a + sigma_s);
    if t >= t_max {
        return None;
    }
    let absorbed = sampler.next_1d() * (sigma_a + sigma_s) < sigma_a;
    Some(Collision { t, fate: if absorbed { Fate::Absorbed { le: m.le[0] } } else { Fate::Scattered } })
}

/// The same by delta tracking (Woodcock et al. 1965) with one majorant for the whole medium.
fn delta_tracking<const N: usize>(
    m: &Heterogeneous,
    ray: &Ray,
    t_max: f32,
    w: &Wavelengths<N>,
    rng: &mut Pcg32,
) -> Option<Collision> {
    let majorant = m.majorant(w)[0];
    let (mut t, t_end) = m.clip(ray, t_max)?;
    loop {
        t += warp::sample_exponential(rng.next_f32(), majorant);
        // without extinction the first flight is infinite or not a number
        if t.is_nan() || t >= t_end {
            return None;
        }
        let point = m.at(ray.at(t), w);
        let (sigma_a, sigma_s) = (point.sigma_a[0], point.sigma_s[0]);
        let u = rng.next_f32() * majorant;
        if u < sigma_a {
            return Some(Collision { t, fate: Fate::Absorbed { le: point.emitted[0] / sigma_a } });
        }
        if u < sigma_a + sigma_s {
            return Some(Collision { t, fate: Fate::Scattered });
        }
    }
}

fn watch<const N: usize, O: PathObserver<N>>(
    seen: &mut O,
    event: Event,
    p: Vec3,
    distance: f32,
    depth: u32,
    medium: MediumId,
) {
    if O::WANTS_VERTICES {
        let (albedo, throughput) = (Spectrum::ONE, Spectrum::ONE);
        seen.vertex(&Vertex { event, p, n: Vec3::ZERO, distance, depth, medium, albedo, throughput });
    }
}
