//! `tyndall diff`.

use std::fmt::Write;

use tyndall::Image;
use tyndall::diff::{ChannelDiff, Diff, DiffOptions, Verdict, diff};

use super::print;
use crate::args::DiffArgs;
use crate::exit::Failure;

/// Compares two images and prints what came of it.
pub fn run(args: &DiffArgs) -> Result<(), Failure> {
    let (a, b) = (Image::read(&args.a)?, Image::read(&args.b)?);
    let options = DiffOptions { block: args.block as usize, alpha: args.alpha, scale: args.scale };
    let found = diff(&a, &b, &options)?;
    if args.json {
        print::json(&found)?;
    } else {
        print::text(&table(&found))?;
    }
    match found.verdict {
        Verdict::Differ if args.exit_code => Err(Failure::Disagreement),
        Verdict::Unknown if args.exit_code => Err(Failure::input(
            "no standard errors are known, so there is no verdict",
            Some("put NAME.error.exr beside an image, or compare films"),
        )),
        _ => Ok(()),
    }
}

fn table(d: &Diff) -> String {
    let mut out = String::new();
    // writing to a string cannot fail
    let _ = write_table(d, &mut out);
    out
}

fn write_table(d: &Diff, out: &mut String) -> std::fmt::Result {
    let width = d.channels.iter().map(|c| c.name.len()).max().unwrap_or(0).max(7);
    writeln!(
        out,
        "{:width$} {:>13} {:>13} {:>11} {:>11} {:>11} {:>9}",
        "channel", "mean A", "mean B", "MSE", "RMSE", "relMSE", "bias %"
    )?;
    for c in &d.channels {
        let bias = c.bias.map_or_else(|| "-".into(), |b| format!("{:.3}", 100.0 * b));
        writeln!(
            out,
            "{:width$} {:>13.6e} {:>13.6e} {:>11.4e} {:>11.4e} {:>11.4e} {bias:>9}",
            c.name, c.mean_a, c.mean_b, c.mse, c.rmse, c.rel_mse
        )?;
    }
    if d.channels.iter().any(|c| c.tests.is_some()) {
        writeln!(
            out,
            "\n{:width$} {:>9} {:>9} {:>7} {:>9} {:>9} {:>11} {:>7}",
            "channel", "t", "p", "blocks", "worst t", "p", "at", "rms t"
        )?;
        d.channels.iter().try_for_each(|c| write_tests(c, width, out))?;
    }
    for c in d.channels.iter().filter(|c| c.non_finite > 0) {
        writeln!(out, "{}: {} pixels are not finite and were left out", c.name, c.non_finite)?;
    }
    write_marks("one sample dominates the error of", d.dominated, out)?;
    write_marks("errors are pooled over tiles in", d.pooled, out)?;
    if !d.left_out.is_empty() {
        writeln!(out, "in one image only, not compared: {}", d.left_out.join(" "))?;
    }
    writeln!(out, "\n{}", verdict(d))
}

/// `one sample dominates the error of 12 pixels of A, 3 of B`.
fn write_marks(what: &str, [a, b]: [Option<u64>; 2], out: &mut String) -> std::fmt::Result {
    let (a, b) = (a.unwrap_or(0), b.unwrap_or(0));
    if a + b == 0 { Ok(()) } else { writeln!(out, "{what} {a} pixels of A, {b} of B") }
}

fn write_tests(c: &ChannelDiff, width: usize, out: &mut String) -> std::fmt::Result {
    let Some(t) = &c.tests else { return Ok(()) };
    let at = format!("{},{}", t.worst_at[0], t.worst_at[1]);
    let mark = if t.rejected { " *" } else { "" };
    writeln!(
        out,
        "{:width$} {:>9.3} {:>9.2e} {:>7} {:>9.3} {:>9.2e} {at:>11} {:>7.3}{mark}",
        c.name, t.t, t.p, t.blocks, t.worst_t, t.worst_p, t.rms_t
    )
}

fn verdict(d: &Diff) -> String {
    let level = format!("at level {} over all tests together", d.alpha);
    let whose = match d.errors {
        [true, true] => "",
        [true, false] => "; B counts as exact, its errors are not known",
        _ => "; A counts as exact, its errors are not known",
    };
    match d.verdict {
        Verdict::Identical => "identical, bit for bit".into(),
        Verdict::Agree => format!("agree {level}{whose}"),
        Verdict::Differ => format!("differ {level}{whose} (channels marked *)"),
        Verdict::Unknown => {
            "no verdict: no standard errors are known (NAME.error.exr beside an image)".into()
        }
    }
}
