//! Quantities as functions of wavelength.
//!
//! A [`Curve`] keeps the exact form that it was given in; nothing is resampled unless [`Curve::bake`] is asked to. Its
//! unit is that of the quantity. Outside a table the rule [`Outside`] holds, and [`Curve::gap`] tells the loader that
//! it will be needed, so that no table is extrapolated in silence.

mod bake;
mod blackbody;
mod bounds;
mod dense;
mod knots;
mod linear;
mod sigmoid;
mod step;

use std::sync::Arc;

pub use blackbody::{Blackbody, SECOND_RADIATION_CONSTANT, WIEN_DISPLACEMENT, planck, planck_sample};
pub use dense::Dense;
pub use linear::PiecewiseLinear;
pub use sigmoid::SigmoidPolynomial;
pub use step::Step;

use crate::error::{SpectralError, require};
use crate::range::{LambdaRange, Outside, RangeGap};
use crate::spectrum::Spectrum;
use crate::wavelengths::Wavelengths;

/// A quantity as a function of wavelength; cheap to clone.
#[derive(Clone, Debug, PartialEq)]
pub enum Curve {
    /// The same everywhere.
    Constant(f32),
    /// Straight lines between uneven points.
    Linear(Arc<PiecewiseLinear>),
    /// One value per band.
    Step(Arc<Step>),
    /// A table at equal distances.
    Dense(Arc<Dense>),
    /// Thermal radiation.
    Blackbody(Blackbody),
    /// A smooth reflectance (an RGB albedo).
    Sigmoid(SigmoidPolynomial),
    /// A smooth spectrum of any size: the factor first (an RGB value without bound).
    ScaledSigmoid(f32, SigmoidPolynomial),
    /// A curve times a number.
    Scaled(f32, Arc<Curve>),
    /// Two curves multiplied (an RGB light: scaled sigmoid times the colour space's illuminant).
    Product(Arc<(Curve, Curve)>),
}

impl Curve {
    /// Zero everywhere.
    pub const ZERO: Self = Self::Constant(0.0);
    /// One everywhere.
    pub const ONE: Self = Self::Constant(1.0);

    /// Straight lines between (`lambda` \[nm\], ascending; `values`), at least two points. Points at equal distances become
    /// [`Curve::Dense`], which is faster and has the same values.
    pub fn linear(lambda: &[f32], values: &[f32], outside: Outside) -> Result<Self, SpectralError> {
        match Dense::from_even_points(lambda, values, outside) {
            Some(table) if lambda[0] >= 0.0 => Ok(Self::Dense(Arc::new(table))),
            _ => Ok(Self::Linear(Arc::new(PiecewiseLinear::new(lambda, values, outside)?))),
        }
    }

    /// As [`Curve::linear`], from `lambda, value, lambda, value, ...`.
    pub fn interleaved(pairs: &[f32], outside: Outside) -> Result<Self, SpectralError> {
        if !pairs.len().is_multiple_of(2) {
            return Err(SpectralError::Length { expected: pairs.len() / 2 + 1, got: pairs.len() / 2 });
        }
        let (lambda, values): (Vec<f32>, Vec<f32>) = pairs.chunks_exact(2).map(|p| (p[0], p[1])).unzip();
        Self::linear(&lambda, &values, outside)
    }

    /// `values[i]` between `edges[i]` and `edges[i + 1]` \[nm\].
    pub fn step(edges: &[f32], values: &[f32], outside: Outside) -> Result<Self, SpectralError> {
        Ok(Self::Step(Arc::new(Step::new(edges, values, outside)?)))
    }

    /// Values at `first_nm`, `first_nm + 1`, ... nm with straight lines between.
    pub fn dense(first_nm: u32, values: &[f32], outside: Outside) -> Result<Self, SpectralError> {
        Ok(Self::Dense(Arc::new(Dense::new(first_nm as f32, 1.0, values, outside)?)))
    }

    /// Planck's law, scaled to the maximum 1 at its peak.
    pub fn blackbody(kelvin: f32) -> Result<Self, SpectralError> {
        Ok(Self::Blackbody(Blackbody::normalized(kelvin)?))
    }

    /// Planck's law in W m^-2 sr^-1 nm^-1.
    pub fn blackbody_absolute(kelvin: f32) -> Result<Self, SpectralError> {
        Ok(Self::Blackbody(Blackbody::absolute(kelvin)?))
    }

    /// This curve times `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f32) -> Self {
        match self {
            _ if factor == 1.0 => self.clone(),
            Self::Constant(v) => Self::Constant(v * factor),
            Self::Sigmoid(s) => Self::ScaledSigmoid(factor, *s),
            Self::ScaledSigmoid(f, s) => Self::ScaledSigmoid(f * factor, *s),
            Self::Scaled(f, curve) => Self::Scaled(f * factor, Arc::clone(curve)),
            Self::Dense(table) => match table.scaled(factor) {
                Some(scaled) => Self::Dense(Arc::new(scaled)),
                None => Self::Scaled(factor, Arc::new(self.clone())),
            },
            _ => Self::Scaled(factor, Arc::new(self.clone())),
        }
    }

    /// This curve times another.
    #[must_use]
    pub fn times(&self, other: &Self) -> Self {
        match (self, other) {
            (Self::Constant(v), curve) | (curve, Self::Constant(v)) => curve.scaled(*v),
            (a, b) => Self::Product(Arc::new((a.clone(), b.clone()))),
        }
    }

    /// Value at `lambda` \[nm\]; NaN outside a table whose rule is [`Outside::Error`].
    #[inline]
    pub fn eval(&self, lambda: f32) -> f32 {
        match self {
            Self::Constant(v) => *v,
            Self::Linear(table) => table.eval(lambda),
            Self::Step(table) => table.eval(lambda),
            Self::Dense(table) => table.eval(lambda),
            Self::Blackbody(body) => body.eval(lambda),
            Self::Sigmoid(s) => s.eval(lambda),
            Self::ScaledSigmoid(factor, s) => factor * s.eval(lambda),
            Self::Scaled(factor, curve) => factor * curve.eval(lambda),
            Self::Product(pair) => pair.0.eval(lambda) * pair.1.eval(lambda),
        }
    }

    /// Values at the wavelengths of a path: `eval` per lane, with the form looked up once.
    #[inline]
    pub fn sample<const N: usize>(&self, w: &Wavelengths<N>) -> Spectrum<N> {
        match self {
            Self::Constant(v) => Spectrum::splat(*v),
            Self::Linear(table) => per_lane(w, |l| table.eval(l)),
            Self::Step(table) => per_lane(w, |l| table.eval(l)),
            Self::Dense(table) => table.sample(w),
            Self::Blackbody(body) => body.sample(w),
            Self::Sigmoid(s) => per_lane(w, |l| s.eval(l)),
            Self::ScaledSigmoid(factor, s) => per_lane(w, |l| factor * s.eval(l)),
            Self::Scaled(factor, curve) => curve.sample(w) * *factor,
            Self::Product(pair) => pair.0.sample(w) * pair.1.sample(w),
        }
    }

    /// Where tables define the curve: the overlap of all tables in it, or `None` for a curve defined everywhere.
    pub fn range(&self) -> Option<LambdaRange> {
        self.tables()
            .map(|(range, _)| range)
            .reduce(|a, b| LambdaRange { min: a.min.max(b.min), max: a.max.min(b.max) })
    }

    /// The first table that does not cover `asked`, with the rule that then holds; for the loader's messages.
    pub fn gap(&self, asked: LambdaRange) -> Option<RangeGap> {
        self.tables().find(|(table, _)| !table.covers(&asked)).map(|(table, outside)| RangeGap {
            asked,
            table,
            outside,
        })
    }

    /// An error when a table whose rule is [`Outside::Error`] does not cover `asked`, else the gap, if any, to warn of.
    pub fn check_range(&self, asked: LambdaRange) -> Result<Option<RangeGap>, SpectralError> {
        let forbidden =
            |(table, outside): &(LambdaRange, Outside)| *outside == Outside::Error && !table.covers(&asked);
        match self.tables().find(forbidden) {
            Some((table, outside)) => Err(RangeGap { asked, table, outside }.into()),
            None => Ok(self.gap(asked)),
        }
    }

    /// Ranges and rules of all tables in the curve.
    fn tables(&self) -> Box<dyn Iterator<Item = (LambdaRange, Outside)> + '_> {
        match self {
            Self::Linear(t) => Box::new(std::iter::once((t.range(), t.outside()))),
            Self::Step(t) => Box::new(std::iter::once((t.range(), t.outside()))),
            Self::Dense(t) => Box::new(std::iter::once((t.range(), t.outside()))),
            Self::Scaled(_, curve) => curve.tables(),
            Self::Product(pair) => Box::new(pair.0.tables().chain(pair.1.tables())),
            Self::Constant(_) | Self::Blackbody(_) | Self::Sigmoid(_) | Self::ScaledSigmoid(..) => {
                Box::new(std::iter::empty())
            }
        }
    }
}

impl Default for Curve {
    fn default() -> Self {
        Self::ZERO
    }
}

/// `f` at every wavelength, in a loop: `array::from_fn` would not inline bodies of this size.
#[inline(always)]
fn per_lane<const N: usize>(w: &Wavelengths<N>, f: impl Fn(f32) -> f32) -> Spectrum<N> {
    let mut out = Spectrum::ZERO;
    for k in 0..N {
        out[k] = f(w.lambda[k]);
    }
    out
}

/// Refuses NaN and infinities.
fn check_finite(values: &[f32]) -> Result<(), SpectralError> {
    match values.iter().find(|v| !v.is_finite()) {
        Some(&v) => require(false, "value of a table", "a finite number", f64::from(v)),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests;
