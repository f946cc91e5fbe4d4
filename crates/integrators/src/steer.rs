//! Directions drawn towards where light comes from: the glow around a light, or what was learned of the place.
//!
//! A direction is drawn from the phase function or BSDF, or from a density that steers it; the density of the mixture
//! enters all weights:
//!
//! ```text
//! p(w) = (1 - a - b) p_scatter(w) + a p_learned(w) + b p_glow(w)
//! ```
//!
//! What steers is a function of the point and of all lanes alike, so that every technique and every hero agrees on it.

use crate::{
    glow::{self, Glow},
    medium::Inside,
    settings::{Guiding, Settings},
};
use tyndall_base::Vec3;
use tyndall_scatter::{
    bsdf::BsdfFlags,
    phase::{Mixture, PhaseFunction},
};
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::{
    Scene,
    guiding::{Class, Directions},
};

/// Share of what was learned, where scattering has no direction of its own.
const SHARE: f32 = 0.4;
/// What is left of the glow's share where something was learned.
const GLOW: f32 = 0.5;

/// What draws directions beside the scattering at a point.
#[derive(Clone, Copy, Debug)]
pub struct Steering<'s> {
    /// What was learned there, with its share.
    learned: Option<(Directions<'s>, f32)>,
    /// The glow around a light, with its share.
    glow: Option<(Glow, f32)>,
}

impl<'s> Steering<'s> {
    /// At the point `p` of a homogeneous medium; `lamp` is the point whose glow attracts the path.
    #[inline(always)]
    pub fn in_medium<const N: usize>(
        (scene, settings): (&'s Scene, &Settings),
        lamp: Option<Vec3>,
        p: Vec3,
        inside: &Inside<'_, N>,
        w: &Wavelengths<N>,
    ) -> Option<Self> {
        let place = learned(scene, settings, Class::Medium, p)
            .map(|place| (place, SHARE * glow::openness(inside.phase, w)));
        Self::of(place, Glow::in_medium(lamp, p, inside, w))
    }

    /// At the point `p` of a medium that varies in space and scatters there like `scattering`.
    #[inline(always)]
    pub fn in_mixture<const N: usize>(
        (scene, settings): (&'s Scene, &Settings),
        p: Vec3,
        scattering: &Mixture<'_, N>,
        w: &Wavelengths<N>,
    ) -> Option<Self> {
        let place = learned(scene, settings, Class::Medium, p)?;
        let openness = match scattering.species() {
            [(_, phase)] => glow::openness::<N>(phase, w),
            _ => glow::openness::<N>(&PhaseFunction::Isotropic, w),
        };
        Self::of(Some((place, SHARE * openness)), None)
    }

    /// At the point `p` of a surface whose normal on the side of the path is `n`: for diffuse reflection.
    #[inline(always)]
    pub fn on_surface<const N: usize>(
        (scene, settings): (&'s Scene, &Settings),
        lamp: Option<Vec3>,
        p: Vec3,
        n: Vec3,
        flags: BsdfFlags,
        inside: Option<&Inside<'_, N>>,
    ) -> Option<Self> {
        if flags != BsdfFlags::DIFFUSE | BsdfFlags::REFLECTION {
            return None;
        }
        let place = learned(scene, settings, Class::facing(n), p).map(|place| (place, SHARE));
        Self::of(place, Glow::on_surface(lamp, p, n, inside))
    }

    #[inline(always)]
    fn of(learned: Option<(Directions<'s>, f32)>, glow: Option<Glow>) -> Option<Self> {
        let rest = learned.as_ref().map_or(1.0, |_| GLOW);
        let glow = glow.map(|g| (g, rest * g.share()));
        (learned.is_some() || glow.is_some()).then_some(Self { learned, glow })
    }

    /// Density of the mixture at `wi`, where the scattering alone has `pdf`.
    #[inline(always)]
    fn mix<const N: usize>(&self, pdf: Spectrum<N>, wi: Vec3) -> Spectrum<N> {
        let (mut share, mut steer) = (0.0, 0.0);
        if let Some((place, s)) = &self.learned {
            share += s;
            steer += s * place.pdf(wi);
        }
        if let Some((glow, s)) = &self.glow {
            share += s;
            steer += s * glow.pdf(wi);
        }
        pdf * (1.0 - share) + Spectrum::splat(steer)
    }

    /// A direction that is steered, when `u` says so; else `u` is what the scattering has left to draw from.
    #[inline(always)]
    pub fn sample(&self, u: &mut [f32; 2]) -> Option<Vec3> {
        let learned = self.learned.as_ref().map_or(0.0, |l| l.1);
        let share = learned + self.glow.as_ref().map_or(0.0, |g| g.1);
        if let Some((place, s)) = &self.learned
            && u[0] < *s
        {
            return Some(place.sample([u[0] / s, u[1]]));
        }
        if let Some((glow, s)) = &self.glow
            && u[0] < share
        {
            return Some(glow.sample([((u[0] - learned) / s).min(1.0 - 0.5 * f32::EPSILON), u[1]]));
        }
        u[0] = ((u[0] - share) / (1.0 - share)).min(1.0 - 0.5 * f32::EPSILON);
        None
    }
}

#[inline(always)]
fn learned<'s>(scene: &'s Scene, settings: &Settings, class: Class, p: Vec3) -> Option<Directions<'s>> {
    if settings.guiding == Guiding::Off {
        return None;
    }
    scene.guiding.as_ref()?.at(class, p)
}

/// Density of `wi` where something may steer beside a scattering of density `pdf`.
#[inline(always)]
pub fn mixed<const N: usize>(steering: Option<&Steering<'_>>, pdf: Spectrum<N>, wi: Vec3) -> Spectrum<N> {
    steering.map_or(pdf, |s| s.mix(pdf, wi))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_base::{vec::vec3, warp};
    use tyndall_testkit::{Rng, chi2_sphere};
    use tyndall_transport::guiding::{Field, Record};

    fn follows(steering: &Steering<'_>, what: &str) {
        let isotropic = Spectrum::<1>::splat(warp::pdf_uniform_sphere());
        let draw = |rng: &mut Rng| {
            let mut u = rng.f32x2();
            let wi = steering.sample(&mut u).unwrap_or_else(|| warp::sample_uniform_sphere(u));
            Some(wi.to_array())
        };
        let pdf = |[x, y, z]: [f32; 3]| f64::from(steering.mix(isotropic, vec3(x, y, z)).hero());
        chi2_sphere(draw, pdf, 200_000, 7).assert_ok(what, 3);
    }

    #[test]
    fn directions_follow_the_density_of_the_mixture() {
        let glow = (Glow::towards(vec3(1.0, 2.0, -0.5).normalize(), 0.5), 0.5);
        follows(&Steering { learned: None, glow: Some(glow) }, "glow and sphere");
        let mut rng = Rng::new(8);
        let mut records: [Vec<Record>; Class::COUNT] = Default::default();
        let draw = |rng: &mut Rng| warp::sample_cosine_hemisphere(rng.f32x2());
        records[0] = (0..1000).map(|_| Record::new(Vec3::ZERO, draw(&mut rng), 1.0)).collect();
        let field = Field::new(records).expect("enough records");
        let place = field.at(Class::Medium, Vec3::ZERO).expect("learned");
        follows(&Steering { learned: Some((place, 0.4)), glow: None }, "learned and sphere");
        let both = Steering { learned: Some((place, 0.4)), glow: Some((glow.0, 0.2)) };
        follows(&both, "learned, glow and sphere");
    }
}
