//! Files of phase functions: `"string phase" "tabulated" "string phasetable" "FILE"`.
//!
//! Text; `#` begins a comment. The first row is `theta` (degrees) or `cos`, then the wavelengths \[nm\], ascending; without
//! wavelengths the one column serves all. Every further row is an angle, from 0 to 180 or from -1 to 1 ascending, then
//! one value of `p` for each wavelength. Each column is normalised to 1 or to 4 pi over the sphere.

use super::{
    context::{Context, at, refuse},
    spectrum,
};
use std::path::Path;
use tyndall_pbrt::{Error, ParamSet};
use tyndall_scatter::phase::Tabulated;
use tyndall_spectral::range::Outside;

/// Numbers in a file at most: 10^7, which is 80 MB of memory.
const MOST_NUMBERS: usize = 10_000_000;

/// The table that the directive names.
pub fn table(ctx: &Context<'_>, params: &ParamSet) -> Result<Tabulated, Error> {
    let Some(name) = params.string_opt("phasetable")? else {
        return Err(params.missing("string", "phasetable"));
    };
    let path = ctx.file(params, "phasetable", name)?;
    let shown = path.display();
    let text = std::fs::read_to_string(&path)
        .map_err(|e| params.error(format!("phasetable: cannot read {shown}: {e}")))?;
    let columns = parse(&path, &text).map_err(|e| params.error(format!("phasetable: {e}")))?;
    let outside = match spectrum::outside(params, Outside::Error)? {
        Outside::Zero => {
            let expected = "must be \"hold\" for a phase function: none scatters nowhere";
            return Err(refuse(params, "extrapolate", expected, "\"zero\""));
        }
        // one column without a wavelength holds everywhere
        _ if columns.everywhere => Outside::Hold,
        rule => rule,
    };
    let made = columns.build(outside).map_err(|e| at(params, format!("{shown}: {e}")))?;
    let gap = made.check_range(ctx.range).map_err(|e| {
        let hint = "give columns over the whole range, or \"string extrapolate\" \"hold\"";
        params.error(format!("phasetable: {shown}: {e}")).hint(hint)
    })?;
    match gap {
        Some(gap) if !columns.everywhere && !params.contains("extrapolate") => {
            params.warn_at("phasetable", format!("{shown}: {gap}"), ctx.warnings);
        }
        _ => {}
    }
    Ok(made)
}

/// A file's rows and columns.
#[derive(Debug)]
struct Columns {
    cosines: bool,
    everywhere: bool,
    lambda: Vec<f32>,
    angles: Vec<f64>,
    /// By wavelength, then by angle.
    values: Vec<f64>,
}

impl Columns {
    fn build(&self, outside: Outside) -> Result<Tabulated, tyndall_scatter::ScatterError> {
        let make = if self.cosines { Tabulated::from_cosines } else { Tabulated::from_degrees };
        make(&self.lambda, &self.angles, &self.values, outside)
    }
}

fn parse(path: &Path, text: &str) -> Result<Columns, String> {
    let mut rows = text
        .lines()
        .enumerate()
        .map(|(i, line)| (i + 1, line.split('#').next().unwrap_or_default()))
        .map(|(i, line)| (i, words(line).collect::<Vec<_>>()))
        .filter(|(_, words)| !words.is_empty());
    let place = |row: usize| format!("{}:{row}", path.display());
    let Some((first, head)) = rows.next() else {
        return Err(format!("{}: the file has no rows", path.display()));
    };
    let cosines = match head[0] {
        "theta" => false,
        "cos" => true,
        other => {
            return Err(format!("{}: expected \"theta\" or \"cos\" first, got \"{other}\"", place(first)));
        }
    };
    let number = |row: usize, word: &str| {
        let value = word.parse::<f64>().ok().filter(|v| v.is_finite());
        value.ok_or_else(|| format!("{}: expected a number, got \"{word}\"", place(row)))
    };
    let mut lambda =
        head[1..].iter().map(|w| number(first, w).map(|v| v as f32)).collect::<Result<Vec<_>, _>>()?;
    let everywhere = lambda.is_empty();
    if everywhere {
        lambda.push(550.0);
    }
    let (mut angles, mut table) = (Vec::new(), Vec::new());
    for (row, words) in rows {
        if words.len() != lambda.len() + 1 {
            let expected = lambda.len() + 1;
            return Err(format!("{}: expected {expected} numbers, got {}", place(row), words.len()));
        }
        if table.len() >= MOST_NUMBERS {
            return Err(format!("{}: more than {MOST_NUMBERS} numbers", place(row)));
        }
        angles.push(number(row, words[0])?);
        for word in &words[1..] {
            table.push(number(row, word)?);
        }
    }
    let n = lambda.len();
    let values =
        (0..n).flat_map(|k| (0..angles.len()).map(move |j| (k, j))).map(|(k, j)| table[j * n + k]).collect();
    Ok(Columns { cosines, everywhere, lambda, angles, values })
}

fn words(line: &str) -> impl Iterator<Item = &str> {
    line.split(|c: char| c.is_whitespace() || c == ',').filter(|w| !w.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn read(text: &str) -> Result<Tabulated, String> {
        let columns = parse(Path::new("fog.txt"), text)?;
        columns.build(Outside::Hold).map_err(|e| e.to_string())
    }

    #[test]
    fn both_norms_and_both_axes() {
        let mean = |t: &str| read(t).unwrap().mean_cosine(500.0);
        // p = (1 + cos) / 4 pi, and the same times 4 pi
        let degrees: String = (0..=1800)
            .map(|i| f64::from(i) / 10.0)
            .map(|t| format!("{t} {}\n", 1.0 + t.to_radians().cos()))
            .collect();
        assert!((mean(&format!("theta 500\n{degrees}")) - 1.0 / 3.0).abs() < 1e-4);
        let unit = 0.25 / std::f64::consts::PI;
        let text = format!("# a comment\ncos, 400, 600\n-1, 0, {unit}\n1, {}, {unit} # linear\n", 2.0 * unit);
        assert!((read(&text).unwrap().mean_cosine(400.0) - 1.0 / 3.0).abs() < 1e-6);
        assert!((mean(&text) - 1.0 / 6.0).abs() < 1e-6);
        assert!(mean("cos\n-1 1\n1 1\n").abs() < 1e-6);
    }

    #[test]
    fn mistakes_are_named() {
        for (text, told) in [
            ("", "no rows"),
            ("angle 500\n", "fog.txt:1: expected \"theta\" or \"cos\""),
            ("theta 500\n0 1 2\n", "fog.txt:2: expected 2 numbers, got 3"),
            ("theta 500\n0 x\n", "fog.txt:2: expected a number, got \"x\""),
            ("cos 500\n-1 1\n1 2\n", "500"),
            ("cos 500\n-1 1\n0.5 1\n", "cosine"),
        ] {
            let e = read(text).map(|_| ()).unwrap_err();
            assert!(e.contains(told), "{text:?}: {e}");
        }
    }

    proptest! {
        #[test]
        fn nothing_panics(text in "(theta|cos)?[ 0-9.e#,\n-]{0,200}") {
            let _ = read(&text);
        }

        /// A sound table with pieces changed: what is read is a phase function.
        #[test]
        fn changed_tables_are_refused_or_sound(
            edits in prop::collection::vec((any::<prop::sample::Index>(), 0..4usize, 0..9usize), 1..5),
        ) {
            let mut text = String::from("cos, 400, 600\n-1, 0, 1 # back\n0 1 1\n0.5 1.5 1\n1, 2, 1\n");
            for (at, cut, piece) in edits {
                let start = at.index(text.len());
                let end = (start + cut).min(text.len());
                let piece = ["0", "-", "9", "1e30", "nan", " ", "\n", "#", "1e-40"][piece];
                text.replace_range(start..end, piece);
            }
            if let Ok(table) = read(&text) {
                let g = table.mean_cosine(500.0);
                prop_assert!(g.abs() <= 1.001, "{text:?}: {g}");
            }
        }
    }
}
