//! The medium a path is in; free flight and transmittance at the path's wavelengths where it is homogeneous.

use crate::{
    settings::{Lengths, Settings},
    weight::{Heuristic, exp},
};
use tyndall_geometry::{Ray, SurfacePoint};
use tyndall_scatter::phase::PhaseFunction;
use tyndall_spectral::{Spectrum, Wavelengths};
use tyndall_transport::{
    MediumId, Scene,
    media::{Heterogeneous, Medium},
    texture::TextureContext,
};

/// Optical depth of which nothing is left in 32 bits.
const OPAQUE: f32 = 87.0;

/// Coefficients \[1/m\] of the medium a path is in, looked up once on entering it.
#[derive(Clone, Copy, Debug)]
pub struct Inside<'s, const N: usize> {
    /// Absorption coefficient.
    pub sigma_a: Spectrum<N>,
    /// Scattering coefficient.
    pub sigma_s: Spectrum<N>,
    /// Extinction coefficient.
    pub sigma_t: Spectrum<N>,
    /// Source radiance \[W m^-2 sr^-1 nm^-1\].
    pub le: Spectrum<N>,
    /// Phase function.
    pub phase: &'s PhaseFunction,
    /// The medium where it varies in space: then the coefficients here are those of density 1 where it is a grid of densities
    /// ([`Heterogeneous::is_measurable`]), else zero.
    pub varying: Option<&'s Heterogeneous>,
}

impl<'s, const N: usize> Inside<'s, N> {
    /// How techniques are combined at a vertex that lies in, or was reached through, `inside`: all of them agree on it.
    #[inline(always)]
    pub fn heuristic(inside: Option<&Self>, settings: &Settings) -> Heuristic {
        let tracked = inside.is_some_and(|inside| inside.tracked(settings).is_some());
        match settings.power {
            true if tracked => Heuristic::Tracked,
            true => Heuristic::Power,
            false => Heuristic::Balance,
        }
    }

    /// The medium `id` at the wavelengths `w` for a path that begins in it; `None` in vacuum.
    #[inline(always)]
    pub fn of(scene: &'s Scene, id: MediumId, w: &Wavelengths<N>) -> Option<Self> {
        Self::entered(scene, id, None, w)
    }

    /// The medium `id` at the wavelengths `w` for a path that entered it at `entry`; `None` in vacuum.
    #[inline(always)]
    pub fn entered(
        scene: &'s Scene,
        id: MediumId,
        entry: Option<&SurfacePoint>,
        w: &Wavelengths<N>,
    ) -> Option<Self> {
        Some(match scene.medium(id)? {
            Medium::Homogeneous(m) => {
                let m = m.at(w);
                let (sigma_a, sigma_s, sigma_t) = (m.sigma_a, m.sigma_s, m.sigma_t());
                Self { sigma_a, sigma_s, sigma_t, le: m.le, phase: m.phase, varying: None }
            }
            Medium::Painted(m) => {
                // no path begins inside: such media have no name that a camera could be put into
                let m = m.at(&entry.map_or(TextureContext::ORIGIN, TextureContext::of), w);
                let (sigma_a, sigma_s, sigma_t) = (m.sigma_a, m.sigma_s, m.sigma_t());
                Self { sigma_a, sigma_s, sigma_t, le: m.le, phase: m.phase, varying: None }
            }
            Medium::Heterogeneous(m) => {
                let z = Spectrum::ZERO;
                let (sigma_a, sigma_s, phase) =
                    m.of_density_one(w).unwrap_or((z, z, &PhaseFunction::Isotropic));
                Self { sigma_a, sigma_s, sigma_t: sigma_a + sigma_s, le: z, phase, varying: Some(m) }
            }
        })
    }

    /// The medium where flights through it have to be tracked.
    #[inline(always)]
    pub fn tracked(&self, settings: &Settings) -> Option<&'s Heterogeneous> {
        self.varying.filter(|m| settings.lengths == Lengths::Tracked || !m.is_measurable())
    }

    /// `sigma_a` and `sigma_s` of density 1 where that is what the medium has.
    #[inline(always)]
    pub fn of_density_one(&self) -> Option<[Spectrum<N>; 2]> {
        // media of another kind have zeros here
        (!self.sigma_t.is_zero()).then_some([self.sigma_a, self.sigma_s])
    }

    /// The length of the ray from `from` to `to` \[m\], in a medium that varies the integral of its density; infinite where
    /// nothing gets through.
    #[inline(always)]
    pub fn length(&self, ray: &Ray, [from, to]: [f32; 2], settings: &Settings) -> f32 {
        let Some(medium) = self.varying else { return to - from };
        if settings.lengths == Lengths::Coarse {
            return medium.coarse_length(ray, [from, to]);
        }
        medium.length(ray, [from, to], OPAQUE / self.sigma_t.min_lane())
    }

    /// exp(-sigma_t t) per lane (Beer-Lambert).
    #[inline(always)]
    pub fn transmittance(&self, t: f32) -> Spectrum<N> {
        exp(self.sigma_t * -t)
    }

    /// exp(-(sigma_t,k - sigma_t,hero) t): transmittance over the hero's, which cannot underflow as a quotient could.
    #[inline(always)]
    pub fn transmittance_over_hero(&self, t: f32) -> Spectrum<N> {
        self.transmittance_over(self.sigma_t.hero(), t)
    }

    /// The same over that of an extinction `sigma` \[1/m\].
    #[inline(always)]
    pub fn transmittance_over(&self, sigma: f32, t: f32) -> Spectrum<N> {
        exp((self.sigma_t - Spectrum::splat(sigma)) * -t)
    }

    /// Density of a collision at distance `t` that does not end the path, per lane \[1/m\].
    #[inline(always)]
    pub fn collision_density(&self, t: f32, settings: &Settings) -> Spectrum<N> {
        self.collision_coefficient(settings) * self.transmittance(t)
    }

    /// sigma_t where absorption is a weight, sigma_s where it ends the path.
    #[inline(always)]
    pub fn collision_coefficient(&self, settings: &Settings) -> Spectrum<N> {
        if settings.survival { self.sigma_t } else { self.sigma_s }
    }

    /// True where nothing scatters at any wavelength, or nothing that scatters counts: the path then passes with the
    /// transmittance as its weight instead of drawing flights that could only end it.
    #[inline(always)]
    pub fn only_absorbs(&self, settings: &Settings) -> bool {
        let passes = self.sigma_s.is_zero() || settings.max_depth == 0;
        settings.survival && settings.exact_transmittance && passes
    }

    /// What the segment \[0, t\] emits towards its start: le sigma_a / sigma_t (1 - exp(-sigma_t t)), exactly.
    #[inline]
    pub fn emitted(&self, t: f32) -> Spectrum<N> {
        let tau = self.sigma_t * t;
        let absorbed = exp(-tau);
        Spectrum::from_fn(|k| {
            // the series keeps thin segments exact where 1 - exp(-tau) would cancel
            let depth = if tau[k] < 1e-2 {
                t * (1.0 - 0.5 * tau[k] + tau[k] * tau[k] * (1.0 / 6.0))
            } else {
                (1.0 - absorbed[k]) / self.sigma_t[k]
            };
            if self.sigma_a[k] > 0.0 { self.le[k] * self.sigma_a[k] * depth } else { 0.0 }
        })
    }
}
