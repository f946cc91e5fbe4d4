//! The verdict, and tables of it as text and CSV.

use super::{
    family::Family,
    judge::{Distribution, Judged, Kind, Row, limit},
    run::Plan,
};
use std::fmt::Write as _;

/// Everything that was compared.
#[derive(Clone, Debug)]
pub struct Report {
    /// How much was rendered.
    pub depth: super::Depth,
    /// Families with their renders.
    pub families: Vec<(&'static Family, Vec<Judged>)>,
    /// Distribution of the scores of all renders.
    pub overall: Distribution,
    /// The greatest |z| of a row that passes.
    pub limit: f64,
    /// Seconds on the wall.
    pub seconds: f64,
    /// Threads.
    pub threads: usize,
}

impl Report {
    pub(super) fn new(plan: &Plan, families: Vec<(&'static Family, Vec<Judged>)>, seconds: f64) -> Self {
        let overall = Distribution::of(families.iter().flat_map(|(_, j)| j));
        // every row is judged, and mean and variance of all
        let limit = limit(overall.noisy + overall.exact + 2);
        Self { depth: plan.depth, families, overall, limit, seconds, threads: plan.threads }
    }

    /// Whether a row passes.
    pub fn passes(&self, row: &Row) -> bool {
        row.kind == Kind::Vague || row.z.abs() <= self.limit
    }

    /// What failed, in words; nothing when all is well.
    pub fn failures(&self) -> Vec<String> {
        let mut out = Vec::new();
        for (family, judged) in &self.families {
            for j in judged {
                if j.dropped > 0 {
                    out.push(format!(
                        "{}, {}, {}: {} samples were dropped",
                        family.name, j.case, j.way, j.dropped
                    ));
                }
                for row in j.rows.iter().filter(|r| !self.passes(r)) {
                    out.push(format!("{}: {}", family.name, told(j, row)));
                }
            }
        }
        let [mean, variance] = self.overall.scores();
        for (what, score) in [("mean", mean), ("variance", variance)] {
            if score.abs() > self.limit {
                out.push(format!("the {what} of all scores is {score:.1} standard errors off"));
            }
        }
        out
    }

    /// Rows that answers of other renderers could be held to: a standard error of at most half the family's tolerance.
    pub fn resolved(&self, family: &Family, judged: &[Judged]) -> usize {
        let fine = |r: &&Row| r.kind != Kind::Vague && r.se <= 0.5 * family.tolerance.of(r.expected);
        judged.iter().flat_map(|j| &j.rows).filter(fine).count()
    }

    /// The worst row of some renders, in words.
    pub fn worst(judged: &[Judged]) -> String {
        let d = Distribution::of(judged);
        d.worst.map_or_else(|| "-".into(), |[j, r]| told(&judged[j], &judged[j].rows[r]))
    }

    /// The `n` worst rows of every family.
    pub fn worst_text(&self, n: usize) -> String {
        self.rows_where(|judged| {
            let mut z: Vec<f64> = judged
                .iter()
                .flat_map(|j| &j.rows)
                .filter(|r| r.kind != Kind::Vague)
                .map(|r| r.z.abs())
                .collect();
            z.sort_by(|a, b| b.total_cmp(a));
            z.get(n - 1).or(z.last()).copied().unwrap_or(f64::INFINITY)
        })
    }

    /// One line per row, by family.
    pub fn rows_text(&self) -> String {
        self.rows_where(|_| f64::NEG_INFINITY)
    }

    /// Rows with a |z| of at least what `least` says of their family.
    fn rows_where(&self, least: impl Fn(&[Judged]) -> f64) -> String {
        let mut out = String::new();
        for (family, judged) in &self.families {
            let _ = writeln!(out, "\n{}: {}\n  {}", family.name, family.title, family.source);
            let _ = writeln!(
                out,
                "  {:<34} {:<16} {:<40} {:>12} {:>12} {:>9} {:>6}",
                "case", "way", "known", "ours", "expected", "se", "z"
            );
            let least = least(judged);
            let wanted =
                |r: &&Row| least.is_infinite() && least < 0.0 || r.kind != Kind::Vague && r.z.abs() >= least;
            for j in judged {
                for row in j.rows.iter().filter(wanted) {
                    let _ = writeln!(out, "  {}", line(j, row, self.passes(row)));
                }
            }
        }
        out
    }

    /// One line per family and one for all.
    pub fn summary_text(&self) -> String {
        let mut out = format!(
            "{:<18} {:>7} {:>6} {:>6} {:>6} {:>14} {:>13}  {}\n",
            "family", "renders", "rows", "exact", "vague", "mean of z", "variance", "worst row"
        );
        for (family, judged) in &self.families {
            let d = Distribution::of(judged);
            let _ = writeln!(out, "{}  {}", distribution_line(family.name, &d), Self::worst(judged));
        }
        let _ = writeln!(out, "{}", distribution_line("all", &self.overall));
        let d = &self.overall;
        let _ = writeln!(
            out,
            "\n{} renders, {} rows judged by their errors, {} by rounding; {} rows are too rare for so few samples\n\
             a row may be {:.2} standard errors off, all together pass with 99.99 %\n\
             {:.0} s on {} threads",
            d.renders, d.noisy, d.exact, d.vague, self.limit, self.seconds, self.threads
        );
        out
    }

    /// All rows as CSV.
    pub fn csv(&self) -> String {
        let mut out = String::from("family,case,way,known,samples,ours,expected,se,z,p,judged,passed\n");
        let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
        for (family, judged) in &self.families {
            for j in judged {
                for r in &j.rows {
                    let _ = writeln!(
                        out,
                        "{},{},{},{},{},{:e},{:e},{:e},{:.4},{:e},{},{}",
                        family.name,
                        quoted(&j.case),
                        quoted(j.way),
                        quoted(&r.label),
                        j.samples,
                        r.ours,
                        r.expected,
                        r.se,
                        r.z,
                        r.p,
                        kind(r.kind),
                        self.passes(r)
                    );
                }
            }
        }
        out
    }
}

/// How a row is judged, in a word.
pub(super) const fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::Noisy => "by error",
        Kind::Exact => "by rounding",
        Kind::Vague => "no",
    }
}

fn told(j: &Judged, row: &Row) -> String {
    format!(
        "{}, {}, {}: {:.6} +- {:.6} against {:.6}, z = {:.2}",
        j.case, j.way, row.label, row.ours, row.se, row.expected, row.z
    )
}

fn line(j: &Judged, row: &Row, passes: bool) -> String {
    let note = match (passes, row.kind) {
        (false, _) => "  FAILED",
        (_, Kind::Vague) => "  too rare, not judged",
        (_, Kind::Exact) => "  by rounding",
        _ => "",
    };
    format!(
        "{:<34} {:<16} {:<40} {:>12.7} {:>12.7} {:>9.2e} {:>6.2}{note}",
        j.case, j.way, row.label, row.ours, row.expected, row.se, row.z
    )
}

fn distribution_line(name: &str, d: &Distribution) -> String {
    let ([m, me], [v, ve]) = (d.mean, d.variance);
    if d.noisy == 0 {
        return format!(
            "{name:<18} {:>7} {:>6} {:>6} {:>6} {:>14} {:>13}",
            d.renders, 0, d.exact, d.vague, "-", "-"
        );
    }
    format!(
        "{name:<18} {:>7} {:>6} {:>6} {:>6} {m:>7.2} +-{me:>4.2} {v:>6.2} +-{ve:>4.2}",
        d.renders, d.noisy, d.exact, d.vague
    )
}
