//! Distances drawn towards a light (Kulla & Fajardo 2012, *Importance sampling techniques for path tracing in
//! participating media*), limited to the lit part of a spotlight's cone.
//!
//! With D the distance of the light point from the ray and s the ray parameter of the nearest point,
//! `t = s + D tan((1 - u) a + u b)`, `p(t) = D / ((b - a)(D^2 + (t - s)^2))`.
//!
//! The sample shares its path space with two others, each with the density of every lane as hero: a free flight
//! followed by light sampling, and a free flight followed by a scattering that happens to meet the light.

use crate::{
    medium::Inside,
    settings::{Equiangular, Settings},
    shadow::{End, Place, shadow},
    steer::{Steering, mixed},
    weight::{PathWeight, combine, divide},
};
use tyndall_base::{Vec3, warp};
use tyndall_geometry::Ray;
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::{
    LightId, MediumId, Scene,
    light::{Light, PositionSample, SpotLight, Target},
    sampler::PathSampler,
};

/// Thickness between ray and light up to which a segment gets a sample.
const THIN: f32 = 1.0;
/// Albedo below which it gets one at any thickness.
const DARK: f32 = 0.7;
/// Thickness beyond which even a dark medium gets none.
const THICK: f32 = 4.0;

/// A segment of a ray in a medium, as the technique sees it.
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    /// Start of the segment \[m\].
    pub o: Vec3,
    /// Unit direction.
    pub d: Vec3,
    /// Length, possibly infinite.
    pub t_max: f32,
    /// Mean extinction over the lanes \[1/m\].
    sigma_t: f32,
    /// Mean albedo over the lanes.
    albedo: f32,
    mode: Equiangular,
    clip: bool,
}

impl Segment {
    /// The segment `[0, t_max]` of `ray` in a medium; `None` where the technique is off or has no light.
    #[inline]
    pub fn new<const N: usize>(
        scene: &Scene,
        settings: &Settings,
        ray: &Ray,
        t_max: f32,
        inside: &Inside<'_, N>,
    ) -> Option<Self> {
        let mode = settings.equiangular;
        if mode == Equiangular::Off || !settings.light_sampling || !scene.lights.has_local() {
            return None;
        }
        let (sigma_t, sigma_s) = (inside.sigma_t.mean(), inside.sigma_s.mean());
        if sigma_s <= 0.0 || inside.varying.is_some() {
            return None;
        }
        let albedo = sigma_s / sigma_t;
        Some(Self { o: ray.o, d: ray.d, t_max, sigma_t, albedo, mode, clip: settings.cone_clipping })
    }

    /// The same for all lights, whether or not the technique pays.
    #[inline(always)]
    #[must_use]
    pub fn always(self) -> Self {
        Self { mode: Equiangular::Always, ..self }
    }

    /// The part of the segment that `light` can light, when seen from the point `y`; `None` when the technique
    /// leaves this pair alone. A function of the segment and `y` only, so that all techniques agree on it.
    #[inline]
    fn lit(&self, light: &Light, y: Vec3) -> Option<Lit> {
        let s = (y - self.o).dot(self.d);
        let distance = (self.o + self.d * s - y).length();
        if distance <= 0.0 || !self.pays(light, distance) {
            return None;
        }
        let (t0, t1) = match light {
            Light::Spot(spot) if self.clip => cone_interval(spot, self.o, self.d, self.t_max)?,
            _ => (0.0, self.t_max),
        };
        (t1 > t0).then_some(Lit { s, distance, t0, t1 })
    }

    #[inline(always)]
    fn pays(&self, light: &Light, distance: f32) -> bool {
        let tau = self.sigma_t * distance;
        match self.mode {
            Equiangular::Off => false,
            Equiangular::Always => true,
            // a beam is narrow: a flight seldom ends in it
            Equiangular::Auto if matches!(light, Light::Spot(_)) => true,
            Equiangular::Auto => tau < THIN || (self.albedo < DARK && tau < THICK),
        }
    }

    /// Density of the whole technique at the scattering point at distance `t` and the light point `target`: choice
    /// of the light, of its point (in solid angle as seen from the scattering point) and of the distance.
    #[inline]
    pub fn density(&self, scene: &Scene, id: LightId, t: f32, target: &Target) -> f32 {
        let light = scene.lights.get(id);
        let Some(lit) = self.lit(light, target.p) else { return 0.0 };
        if t < lit.t0 || t > lit.t1 {
            return 0.0;
        }
        let x = self.o + self.d * t;
        let solid = target.pdf_area / jacobian(light, x, target);
        let pdf = scene.lights.pmf_local(id) * solid * lit.pdf(t);
        if pdf.is_finite() { pdf } else { 0.0 }
    }
}

/// The lit part of a segment and where it is nearest to the light.
#[derive(Clone, Copy, Debug)]
struct Lit {
    s: f32,
    distance: f32,
    t0: f32,
    t1: f32,
}

impl Lit {
    #[inline(always)]
    fn sample(&self, u: f32) -> (f32, f32) {
        let e = self.distribution();
        let t = e.sample(u);
        (t, e.pdf(t))
    }

    #[inline(always)]
    fn pdf(&self, t: f32) -> f32 {
        self.distribution().pdf(t)
    }

    #[inline(always)]
    fn distribution(&self) -> warp::Equiangular {
        warp::Equiangular::new(self.s, self.distance, self.t0, self.t1)
    }
}

/// Solid angle at `x` per area at the light (1 for points, whose samples carry 1/d^2 in the intensity).
#[inline(always)]
fn jacobian(light: &Light, x: Vec3, target: &Target) -> f32 {
    if light.is_delta() {
        return 1.0;
    }
    let to = target.p - x;
    let d2 = to.length_squared();
    target.n.abs_dot(to) / (d2 * d2.sqrt())
}

/// Where the segment runs inside the spotlight's cone: roots of ((x - p).a)^2 = cos^2 |x - p|^2 on the lit side.
fn cone_interval(spot: &SpotLight, o: Vec3, d: Vec3, t_max: f32) -> Option<(f32, f32)> {
    let cos = f64::from(spot.cos_end);
    if cos <= 0.0 {
        return Some((0.0, t_max)); // wider than a half-space: not convex
    }
    let f = |v: Vec3| [f64::from(v.x), f64::from(v.y), f64::from(v.z)];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (axis, d64, q) = (f(spot.axis), f(d), f(o - spot.p));
    let (da, qa, c2) = (dot(d64, axis), dot(q, axis), cos * cos);
    // the quadratic a t^2 + 2 b t + c > 0 inside the double cone
    let a = da * da - c2 * dot(d64, d64);
    let b = da * qa - c2 * dot(d64, q);
    let c = qa * qa - c2 * dot(q, q);
    let lit = |t: f64| qa + t * da > 0.0;
    let disc = b * b - a * c;
    let (lo, hi) = if a < 0.0 {
        // leaves the cone at both ends
        if disc <= 0.0 {
            return None;
        }
        let r = disc.sqrt();
        let (t0, t1) = ((-b + r) / a, (-b - r) / a);
        if !lit(0.5 * (t0 + t1)) {
            return None;
        }
        (t0, t1)
    } else {
        // runs to infinity inside one of the two nappes
        let r = disc.max(0.0).sqrt();
        let (t0, t1) = if a > 0.0 { ((-b - r) / a, (-b + r) / a) } else { (-c / (2.0 * b), -c / (2.0 * b)) };
        if da > 0.0 { (t1, f64::INFINITY) } else { (f64::NEG_INFINITY, t0) }
    };
    // a hair wider than the cone, so that rounding loses none of it
    let slack = 1e-5 * (1.0 + lo.abs().min(hi.abs()));
    let (t0, t1) = ((lo - slack).max(0.0) as f32, (hi + slack).min(f64::from(t_max)) as f32);
    (t1 > t0).then_some((t0, t1))
}

/// The path in front of a segment.
#[derive(Clone, Copy, Debug)]
pub struct Origin<'a, 's, const N: usize> {
    /// The medium of the segment.
    pub medium: MediumId,
    /// Its coefficients.
    pub inside: &'a Inside<'s, N>,
    /// The weight at the segment's start.
    pub weight: &'a PathWeight<N>,
    /// The point whose glow attracts the path.
    pub lamp: Option<Vec3>,
    /// Scatterings that the sampled light has had.
    pub order: u32,
    /// The path's time within the shutter.
    pub time: f32,
    /// The hero is drawn anew at the scattering, which makes densities before and after it independent.
    pub anew: bool,
    /// Where flights are shared, the technique has its part of the light for itself.
    pub division: Option<Division>,
}

/// How the light that scatters at a point y towards a path is divided between paths that meet y by a flight and
/// equiangular samples, where the former are shared by pixels (see [`crate::reuse`]) and densities of all techniques at y
/// are not to be had: by a function of y and the light point alone,
///
/// ```text
/// part of flights = d / (d + rho),   rho = 1 / (width n sigma_t)
/// ```
///
/// with d the distance of the two points, n the number of pixels, and `width d` the length over which equiangular samples
/// spread; that is the balance heuristic for a ray that passes the light at the distance d. Flights have all the light of
/// surfaces: what these send to a point is bounded.
#[derive(Clone, Copy, Debug)]
pub struct Division {
    /// `n sigma_t` \[1/m\]: collisions of the flights of all pixels.
    collisions: f32,
}

impl Division {
    /// In a medium, for the flights of `n` pixels; `None` where equiangular samples are off.
    #[inline(always)]
    pub fn new<const N: usize>(
        scene: &Scene,
        settings: &Settings,
        inside: &Inside<'_, N>,
        n: usize,
    ) -> Option<Self> {
        let on =
            settings.equiangular != Equiangular::Off && settings.light_sampling && scene.lights.has_points();
        (on && !inside.sigma_s.is_zero() && inside.varying.is_none())
            .then(|| Self { collisions: n as f32 * inside.sigma_t.mean() })
    }

    /// The part of flights at the distance `d` from a point of `light`.
    #[inline(always)]
    pub fn of_flights(&self, light: &Light, d: f32) -> f32 {
        let width = match light {
            Light::Spot(spot) if spot.cos_end > 0.0 => {
                2.0 * (1.0 - spot.cos_end * spot.cos_end).max(0.0).sqrt() / spot.cos_end
            }
            _ => std::f32::consts::PI,
        };
        let x = width.min(std::f32::consts::PI) * self.collisions * d;
        if light.is_local() && light.is_delta() { x / (x + 1.0) } else { 1.0 }
    }
}

/// One sample of the technique on `segment`: the light it adds to the pixel.
#[inline]
pub fn sample<const N: usize>(
    scene: &Scene,
    settings: &Settings,
    segment: &Segment,
    at: &Origin<'_, '_, N>,
    w: &Wavelengths<N>,
    sampler: &mut PathSampler,
) -> Spectrum<N> {
    // the light, a point on it, and the distance
    let u_light = sampler.next_1d();
    let u_point = sampler.next_2d();
    let u_t = sampler.next_1d();
    (|| {
        let id = scene.lights.select_local(u_light)?.id;
        let light = scene.lights.get(id);
        let y = light.sample_position(&scene.accel, [u_point.x, u_point.y])?;
        let (t, pdf_t) = segment.lit(light, y.target.p)?.sample(u_t);
        if pdf_t.is_nan() || pdf_t <= 0.0 {
            return None;
        }
        connect(scene, settings, segment, at, id, &y, t, w, sampler)
    })()
    .unwrap_or(Spectrum::ZERO)
}

/// Scatters at distance `t` towards the light point `y`.
#[expect(clippy::too_many_arguments, reason = "the state of a path and of a sample")]
#[inline]
fn connect<const N: usize>(
    scene: &Scene,
    settings: &Settings,
    segment: &Segment,
    at: &Origin<'_, '_, N>,
    id: LightId,
    y: &PositionSample,
    t: f32,
    w: &Wavelengths<N>,
    sampler: &mut PathSampler,
) -> Option<Spectrum<N>> {
    let (light, inside, weight) = (scene.lights.get(id), at.inside, at.weight);
    let x = segment.o + segment.d * t;
    let to = y.target.p - x;
    let d2 = to.length_squared();
    if d2 == 0.0 {
        return None;
    }
    let own = at.division.map_or(1.0, |division| 1.0 - division.of_flights(light, d2.sqrt()));
    if own <= 0.0 {
        return None;
    }
    let wi = to * (1.0 / d2.sqrt());
    let mut l = light.emitted_along(y, -wi, w);
    if light.is_delta() {
        l *= 1.0 / d2;
    }
    let technique = segment.density(scene, id, t, &y.target);
    if l.is_zero() || technique.is_nan() || technique <= 0.0 {
        return None;
    }
    let s = shadow(
        scene,
        settings,
        x,
        Place { medium: at.medium, inside: Some(inside), time: at.time },
        End::At(y.target),
        w,
        sampler,
    )?;
    let phase = inside.phase.eval(-segment.d, wi, w);
    let f = inside.sigma_s * inside.transmittance(t) * phase;
    if at.division.is_some() {
        return Some(divide(weight.beta * f * s.t * l * own, weight.r_u * s.r_l * technique));
    }
    // densities of the three techniques, lane by lane
    let flight = inside.collision_density(t, settings);
    let by_light = scene.lights.pmf_at(x, Vec3::ZERO, id) * light.pdf_li(&scene.accel, x, wi, &y.target);
    let steering = Steering::in_medium((scene, settings), at.lamp, x, inside, w);
    let by_chance =
        if light.is_hidden() { Spectrum::ZERO } else { mixed(steering.as_ref(), phase, wi) * s.r_u };
    let flown = if at.anew { Spectrum::splat((weight.r_u * flight).mean()) } else { weight.r_u * flight };
    let own = weight.r_u * s.r_l * technique;
    let heuristic = Inside::heuristic(Some(inside), settings);
    let others = [flown * s.r_l * by_light, flown * by_chance];
    Some(combine(heuristic, weight.beta * f * s.t * l, own, others))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_base::vec::vec3;
    use tyndall_spectral::Curve;
    use tyndall_testkit::{Rng, chi2_1d};

    #[test]
    fn cone_interval_holds_exactly_the_lit_points() {
        let spot = SpotLight::new(vec3(0.0, 3.0, 0.0), vec3(0.0, -1.0, 0.0), Curve::ONE.into(), 20.0, 5.0)
            .expect("valid");
        let rays = [
            (vec3(-5.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0)),
            (vec3(-5.0, 5.0, 0.0), vec3(1.0, 0.0, 0.0)),
            (vec3(0.1, 2.0, 0.0), vec3(0.0, -1.0, 0.0)),
            (vec3(0.1, -2.0, 0.0), vec3(0.0, 1.0, 0.0)),
            (vec3(0.0, 0.0, 0.3), vec3(0.6, 0.0, 0.8)),
            (vec3(2.0, 0.0, 0.3), vec3(-0.6, 0.3, -0.2).normalize()),
        ];
        for (o, d) in rays {
            let interval = cone_interval(&spot, o, d, 10.0);
            for i in 0..2000 {
                let t = 10.0 * (i as f32 + 0.5) / 2000.0;
                let to = (o + d * t - spot.p).normalize();
                let cos = to.dot(spot.axis);
                if (cos - spot.cos_end).abs() < 1e-3 {
                    continue; // on the edge
                }
                let inside = interval.is_some_and(|(a, b)| t >= a && t <= b);
                assert_eq!(inside, cos > spot.cos_end, "{o:?} {d:?} at {t}: {interval:?}");
            }
        }
    }

    /// Distances in the lit part of a beam, near and far, across, along and against it.
    #[test]
    fn cone_limited_distances_follow_their_density() {
        let spot = SpotLight::new(vec3(0.0, 3.0, 0.0), vec3(0.0, -1.0, 0.0), Curve::ONE.into(), 12.0, 4.0)
            .expect("valid");
        let light = Light::Spot(spot);
        let rays = [
            (vec3(-5.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0), 40.0),
            (vec3(-5.0, -20.0, 0.3), vec3(1.0, 0.0, 0.0), 40.0),
            (vec3(-0.3, 2.9, 0.0), vec3(1.0, 0.1, 0.0).normalize(), 40.0),
            (vec3(0.02, 2.0, 0.0), vec3(0.0, -1.0, 0.0), 40.0),
            (vec3(0.1, -6.0, 0.02), vec3(0.0, 1.0, 0.0), 40.0),
            (vec3(0.0, 0.0, 0.3), vec3(0.6, 0.0, 0.8), 0.2),
            (vec3(2.0, 0.0, 0.3), vec3(-0.6, 0.3, -0.2).normalize(), f32::INFINITY),
        ];
        for (o, d, t_max) in rays {
            let segment =
                Segment { o, d, t_max, sigma_t: 0.1, albedo: 0.9, mode: Equiangular::Auto, clip: true };
            let lit = segment.lit(&light, vec3(0.0, 3.0, 0.0)).expect("the ray crosses the beam");
            let (from, to) = (f64::from(lit.t0), f64::from(lit.t1));
            assert!(to < 60.0, "{o:?} {d:?}: {lit:?}");
            let draw = |rng: &mut Rng| {
                let (t, pdf) = lit.sample(rng.f32());
                assert!((pdf / lit.pdf(t) - 1.0).abs() < 1e-6, "{lit:?} at {t}");
                Some(f64::from(t))
            };
            let pdf = |t: f64| f64::from(lit.pdf(t as f32));
            chi2_1d(draw, pdf, [from, to], 200_000, 3).assert_ok(&format!("{o:?} {d:?}"), rays.len());
        }
    }
}
