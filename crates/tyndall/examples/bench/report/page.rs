//! The report as a page that stands alone, with plots.

use super::{Report, Row, tables, text};
use crate::{measure::OURS, scenes::SCENES};
use tyndall::page::{Axis, Chart, Document, Series, Table};

/// The page.
pub fn html(report: &Report) -> String {
    let mut page = Document::new("Tyndall: benchmark");
    page.paragraph(&text::about());
    page.command("cargo xtask bench");
    let plots: Vec<(String, String)> = SCENES.iter().filter_map(|s| error_against_time(report, s)).collect();
    if !plots.is_empty() {
        page.heading(2, "Error against time");
        page.paragraph(
            "Mean squared error of luminance, without the pixels that see a lamp, against user CPU seconds of rendering on one \
             thread, for each number of samples per pixel. Lower and further to the left is better. Broken: error falling as \
             1/N from our first point, as that of independent samples does.",
        );
        page.figures(&plots);
    }
    for s in tables::sections(report) {
        page.heading(2, &s.title);
        page.paragraph(&s.about);
        let mut table = Table::new(s.header.clone());
        s.rows.iter().for_each(|row| table.push(row.clone(), row.iter().any(|cell| cell == "DIFFERENT")));
        if s.rows.len() > 30 {
            page.folded_table(&format!("{} rows", s.rows.len()), &table)
        } else {
            page.table(&table)
        }
        let chart = match s.title.as_str() {
            "Threads" => threads(report),
            "Growth: triangles" => triangles(report),
            _ => None,
        };
        if let Some((svg, caption)) = chart {
            page.figure(&svg, &caption);
        }
    }
    page.finish()
}

/// A renderer's name without what all of its kind share, so that the legend leaves room for the plot.
fn short(name: &str) -> String {
    name.replace("_ad_spectral", "").replace("_spectral", "")
}

/// One point for each number of samples.
fn points(rows: &[&Row]) -> (Vec<[f64; 2]>, Vec<f64>) {
    let bar = |r: &&Row| r.measured.mse * r.measured.headline_se / r.measured.headline;
    (rows.iter().map(|r| [r.measured.seconds, r.measured.mse]).collect(), rows.iter().map(bar).collect())
}

fn error_against_time(report: &Report, scene: &crate::scenes::BenchScene) -> Option<(String, String)> {
    let rows: Vec<&Row> = report.rows.iter().filter(|r| r.scene == scene.name).collect();
    let mut names: Vec<&str> = rows.iter().map(|r| r.renderer.as_str()).collect();
    names.dedup();
    let x = Axis::new("user CPU [s]").log();
    let mut chart = Chart::new(scene.name, x, Axis::new("MSE of Y").log()).size(720.0, 400.0);
    for name in &names {
        let of: Vec<&Row> = rows.iter().filter(|r| r.renderer == *name).copied().collect();
        let (points, errors) = points(&of);
        chart = chart.with(Series::line(&short(name), points).errors(errors));
    }
    let first = rows.iter().find(|r| r.renderer == OURS).or(rows.first())?;
    let slowest = rows.iter().map(|r| r.measured.seconds).fold(0.0, f64::max);
    let [from, to] =
        [1.0, slowest / first.measured.seconds].map(|n| [first.measured.seconds * n, first.measured.mse / n]);
    chart = chart.with(Series::dashed("1/N", vec![from, to]).colour("#999999"));
    for name in &names {
        let of: Vec<&Row> = rows.iter().filter(|r| r.renderer == *name).copied().collect();
        let i = names.iter().position(|n| n == name).unwrap_or(0);
        chart = chart.with(Series::points("", points(&of).0).colour(tyndall::page::colour(i)));
    }
    Some((chart.to_svg(), scene.about.to_owned()))
}

fn threads(report: &Report) -> Option<(String, String)> {
    let value = |l: &serde_json::Value, key: &str| l[key].as_f64().unwrap_or(f64::NAN);
    let lines = report.kind("threads");
    let one = value(lines.first()?, "seconds");
    let points: Vec<[f64; 2]> =
        lines.iter().map(|l| [value(l, "threads"), one / value(l, "seconds")]).collect();
    let most = points.last()?[0];
    let chart = Chart::new("Threads", Axis::new("threads"), Axis::new("times faster than one"))
        .with(Series::line("measured", points.clone()))
        .with(Series::dashed("possible", vec![[1.0, 1.0], [most, most]]).colour("#999999"))
        .with(Series::points("", points).colour(tyndall::page::colour(0)));
    Some((chart.to_svg(), "Speed against threads.".into()))
}

fn triangles(report: &Report) -> Option<(String, String)> {
    let value = |l: &serde_json::Value, key: &str| l[key].as_f64().unwrap_or(f64::NAN);
    let lines = report.kind("triangles");
    let point = |l| [value(l, "triangles"), 1e9 / value(l, "samples_per_second")];
    let points: Vec<[f64; 2]> = lines.iter().map(point).collect();
    let most = points.iter().map(|p| p[1]).fold(f64::NEG_INFINITY, f64::max);
    lines.first()?;
    let chart = Chart::new(
        "Terrain",
        Axis::new("triangles").log(),
        Axis::new("CPU time of a sample [ns]").range(0.0, 1.2 * most),
    )
    .with(Series::line("ours", points.clone()))
    .with(Series::points("", points).colour(tyndall::page::colour(0)));
    Some((
        chart.to_svg(),
        "A straight line here is growth with the logarithm of the number of triangles.".into(),
    ))
}
