//! Scores: what was measured against what is known.
//!
//! A row's `t = (ours - expected) / se` becomes a normal score `z` of the same probability; a row fails beyond the quantile
//! that Sidak's rule gives all rows together. Rows of one render share paths, so the mean of all `z` and of all `z^2` are
//! judged with the correlations `rho` that replicates show: `Var(sum z) = sum rho`, `Var(sum z^2) = 2 sum rho^2`.

use super::{case::Case, measure::Answers, way::Way};
use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

/// The chance that a correct program fails.
pub const ALPHA: f64 = 1e-4;
/// Rounding of a path's products of f32, relative to the answer.
const ROUNDING: f64 = 1e-6;
/// Paths that must tell something of a band before its error is trusted; fewer leave its law too skew for a t-test.
const TELLING_PATHS: f64 = 200.0;

/// What a row is good for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Judged by its standard error.
    Noisy,
    /// Nothing varies but rounding: judged by it, and left out of the distribution of scores.
    Exact,
    /// Too few paths tell anything of it; not judged.
    Vague,
}

/// One comparison.
#[derive(Clone, Debug)]
pub struct Row {
    /// What is known.
    pub label: String,
    /// Ours.
    pub ours: f64,
    /// Known.
    pub expected: f64,
    /// Standard error of the difference: ours, that of the known answer, rounding.
    pub se: f64,
    /// Normal score.
    pub z: f64,
    /// Its two-sided probability.
    pub p: f64,
    /// What it is good for.
    pub kind: Kind,
}

/// All comparisons of one render.
#[derive(Clone, Debug)]
pub struct Judged {
    /// The case's name.
    pub case: String,
    /// The way's name.
    pub way: &'static str,
    /// Samples of the whole image.
    pub samples: u64,
    /// Samples that were dropped: any is a failure.
    pub dropped: u64,
    /// Seconds of one core.
    pub seconds: f64,
    /// One row a band.
    pub rows: Vec<Row>,
    /// Sum of the correlations of the noisy rows.
    pub rho: f64,
    /// Sum of their squares.
    pub rho_squared: f64,
}

/// Compares a render with what is known.
pub fn judge(case: &Case, way: &Way, answers: &Answers, seconds: f64) -> Judged {
    let per_row =
        answers.samples as f64 * f64::from(way.lanes(case.bands.count)) / case.expected.len() as f64;
    let row = |i: usize| {
        let (ours, expected, own) = (answers.pooled.mean[i], case.expected[i], answers.pooled.se(i));
        let floor = (ROUNDING * expected.abs()).hypot(case.uncertainty);
        let se = own.hypot(floor.max(1e-12));
        let t = (ours - expected) / se;
        let telling = per_row * (expected / case.brightest).abs().min(1.0);
        let kind = match () {
            // a zero has no error of its own when nothing was met
            () if own <= 3.0 * floor && ours != 0.0 => Kind::Exact,
            () if telling < TELLING_PATHS => Kind::Vague,
            () => Kind::Noisy,
        };
        let p = two_sided(t, f64::from(answers.pooled.dof));
        Row { label: case.labels[i].clone(), ours, expected, se, z: score(t, p), p, kind }
    };
    let rows: Vec<Row> = (0..case.expected.len()).map(row).collect();
    let (rho, rho_squared) = correlations(&rows, answers);
    Judged {
        case: case.name.clone(),
        way: way.name,
        samples: answers.samples,
        dropped: answers.dropped,
        seconds,
        rows,
        rho,
        rho_squared,
    }
}

/// Sums of the correlations of the noisy rows' scores, and of their squares without what chance adds:
/// `(nu rho^2 - 1) / (nu - 1)` has the mean 0 for independent rows and is 1 for equal ones.
fn correlations(rows: &[Row], answers: &Answers) -> (f64, f64) {
    let noisy: Vec<usize> = (0..rows.len()).filter(|&i| rows[i].kind == Kind::Noisy).collect();
    let dof = f64::from(answers.pooled.dof);
    let (mut sum, mut squares) = (0.0, 0.0);
    for &a in &noisy {
        for &b in &noisy {
            let rho = answers.pooled.covariance(a, b) / (rows[a].se * rows[b].se);
            sum += rho;
            let square = (dof * rho * rho - 1.0) / (dof - 1.0).max(1.0);
            squares += if a == b { 1.0 } else { square };
        }
    }
    (sum.max(0.0), squares.max(noisy.len() as f64))
}

/// P(|T| >= |t|) of Student's distribution; 0 for what is not a number.
fn two_sided(t: f64, dof: f64) -> f64 {
    if t.is_nan() || dof < 1.0 {
        return 0.0;
    }
    let student = StudentsT::new(0.0, 1.0, dof).expect("at least one degree of freedom");
    2.0 * student.sf(t.abs())
}

fn normal() -> Normal {
    Normal::new(0.0, 1.0).expect("unit variance is valid")
}

/// The normal score of the probability `p`, with the sign of `t`.
fn score(t: f64, p: f64) -> f64 {
    -normal().inverse_cdf(0.5 * p.clamp(1e-300, 1.0)) * t.signum()
}

/// The greatest |z| of one out of `n` comparisons that pass together at [`ALPHA`].
pub fn limit(n: usize) -> f64 {
    -normal().inverse_cdf(0.5 * level(n))
}

/// Sidak's level of one out of `n` comparisons: `1 - (1 - ALPHA)^(1/n)`.
pub fn level(n: usize) -> f64 {
    -f64::exp_m1(f64::ln_1p(-ALPHA) / n.max(1) as f64)
}

/// The distribution of the scores of some renders.
#[derive(Clone, Debug, Default)]
pub struct Distribution {
    /// Renders.
    pub renders: usize,
    /// Rows judged by their standard errors.
    pub noisy: usize,
    /// Rows judged by rounding.
    pub exact: usize,
    /// Rows not judged.
    pub vague: usize,
    /// Mean of z over the noisy rows and its standard error.
    pub mean: [f64; 2],
    /// Mean of z^2 over the noisy rows and its standard error.
    pub variance: [f64; 2],
    /// The worst |z| of all judged rows: render and row.
    pub worst: Option<[usize; 2]>,
    /// Seconds of one core.
    pub seconds: f64,
}

impl Distribution {
    /// Of these renders.
    pub fn of<'j>(renders: impl IntoIterator<Item = &'j Judged>) -> Self {
        let mut d = Self::default();
        let (mut rho, mut rho_squared, mut worst) = (0.0, 0.0, -1.0);
        for (r, judged) in renders.into_iter().enumerate() {
            d.renders += 1;
            d.seconds += judged.seconds;
            rho += judged.rho;
            rho_squared += judged.rho_squared;
            for (i, row) in judged.rows.iter().enumerate() {
                match row.kind {
                    Kind::Vague => d.vague += 1,
                    Kind::Exact => d.exact += 1,
                    Kind::Noisy => {
                        d.noisy += 1;
                        d.mean[0] += row.z;
                        d.variance[0] += row.z * row.z;
                    }
                }
                if row.kind != Kind::Vague && row.z.abs() > worst {
                    worst = row.z.abs();
                    d.worst = Some([r, i]);
                }
            }
        }
        let n = d.noisy.max(1) as f64;
        d.mean = [d.mean[0] / n, rho.sqrt() / n];
        d.variance = [d.variance[0] / n, (2.0 * rho_squared).sqrt() / n];
        d
    }

    /// How far mean and mean square are from 0 and 1, in their standard errors; 0 where nothing varies.
    pub fn scores(&self) -> [f64; 2] {
        let of = |[value, se]: [f64; 2], truth: f64| if se > 0.0 { (value - truth) / se } else { 0.0 };
        [of(self.mean, 0.0), of(self.variance, 1.0)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sidak_and_scores() {
        assert!((level(1) - ALPHA).abs() < 1e-12);
        assert!((limit(1) - 3.8906).abs() < 1e-3);
        assert!(limit(1000) > 5.0 && limit(1000) < 5.4);
        assert!((score(-2.0, 0.0455) + 2.0).abs() < 1e-3);
        assert_eq!(two_sided(f64::NAN, 10.0), 0.0);
        assert!((two_sided(2.0, 1e6) - 0.0455).abs() < 1e-3);
    }
}
