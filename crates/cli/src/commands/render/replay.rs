//! `tyndall render --pixel x,y --sample k --trace`: one path, its vertices printed.

use std::fmt::Write;

use tyndall::trace::{Step, Trace};
use tyndall::{Plan, trace};

use super::super::print;
use crate::args::value::Pixel;
use crate::args::{LogArgs, LogFormat};
use crate::exit::Failure;

/// Prints the path, as JSON with `--log json`.
pub fn run(plan: &Plan, pixel: Pixel, sample: u32, log: &LogArgs) -> Result<(), Failure> {
    let bounds = plan.job.film.bounds;
    if !bounds.contains(pixel.x, pixel.y) {
        let (x1, y1) = (bounds.x1 - 1, bounds.y1 - 1);
        return Err(Failure::input(
            format!("--pixel {pixel}: expected a pixel from {},{} to {x1},{y1}", bounds.x0, bounds.y0),
            Some("pixels count from 0 at the upper left"),
        ));
    }
    let trace = trace(plan, pixel.x, pixel.y, sample);
    if log.log == LogFormat::Json { print::json(&trace) } else { print::text(&text(&trace)) }
}

fn text(trace: &Trace) -> String {
    let mut out = String::new();
    // writing to a string cannot fail
    let _ = write_all(trace, &mut out);
    out
}

fn write_all(t: &Trace, out: &mut String) -> std::fmt::Result {
    writeln!(out, "pixel {},{} sample {}", t.pixel[0], t.pixel[1], t.sample)?;
    writeln!(out, "lambda [nm]    {}", row(&t.lambda_nm))?;
    writeln!(out, "pdf [1/nm]     {}", row(&t.pdf))?;
    for step in &t.steps {
        write_step(step, out)?;
    }
    writeln!(out, "radiance       {}", row(&t.radiance))?;
    let film: Vec<String> = t.film.iter().map(|(name, v)| format!("{name} {v:.6e}")).collect();
    writeln!(out, "film           {}", film.join("  "))
}

fn write_step(step: &Step, out: &mut String) -> std::fmt::Result {
    match step {
        Step::Light { order, value } => writeln!(out, "+ light of order {order}  {}", row(value)),
        Step::Vertex { event, p, n, distance, depth, medium, albedo, throughput } => {
            let medium = medium.as_deref().map_or_else(|| "vacuum".into(), |m| format!("\"{m}\""));
            writeln!(out, "{event}  depth {depth}, {distance} m through {medium}")?;
            writeln!(out, "  p [m]        {} {} {}", p[0], p[1], p[2])?;
            if let Some(n) = n {
                writeln!(out, "  n            {} {} {}", n[0], n[1], n[2])?;
            }
            writeln!(out, "  albedo       {}", row(albedo))?;
            writeln!(out, "  throughput   {}", row(throughput))
        }
    }
}

fn row(values: &[f32]) -> String {
    values.iter().map(|v| format!("{v:>12.6e}")).collect::<Vec<_>>().join(" ")
}
