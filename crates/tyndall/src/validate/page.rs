//! The results as a page with charts.

use super::{
    Report,
    family::Family,
    judge::{Distribution, Judged, Kind, Row},
    report::kind,
};
use crate::page::{Axis, Chart, Document, Series, Table};

/// Edges of the histogram of scores.
const BINS: std::ops::RangeInclusive<i32> = -12..=12;

pub(super) fn html(report: &Report, command: &str) -> String {
    let mut page = Document::new("Tyndall against known answers");
    let failures = report.failures();
    let d = &report.overall;
    page.paragraph(&format!(
        "{} rows in {} renders, {}: scores z = (ours - expected) / standard error have mean {:.3} +- {:.3} and variance {:.3} \
         +- {:.3}, where 0 and 1 are right. {}",
        d.noisy + d.exact,
        d.renders,
        if failures.is_empty() { "all pass" } else { "not all pass" },
        d.mean[0],
        d.mean[1],
        d.variance[0],
        d.variance[1],
        format_args!("{:.0} s on {} threads, depth {}.", report.seconds, report.threads, report.depth.name()),
    ));
    page.command(command);
    for failure in &failures {
        page.paragraph(&format!("Failed: {failure}"));
    }
    page.paragraph(
        "Known answers come from solvers and formulas that share nothing with the renderer. Errors come from 32 replicates a \
         pixel; rows of one render share paths, so mean and variance of all scores are judged with the correlations that \
         replicates show. A row fails beyond the quantile that Sidak's rule gives all rows together.",
    );
    page.figure(
        &histogram("Scores of all rows", report.families.iter().flat_map(|(_, j)| j)),
        "Bars: rows; broken: the normal law.",
    );
    page.heading(2, "Families");
    page.table(&families(report));
    for (family, judged) in &report.families {
        section(&mut page, report, family, judged);
    }
    page.finish()
}

fn families(report: &Report) -> Table {
    let header = [
        "family",
        "renders",
        "rows",
        "exact",
        "too rare",
        "SE <= tolerance / 2",
        "mean of z",
        "+-",
        "variance",
        "+-",
        "worst row",
    ];
    let mut table = Table::new(header);
    for (family, judged) in &report.families {
        let d = Distribution::of(judged);
        let bad = judged.iter().flat_map(|j| &j.rows).any(|r| !report.passes(r));
        table.push(line(family.name, &d, report.resolved(family, judged), Report::worst(judged)), bad);
    }
    let resolved = report.families.iter().map(|(f, j)| report.resolved(f, j)).sum();
    table.push(line("all", &report.overall, resolved, String::new()), false);
    table
}

fn line(name: &str, d: &Distribution, resolved: usize, worst: String) -> Vec<String> {
    let number = |v: f64| if d.noisy == 0 { String::new() } else { format!("{v:.2}") };
    let [[m, me], [v, ve]] = [d.mean, d.variance];
    vec![
        name.into(),
        d.renders.to_string(),
        d.noisy.to_string(),
        d.exact.to_string(),
        d.vague.to_string(),
        resolved.to_string(),
        number(m),
        number(me),
        number(v),
        number(ve),
        worst,
    ]
}

fn section(page: &mut Document, report: &Report, family: &Family, judged: &[Judged]) {
    page.heading(2, family.title);
    page.paragraph(&format!("Known from: {}.", family.source));
    page.figures(&[
        (answers(judged), "Ours over the known answers; the line is equality.".into()),
        (histogram("Scores", judged), "Scores of the rows that are judged by their errors.".into()),
    ]);
    let mut table = Table::new(["case", "way", "known", "ours", "expected", "se", "z", "judged"]);
    for j in judged {
        for r in &j.rows {
            let cells = [
                j.case.clone(),
                j.way.into(),
                r.label.clone(),
                format!("{:.7}", r.ours),
                format!("{:.7}", r.expected),
                format!("{:.1e}", r.se),
                format!("{:.2}", r.z),
                kind(r.kind).into(),
            ];
            table.push(cells, !report.passes(r));
        }
    }
    page.folded_table(&format!("All {} rows", table.len()), &table);
}

fn rows<'j>(judged: impl IntoIterator<Item = &'j Judged>) -> impl Iterator<Item = &'j Row> {
    judged.into_iter().flat_map(|j| &j.rows)
}

/// Ours over the known answers.
fn answers(judged: &[Judged]) -> String {
    let shown = || rows(judged).filter(|r| r.kind != Kind::Vague && r.expected > 0.0);
    let points = shown().map(|r| [r.expected, r.ours]).collect();
    let ends = shown().fold([f64::INFINITY, 0.0f64], |[a, b], r| [a.min(r.expected), b.max(r.expected)]);
    Chart::new("Ours against known", Axis::new("known").log(), Axis::new("ours").log())
        .with(Series::dashed("", ends.map(|v| [v, v]).into()).colour("#888888"))
        .with(Series::points("", points).errors(shown().map(|r| r.se).collect()))
        .size(460.0, 340.0)
        .to_svg()
}

/// Scores beside the normal law.
fn histogram<'j>(title: &str, judged: impl IntoIterator<Item = &'j Judged>) -> String {
    let z: Vec<f64> = rows(judged).filter(|r| r.kind == Kind::Noisy).map(|r| r.z).collect();
    let edges: Vec<f64> = BINS.map(|i| 0.5 * f64::from(i) - 0.25).collect();
    let mut counts = vec![0.0; edges.len() - 1];
    let last = counts.len() - 1;
    for v in &z {
        let bin = ((v - edges[0]) / 0.5).floor().clamp(0.0, last as f64);
        counts[bin as usize] += 1.0;
    }
    let density = |x: f64| 0.5 * z.len() as f64 * (-0.5 * x * x).exp() / (2.0 * std::f64::consts::PI).sqrt();
    let law = (-60..=60).map(|i| 0.1 * f64::from(i)).map(|x| [x, density(x)]).collect();
    Chart::new(title, Axis::new("z"), Axis::new("rows"))
        .with(Series::bins("", &edges, &counts))
        .with(Series::dashed("", law))
        .size(460.0, 340.0)
        .to_svg()
}
