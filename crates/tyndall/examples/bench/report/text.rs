//! The report as Markdown.

use super::{Report, machine, tables};

/// All tables.
pub fn markdown(report: &Report) -> String {
    let mut out = format!("# Benchmark\n\n{}\n", about());
    for s in tables::sections(report) {
        out += &format!("\n## {}\n\n{}\n\n", s.title, s.about);
        out += &format!("| {} |\n|{}\n", s.header.join(" | "), "---|".repeat(s.header.len()));
        s.rows.iter().for_each(|row| out += &format!("| {} |\n", row.join(" | ")));
    }
    out
}

/// What it was measured on.
pub fn about() -> String {
    let m = machine();
    let mut text = format!(
        "Tyndall {} on {}, {} threads.",
        m["version"].as_str().unwrap_or_default(),
        m["processor"].as_str().unwrap_or("a processor of unknown name"),
        m["threads"]
    );
    if m["checked"] == true {
        text += " Built with debug assertions: OUR FIGURES ARE NOT THOSE OF A RELEASE BUILD.";
    }
    text
}
