//! One channel of two images.

use super::{ChannelDiff, DiffOptions, tests_of::test};
use crate::{Image, statistics};
use tyndall_film::{PixelBounds, Squares, SumError};

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
    errors: [Option<Squares<'i>>; 2],
    freedom: [Freedom<'i>; 2],
    pub scale: f64,
    pub width: usize,
}

impl<'i> Pair<'i> {
    fn new(name: &str, a: &'i Image, b: &'i Image, scale: f64) -> Self {
        let values = |i: &'i Image| i.values.channel(name).unwrap_or_default();
        Self {
            a: values(a),
            b: values(b),
            errors: [a, b].map(|i| i.squares(name)),
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

    /// Error of the sum of differences over the pixels of an area that count; an image whose errors are not known has none.
    pub fn error(&self, area: PixelBounds, counts: impl Fn(usize) -> bool) -> SumError {
        let of = |i: usize, scale: f64| match &self.errors[i] {
            Some(errors) => errors.sum(area, &counts, |p| self.freedom[i].at(p)).scaled(scale),
            None => SumError::default(),
        };
        of(0, self.scale).and(of(1, 1.0))
    }

    pub fn has_errors(&self) -> bool {
        self.errors.iter().any(Option::is_some)
    }

    /// All pixels, counted from the window's corner.
    pub fn area(&self) -> PixelBounds {
        PixelBounds::new(0, 0, self.width as u32, (self.a.len() / self.width.max(1)) as u32)
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
