//! Two images against each other: error measures, and where standard errors are known a verdict.
//!
//! Per channel, with `a` the image and `b` the reference, over pixels:
//!
//! - `MSE = mean((a - b)^2)`, `RMSE` its root, `bias = mean(a) / mean(b) - 1`;
//! - `relMSE = mean((a - b)^2 / max(|b|, 0.01 mean(b))^2)`: dark pixels count relative to a hundredth of the mean.
//!
//! With standard errors `s`, the mean difference `d` over a block of pixels has variance `v = sum(v_a + v_b) / n^2`, `v = s^2`
//! for independent pixels; squares of pixels that share paths count as one, by their own error where it is known, else by
//! its upper bound ([`tyndall_film::stats::squares`]). Blocks of whole squares are independent of each other.
//! `t = d / sqrt(v)` follows Student's distribution with the degrees of freedom of Welch (1947) and Satterthwaite (1946),
//! `(sum v_i)^2 / sum(v_i^2 / nu_i)`. Two tests a channel: the worst block, corrected for their number by Sidak (1967), and
//! the whole image. The images differ when Holm's (1979) procedure over all tests rejects one at level alpha.

mod channel;
mod tests_of;

use crate::{Error, Image, image::ordered, statistics};
use channel::compare;
use serde::Serialize;
use tests_of::holm;

/// What to compare, and how.
#[derive(Clone, Copy, Debug)]
pub struct DiffOptions {
    /// Side of the blocks \[pixels\].
    pub block: usize,
    /// Probability of calling equal images different.
    pub alpha: f64,
    /// Factor on the first image.
    pub scale: f64,
}

impl Default for DiffOptions {
    fn default() -> Self {
        Self { block: 8, alpha: 0.01, scale: 1.0 }
    }
}

/// What came of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Every sample has the same bits.
    Identical,
    /// The differences are as large as the errors allow.
    Agree,
    /// They are larger.
    Differ,
    /// No errors are known.
    Unknown,
}

/// The comparison.
#[derive(Clone, Debug, Serialize)]
pub struct Diff {
    /// Columns and rows.
    pub size: [usize; 2],
    /// Whose errors are known: of the first, of the second image.
    pub errors: [bool; 2],
    /// Pixels of the first and the second image in which one sample dominates the error; `null` where not known.
    pub dominated: [Option<u64>; 2],
    /// Pixels whose errors were pooled over their tile.
    pub pooled: [Option<u64>; 2],
    /// Level of the verdict.
    pub alpha: f64,
    /// Side of the blocks \[pixels\].
    pub block: usize,
    /// Channel by channel.
    pub channels: Vec<ChannelDiff>,
    /// Channels that only one image has.
    pub left_out: Vec<String>,
    /// The verdict over all channels.
    pub verdict: Verdict,
}

/// One channel.
#[derive(Clone, Debug, Serialize)]
pub struct ChannelDiff {
    /// Its name.
    pub name: String,
    /// Mean of the first image.
    pub mean_a: f64,
    /// Mean of the second image.
    pub mean_b: f64,
    /// Mean squared error.
    pub mse: f64,
    /// Its root.
    pub rmse: f64,
    /// Mean squared relative error.
    pub rel_mse: f64,
    /// `mean(a) / mean(b) - 1`; `null` where the reference is black.
    pub bias: Option<f64>,
    /// Samples of either image that are not finite, which the measures leave out.
    pub non_finite: usize,
    /// The tests, where errors are known.
    pub tests: Option<ChannelTests>,
}

/// Tests of a channel.
#[derive(Clone, Debug, Serialize)]
pub struct ChannelTests {
    /// t of the whole image's mean difference.
    pub t: f64,
    /// Its two-sided probability.
    pub p: f64,
    /// Blocks with known errors.
    pub blocks: usize,
    /// The largest |t| of a block, with its sign.
    pub worst_t: f64,
    /// First pixel of that block.
    pub worst_at: [usize; 2],
    /// Probability of so large a block anywhere.
    pub worst_p: f64,
    /// Root mean square of the blocks' t: 1 where errors are right, below where they are upper estimates.
    pub rms_t: f64,
    /// Whether Holm's procedure rejects one of the two.
    pub rejected: bool,
}

/// Compares `a` with the reference `b`.
///
/// # Errors
/// When sizes differ or no channel is common.
pub fn diff(a: &Image, b: &Image, options: &DiffOptions) -> Result<Diff, Error> {
    let size = [a.values.width(), a.values.height()];
    if a.values.window() != b.values.window() {
        let show =
            |w: tyndall_files::image::Window| format!("{} x {} from {},{}", w.width, w.height, w.x0, w.y0);
        return Err(Error::options(
            format!("the images have windows {} and {}", show(a.values.window()), show(b.values.window())),
            Some("render both at the same --resolution and --crop".into()),
        ));
    }
    let names = |i: &Image| ordered(&i.values).into_iter().map(|c| c.name.clone()).collect::<Vec<_>>();
    let (names_a, names_b) = (names(a), names(b));
    let common: Vec<&String> = names_a.iter().filter(|n| names_b.contains(n)).collect();
    if common.is_empty() {
        return Err(Error::options(
            format!("the images have no channel in common: {} and {}", names_a.join(" "), names_b.join(" ")),
            Some("compare images of the same kind, such as R, G, B with R, G, B".into()),
        ));
    }
    let single = names_a
        .iter()
        .filter(|n| !names_b.contains(n))
        .chain(names_b.iter().filter(|n| !names_a.contains(n)));
    let left_out = single.cloned().collect();
    let mut channels: Vec<ChannelDiff> = common.iter().map(|name| compare(name, a, b, options)).collect();
    holm(&mut channels, options.alpha);
    let errors = [a.errors.is_some(), b.errors.is_some()];
    let verdict = verdict(&channels, &common, a, b, options.scale);
    let marked = |name: &str| [a, b].map(|i| statistics::marked(i.errors.as_ref(), name));
    Ok(Diff {
        size,
        errors,
        dominated: marked(statistics::DOMINATED),
        pooled: marked(statistics::POOLED),
        alpha: options.alpha,
        block: options.block,
        channels,
        left_out,
        verdict,
    })
}

fn verdict(channels: &[ChannelDiff], common: &[&String], a: &Image, b: &Image, scale: f64) -> Verdict {
    let same = |name: &&String| {
        let bits =
            |i: &Image| i.values.channel(name).map(|c| c.iter().map(|v| v.to_bits()).collect::<Vec<_>>());
        bits(a) == bits(b)
    };
    if scale == 1.0 && common.iter().all(same) {
        return Verdict::Identical;
    }
    let mut tests = channels.iter().filter_map(|c| c.tests.as_ref()).peekable();
    if tests.peek().is_none() {
        return Verdict::Unknown;
    }
    if tests.any(|t| t.rejected) { Verdict::Differ } else { Verdict::Agree }
}

#[cfg(test)]
mod tests;
