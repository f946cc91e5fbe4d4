//! Switches of the integrators. Every technique that pays can be turned off, to show that the mean does not move.

use tyndall_transport::sampler::SamplerKind;

/// When a segment also gets an equiangular sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Equiangular {
    /// Never.
    Off,
    /// Where the medium between ray and light is thin or absorbs much.
    #[default]
    Auto,
    /// On every segment of a medium.
    Always,
}

/// When paths are guided by what was learned of the light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Guiding {
    /// Never.
    Off,
    /// Where all media are thin: in thick ones the glow around a light tells as much.
    #[default]
    Auto,
    /// Wherever anything was learned.
    Always,
}

/// How lengths of rays through grids of densities are known. Paths are tracked, all of them; links between shared paths are
/// not (see [`crate::reuse`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lengths {
    /// By null collisions (see [`crate::tracking`]).
    #[default]
    Tracked,
    /// In closed form.
    Exact,
    /// By coarse sums: not the lengths, but what links are weighed by.
    Coarse,
}

/// How a path integrator works. Defaults are what ships.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Scatterings a path may have; `u32::MAX` is unlimited. Boundaries without a material are free.
    pub max_depth: u32,
    /// Points of the first dimensions.
    pub sampler: SamplerKind,
    /// Widen narrow lobes after the first scattering that is not specular (pbrt's `regularize`): biased.
    pub regularize: bool,
    /// Choose directions to lights (next-event estimation), combined with chance hits.
    pub light_sampling: bool,
    /// Where the lights are few, sample each of them at a path's first surface, not one that is drawn, and an area that is alone
    /// twice.
    pub each_light: bool,
    /// Combine light sampling, chance hits and equiangular samples by the power heuristic; in media that vary by densities, with
    /// less trust in light sampling. Off: by the balance heuristic, as points of media that emit always are.
    pub power: bool,
    /// `exp(-sigma_t d)` on shadow rays; off: a free flight along the shadow ray that passes or does not.
    pub exact_transmittance: bool,
    /// Shadow rays through media that vary take what is certain of the extinction in closed form (residual ratio
    /// tracking); off: ratio tracking.
    pub residual: bool,
    /// How far rays come in media that vary: no switch of the user's, links have settings of their own.
    pub lengths: Lengths,
    /// Weight by the albedo; off: absorption ends the path.
    pub survival: bool,
    /// Distances drawn towards a light.
    pub equiangular: Equiangular,
    /// Segments of a path that [`Equiangular::Auto`] considers, counted by the scatterings before them.
    pub equiangular_depth: u32,
    /// Limit equiangular distances to the lit part of a spotlight's cone.
    pub cone_clipping: bool,
    /// Draw directions towards the glow around a light in a medium, too.
    pub glow: bool,
    /// Learn where light comes from before the first sample, and draw directions from that, too.
    pub guiding: Guiding,
    /// Paths of neighbouring pixels go on from each other's second scattering.
    pub reuse: bool,
    /// What light the points have in common that paths are shared at is left to each pixel's own path.
    pub level: bool,
    /// Pixels at the rim of a lamp, around a point of light in a medium, before a medium that is a light, or with a lamp in a
    /// rough mirror, take the lowest orders of light from more paths.
    pub refine: bool,
    /// Russian roulette begins after this many scatterings; `u32::MAX` turns it off.
    pub roulette_depth: u32,
    /// A path of throughput below this is at risk.
    pub roulette_threshold: f32,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            max_depth: 5,
            sampler: SamplerKind::OwenSobol,
            regularize: false,
            light_sampling: true,
            each_light: true,
            power: true,
            exact_transmittance: true,
            residual: true,
            lengths: Lengths::Tracked,
            survival: true,
            equiangular: Equiangular::Auto,
            equiangular_depth: u32::MAX,
            cone_clipping: true,
            glow: true,
            guiding: Guiding::Auto,
            reuse: true,
            level: true,
            refine: true,
            roulette_depth: 1,
            roulette_threshold: 0.25,
        }
    }
}
