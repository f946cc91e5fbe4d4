//! Means, standard errors and families of z-tests.

use tyndall_film::Developed;
use tyndall_testkit::{
    ALPHA,
    distribution::{normal_quantile, student_two_sided},
    sidak,
};

/// Rounding of a path's products of f32, relative to the answer.
const ROUNDING: f64 = 1e-6;
/// Degrees of freedom beyond which Student's law is the normal one.
const MANY: f64 = 1e6;

/// A mean with its standard error.
#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    pub mean: f64,
    pub se: f64,
    pub dof: f64,
}

impl Estimate {
    /// `a + b x`.
    pub fn affine(self, a: f64, b: f64) -> Self {
        Self { mean: a + b * self.mean, se: b.abs() * self.se, dof: self.dof }
    }
}

/// The mean over all pixels of every channel that has errors.
pub fn pooled(d: &Developed) -> Vec<Estimate> {
    let one = |channel: usize| {
        let (mean, error) = d.mean_over(channel, d.bounds);
        Estimate { mean, se: error.variance.sqrt(), dof: error.dof().min(MANY) }
    };
    (0..d.error.len()).map(one).collect()
}

/// Comparisons that share one error probability.
#[derive(Debug, Default)]
pub struct Family {
    rows: Vec<Row>,
}

#[derive(Debug)]
struct Row {
    label: String,
    got: Estimate,
    expected: f64,
    t: f64,
    p: f64,
}

impl Family {
    /// Compares a band with a known answer.
    pub fn known(&mut self, label: impl Into<String>, got: Estimate, expected: f64) {
        assert!(got.mean.is_finite() && got.se.is_finite());
        let t = (got.mean - expected) / got.se.hypot(ROUNDING * expected.abs().max(1e-12));
        self.rows.push(Row { label: label.into(), got, expected, t, p: student_two_sided(t, got.dof) });
    }

    /// Compares all bands with known answers.
    pub fn bands(&mut self, label: &str, got: &[Estimate], expected: &[f64]) {
        assert_eq!(got.len(), expected.len());
        for (i, (g, e)) in got.iter().zip(expected).enumerate() {
            self.known(format!("{label}, band {i}"), *g, *e);
        }
    }

    /// Compares the bands of two independent renders.
    pub fn equal(&mut self, label: &str, a: &[Estimate], b: &[Estimate]) {
        assert_eq!(a.len(), b.len());
        for (i, (a, b)) in a.iter().zip(b).enumerate() {
            let se = a.se.hypot(b.se);
            let spread = a.se.powi(4) / a.dof + b.se.powi(4) / b.dof;
            let dof = if spread > 0.0 { se.powi(4) / spread } else { a.dof };
            self.known(format!("{label}, band {i}"), Estimate { mean: a.mean, se, dof }, b.mean);
        }
    }

    /// Of each comparison the difference and its normal score.
    pub fn differences(&self) -> Vec<[f64; 2]> {
        let score = |r: &Row| -normal_quantile(0.5 * r.p.max(1e-300)) * r.t.signum();
        self.rows.iter().map(|r| [r.got.mean - r.expected, score(r)]).collect()
    }

    /// Panics when any comparison fails at [`ALPHA`] shared over the family, or knows its answer too badly to judge:
    /// `resolution` is the greatest standard error allowed, relative to the answer (or to a fiftieth of the family's
    /// greatest, where that is more).
    #[track_caller]
    pub fn assert(self, resolution: f64) {
        let level = sidak(ALPHA, self.rows.len());
        let failed = |r: &Row| r.p.is_nan() || r.p <= level;
        let scale = 0.02 * self.rows.iter().map(|r| r.expected.abs()).fold(0.0, f64::max);
        let vague = |r: &Row| r.got.se > resolution * r.expected.abs().max(scale);
        let tell = |r: &&Row| {
            let (g, e) = (r.got, r.expected);
            format!(
                "{}: {:.6} +- {:.6} against {e:.6}, t = {:.2}, p = {:.1e}",
                r.label, g.mean, g.se, r.t, r.p
            )
        };
        let bad: Vec<String> = self.rows.iter().filter(|r| failed(r)).map(|r| tell(&r)).collect();
        assert!(
            bad.is_empty(),
            "{} of {} fail at {level:.1e}:\n{}",
            bad.len(),
            self.rows.len(),
            bad.join("\n")
        );
        let vague: Vec<String> = self.rows.iter().filter(|r| vague(r)).map(|r| tell(&r)).collect();
        assert!(vague.is_empty(), "errors above {resolution} of the answer:\n{}", vague.join("\n"));
    }
}
