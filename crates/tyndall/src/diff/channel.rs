//! One channel of two images.

use super::{ChannelDiff, DiffOptions, tests_of::test};
use crate::{Image, statistics};

/// Degrees of freedom of an image's errors, pixel by pixel where the file tells.
struct Freedom<'i> {
    plane: Option<&'i [f32]>,
    whole: f64,
}

impl<'i> Freedom<'i> {
    /// Without a word on the freedom of its errors a file counts as having much.
    fn of(image: &'i Image) -> Self {
        let plane = image.errors.as_ref().and_then(|e| e.channel(statistics::FREEDOM));
        Self { plane, whole: image.degrees_of_freedom().map_or(1e6, f64::from) }
    }

    fn at(&self, p: usize) -> f64 {
        self.plane.map_or(self.whole, |plane| f64::from(plane[p])).max(1.0)
    }
}

/// A channel's planes.
pub(super) struct Pair<'i> {
    pub a: &'i [f32],
    pub b: &'i [f32],
    pub error_a: Option<&'i [f32]>,
    pub error_b: Option<&'i [f32]>,
    freedom: [Freedom<'i>; 2],
    pub scale: f64,
    pub width: usize,
}

impl<'i> Pair<'i> {
    fn new(name: &str, a: &'i Image, b: &'i Image, scale: f64) -> Self {
        let values = |i: &'i Image| i.values.channel(name).unwrap_or_default();
        let errors = |i: &'i Image| i.errors.as_ref().and_then(|e| e.channel(name));
        Self {
            a: values(a),
            b: values(b),
            error_a: errors(a),
            error_b: errors(b),
            freedom: [Freedom::of(a), Freedom::of(b)],
            scale,
            width: a.values.width(),
        }
    }

    /// The two values; `None` where one is not finite.
    pub fn at(&self, p: usize) -> Option<(f64, f64)> {
        let (a, b) = (f64::from(self.a[p]) * self.scale, f64::from(self.b[p]));
        (a.is_finite() && b.is_finite()).then_some((a, b))
    }

    /// Variances of the two values, 0 for one whose errors are not known.
    pub fn variances(&self, p: usize) -> [f64; 2] {
        let square = |e: Option<&[f32]>, scale: f64| e.map_or(0.0, |e| (f64::from(e[p]) * scale).powi(2));
        [square(self.error_a, self.scale), square(self.error_b, 1.0)]
    }

    /// Degrees of freedom of the two errors.
    pub fn freedom(&self, p: usize) -> [f64; 2] {
        [self.freedom[0].at(p), self.freedom[1].at(p)]
    }

    pub fn has_errors(&self) -> bool {
        self.error_a.is_some() || self.error_b.is_some()
    }
}

pub(super) fn compare(name: &str, a: &Image, b: &Image, options: &DiffOptions) -> ChannelDiff {
    let pair = Pair::new(name, a, b, options.scale);
    let finite: Vec<(f64, f64)> = (0..pair.a.len()).filter_map(|p| pair.at(p)).collect();
    let n = finite.len().max(1) as f64;
    let mean = |f: &dyn Fn(&(f64, f64)) -> f64| finite.iter().map(f).sum::<f64>() / n;
    let (mean_a, mean_b) = (mean(&|v| v.0), mean(&|v| v.1));
    let mse = mean(&|(a, b)| (a - b).powi(2));
    let floor = 0.01 * mean_b.abs();
    let relative = |(a, b): &(f64, f64)| {
        let scale = b.abs().max(floor);
        if a == b { 0.0 } else { ((a - b) / scale).powi(2) }
    };
    ChannelDiff {
        name: name.to_owned(),
        mean_a,
        mean_b,
        mse,
        rmse: mse.sqrt(),
        rel_mse: mean(&relative),
        bias: (mean_b != 0.0).then(|| mean_a / mean_b - 1.0),
        non_finite: pair.a.len() - finite.len(),
        tests: pair.has_errors().then(|| test(&pair, options.block)).flatten(),
    }
}
