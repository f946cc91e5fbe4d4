//! Arrows between crates point down only (`ARCHITECTURE.md` draws them).

use serde_json::Value;

use crate::{Findings, sizes, workspace};

/// Level of every crate. An arrow must lead to a strictly smaller level.
const LEVELS: &[(&str, u32)] = &[
    ("tyndall-base", 0),
    ("tyndall-testkit", 0),
    ("tyndall-pbrt", 0),
    ("tyndall-spectral", 1),
    ("tyndall-geometry", 1),
    ("tyndall-scatter", 2),
    ("tyndall-film", 2),
    ("tyndall-files", 2),
    ("tyndall-transport", 3),
    ("tyndall-integrators", 4),
    ("tyndall-engine", 5),
    ("tyndall-io", 6),
    ("tyndall", 7),
    ("tyndall-cli", 8),
];
/// Statistics for tests: any crate may use it as a dev-dependency, none otherwise.
const TESTKIT: &str = "tyndall-testkit";
/// Stands outside the layers and uses none of them.
const XTASK: &str = "xtask";

/// An arrow `from -> to`, as `cargo metadata` tells it.
#[derive(Debug, PartialEq, Eq)]
struct Arrow {
    from: String,
    to: String,
    dev: bool,
}

/// Checks arrows and file sizes.
pub fn check() -> Result<Findings, String> {
    let metadata =
        workspace::output(workspace::cargo().args(["metadata", "--no-deps", "--format-version", "1"]))?;
    let metadata: Value =
        serde_json::from_str(&metadata).map_err(|error| format!("cargo metadata: {error}"))?;
    let (names, arrows) = read(&metadata)?;
    println!("layers: {} crates, {} arrows between them", names.len(), arrows.len());
    let mut findings: Findings = names.iter().filter_map(|name| unknown(name)).collect();
    findings.extend(arrows.iter().filter_map(wrong));
    findings.extend(sizes::check()?);
    Ok(findings)
}

/// The workspace's crates and the arrows between them.
fn read(metadata: &Value) -> Result<(Vec<String>, Vec<Arrow>), String> {
    let packages = metadata["packages"].as_array().ok_or("cargo metadata lists no packages")?;
    let name = |value: &Value| value["name"].as_str().unwrap_or_default().to_owned();
    let names: Vec<String> = packages.iter().map(name).collect();
    let mut arrows = Vec::new();
    for package in packages {
        let dependencies =
            package["dependencies"].as_array().ok_or("a package without a list of dependencies")?;
        arrows.extend(dependencies.iter().filter(|dependency| names.contains(&name(dependency))).map(
            |dependency| Arrow {
                from: name(package),
                to: name(dependency),
                dev: dependency["kind"] == "dev",
            },
        ));
    }
    Ok((names, arrows))
}

fn level(name: &str) -> Option<u32> {
    LEVELS.iter().find(|(crate_name, _)| *crate_name == name).map(|&(_, level)| level)
}

fn unknown(name: &str) -> Option<String> {
    let known = name == XTASK || level(name).is_some();
    (!known).then(|| format!("{name}: has no level; give it one in xtask/src/layers.rs and ARCHITECTURE.md"))
}

fn wrong(arrow: &Arrow) -> Option<String> {
    let Arrow { from, to, dev } = arrow;
    if to == TESTKIT {
        return (!dev).then(|| format!("{from} -> {to}: the test kit may only be a dev-dependency"));
    }
    let (from_level, to_level) = (level(from)?, level(to)?);
    (to_level >= from_level).then(|| {
        format!(
            "{from} (level {from_level}) -> {to} (level {to_level}): an arrow must lead to a smaller level"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arrow(from: &str, to: &str, dev: bool) -> Arrow {
        Arrow { from: from.into(), to: to.into(), dev }
    }

    #[test]
    fn arrows_lead_down() {
        assert_eq!(wrong(&arrow("tyndall-film", "tyndall-spectral", false)), None);
        assert_eq!(wrong(&arrow("tyndall-film", "tyndall-spectral", true)), None);
        assert!(wrong(&arrow("tyndall-film", "tyndall-scatter", false)).is_some(), "same level");
        assert!(wrong(&arrow("tyndall-base", "tyndall-film", false)).is_some(), "upwards");
        assert!(wrong(&arrow("tyndall-base", "tyndall-film", true)).is_some(), "upwards, for tests");
    }

    #[test]
    fn the_test_kit_is_for_tests() {
        assert_eq!(wrong(&arrow("tyndall-base", TESTKIT, true)), None);
        assert!(wrong(&arrow("tyndall-cli", TESTKIT, false)).is_some());
    }

    #[test]
    fn every_crate_needs_a_level() {
        assert_eq!(unknown("tyndall-io"), None);
        assert!(unknown("tyndall-new").is_some());
    }

    #[test]
    fn reads_what_cargo_tells() {
        let metadata = serde_json::json!({"packages": [
            {"name": "a", "dependencies": [{"name": "b", "kind": "dev"}, {"name": "serde", "kind": null}]},
            {"name": "b", "dependencies": []},
        ]});
        let (names, arrows) = read(&metadata).expect("well formed");
        assert_eq!(names, ["a", "b"]);
        assert_eq!(arrows, [arrow("a", "b", true)]);
    }
}
