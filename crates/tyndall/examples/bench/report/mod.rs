//! The report: JSON to compare, Markdown to read, a page to look at. All of it is made from what the stages wrote, so that
//! any of them can be measured anew.

mod page;
mod tables;
mod text;

use crate::{
    agree::{self, Agreement},
    efficiency::{Efficiency, Measurement},
    generate::write,
    mask,
    measure::OURS,
    setup::Setup,
    store,
};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// What tells lines of a kind apart: a later one takes the place of an earlier.
const IDENTITY: [&str; 10] =
    ["kind", "renderer", "scene", "spp", "threads", "loop", "set", "unit", "triangles", "changed"];

/// A renderer on a scene at a number of samples.
#[derive(Clone, Debug)]
pub struct Row {
    pub renderer: String,
    pub scene: String,
    pub spp: u64,
    pub seeds: usize,
    pub resolution: usize,
    pub measured: Efficiency,
}

/// Another renderer's picture beside ours.
#[derive(Clone, Debug)]
pub struct Beside {
    pub renderer: String,
    pub scene: String,
    pub agreement: Agreement,
}

/// All that was measured.
#[derive(Debug, Default)]
pub struct Report {
    /// Efficiencies, scene by scene, ours first.
    pub rows: Vec<Row>,
    /// Whether pictures agree.
    pub beside: Vec<Beside>,
    /// All other lines, by kind.
    pub lines: BTreeMap<String, Vec<Value>>,
    /// An earlier report.
    pub before: Option<Value>,
}

/// Writes `bench.json`, `bench.md` and `bench.html`, and prints the tables.
pub fn all(setup: &Setup) -> Result<(), String> {
    let report = Report::of(setup)?;
    let json = format!("{:#}\n", report.json());
    write(&setup.folder.join("bench.json"), json.as_bytes())?;
    let text = text::markdown(&report);
    write(&setup.folder.join("bench.md"), text.as_bytes())?;
    write(&setup.folder.join("bench.html"), page::html(&report).as_bytes())?;
    print!("{text}");
    Ok(())
}

/// The last line of every identity, in the order of their first ones.
fn latest(lines: Vec<Value>) -> Vec<Value> {
    let identity = |l: &Value| IDENTITY.map(|key| l[key].to_string()).join("|");
    let mut kept: Vec<(String, Value)> = Vec::new();
    for line in lines {
        let id = identity(&line);
        match kept.iter_mut().find(|(other, _)| *other == id) {
            Some((_, old)) => *old = line,
            None => kept.push((id, line)),
        }
    }
    kept.into_iter().map(|(_, line)| line).collect()
}

impl Report {
    fn of(setup: &Setup) -> Result<Self, String> {
        let mut report = Self::default();
        let mut pictures = Vec::new();
        for line in latest(store::lines(&setup.folder)?) {
            match line["kind"].as_str() {
                Some("pictures") => pictures.push(line),
                Some(kind) => report.lines.entry(kind.to_owned()).or_default().push(line),
                None => return Err(format!("a line without a kind: {line}")),
            }
        }
        for scene in crate::scenes::SCENES {
            let of_scene: Vec<&Value> = pictures.iter().filter(|l| l["scene"] == scene.name).collect();
            report.scene(setup, scene, &of_scene)?;
        }
        let read = |path: &std::path::PathBuf| {
            let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
            serde_json::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))
        };
        report.before = setup.against.as_ref().map(read).transpose()?;
        Ok(report)
    }

    fn scene(
        &mut self,
        setup: &Setup,
        scene: &crate::scenes::BenchScene,
        lines: &[&Value],
    ) -> Result<(), String> {
        let mut all: Vec<(String, u64, Measurement)> = Vec::new();
        for line in lines {
            let name = line["renderer"].as_str().unwrap_or_default().to_owned();
            all.push((name, line["spp"].as_u64().unwrap_or(0), store::measurement(&setup.folder, line)?));
        }
        // stable: the order of the numbers of samples stays
        all.sort_by_key(|(name, ..)| (name != OURS, name.clone()));
        let Some(width) = all.first().map(|(.., m)| m.width) else { return Ok(()) };
        if let Some((name, ..)) = all.iter().find(|(.., m)| m.width != width) {
            return Err(format!(
                "{}: the pictures of {name} have another size\nhint: measure them again, all with --quick or all without",
                scene.name
            ));
        }
        let mask = mask::lamp(setup, scene, width as u32)?;
        let best =
            |wanted: &str| all.iter().filter(|(name, ..)| name == wanted).max_by_key(|(_, spp, _)| *spp);
        let ours = best(OURS);
        for (renderer, spp, m) in &all {
            let reference = ours.or_else(|| best(renderer)).map_or_else(Vec::new, |(.., m)| m.mean_picture());
            self.rows.push(Row {
                renderer: renderer.clone(),
                scene: scene.name.into(),
                spp: *spp,
                seeds: m.pictures.len(),
                resolution: m.width,
                measured: m.efficiency(&mask, &reference),
            });
        }
        let mut others: Vec<&str> =
            all.iter().map(|(name, ..)| name.as_str()).filter(|n| *n != OURS).collect();
        others.dedup();
        for other in others {
            let compared = best(other).zip(ours).and_then(|((.., a), (.., b))| agree::compare(a, b));
            if let Some(agreement) = compared {
                self.beside.push(Beside { renderer: other.into(), scene: scene.name.into(), agreement });
            }
        }
        Ok(())
    }

    /// Lines of a kind.
    pub fn kind(&self, kind: &str) -> &[Value] {
        self.lines.get(kind).map_or(&[], Vec::as_slice)
    }

    fn json(&self) -> Value {
        let rows: Vec<Value> = self
            .rows
            .iter()
            .map(|r| {
                json!({
                    "renderer": r.renderer, "scene": r.scene, "spp": r.spp, "seeds": r.seeds,
                    "resolution": r.resolution, "measured": r.measured.json(),
                })
            })
            .collect();
        let beside: Vec<Value> = self
            .beside
            .iter()
            .map(|b| json!({ "renderer": b.renderer, "scene": b.scene, "agreement": b.agreement.json() }))
            .collect();
        json!({ "machine": machine(), "efficiency": rows, "same_picture": beside, "lines": self.lines })
    }
}

/// What the figures were taken on.
pub fn machine() -> Value {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info
        .lines()
        .find_map(|l| l.strip_prefix("model name")?.split_once(':').map(|(_, m)| m.trim().to_owned()));
    json!({
        "processor": model, "threads": std::thread::available_parallelism().map_or(0, usize::from),
        "version": env!("CARGO_PKG_VERSION"), "checked": cfg!(debug_assertions),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn later_lines_win() {
        let line =
            |threads: u32, seconds: f64| json!({ "kind": "threads", "threads": threads, "seconds": seconds });
        let kept = latest(vec![line(1, 4.0), line(2, 2.0), line(1, 3.0)]);
        assert_eq!(kept, [line(1, 3.0), line(2, 2.0)]);
    }

    /// A folder with pictures of two renderers, and one line of every other kind.
    #[test]
    fn every_table_and_chart_is_made() {
        let folder = tempfile::tempdir().expect("a folder");
        let words = [folder.path().to_string_lossy().into_owned(), "--quick".into()];
        let setup = Setup::parse(&words).expect("good options");
        crate::generate::write_texts(&setup.scene_folder()).expect("scenes");
        for (renderer, seconds) in [(OURS, 1.0), ("Other, sampler", 2.0)] {
            for spp in [4u32, 16] {
                let y = |seed: u32, i: u32| f64::from(1 + tyndall::base::hash::hash3(spp, seed, i) % 7);
                let m = Measurement {
                    pictures: (0..4).map(|s| (0..1024).map(|i| y(s, i)).collect()).collect(),
                    seconds: vec![seconds; 4],
                    width: 32,
                    spp: f64::from(spp),
                };
                store::pictures(&setup.folder, renderer, "fog-box", spp, &m).expect("kept");
            }
        }
        let other = [
            json!({ "kind": "start", "renderer": OURS, "scene": "fog-box", "seconds": 0.01, "user_seconds": 0.01, "bytes": 9e6 }),
            json!({ "kind": "threads", "scene": "fog-box", "threads": 1, "spp": 4, "resolution": 32, "seconds": 2.0 }),
            json!({ "kind": "threads", "scene": "fog-box", "threads": 2, "spp": 4, "resolution": 32, "seconds": 1.0 }),
            json!({ "kind": "technique", "scene": "fog-box", "changed": "equiangular off", "spp": 16, "ratio": 1.5, "ratio_se": 0.1, "ratio_whole": 1.2 }),
            json!({ "kind": "triangles", "triangles": 1058, "load_seconds": 0.1, "build_seconds": 0.1, "samples_per_second": 5e5, "tree_bytes_per_triangle": 60.0 }),
            json!({ "kind": "bytes", "unit": "pixel", "from": 10.0, "to": 20.0, "peak": [1e6, 2e6], "bytes": 1e5 }),
            json!({ "kind": "rays", "renderer": "Tyndall", "scene": "cave", "set": "bounce", "triangles": 9, "rays": 4, "mrays": 5.0, "hits": 4 }),
            json!({ "kind": "rays", "renderer": "Embree 4.4.0", "scene": "cave", "set": "bounce", "triangles": 9, "rays": 4, "mrays": 4.0, "hits": 4 }),
            json!({ "kind": "inner", "loop": "sampler", "nanoseconds": 5.0 }),
            json!({ "kind": "count", "loop": "sampler", "instructions": 40.0 }),
        ];
        other.iter().for_each(|l| store::line(&setup.folder, l).expect("kept"));
        let mut report = Report::of(&setup).expect("a report");
        report.before = Some(report.json());
        let text = text::markdown(&report);
        for word in ["2.00 times", "the same", "1.50 +- 0.10 (1.20)", "100 kB", "1.25", "40.0", "+0.00 %"] {
            assert!(text.contains(word), "{word} is missing in\n{text}");
        }
        let html = page::html(&report);
        assert!(html.matches("<svg").count() >= 3 && !html.contains("NaN"), "{html}");
    }
}
