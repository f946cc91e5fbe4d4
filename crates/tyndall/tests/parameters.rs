//! No parameter of a scene is passed over in silence: each is consumed, ignored with a reason, or unsupported.

use std::path::Path;
use tyndall::{Options, Source, info::info, load, pbrt::ParamState};

fn check(source: Source<'_>, least: usize) {
    let loaded = load(source, &Options::default()).unwrap_or_else(|e| panic!("{e}"));
    let unread: Vec<String> = loaded
        .inventory
        .iter()
        .filter(|p| p.state() == ParamState::Unread)
        .map(|p| format!("{}: {} \"{} {}\"", loaded.sources.location(p.span), p.owner, p.kind, p.name))
        .collect();
    assert!(unread.is_empty(), "nobody asked for\n{}", unread.join("\n"));
    assert!(loaded.inventory.len() >= least, "only {} parameters", loaded.inventory.len());
    let told = info(&loaded, Options::default().range);
    assert_eq!(told.parameters.len(), loaded.inventory.len());
    for p in told.parameters.iter().filter(|p| p.state != "consumed") {
        assert!(p.reason.as_ref().is_some_and(|r| !r.is_empty()), "{}: {} without a reason", p.place, p.name);
    }
}

#[test]
fn of_the_built_in_scene() {
    check(Source::BuiltIn, 30);
}

#[test]
fn of_one_of_everything() {
    check(Source::File(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/scenes/gallery.pbrt"))), 90);
}
