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
        Ok(Self { width, height, channels })
    }

    /// Half the size: means of four pixels, whose noise is independent.
    pub(super) fn halved(&self) -> Self {
        let size = [self.width, self.height];
        let halve = |c: &Channel| Channel {
            mean: pyramid::halve(&c.mean, size, 1),
            variance: pyramid::halve(&c.variance, size, 2),
        };
        let [width, height] = pyramid::half_size(size);
        Self { width, height, channels: self.channels.iter().map(halve).collect() }
    }
}
