//! The report: Markdown to read, JSON to compare.

use crate::{
    Size, TECHNIQUE_SPP,
    measure::Efficiency,
    pbrt::Peer,
    scenes::BenchScene,
    variants::{DEFAULTS, TECHNIQUES, Variant},
};
use serde_json::{Value, json};
use std::fmt::Write;

/// All that was measured; per scene, in the order of `scenes`.
pub struct Report<'a> {
    pub size: &'a Size,
    pub scenes: &'a [&'static BenchScene],
    /// Samples per pixel and efficiency of the defaults.
    pub defaults: Vec<Vec<(u32, Efficiency)>>,
    /// Efficiency of the defaults, then of each technique's variant where the scene allows it; empty when left out.
    pub techniques: Vec<Vec<Option<Efficiency>>>,
    pub peers: Vec<Peer>,
}

impl Report<'_> {
    /// Tables of defaults, techniques and, if there, pbrt.
    pub fn markdown(&self) -> String {
        let mut s = String::from("# Benchmark\n\n");
        s += "E = 1 / (MSE_Y x CPU s) on one thread; headline: without the pixels that see a lamp and their neighbours; ";
        s += "+- is the standard error over seeds.\n\n";
        self.defaults_table(&mut s);
        if !self.techniques.is_empty() {
            self.techniques_table(&mut s);
        }
        if !self.peers.is_empty() {
            s += "\n## pbrt-v4, 16 samples per pixel\n\n| scene | samples/s | E headline | E whole frame | mean Y |\n|---|---|---|---|---|\n";
            for (name, scene, e) in &self.peers {
                s += &format!("| {name}: {scene} {}\n", cells(e));
            }
        }
        s
    }

    fn defaults_table(&self, s: &mut String) {
        let Size { seeds, resolution: r, .. } = self.size;
        *s += &format!("## What ships, {r} x {r} pixels, {seeds} seeds\n\n");
        *s +=
            "| scene | spp | samples/s | E headline | E whole frame | mean Y |\n|---|---|---|---|---|---|\n";
        for (scene, rows) in self.scenes.iter().zip(&self.defaults) {
            for (spp, e) in rows {
                *s += &format!("| {} ({}) | {spp} {}\n", scene.name, scene.about, cells(e));
            }
        }
    }

    /// How much better the defaults are than each variant.
    fn techniques_table(&self, s: &mut String) {
        let Size { seeds, technique_resolution: r, .. } = self.size;
        *s += &format!(
            "\n## Techniques, {r} x {r} pixels, {TECHNIQUE_SPP} samples per pixel, {seeds} seeds\n\n"
        );
        *s += "E of the defaults over E with one technique changed: above 1 the default wins. Headline, in brackets the\n";
        *s += "whole frame; bold: the scene on which the default is there to win.\n\n| changed |";
        self.scenes.iter().for_each(|scene| *s += &format!(" {} |", scene.name));
        *s += &format!("\n|---|{}\n", "---|".repeat(self.scenes.len()));
        for (i, variant) in TECHNIQUES.iter().enumerate() {
            *s += &format!("| {} |", variant.name);
            for (scene, measured) in self.scenes.iter().zip(&self.techniques) {
                *s += &ratio(&measured[0], &measured[i + 1], scene.name == variant.wins_on);
            }
            *s += "\n";
        }
    }

    /// Everything as numbers.
    pub fn json(&self) -> String {
        let defaults = |rows: &Vec<(u32, Efficiency)>| -> Value {
            rows.iter().map(|(spp, e)| json!({ "spp": spp, "measured": number(e) })).collect()
        };
        let variants: Vec<&Variant> = std::iter::once(&DEFAULTS).chain(TECHNIQUES).collect();
        let techniques = |all: &Vec<Option<Efficiency>>| -> Value {
            variants
                .iter()
                .zip(all)
                .map(|(v, e)| json!({ "changed": v.name, "measured": e.as_ref().map(number) }))
                .collect()
        };
        let none = Vec::new();
        let one = |i: usize| {
            let techniques = techniques(self.techniques.get(i).unwrap_or(&none));
            json!({ "scene": self.scenes[i].name, "defaults": defaults(&self.defaults[i]), "techniques": techniques })
        };
        let scenes: Vec<Value> = (0..self.scenes.len()).map(one).collect();
        let peers: Vec<Value> = self
            .peers
            .iter()
            .map(|(n, s, e)| json!({ "renderer": n, "scene": s, "measured": number(e) }))
            .collect();
        let size = json!({
            "seeds": self.size.seeds, "resolution": self.size.resolution,
            "technique_resolution": self.size.technique_resolution, "technique_spp": TECHNIQUE_SPP,
        });
        format!("{:#}\n", json!({ "size": size, "scenes": scenes, "peers": peers }))
    }
}

fn number(e: &Efficiency) -> Value {
    json!({
        "headline": e.headline, "headline_se": e.headline_se, "whole": e.whole, "mse_y_headline": e.mse,
        "cpu_seconds": e.seconds, "samples_per_second": e.samples_per_second, "mean_y": e.mean_y,
    })
}

fn cells(e: &Efficiency) -> String {
    let mut s = String::new();
    let k = e.samples_per_second / 1e3;
    let _ = write!(
        s,
        "| {k:.0} k | {} +- {} | {} | {:.4} |",
        three(e.headline),
        three(e.headline_se),
        three(e.whole),
        e.mean_y
    );
    s
}

fn ratio(default: &Option<Efficiency>, changed: &Option<Efficiency>, bold: bool) -> String {
    let (Some(d), Some(c)) = (default, changed) else { return " - |".into() };
    let (headline, whole) = (d.headline / c.headline, d.whole / c.whole);
    let relative = ((d.headline_se / d.headline).powi(2) + (c.headline_se / c.headline).powi(2)).sqrt();
    let mark = if bold { "**" } else { "" };
    format!(" {mark}{headline:.2}{mark} +- {:.2} ({whole:.2}) |", headline * relative)
}

/// Three significant digits.
fn three(x: f64) -> String {
    let digits = 2 - x.abs().max(1e-9).log10().floor() as i32;
    let round = 10f64.powi(digits);
    format!("{:.*}", digits.max(0) as usize, (x * round).round() / round)
}
