//! `tyndall info`.

use std::collections::BTreeMap;
use std::fmt::Write;

use tyndall::info::{Info, MediumInfo, ParameterInfo, info};
use tyndall::load;

use super::{print, scene};
use crate::args::{InfoArgs, LogArgs};
use crate::exit::Failure;
use crate::log::Console;

/// Tells what is in a scene.
pub fn run(args: &InfoArgs, log: &LogArgs, console: &Console) -> Result<(), Failure> {
    let options = scene::reading(&args.reading)?;
    let loaded = load(scene::source(args.scene.as_deref()), &options)?;
    scene::tell(&loaded.diagnostics.to_vec(), args.reading.strict, log, console)?;
    let info = info(&loaded, options.range);
    if args.json { print::json(&info) } else { print::text(&text(&info)) }
}

fn text(info: &Info) -> String {
    let mut out = String::new();
    // writing to a string cannot fail
    let _ = write_all(info, &mut out);
    out
}

fn write_all(i: &Info, out: &mut String) -> std::fmt::Result {
    writeln!(out, "scene      hash {}", i.scene_hash)?;
    writeln!(out, "units      {}, lengths in m, range {} to {} nm", i.units, i.range_nm[0], i.range_nm[1])?;
    let [w, h] = i.film.resolution;
    let [x0, y0, x1, y1] = i.film.window;
    write!(out, "film       {w} x {h} pixels, {}", i.film.colour_space)?;
    if [x0, y0, x1, y1] != [0, 0, w, h] {
        write!(out, ", window {x0},{y0} to {x1},{y1}")?;
    }
    match i.film.band_edges_nm.len() {
        0 => writeln!(out)?,
        n => writeln!(out, ", {} bands", n - 1)?,
    }
    writeln!(out, "integrator {}, {} samples per pixel", i.integrator, i.spp)?;
    write_geometry(i, out)?;
    write_media(i, out)?;
    write_lights(i, out)?;
    write_boundaries(i, out)?;
    write_parameters(&i.parameters, out)
}

fn write_geometry(i: &Info, out: &mut String) -> std::fmt::Result {
    let g = &i.geometry;
    write!(out, "geometry   {} triangles, {} other primitives", g.triangles, g.others)?;
    if g.degenerate > 0 {
        write!(out, ", {} without area left out", g.degenerate)?;
    }
    if g.instances > 0 {
        write!(out, ", {} instances", g.instances)?;
    }
    writeln!(out, ", {} materials, {:.1} MiB", g.materials, g.bytes as f64 / f64::from(1 << 20))?;
    match g.bounds {
        Some([lo, hi]) => writeln!(
            out,
            "           from ({}, {}, {}) to ({}, {}, {}) m, diagonal {} m",
            lo[0], lo[1], lo[2], hi[0], hi[1], hi[2], g.diagonal
        ),
        None => writeln!(out, "           nothing to see"),
    }
}

fn write_media(i: &Info, out: &mut String) -> std::fmt::Result {
    let camera = i.camera_medium.as_deref().map_or_else(|| "vacuum".into(), |m| format!("\"{m}\""));
    writeln!(out, "\nmedia      camera in {camera}; least to greatest value over the range")?;
    if i.media.is_empty() {
        writeln!(out, "           none")?;
    }
    i.media.iter().try_for_each(|m| write_medium(m, out))
}

fn write_medium(m: &MediumInfo, out: &mut String) -> std::fmt::Result {
    let span =
        |[low, high]: [f32; 2]| if low == high { format!("{low}") } else { format!("{low} to {high}") };
    writeln!(out, "  \"{}\" ({}){}", m.name, m.class, if m.emits { ", emits" } else { "" })?;
    writeln!(
        out,
        "    sigma_a  {} 1/m, sigma_s {} 1/m, sigma_t {} 1/m",
        span(m.sigma_a),
        span(m.sigma_s),
        span(m.sigma_t)
    )?;
    writeln!(out, "    albedo {}, mean cosine {}", span(m.albedo), span(m.mean_cosine))?;
    writeln!(out, "    optical depth {} along the diagonal of the scene", span(m.optical_depth))
}

fn write_lights(i: &Info, out: &mut String) -> std::fmt::Result {
    writeln!(out, "\nlights     {}", if i.lights.is_empty() { "none: the image will be black" } else { "" })?;
    for l in &i.lights {
        let lines = if l.lines > 0 { format!(", {} spectral lines", l.lines) } else { String::new() };
        let share = 100.0 * l.power_share;
        writeln!(out, "  {:<16} {share:6.2} % of the power, {} primitives{lines}", l.kind, l.primitives)?;
    }
    Ok(())
}

fn write_boundaries(i: &Info, out: &mut String) -> std::fmt::Result {
    let b = &i.boundaries;
    writeln!(
        out,
        "\nboundaries {} of {} crossings on {} paths contradict the medium of the path",
        b.contradictions, b.crossings, b.paths
    )?;
    let name = |n: &Option<String>| n.as_ref().map_or_else(|| "vacuum".to_owned(), |n| format!("\"{n}\""));
    for e in &b.examples {
        let [x, y, z] = e.p;
        writeln!(
            out,
            "  shape {} at ({x}, {y}, {z}): the path is in {}, the surface expects {}",
            e.shape,
            name(&e.tracked),
            name(&e.expected)
        )?;
    }
    if b.contradictions > 0 {
        writeln!(
            out,
            "  hint: look for holes, reversed normals, overlapping volumes, and the camera's MediumInterface"
        )?;
    }
    Ok(())
}

fn write_parameters(parameters: &[ParameterInfo], out: &mut String) -> std::fmt::Result {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    parameters.iter().for_each(|p| *counts.entry(&p.state).or_default() += 1);
    let counts: Vec<String> = counts.iter().map(|(state, n)| format!("{n} {state}")).collect();
    writeln!(out, "\nparameters {}", counts.join(", "))?;
    for p in parameters {
        let reason = p.reason.as_deref().map_or_else(String::new, |r| format!(": {r}"));
        writeln!(out, "  {:<12} {}: {}, \"{} {}\"{reason}", p.state, p.place, p.directive, p.kind, p.name)?;
    }
    Ok(())
}
