//! What a caller may ask for beyond what the scene says.

use std::time::Duration;
use tyndall_engine::{Shard, Target};
use tyndall_film::{ErrorMode, Guide};
use tyndall_geometry::Dispatch;
use tyndall_integrators::layers::{Aov, Orders};
use tyndall_spectral::{LambdaRange, strategy::Rule};

/// How wavelengths travel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spectral {
    /// Several on one path, one of which leads (Wilkie et al. 2014).
    Hero {
        /// 1, 4, 8 or 16.
        wavelengths: u32,
    },
    /// One path, one wavelength (Wang & Chern 2001).
    Opow {
        /// A fixed set of so many equidistant wavelengths; `None` draws from the continuum.
        set: Option<(u32, Rule)>,
    },
    /// One path, all wavelengths of a fixed set, decisions by their means: biased in chromatic media.
    Opaw {
        /// Size and rule of the set.
        set: (u32, Rule),
    },
    /// Stratified wavelength clusters (Evans & McCool 1999): several on one path until they must part.
    Swc {
        /// 1, 4, 8 or 16.
        wavelengths: u32,
    },
}

impl Spectral {
    /// The name on the command line.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Hero { .. } => "hero",
            Self::Opow { .. } => "opow",
            Self::Opaw { .. } => "opaw",
            Self::Swc { .. } => "swc",
        }
    }

    /// The fixed set, where there is one.
    pub const fn set(&self) -> Option<(u32, Rule)> {
        match *self {
            Self::Opow { set } => set,
            Self::Opaw { set } => Some(set),
            Self::Hero { .. } | Self::Swc { .. } => None,
        }
    }
}

/// Density that wavelengths are drawn from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WavelengthPdf {
    /// `Light`, but `Uniform` for the integrator `wang-chern`, as in the paper.
    #[default]
    Auto,
    /// What the lights emit and the film sees.
    Light,
    /// What the eye sees.
    Visible,
    /// The same everywhere.
    Uniform,
}

/// Everything that can be asked for. `Default` is what the scene says.
#[derive(Clone, Debug)]
pub struct Options {
    /// Samples per pixel; the scene's if `None`.
    pub spp: Option<u32>,
    /// How wavelengths travel.
    pub spectral: Spectral,
    /// Their density.
    pub wavelength_pdf: WavelengthPdf,
    /// Spectral range \[nm\].
    pub range: LambdaRange,
    /// Another integrator than the scene's.
    pub integrator: Option<String>,
    /// Another choice than the scene's whether lights are sampled.
    pub light_sampling: Option<bool>,
    /// Another depth than the scene's; `u32::MAX` is unlimited.
    pub max_depth: Option<u32>,
    /// Another size than the scene's.
    pub resolution: Option<[u32; 2]>,
    /// A part of the picture: x0, x1, y0, y1 in fractions.
    pub crop: Option<[f32; 4]>,
    /// Edges of spectral bands \[nm\].
    pub band_edges: Option<Vec<f32>>,
    /// Auxiliary outputs.
    pub aovs: Vec<Aov>,
    /// Orders of scattering as layers.
    pub orders: Vec<Orders>,
    /// Another seed than the scene's.
    pub seed: Option<u64>,
    /// How errors are found.
    pub errors: ErrorMode,
    /// Samples of a larger luminance are scaled down to it and counted.
    pub clamp: Option<f32>,
    /// Limit of rendering time.
    pub time: Option<Duration>,
    /// Error to reach.
    pub target: Option<Target>,
    /// A part of the work.
    pub shard: Option<Shard>,
    /// What earlier rounds have learned.
    pub guide: Guide,
    /// Doubtful tables are errors.
    pub strict: bool,
    /// Values that replace those of the scene, as `NAME.PARAM=VALUE`.
    pub set: Vec<String>,
    /// Instructions to use; the bits are the same.
    pub dispatch: Dispatch,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            spp: None,
            spectral: Spectral::Hero { wavelengths: 8 },
            wavelength_pdf: WavelengthPdf::Auto,
            range: LambdaRange::VISIBLE,
            integrator: None,
            light_sampling: None,
            max_depth: None,
            resolution: None,
            crop: None,
            band_edges: None,
            aovs: Vec::new(),
            orders: Vec::new(),
            seed: None,
            errors: ErrorMode::Conservative,
            clamp: None,
            time: None,
            target: None,
            shard: None,
            guide: Guide::default(),
            strict: false,
            set: Vec::new(),
            dispatch: Dispatch::Detect,
        }
    }
}
