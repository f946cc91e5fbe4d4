//! What is to be cleaned: means with the variances of their noise.

use super::pyramid;
use crate::Error;

/// A channel of a picture, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Means.
    pub mean: Vec<f32>,
    /// Variances of the means: squares of their standard errors; infinite where unknown.
    pub variance: Vec<f32>,
}

/// A picture with the variances of its noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Noisy {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Its channels, whose similarity is judged together.
    pub channels: Vec<Channel>,
    /// Side of the squares of pixels whose noise is alike, counted from the first pixel; 1 where all pixels are independent.
    pub square: u32,
    /// Correlation of the noise of two pixels of a square.
    pub correlation: f32,
}

impl Noisy {
    /// From means and standard errors, `width * height` each.
    ///
    /// # Errors
    /// When planes differ in size, or half of the errors of a channel or more are unknown.
    pub fn new(width: usize, height: usize, planes: &[(&[f32], &[f32])]) -> Result<Self, Error> {
        let mut channels = Vec::with_capacity(planes.len());
        for (mean, se) in planes {
            let sizes = [width * height, mean.len(), se.len()];
            if sizes != [sizes[0]; 3] {
                return Err(Error::options(
                    format!(
                        "means and standard errors: expected {} of each, got {} and {}",
                        sizes[0], sizes[1], sizes[2]
                    ),
                    Some("the errors are those of another image: render, or copy, both files again".into()),
                ));
            }
            let known = se.iter().filter(|e| e.is_finite()).count();
            if 2 * known <= se.len() {
                return Err(Error::options(
                    format!("the standard errors of {} of {} pixels are unknown", se.len() - known, se.len()),
                    Some("they need two samples a pixel, and four with --errors replicated".into()),
                ));
            }
            let variance = se.iter().map(|e| if e.is_finite() { e * e } else { f32::INFINITY });
            channels.push(Channel { mean: mean.to_vec(), variance: variance.collect() });
        }
        Ok(Self { width, height, channels, square: 1, correlation: 0.0 })
    }

    /// The same with noise that pixels of a square have in common.
    #[must_use]
    pub fn alike(self, square: u32, correlation: f32) -> Self {
        Self { square, correlation: if square > 1 { correlation } else { 0.0 }, ..self }
    }

    /// Half the size: means of four pixels. Of variance v and correlation rho, they have the variance `v (1 + 3 rho) / 4` and
    /// among each other the correlation `4 rho / (1 + 3 rho)`.
    pub(super) fn halved(&self) -> Self {
        let (size, rho) = ([self.width, self.height], self.correlation);
        let [width, height] = pyramid::half_size(size);
        let halve = |c: &Channel| {
            let mut variance = pyramid::halve(&c.variance, size, 2);
            if rho > 0.0 {
                let errors: Vec<f32> = c.variance.iter().map(|v| v.sqrt()).collect();
                let as_one = pyramid::halve(&errors, size, 1);
                variance.iter_mut().zip(as_one).for_each(|(v, one)| *v += rho * (one * one - *v));
            }
            Channel { mean: pyramid::halve(&c.mean, size, 1), variance }
        };
        let channels = self.channels.iter().map(halve).collect();
        let half = Self { width, height, channels, square: 1, correlation: 0.0 };
        half.alike(self.square / 2, 4.0 * rho / (1.0 + 3.0 * rho))
    }
}
