//! What light sources emit: a continuum and spectral lines.
//!
//! A line (sodium, mercury, a laser) is an atom of the spectrum: power at one wavelength, without width. It is drawn
//! with its own probability, never through a table of densities; at a slot that carries a line the value of an
//! emission is the line's power, and at a slot on the continuum it is the power per nm.

use std::sync::Arc;

use crate::curve::Curve;
use crate::error::{SpectralError, require};
use crate::range::{LambdaRange, RangeGap};
use crate::spectrum::Spectrum;
use crate::wavelengths::Wavelengths;

/// Power at a single wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Wavelength \[nm\].
    pub lambda: f32,
    /// Power, in the unit of the continuum times nm.
    pub power: f32,
}

/// A continuum \[per nm\] and lines; cheap to clone.
#[derive(Clone, Debug, PartialEq)]
pub struct Emission {
    continuum: Curve,
    lines: Arc<[Line]>,
}

impl Emission {
    /// No light.
    pub fn none() -> Self {
        Curve::ZERO.into()
    }

    /// `continuum` per nm and `lines`; two lines at one wavelength are added.
    pub fn new(continuum: Curve, lines: &[Line]) -> Result<Self, SpectralError> {
        let mut sorted: Vec<Line> = Vec::with_capacity(lines.len());
        for line in lines {
            let (lambda, power) = (f64::from(line.lambda), f64::from(line.power));
            require(lambda > 0.0 && lambda.is_finite(), "wavelength of a line [nm]", "> 0", lambda)?;
            require(power >= 0.0 && power.is_finite(), "power of a line", ">= 0 and finite", power)?;
            match sorted.iter_mut().find(|l| l.lambda == line.lambda) {
                Some(same) => same.power += line.power,
                None => sorted.push(*line),
            }
        }
        sorted.sort_by(|a, b| a.lambda.total_cmp(&b.lambda));
        Ok(Self { continuum, lines: sorted.into() })
    }

    /// The continuous part \[per nm\].
    pub fn continuum(&self) -> &Curve {
        &self.continuum
    }

    /// The lines, by ascending wavelength.
    pub fn lines(&self) -> &[Line] {
        &self.lines
    }

    /// This emission times `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f32) -> Self {
        let lines = self.lines.iter().map(|l| Line { power: l.power * factor, ..*l }).collect();
        Self { continuum: self.continuum.scaled(factor), lines }
    }

    /// True when nothing is emitted at any wavelength.
    pub fn is_dark(&self) -> bool {
        self.continuum == Curve::ZERO && self.lines.iter().all(|l| l.power == 0.0)
    }

    /// The first table that does not cover `asked`; see [`Curve::gap`].
    pub fn gap(&self, asked: LambdaRange) -> Option<RangeGap> {
        self.continuum.gap(asked)
    }

    /// Power of the line exactly at `lambda` \[nm\], 0 if there is none.
    #[inline]
    pub fn line_power(&self, lambda: f32) -> f32 {
        self.lines.iter().find(|l| l.lambda == lambda).map_or(0.0, |l| l.power)
    }

    /// Values at the wavelengths of a path: per nm on the continuum, power on lines.
    #[inline]
    pub fn sample<const N: usize>(&self, w: &Wavelengths<N>) -> Spectrum<N> {
        let mut values = self.continuum.sample(w);
        for k in 0..N {
            if w.on_line(k) {
                values[k] = self.line_power(w.lambda[k]);
            }
        }
        values
    }
}

impl From<Curve> for Emission {
    fn from(continuum: Curve) -> Self {
        Self { continuum, lines: Arc::new([]) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wavelengths::CONTINUUM;

    #[test]
    fn slots_see_either_the_continuum_or_their_line() {
        let lines = [
            Line { lambda: 589.6, power: 2.0 },
            Line { lambda: 435.8, power: 5.0 },
            Line { lambda: 589.6, power: 1.0 },
        ];
        let lamp = Emission::new(Curve::Constant(0.25), &lines).unwrap();
        let w = Wavelengths {
            lambda: [589.6, 589.6, 435.8, 546.1],
            pdf: [0.01, 0.5, 0.25, 0.25],
            line: [CONTINUUM, 1, 0, 2],
        };
        assert_eq!(lamp.sample(&w).0, [0.25, 3.0, 5.0, 0.0]);
        assert_eq!(lamp.scaled(2.0).sample(&w).0, [0.5, 6.0, 10.0, 0.0]);
        assert_eq!(Emission::from(Curve::ONE).sample(&w).0, [1.0, 0.0, 0.0, 0.0]);
        assert!(Emission::none().is_dark() && !lamp.is_dark());
    }

    #[test]
    fn impossible_lines_are_refused() {
        assert!(Emission::new(Curve::ZERO, &[Line { lambda: 500.0, power: -1.0 }]).is_err());
        assert!(Emission::new(Curve::ZERO, &[Line { lambda: f32::NAN, power: 1.0 }]).is_err());
    }
}
