//! Free flight and transmittance in media that vary in space, by null collisions.
//!
//! A majorant `sigma_maj(lambda) >= sigma_t(lambda, x)` is known piece by piece along the ray; the medium is filled up to it
//! with particles that do nothing, `sigma_n = sigma_maj - sigma_t` (Woodcock et al. 1965). Tentative collisions come with
//! the hero's `sigma_maj T_maj`; what happens at one is decided at the hero's wavelength too, and every lane carries its
//! own product of coefficients (Miller, Georgiev, Jarosz 2019, *A null-scattering path integral formulation of light
//! transport*). Emission is added at every tentative collision, whatever happens there (Simon et al. 2017).
//!
//! Shadow rays by residual ratio tracking (Novak et al. 2014): what is certain of the density, `m`, in closed form, and
//! only the rest `sigma_maj - m unit` by tentative collisions. The integrand over the tentative collisions is the same,
//! `prod sigma_n exp(-int sigma_maj)`, so that the two ways to a light are compared collision by collision.

use crate::{
    ember::Ember,
    settings::Settings,
    shadow::Shadow,
    weight::{PathWeight, divide, exp},
};
use tyndall_base::{Vec3, rng::Pcg32, warp};
use tyndall_geometry::Ray;
use tyndall_scatter::phase::Mixture;
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::media::{
    Heterogeneous, Visitor,
    majorant::{Majorants, Stretch},
    model::{MediumModel, Point},
};

/// Null collisions after which the exponentials are multiplied in, so that no product leaves the range of f32.
const BURST: u32 = 4;
/// A transmittance below this is at risk on a shadow ray.
const FAINT: f32 = 0.1;

/// How a flight ended.
#[derive(Debug)]
pub enum Flight<'m, const N: usize> {
    /// At the end of the segment.
    Through,
    /// In a scattering, whose weight is in the path's already.
    Scattered(Collision<'m, N>),
    /// In nothing.
    Ended,
}

/// A scattering in a medium.
#[derive(Debug)]
pub struct Collision<'m, const N: usize> {
    /// Distance along the ray.
    pub t: f32,
    /// Single-scattering albedo there.
    pub albedo: Spectrum<N>,
    /// What scatters there.
    pub scattering: Mixture<'m, N>,
}

/// A path on a segment of a ray.
#[derive(Debug)]
pub struct Traveller<'a, 'm, const N: usize> {
    /// The ray.
    pub ray: Ray,
    /// What is known of the medium; see [`Inside::of_density_one`](crate::medium::Inside::of_density_one).
    pub known: Option<[Spectrum<N>; 2]>,
    /// Where the segment ends.
    pub t_max: f32,
    /// The path's wavelengths.
    pub w: &'m Wavelengths<N>,
    /// Switches.
    pub settings: &'a Settings,
    /// Optical distance to the next tentative collision at the hero's wavelength.
    pub flight: &'a mut f32,
    /// The path's weight.
    pub weight: &'a mut PathWeight<N>,
    /// The lane that decides: the hero, but for paths that are shared.
    pub pilot: usize,
    /// Emission that reaches the pixel.
    pub emitted: &'a mut Spectrum<N>,
    /// How light sampling could have found that emission.
    pub ember: Option<Ember<'a>>,
    /// Numbers.
    pub rng: Pcg32,
}

/// Follows the free flight through `medium`.
#[inline(never)]
pub fn fly<'m, const N: usize>(medium: &'m Heterogeneous, traveller: Traveller<'_, 'm, N>) -> Flight<'m, N> {
    let ray = traveller.ray;
    medium.visit(Fly { local: medium.local(&ray), traveller })
}

/// Optical lengths since the weights were last brought up to date, over the unit spectrum.
#[derive(Clone, Copy, Debug, Default)]
struct Lengths {
    /// Of the majorant.
    max: f32,
    /// Of what shadow rays sample.
    sampled: f32,
    nulls: u32,
}

impl Lengths {
    #[inline(always)]
    fn add(&mut self, max: f32, sampled: f32, dt: f32) {
        self.max += max * dt;
        self.sampled += sampled * dt;
    }
}

struct Fly<'a, 'm, const N: usize> {
    local: (Vec3, Vec3),
    traveller: Traveller<'a, 'm, N>,
}

impl<'m, const N: usize> Visitor<'m> for Fly<'_, 'm, N> {
    type Output = Flight<'m, N>;

    #[inline(never)]
    fn visit<M: MediumModel>(self, model: &'m M, majorants: &'m Majorants) -> Flight<'m, N> {
        let (o, d) = self.local;
        let mut a = self.traveller;
        let prepared = model.prepare_known(a.w, a.known);
        let unit = model.unit(&prepared);
        let mut passed = Lengths::default();
        let mut walker = majorants.walk(o, d, a.t_max);
        let mut t = walker.start();
        while let Some(stretch) = walker.step() {
            let sampled = a.sampled(&stretch);
            loop {
                let rate = unit[a.pilot] * stretch.max;
                let tau = rate * (stretch.t1 - t);
                if *a.flight >= tau {
                    *a.flight -= tau;
                    passed.add(stretch.max, sampled, stretch.t1 - t);
                    t = stretch.t1;
                    break;
                }
                let dt = *a.flight / rate;
                t += dt;
                passed.add(stretch.max, sampled, dt);
                *a.flight = warp::sample_exponential(a.rng.next_f32(), 1.0);
                let p = o + d * t;
                let point = model.at(p, &prepared);
                a.emission(&point, (t, p), unit, stretch.max, &passed);
                match a.event(&point, unit, [stretch.max, sampled], &mut passed) {
                    Event::Null => {}
                    Event::Ended => return Flight::Ended,
                    Event::Real => {
                        let scattering = model.scattering(p, point.sigma_s, &prepared);
                        let albedo = point.sigma_s.safe_div(point.sigma_a + point.sigma_s);
                        return Flight::Scattered(Collision { t, albedo, scattering });
                    }
                }
            }
        }
        a.catch_up(unit, &mut passed);
        Flight::Through
    }
}

/// What a tentative collision turns out to be.
enum Event {
    Null,
    Real,
    Ended,
}

impl<const N: usize> Traveller<'_, '_, N> {
    /// The density that shadow rays sample on a stretch.
    #[inline(always)]
    fn sampled(&self, s: &Stretch) -> f32 {
        if self.settings.residual { s.max - s.min } else { s.max }
    }

    /// Emission at a tentative collision at distance `t`, the point `p` of the medium's space: `beta T emitted / (T_h
    /// sigma_maj_h)`, whose density in lane k is `sigma_maj_k T_k`, beside that of choosing the point as a light.
    #[inline(always)]
    fn emission(
        &mut self,
        point: &Point<N>,
        (t, p): (f32, Vec3),
        unit: Spectrum<N>,
        max: f32,
        passed: &Lengths,
    ) {
        if point.emitted.is_zero() {
            return;
        }
        let inv = 1.0 / (unit[self.pilot] * max);
        let ratio = over(unit, self.pilot, passed.max);
        let mut r = self.weight.r_u * unit * ratio * (max * inv);
        if let Some(ember) = &self.ember {
            let density = ember.density(self.ray.at(t), p);
            r += self.weight.r_l * self.competing(unit, ratio, passed) * (inv * density);
        }
        *self.emitted += divide(self.weight.beta * point.emitted * ratio * inv, r);
    }

    /// What the techniques that choose a light have for getting this far, over the hero's transmittance of the
    /// majorant, where `ratio` is that of the lanes.
    #[inline(always)]
    fn competing(&self, unit: Spectrum<N>, ratio: Spectrum<N>, passed: &Lengths) -> Spectrum<N> {
        if !self.settings.exact_transmittance {
            return ratio;
        }
        let hero = unit[self.pilot] * passed.max;
        exp(unit.map(|u| hero - u * passed.sampled))
    }

    /// Decides at the hero's wavelength and weighs all lanes.
    #[inline(always)]
    fn event(
        &mut self,
        point: &Point<N>,
        unit: Spectrum<N>,
        [max, sampled]: [f32; 2],
        passed: &mut Lengths,
    ) -> Event {
        let sigma_t = point.sigma_a + point.sigma_s;
        let u = self.rng.next_f32() * (unit[self.pilot] * max);
        if u >= sigma_t[self.pilot] {
            let sigma_n = (unit * max - sigma_t).max(0.0);
            let competing = if self.settings.exact_transmittance { unit * sampled } else { sigma_n };
            if !self.weight.null(self.pilot, sigma_n, competing) {
                return Event::Ended;
            }
            passed.nulls += 1;
            if passed.nulls == BURST {
                self.catch_up(unit, passed);
            }
            return Event::Null;
        }
        let coefficient = if self.settings.survival { sigma_t } else { point.sigma_s };
        if u >= coefficient[self.pilot] {
            return Event::Ended;
        }
        let ratio = over(unit, self.pilot, passed.max) * (1.0 / coefficient[self.pilot]);
        self.weight.fly(point.sigma_s * ratio, coefficient * ratio);
        if self.weight.beta.is_zero() { Event::Ended } else { Event::Real }
    }

    /// Multiplies the transmittances of the majorant into the weights.
    #[inline(always)]
    fn catch_up(&mut self, unit: Spectrum<N>, passed: &mut Lengths) {
        let ratio = over(unit, self.pilot, passed.max);
        self.weight.fly(ratio, ratio);
        self.weight.compete(self.competing(unit, ratio, passed));
        *passed = Lengths::default();
    }
}

/// `exp(-(unit_k - unit_j) length)`.
#[inline(always)]
fn over<const N: usize>(unit: Spectrum<N>, j: usize, length: f32) -> Spectrum<N> {
    let least = unit[j];
    exp(unit.map(|u| (least - u) * length))
}

/// Transmittance of `medium` along a shadow ray up to `t_max`, multiplied into `s`; `None` when nothing gets through. What is
/// known of the medium is as for [`Traveller`].
#[inline(never)]
pub fn transmit<const N: usize>(
    (medium, known): (&Heterogeneous, Option<[Spectrum<N>; 2]>),
    ray: &Ray,
    t_max: f32,
    w: &Wavelengths<N>,
    settings: &Settings,
    rng: Pcg32,
    s: &mut Shadow<N>,
) -> Option<()> {
    let local = medium.local(ray);
    let [t, r_l, r_u] = medium.visit(Transmit { local, known, t_max, w, settings, rng })?;
    s.t *= t;
    s.r_l *= r_l;
    s.r_u *= r_u;
    Some(())
}

struct Transmit<'a, const N: usize> {
    local: (Vec3, Vec3),
    known: Option<[Spectrum<N>; 2]>,
    t_max: f32,
    w: &'a Wavelengths<N>,
    settings: &'a Settings,
    rng: Pcg32,
}

impl<'m, const N: usize> Visitor<'m> for Transmit<'_, N> {
    type Output = Option<[Spectrum<N>; 3]>;

    #[inline(never)]
    fn visit<M: MediumModel>(mut self, model: &'m M, majorants: &'m Majorants) -> Option<[Spectrum<N>; 3]> {
        let (o, d) = self.local;
        let prepared = model.prepare_known(self.w, self.known);
        let unit = model.unit(&prepared);
        let residual = self.settings.residual && self.settings.exact_transmittance;
        let mut s = Estimate { r_u: Spectrum::ONE, r_l: Spectrum::ONE, roulette: 1.0 };
        let mut passed = Lengths::default();
        let mut walker = majorants.walk(o, d, self.t_max);
        let mut t = walker.start();
        let mut flight = warp::sample_exponential(self.rng.next_f32(), 1.0);
        while let Some(stretch) = walker.step() {
            let sampled = if residual { stretch.max - stretch.min } else { stretch.max };
            loop {
                let rate = unit.hero() * sampled;
                let tau = rate * (stretch.t1 - t);
                if flight >= tau {
                    flight -= tau;
                    passed.add(stretch.max, sampled, stretch.t1 - t);
                    t = stretch.t1;
                    break;
                }
                let dt = flight / rate;
                t += dt;
                passed.add(stretch.max, sampled, dt);
                flight = warp::sample_exponential(self.rng.next_f32(), 1.0);
                let sigma_t = model.extinction(o + d * t, &prepared);
                let majorant = unit * stretch.max;
                if self.settings.exact_transmittance {
                    s.ratio(majorant, sigma_t, unit, rate);
                    if !s.survives(&mut self.rng) {
                        return None;
                    }
                } else {
                    s.delta(majorant, sigma_t, &mut self.rng)?;
                }
                passed.nulls += 1;
                if passed.nulls == BURST {
                    s.catch_up(unit, &mut passed, self.settings);
                }
            }
        }
        s.catch_up(unit, &mut passed, self.settings);
        Some([s.r_u * s.roulette, s.r_l, s.r_u])
    }
}

/// A shadow ray under way: densities over the hero's, and the weight of its roulette.
struct Estimate<const N: usize> {
    r_u: Spectrum<N>,
    r_l: Spectrum<N>,
    roulette: f32,
}

impl<const N: usize> Estimate<N> {
    /// A tentative collision of the technique that chose the light, which came with `rate` at the hero's wavelength.
    #[inline(always)]
    fn ratio(&mut self, majorant: Spectrum<N>, sigma_t: Spectrum<N>, unit: Spectrum<N>, rate: f32) {
        self.r_u *= (majorant - sigma_t).max(0.0) * (1.0 / rate);
        self.r_l *= unit * (1.0 / unit.hero());
    }

    /// A tentative collision of a flight that a real one ends.
    #[inline(always)]
    fn delta(&mut self, majorant: Spectrum<N>, sigma_t: Spectrum<N>, rng: &mut Pcg32) -> Option<()> {
        let sigma_n = (majorant - sigma_t).max(0.0);
        if rng.next_f32() * majorant.hero() < sigma_t.hero() || sigma_n.hero() <= 0.0 {
            return None;
        }
        let ratio = sigma_n * (1.0 / sigma_n.hero());
        self.r_u *= ratio;
        self.r_l *= ratio;
        Some(())
    }

    /// Roulette on what is left.
    #[inline(always)]
    fn survives(&mut self, rng: &mut Pcg32) -> bool {
        let left = self.r_u.max_lane() * self.roulette;
        if left >= FAINT * self.r_l.mean() {
            return true;
        }
        self.roulette *= 2.0;
        left > 0.0 && rng.next_f32() < 0.5
    }

    #[inline(always)]
    fn catch_up(&mut self, unit: Spectrum<N>, passed: &mut Lengths, settings: &Settings) {
        let ratio = over(unit, 0, passed.sampled);
        self.r_l *= ratio;
        self.r_u *= if settings.exact_transmittance {
            let hero = unit.hero() * passed.sampled;
            exp(unit.map(|u| hero - u * passed.max))
        } else {
            ratio
        };
        *passed = Lengths::default();
    }
}
