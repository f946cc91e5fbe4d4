//! The tables, as text in cells; Markdown and page print the same.

use super::{Report, Row};
use crate::{measure::OURS, scenes::SCENES, variants::TECHNIQUES};
use serde_json::Value;

/// A table with its title and what its columns mean.
#[derive(Debug)]
pub struct Section {
    pub title: String,
    pub about: String,
    pub header: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

fn section(title: &str, about: &str, header: &[&str], rows: Vec<Vec<String>>) -> Section {
    let header = header.iter().map(|&h| h.to_owned()).collect();
    Section { title: title.into(), about: about.into(), header, rows }
}

/// All tables that have rows.
pub fn sections(report: &Report) -> Vec<Section> {
    let all = [
        side_by_side(report),
        same(report),
        starts(report),
        threads(report),
        rays(report),
        triangles(report),
        bytes(report),
        samples(report),
        inner(report),
        techniques(report),
        efficiencies(report),
    ];
    all.into_iter().filter(|s| !s.rows.is_empty()).collect()
}

/// Three significant digits, with thousands set apart.
pub fn three(x: f64) -> String {
    if !x.is_finite() {
        return "-".into();
    }
    if x == 0.0 {
        return "0".into();
    }
    let digits = 2 - x.abs().log10().floor() as i32;
    if digits >= 7 {
        return format!("{x:.2e}");
    }
    let round = 10f64.powi(digits);
    let text = format!("{:.*}", digits.max(0) as usize, (x * round).round() / round);
    if x.abs() < 10_000.0 { text } else { thousands(&text) }
}

fn thousands(digits: &str) -> String {
    let mut out = String::new();
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) && c.is_ascii_digit() {
            out.push(',');
        }
        out.push(c);
    }
    out
}

fn number(line: &Value, key: &str) -> f64 {
    line[key].as_f64().unwrap_or(f64::NAN)
}

fn word(line: &Value, key: &str) -> String {
    line[key].as_str().map_or_else(|| line[key].to_string(), str::to_owned)
}

/// Bytes in the unit that keeps them short.
fn memory(bytes: f64) -> String {
    let unit = [(1e9, "GB"), (1e6, "MB"), (1e3, "kB")].into_iter().find(|(size, _)| bytes.abs() >= *size);
    unit.map_or_else(
        || format!("{} B", three(bytes)),
        |(size, name)| format!("{} {name}", three(bytes / size)),
    )
}

/// Samples per pixel at which renderers stand side by side.
const COMPARED_SPP: u64 = 16;

/// The better of a renderer's rows at 16 samples per pixel.
fn best<'r>(report: &'r Report, scene: &str, wanted: impl Fn(&str) -> bool) -> Option<&'r Row> {
    let rows =
        report.rows.iter().filter(|r| r.scene == scene && r.spp == COMPARED_SPP && wanted(&r.renderer));
    rows.max_by(|a, b| a.measured.headline.total_cmp(&b.measured.headline))
}

fn side_by_side(report: &Report) -> Section {
    let mut rows = Vec::new();
    for scene in SCENES {
        let ours = best(report, scene.name, |r| r == OURS);
        let others = best(report, scene.name, |r| r != OURS);
        if let Some((ours, other)) = ours.zip(others) {
            let times = |a: f64, b: f64| format!("{:.2} times", a / b);
            let (a, b) = (&ours.measured, &other.measured);
            rows.push(vec![
                format!("{} ({})", scene.name, scene.about),
                three(a.headline),
                three(b.headline),
                other.renderer.clone(),
                times(a.headline, b.headline),
                times(a.whole, b.whole),
            ]);
        }
    }
    section(
        "Beside the best of the others, 16 samples per pixel",
        "Headline efficiency of ours and of the best renderer, variant and sampler among the others; ours over theirs, \
         headline and whole frame.",
        &["scene", "ours", "best other", "which", "headline", "whole frame"],
        rows,
    )
}

fn efficiencies(report: &Report) -> Section {
    let row = |r: &Row| {
        let m = &r.measured;
        vec![
            r.scene.clone(),
            r.renderer.clone(),
            r.spp.to_string(),
            format!("{} k", three(m.samples_per_second / 1e3)),
            format!("{} +- {}", three(m.headline), three(m.headline_se)),
            format!("{} +- {}", three(m.whole), three(m.whole_se)),
            three(m.relative_mse),
            format!("{:.4} +- {:.4}", m.mean_y, m.mean_y_se),
            three(m.seconds),
            format!("{} x {}, {}", r.resolution, r.resolution, r.seeds),
        ]
    };
    section(
        "Everything, one thread",
        "E = 1 / (MSE_Y x user CPU s) without the pixels that see a lamp and their neighbours (headline), and of all pixels; \
         MSE_Y from the variance over seeds, CPU seconds of rendering alone, the median over seeds. relMSE: mean over all \
         pixels of the squared error over the squared reference. +- is the standard error over seeds.",
        &[
            "scene",
            "renderer",
            "spp",
            "samples/s",
            "E headline",
            "E whole frame",
            "relMSE",
            "mean Y",
            "CPU s",
            "pixels, seeds",
        ],
        report.rows.iter().map(row).collect(),
    )
}

fn same(report: &Report) -> Section {
    let rows = report.beside.iter().map(|b| {
        let a = &b.agreement;
        let verdict = match a.same {
            Some(true) => "the same",
            Some(false) => "DIFFERENT",
            None => "too few pictures to tell",
        };
        vec![
            b.scene.clone(),
            b.renderer.clone(),
            format!("{:.4} +- {:.4}", a.ratio, a.ratio_se),
            format!("{:.2} +- {:.2}", a.blocks, a.blocks_sd),
            verdict.into(),
        ]
    });
    section(
        "The same picture?",
        "Mean Y of the other renderer over ours, and mean square of the scores of blocks of 8 x 8 pixels over what noise alone \
         gives, both at their most samples. An efficiency counts for nothing where a picture is different.",
        &["scene", "renderer", "mean over ours", "blocks", "verdict"],
        rows.collect(),
    )
}

fn starts(report: &Report) -> Section {
    let rows = report.kind("start").iter().map(|l| {
        vec![
            word(l, "scene"),
            word(l, "renderer"),
            format!("{} ms", three(1e3 * number(l, "seconds"))),
            format!("{} ms", three(1e3 * number(l, "user_seconds"))),
            memory(number(l, "bytes")),
        ]
    });
    section(
        "Start-up and memory",
        "Wall clock and user CPU of a whole process that renders one pixel with one sample: reading the scene, building, \
         rendering, writing. Memory: greatest resident set of a process that renders the whole picture (of Mitsuba: one pixel).",
        &["scene", "renderer", "to the first pixel", "user CPU", "peak memory"],
        rows.collect(),
    )
}

fn threads(report: &Report) -> Section {
    let lines = report.kind("threads");
    let one = lines.first().map_or(f64::NAN, |l| number(l, "seconds"));
    let rows = lines.iter().map(|l| {
        let faster = one / number(l, "seconds");
        vec![
            word(l, "threads"),
            word(l, "scene"),
            three(number(l, "seconds")),
            format!("{faster:.2}"),
            format!("{:.0} %", 100.0 * faster / number(l, "threads")),
        ]
    });
    section(
        "Threads",
        "Wall clock of rendering, the median of rounds that take turns; over one thread; of what that many threads could do.",
        &["threads", "scene", "seconds", "faster", "of the possible"],
        rows.collect(),
    )
}

fn rays(report: &Report) -> Section {
    let lines = report.kind("rays");
    let is_ours = |l: &&Value| l["renderer"] == OURS;
    let rows = lines.iter().filter(is_ours).map(|l| {
        let other =
            lines.iter().find(|o| !is_ours(o) && ["scene", "set"].iter().all(|key| o[*key] == l[*key]));
        let theirs = other.map(|o| number(o, "mrays"));
        let hits = other.map(|o| format!("{} / {}", word(l, "hits"), word(o, "hits")));
        vec![
            word(l, "scene"),
            three(number(l, "triangles")),
            word(l, "set"),
            three(number(l, "mrays")),
            theirs.map_or_else(|| "-".into(), three),
            theirs.map_or_else(|| "-".into(), |t| format!("{:.2}", number(l, "mrays") / t)),
            hits.unwrap_or_else(|| word(l, "hits")),
        ]
    });
    section(
        "Rays",
        "Millions of rays per CPU second of one thread, one ray at a time, the best of several rounds; Embree 4 in its robust \
         mode with a high-quality tree over the same triangles and the same rays. Hits: ours / Embree's.",
        &["mesh", "triangles", "rays", "ours", "Embree", "ours over Embree", "hits"],
        rows.collect(),
    )
}

fn triangles(report: &Report) -> Section {
    let rows = report.kind("triangles").iter().map(|l| {
        vec![
            three(number(l, "triangles")),
            three(number(l, "load_seconds")),
            three(number(l, "build_seconds")),
            format!("{} k", three(number(l, "samples_per_second") / 1e3)),
            three(number(l, "tree_bytes_per_triangle")),
        ]
    });
    section(
        "Growth: triangles",
        "The terrain at several sizes: seconds to read it and to build the tree, samples per CPU second, bytes of the tree.",
        &["triangles", "read", "build", "samples/s", "bytes of tree per triangle"],
        rows.collect(),
    )
}

fn bytes(report: &Report) -> Section {
    let rows = report.kind("bytes").iter().map(|l| {
        let peak = |i: usize| memory(l["peak"][i].as_f64().unwrap_or(f64::NAN));
        vec![
            word(l, "unit"),
            memory(number(l, "bytes")),
            format!("{} at {}, {} at {}", peak(0), three(number(l, "from")), peak(1), three(number(l, "to"))),
        ]
    });
    section(
        "Growth: memory",
        "Peak memory of the program at two sizes, and what one more takes: reading, rendering and writing included.",
        &["one more", "takes", "peak memory"],
        rows.collect(),
    )
}

fn samples(report: &Report) -> Section {
    let ours: Vec<&Row> = report.rows.iter().filter(|r| r.renderer == OURS).collect();
    let rows = ours.iter().map(|r| {
        let first =
            ours.iter().find(|o| o.scene == r.scene).map_or(f64::NAN, |o| o.measured.samples_per_second);
        let nanoseconds = 1e9 / r.measured.samples_per_second;
        vec![
            r.scene.clone(),
            r.spp.to_string(),
            three(nanoseconds),
            format!("{:.2}", first / r.measured.samples_per_second),
        ]
    });
    section(
        "Growth: samples",
        "CPU time of a sample, and over that of the fewest samples: 1 where cost is linear.",
        &["scene", "spp", "ns per sample", "over the first"],
        rows.collect(),
    )
}

fn inner(report: &Report) -> Section {
    let (times, counts) = (report.kind("inner"), report.kind("count"));
    let mut names: Vec<String> = times.iter().chain(counts).map(|l| word(l, "loop")).collect();
    let mut seen = std::collections::BTreeSet::new();
    names.retain(|n| seen.insert(n.clone()));
    let find = |lines: &[Value], name: &str, key: &str| {
        lines.iter().find(|l| l["loop"] == *name).map_or(f64::NAN, |l| number(l, key))
    };
    let old =
        report.before.as_ref().and_then(|b| b["lines"]["count"].as_array()).cloned().unwrap_or_default();
    let rows = names.iter().map(|name| {
        let (time, count) = (find(times, name, "nanoseconds"), find(counts, name, "instructions"));
        let change = 100.0 * (count / find(&old, name, "instructions") - 1.0);
        let rate = 1e3 / time;
        let change = if change.is_finite() { format!("{change:+.2} %") } else { "-".into() };
        vec![
            name.clone(),
            three(time),
            three(rate),
            if count.is_finite() { format!("{count:.1}") } else { "-".into() },
            change,
        ]
    });
    section(
        "Inner loops",
        "Nanoseconds of a call with eight wavelengths on one thread (the best of many runs), millions of calls per second, \
         instructions under callgrind, and their change against an earlier report. The loops over phase functions and BSDFs \
         hold the making of their directions, which stands on a line of its own.",
        &["loop", "ns", "M/s", "instructions", "against before"],
        rows.collect(),
    )
}

fn techniques(report: &Report) -> Section {
    let lines = report.kind("technique");
    let measured = |scene: &str| lines.iter().any(|l| l["scene"] == *scene);
    let scenes: Vec<&str> = SCENES.iter().map(|s| s.name).filter(|s| measured(s)).collect();
    let cell = |changed: &str, scene: &str| {
        let line = lines.iter().find(|l| l["changed"] == *changed && l["scene"] == *scene);
        line.map_or_else(
            || "-".into(),
            |l| {
                format!(
                    "{:.2} +- {:.2} ({:.2})",
                    number(l, "ratio"),
                    number(l, "ratio_se"),
                    number(l, "ratio_whole")
                )
            },
        )
    };
    let variants = TECHNIQUES.iter().filter(|v| lines.iter().any(|l| l["changed"] == *v.name));
    let rows = variants.map(|v| {
        let cells = scenes.iter().map(|s| cell(v.name, s));
        [v.name.to_owned(), v.wins_on.to_owned()].into_iter().chain(cells).collect()
    });
    let rows = rows.collect();
    let header: Vec<&str> = ["changed", "there for"].into_iter().chain(scenes.iter().copied()).collect();
    section(
        "Techniques",
        "Efficiency of the defaults over that with one technique changed, headline, in brackets the whole frame: above 1 the \
         default wins. `there for`: the scene on which it is there to win.",
        &header,
        rows,
    )
}

#[cfg(test)]
mod tests {
    use super::{memory, three};

    #[test]
    fn digits() {
        assert_eq!(
            [three(0.012345), three(123.45), three(23_456.0), three(1_234_567.0)],
            ["0.0123", "123", "23,500", "1,230,000"]
        );
        assert_eq!([three(f64::NAN), three(0.0), three(3e-8)], ["-", "0", "3.00e-8"]);
        assert_eq!([memory(12.0), memory(1.5e6), memory(2.25e9)], ["12.0 B", "1.50 MB", "2.25 GB"]);
    }
}
