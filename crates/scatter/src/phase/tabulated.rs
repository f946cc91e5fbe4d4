//! A phase function from a table over wavelength and angle, as Lorenz-Mie programs write it.
//!
//! Between angles `p` is linear in `cos theta`; between wavelengths `lambda_i` and `lambda_i+1` it is the mixture
//! `(1 - w) p_i + w p_i+1`, `w` linear in wavelength, so that evaluation, sampling and norm agree to the last digit: the
//! sampler picks one of the two tables and inverts its distribution exactly. Angles may be as dense towards forward as
//! the peak needs; they are kept as given, in `v = 1 - cos theta`, which resolves 0.01 degrees.
//!
//! Tables are normalised to 1 or to 4 pi over the sphere; which one is found from their integral, and anything else
//! (beyond 1 %) is refused. What is left of the error is divided out.

use super::deflection::Deflection;
use crate::error::{ScatterError, require};
use std::cmp::Ordering;
use std::f64::consts::PI;
use std::sync::Arc;
use tyndall_base::math::f64::sin;
use tyndall_base::warp::sample_linear;
use tyndall_spectral::range::{LambdaRange, Outside, RangeGap};
use tyndall_spectral::{SpectralError, Spectrum, Wavelengths};

/// How far from 1 or 4 pi the integral of a table may be.
const NORM_TOLERANCE: f64 = 0.01;

/// A table over wavelength and angle; cheap to clone.
#[derive(Clone, Debug, PartialEq)]
pub struct Tabulated(Arc<Table>);

#[derive(Debug, PartialEq)]
struct Table {
    lambda: Vec<f32>,
    outside: Outside,
    /// `1 - cos theta`, from 0 to 2.
    versine: Vec<f32>,
    rows: Vec<Row>,
}

/// The phase function at one wavelength.
#[derive(Debug, PartialEq)]
struct Row {
    /// `p` \[1/sr\] at each angle.
    p: Vec<f32>,
    /// Fraction of the light within each angle.
    cdf: Vec<f64>,
    mean_cosine: f32,
}

impl Tabulated {
    /// `p[i * theta.len() + j]` at `lambda[i]` \[nm\] and `theta[j]` \[degrees\], both ascending, `theta` from 0 to 180.
    ///
    /// `outside` rules beyond the wavelengths of the table: held or not defined.
    pub fn from_degrees(
        lambda: &[f32],
        theta: &[f64],
        p: &[f64],
        outside: Outside,
    ) -> Result<Self, ScatterError> {
        ascending("scattering angles [degrees]", theta)?;
        spans("first and last scattering angle [degrees]", "0 and 180", theta, [0.0, 180.0])?;
        // 1 - cos = 2 sin^2(theta / 2)
        let half_sine = |t: &f64| sin(0.5 * t.to_radians());
        let versine = theta.iter().map(half_sine).map(|s| 2.0 * s * s).collect();
        Self::new(lambda, versine, p.to_vec(), outside)
    }

    /// As [`Tabulated::from_degrees`] over `cos_theta`, ascending from -1 to 1.
    pub fn from_cosines(
        lambda: &[f32],
        cos_theta: &[f64],
        p: &[f64],
        outside: Outside,
    ) -> Result<Self, ScatterError> {
        ascending("cosines of the scattering angle", cos_theta)?;
        spans("first and last cosine of the scattering angle", "-1 and 1", cos_theta, [-1.0, 1.0])?;
        let versine = cos_theta.iter().rev().map(|c| 1.0 - c).collect();
        let forward_first = p.chunks(cos_theta.len()).flat_map(|row| row.iter().rev()).copied().collect();
        Self::new(lambda, versine, forward_first, outside)
    }

    fn new(lambda: &[f32], versine: Vec<f64>, p: Vec<f64>, outside: Outside) -> Result<Self, ScatterError> {
        let wavelengths: Vec<f64> = lambda.iter().copied().map(f64::from).collect();
        ascending("wavelengths [nm]", &wavelengths)?;
        shape("wavelengths", lambda.len().max(1), lambda.len())?;
        shape("values, one per wavelength and angle", lambda.len() * versine.len(), p.len())?;
        let rule = "held outside its wavelengths, or an error there; zero";
        require(outside != Outside::Zero, "extrapolation of a phase table", rule, 0.0)?;
        let rows: Result<_, _> =
            lambda.iter().zip(p.chunks(versine.len())).map(|(&l, row)| Row::new(l, &versine, row)).collect();
        let versine = versine.iter().map(|&v| v as f32).collect();
        Ok(Self(Arc::new(Table { lambda: lambda.to_vec(), outside, versine, rows: rows? })))
    }

    /// The wavelengths of the table.
    pub fn range(&self) -> LambdaRange {
        let lambda = &self.0.lambda;
        LambdaRange { min: lambda[0], max: lambda[lambda.len() - 1] }
    }

    /// As [`Curve::check_range`](tyndall_spectral::curve::Curve::check_range).
    pub fn check_range(&self, asked: LambdaRange) -> Result<Option<RangeGap>, SpectralError> {
        let gap = RangeGap { asked, table: self.range(), outside: self.0.outside };
        match self.0.outside {
            _ if gap.table.covers(&asked) => Ok(None),
            Outside::Error => Err(gap.into()),
            _ => Ok(Some(gap)),
        }
    }

    /// `p` \[1/sr\] per lane at `v = 1 - cos theta`; the angle is looked up once for all lanes.
    #[inline]
    pub fn eval<const N: usize>(&self, versine: f32, lambda: &Wavelengths<N>) -> Spectrum<N> {
        let table = &*self.0;
        let v = &table.versine;
        let j = v.partition_point(|&node| node <= versine).clamp(1, v.len() - 1) - 1;
        let t = (versine - v[j]) / (v[j + 1] - v[j]);
        let at = |i: usize| table.rows[i].p[j] + t * (table.rows[i].p[j + 1] - table.rows[i].p[j]);
        Spectrum::from_fn(|k| {
            let (i, w) = table.bracket(lambda.lambda[k]);
            if w == 0.0 { at(i) } else { (1.0 - w) * at(i) + w * at(i + 1) }
        })
    }

    /// Draws the angle at `lambda` \[nm\].
    #[inline]
    pub fn sample(&self, u: f32, lambda: f32) -> Deflection {
        let (i, w) = self.0.bracket(lambda);
        // the second table with probability w; the rest of u goes on
        let (i, u) = if u < w { (i + 1, u / w) } else { (i, (u - w) / (1.0 - w)) };
        Deflection::from_versine(self.0.rows[i].sample(&self.0.versine, u.min(1.0)))
    }

    /// `<cos theta>` at `lambda` \[nm\].
    pub fn mean_cosine(&self, lambda: f32) -> f32 {
        let (i, w) = self.0.bracket(lambda);
        let at = |i: usize| self.0.rows[i].mean_cosine;
        if w == 0.0 { at(i) } else { (1.0 - w) * at(i) + w * at(i + 1) }
    }
}

impl Table {
    /// The row at or below `lambda` and the weight of the next one; NaN where the table is not defined.
    #[inline]
    fn bracket(&self, lambda: f32) -> (usize, f32) {
        let l = &self.lambda;
        let above = l.partition_point(|&node| node <= lambda);
        let last = l.len() - 1;
        let beyond = above == 0 || lambda > l[last];
        if beyond && self.outside == Outside::Error {
            return (0, f32::NAN);
        }
        match above {
            0 => (0, 0.0),
            n if n > last => (last, 0.0),
            n => (n - 1, (lambda - l[n - 1]) / (l[n] - l[n - 1])),
        }
    }
}

impl Row {
    fn new(lambda: f32, versine: &[f64], p: &[f64]) -> Result<Self, ScatterError> {
        for &value in p {
            let ok = value >= 0.0 && value.is_finite();
            require(ok, "value of a phase table [1/sr]", "a finite number >= 0", value)?;
        }
        // int p dw = 2 pi int p dv, exact for straight lines
        let cells = || versine.windows(2).zip(p.windows(2)).map(|(v, p)| (v[0], v[1] - v[0], p[0], p[1]));
        let mut cdf = vec![0.0];
        for (_, dv, a, b) in cells() {
            cdf.push(cdf[cdf.len() - 1] + PI * dv * (a + b));
        }
        let norm = cdf[cdf.len() - 1];
        if [1.0, 4.0 * PI].iter().all(|want| (norm / want - 1.0).abs() > NORM_TOLERANCE) {
            return Err(ScatterError::Norm { lambda, got: norm });
        }
        let first = |(v, dv, a, b): (f64, f64, f64, f64)| PI * dv * (v * (a + b) + dv * (a + 2.0 * b) / 3.0);
        let mean_cosine = (1.0 - cells().map(first).sum::<f64>() / norm) as f32;
        cdf.iter_mut().for_each(|f| *f /= norm);
        Ok(Self { p: p.iter().map(|p| (p / norm) as f32).collect(), cdf, mean_cosine })
    }

    #[inline]
    fn sample(&self, versine: &[f32], u: f32) -> f32 {
        let u = f64::from(u);
        let j = self.cdf.partition_point(|&f| f <= u).clamp(1, self.cdf.len() - 1) - 1;
        let within = (u - self.cdf[j]) / (self.cdf[j + 1] - self.cdf[j]);
        let t = sample_linear(within.clamp(0.0, 1.0) as f32, self.p[j], self.p[j + 1]);
        versine[j] + t * (versine[j + 1] - versine[j])
    }
}

fn ascending(what: &'static str, x: &[f64]) -> Result<(), ScatterError> {
    for (i, pair) in x.windows(2).enumerate() {
        if pair[0].partial_cmp(&pair[1]) != Some(Ordering::Less) {
            return Err(ScatterError::Unsorted { what, index: i + 1, previous: pair[0], got: pair[1] });
        }
    }
    Ok(())
}

fn shape(what: &'static str, expected: usize, got: usize) -> Result<(), ScatterError> {
    if expected == got { Ok(()) } else { Err(ScatterError::Shape { what, expected, got }) }
}

/// Both ends of the axis, to rounding.
fn spans(what: &'static str, expected: &'static str, x: &[f64], ends: [f64; 2]) -> Result<(), ScatterError> {
    shape("angles at least", x.len().max(2), x.len())?;
    for (got, want) in [(x[0], ends[0]), (x[x.len() - 1], ends[1])] {
        require((got - want).abs() < 1e-9, what, expected, got)?;
    }
    Ok(())
}
