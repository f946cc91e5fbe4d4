//! What a film holds: window, channels, error mode.

use serde::{Deserialize, Serialize};

use crate::{FilmError, PixelBounds, develop::POOL_TILE};

/// How standard errors are estimated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum ErrorMode {
    /// Sums of squares of all samples of a pixel. Samples of one scrambled net are not independent: the plain variance
    /// overstates the error of their mean, so this is an upper estimate.
    Conservative,
    /// Sample `i` belongs to replicate `i mod replicates`, each with a scramble of its own; the spread of the replicates
    /// gives the error, with `replicates - 1` degrees of freedom.
    Replicated {
        /// Number of replicates, 2 to 64; 8 is the usual one.
        replicates: u32,
    },
}

impl ErrorMode {
    /// Replicated with the usual 8 replicates.
    pub const REPLICATED: Self = Self::Replicated { replicates: 8 };

    /// Number of slots a pixel's samples are spread over.
    #[inline(always)]
    pub const fn slots(self) -> u32 {
        match self {
            Self::Conservative => 1,
            Self::Replicated { replicates } => replicates,
        }
    }

    /// `conservative` or `replicated`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Conservative => "conservative",
            Self::Replicated { .. } => "replicated",
        }
    }
}

/// What is kept of the channels of a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Statistics {
    /// Mean and standard error.
    Errors,
    /// Mean only (AOVs).
    Mean,
}

/// Weights that samples may carry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Weights {
    /// Every sample has weight 1 (filters without negative lobes).
    Unit,
    /// Weights are 1 or -1 (filters with negative lobes); a pixel is the ratio of weighted sum and sum of weights.
    Signed,
}

/// Channels that belong together: the image itself, one order of scattering, an AOV.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct ChannelGroup {
    /// Name of the layer; empty for the image itself.
    pub name: String,
    /// Unit of the values, as written into files.
    pub unit: String,
    /// Names of the channels.
    pub channels: Vec<String>,
    /// What is kept.
    pub statistics: Statistics,
}

/// Description of a film.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FilmSpec {
    /// Size of the whole image \[pixels\].
    pub resolution: [u32; 2],
    /// The part of it that is rendered.
    pub bounds: PixelBounds,
    /// Channels; groups with errors stand before those without.
    pub groups: Vec<ChannelGroup>,
    /// Weights of the first channels that make up luminance Y, on which error summaries, stop rules and flags rest.
    pub luminance: Vec<f32>,
    /// How errors are estimated.
    pub mode: ErrorMode,
    /// Weights that samples carry.
    pub weights: Weights,
    /// Samples whose |Y| is greater are scaled down to it; what that removes is counted and summed. Off by default.
    pub clamp: Option<f32>,
    /// The job's seed, reported beside bad samples.
    pub seed: u64,
    /// Side of the squares of pixels whose samples of the same number share paths, so that they have errors in common; the
    /// squares are `bounds.tiles(square)`. 1 where all pixels are independent. Set by whoever knows the pass.
    #[serde(default = "alone", skip_serializing_if = "is_alone")]
    pub square: u32,
}

/// The `square` of films that say nothing of it.
const fn alone() -> u32 {
    1
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
const fn is_alone(square: &u32) -> bool {
    *square == 1
}

impl FilmSpec {
    /// A film of the whole image with one group of channels and no clamp.
    pub fn new(resolution: [u32; 2], group: ChannelGroup, luminance: Vec<f32>, mode: ErrorMode) -> Self {
        Self {
            resolution,
            bounds: PixelBounds::new(0, 0, resolution[0], resolution[1]),
            groups: vec![group],
            luminance,
            mode,
            weights: Weights::Unit,
            clamp: None,
            seed: 0,
            square: alone(),
        }
    }

    /// Channels X, Y, Z in pbrt's normalisation.
    pub fn xyz(resolution: [u32; 2], mode: ErrorMode) -> Self {
        let group = ChannelGroup {
            name: String::new(),
            unit: "pbrt-normalised".into(),
            channels: ["X", "Y", "Z"].map(String::from).to_vec(),
            statistics: Statistics::Errors,
        };
        Self::new(resolution, group, vec![0.0, 1.0, 0.0], mode)
    }

    /// With one more group; see [`FilmSpec::groups`] for the order.
    pub fn with_group(mut self, group: ChannelGroup) -> Self {
        self.groups.push(group);
        self
    }

    /// Number of channels of all groups: the length of a sample.
    pub fn channels(&self) -> usize {
        self.groups.iter().map(|g| g.channels.len()).sum()
    }

    /// Number of leading channels that have errors.
    pub fn channels_with_errors(&self) -> usize {
        self.groups.iter().filter(|g| g.statistics == Statistics::Errors).map(|g| g.channels.len()).sum()
    }

    /// Names of all channels, `group.channel` where the group has a name.
    pub fn channel_names(&self) -> Vec<String> {
        let full =
            |g: &ChannelGroup, c: &str| if g.name.is_empty() { c.into() } else { format!("{}.{c}", g.name) };
        self.groups.iter().flat_map(|g| g.channels.iter().map(move |c| full(g, c))).collect()
    }

    /// Bytes of one pixel's sums.
    pub fn bytes_per_pixel(&self) -> u64 {
        let layout = Layout::new(self);
        (layout.sums * 16
            + layout.squares * 24
            + layout.cross * 16
            + layout.slots * 4
            + layout.weights * 4
            + 8) as u64
    }

    /// Bytes of the whole film's sums.
    pub fn bytes(&self) -> u128 {
        u128::from(self.bytes_per_pixel()) * u128::from(self.bounds.area())
    }

    /// Refuses a film that needs more than `limit` bytes; nothing is allocated.
    pub fn check_size(&self, limit: u64) -> Result<(), FilmError> {
        let needed = self.bytes();
        if needed <= u128::from(limit) {
            return Ok(());
        }
        let (width, height) = (self.bounds.width(), self.bounds.height());
        Err(FilmError::TooLarge { width, height, channels: self.channels(), needed, limit })
    }

    /// Checks every field.
    pub fn validate(&self) -> Result<(), FilmError> {
        let [width, height] = self.resolution;
        if self.bounds.area() == 0 {
            return Err(FilmError::Empty { width: self.bounds.width(), height: self.bounds.height() });
        }
        if !PixelBounds::new(0, 0, width, height).encloses(&self.bounds) {
            return Err(invalid("crop", "a window inside the image", format!("{:?}", self.bounds)));
        }
        self.validate_channels()?;
        if !(self.square.is_power_of_two() && self.square <= POOL_TILE) {
            return Err(invalid("square", "1, 2, 4, 8 or 16 pixels", self.square.to_string()));
        }
        match self.mode {
            ErrorMode::Replicated { replicates } if !(2..=64).contains(&replicates) => {
                Err(invalid("replicates", "2 to 64", replicates.to_string()))
            }
            _ => Ok(()),
        }
    }

    fn validate_channels(&self) -> Result<(), FilmError> {
        let first_mean = self.groups.iter().position(|g| g.statistics == Statistics::Mean);
        let last_error = self.groups.iter().rposition(|g| g.statistics == Statistics::Errors);
        match (first_mean, last_error) {
            (_, None) => return Err(invalid("groups", "a group with errors", "none".into())),
            (Some(mean), Some(error)) if mean < error => {
                let got = format!("`{}` after `{}`", self.groups[error].name, self.groups[mean].name);
                return Err(invalid("groups", "groups with errors before those without", got));
            }
            _ => {}
        }
        let weights = &self.luminance;
        if weights.is_empty()
            || weights.len() > self.channels_with_errors()
            || !weights.iter().all(|w| w.is_finite())
        {
            return Err(invalid("luminance", "finite weights of leading channels", format!("{weights:?}")));
        }
        match self.clamp {
            Some(c) if !(c > 0.0 && c.is_finite()) => {
                Err(invalid("clamp", "a positive number", c.to_string()))
            }
            _ => Ok(()),
        }
    }

    /// In which respects another film is of a different kind; `None` when the two can be added.
    pub fn difference(&self, other: &Self) -> Option<String> {
        let mut what = Vec::new();
        let mut note = |same: bool, name: &str, a: String, b: String| {
            if !same {
                what.push(format!("{name}: {a} and {b}"));
            }
        };
        let size = |s: &Self| format!("{} x {}", s.resolution[0], s.resolution[1]);
        note(self.resolution == other.resolution, "resolution", size(self), size(other));
        let crop = |s: &Self| format!("{:?}", s.bounds);
        note(self.bounds == other.bounds, "window", crop(self), crop(other));
        let names = |s: &Self| s.channel_names().join(" ");
        note(self.groups == other.groups, "channels", names(self), names(other));
        let y = |s: &Self| format!("{:?}", s.luminance);
        note(self.luminance == other.luminance, "luminance", y(self), y(other));
        let mode = |s: &Self| format!("{:?}", s.mode);
        note(self.mode == other.mode, "error mode", mode(self), mode(other));
        let weights = |s: &Self| format!("{:?}", s.weights);
        note(self.weights == other.weights, "weights", weights(self), weights(other));
        let clamp = |s: &Self| s.clamp.map_or("off".into(), |c| c.to_string());
        note(self.clamp == other.clamp, "clamp", clamp(self), clamp(other));
        note(self.seed == other.seed, "seed", self.seed.to_string(), other.seed.to_string());
        let square = |s: &Self| format!("squares of {0} x {0}", s.square);
        note(self.square == other.square, "pixels that share paths", square(self), square(other));
        (!what.is_empty()).then(|| what.join("; "))
    }
}

fn invalid(field: &'static str, expected: &'static str, got: String) -> FilmError {
    FilmError::Invalid { field, expected, got }
}

/// Numbers of accumulators per pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Layout {
    /// Channels of a sample.
    pub channels: usize,
    /// Leading channels that have errors.
    pub with_errors: usize,
    /// Replicates, 1 in conservative mode.
    pub slots: usize,
    /// Sums of values: `[slot][channel with error]`, then `[channel without]`.
    pub sums: usize,
    /// Sums of squares: `[channel with error]`, then Y; none when replicated.
    pub squares: usize,
    /// Unweighted sums, for errors of signed samples; none otherwise.
    pub cross: usize,
    /// Sums of weights: one per slot where they differ from the count.
    pub weights: usize,
}

impl Layout {
    pub fn new(spec: &FilmSpec) -> Self {
        let channels = spec.channels();
        let with_errors = spec.channels_with_errors();
        let slots = spec.mode.slots() as usize;
        let plain = spec.mode == ErrorMode::Conservative;
        let signed = spec.weights == Weights::Signed;
        Self {
            channels,
            with_errors,
            slots,
            sums: slots * with_errors + (channels - with_errors),
            squares: if plain { with_errors + 1 } else { 0 },
            cross: if plain && signed { with_errors } else { 0 },
            weights: if signed { slots } else { 0 },
        }
    }
}
