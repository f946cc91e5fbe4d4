//! Writes the scenes out, so that other renderers can be run on them.

use super::{Case, Dialect, Family, case::Measured};
use crate::Error;
use std::{fmt::Write as _, path::Path};
use tyndall_files::atomic::write_bytes_atomic;

/// What was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Written {
    /// Scenes.
    pub scenes: usize,
    /// Those among them that pbrt-v4 reads too.
    pub plain: usize,
}

/// Writes `DIR/FAMILY/CASE.pbrt`, in the plain format of pbrt-v4 where that can say it, and `DIR/expected.csv`.
///
/// # Errors
/// When a folder or file cannot be written.
pub fn write(dir: &Path, families: &[&'static Family]) -> Result<Written, Error> {
    let mut written = Written { scenes: 0, plain: 0 };
    let mut table =
        String::from("scene,plain pbrt-v4,quantity,from_nm,to_nm,known,expected,uncertainty,offset,factor\n");
    for family in families {
        let folder = dir.join(family.name);
        std::fs::create_dir_all(&folder).map_err(|e| folder_error(&folder, &e))?;
        for (plain, own) in (family.cases)(Dialect::Pbrt).iter().zip((family.cases)(Dialect::Own)) {
            let why = plain.beyond_pbrt();
            let case = if why.is_none() { plain } else { &own };
            let name = format!("{}.pbrt", file_name(&case.name));
            let text = format!("{}{}", remarks(family, case, why), case.text);
            write_bytes_atomic(&folder.join(&name), text.as_bytes())?;
            rows(&mut table, &format!("{}/{name}", family.name), case, why.is_none());
            written.scenes += 1;
            written.plain += usize::from(why.is_none());
        }
    }
    write_bytes_atomic(&dir.join("expected.csv"), table.as_bytes())?;
    Ok(written)
}

fn folder_error(folder: &Path, e: &std::io::Error) -> Error {
    Error::options(
        format!("{}: cannot make the folder: {e}", folder.display()),
        Some("name another by --scene-dir".into()),
    )
}

/// A name that every file system takes.
fn file_name(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() || ".=-".contains(c) { c } else { '_' }).collect()
}

fn remarks(family: &Family, case: &Case, why: Option<&str>) -> String {
    let format = why.map_or_else(
        || "# plain pbrt-v4".to_owned(),
        |why| format!("# beyond pbrt-v4: {why}; parameters of tyndall's own are listed in its manual"),
    );
    let quantity = match case.measured {
        Measured::Bands => "each band of the spectral film",
        Measured::Xyz => "X, Y, Z with light of Y = 1",
    };
    format!(
        "# {}: {}\n# known: {}\n{format}\n# range {} to {} nm; by tyndall: --range {}:{}\n\
         # answer = {} + {} x (mean over the image of {quantity}); expected.csv lists the answers\n",
        family.title,
        case.name,
        family.source,
        case.range.min,
        case.range.max,
        case.range.min,
        case.range.max,
        case.offset,
        case.factor
    )
}

fn rows(table: &mut String, scene: &str, case: &Case, plain: bool) {
    let edges = case.bands.edges();
    for (i, (label, expected)) in case.labels.iter().zip(&case.expected).enumerate() {
        let (quantity, from, to) = match case.measured {
            Measured::Bands => ("band", edges[i], edges[i + 1]),
            Measured::Xyz => (["X", "Y", "Z"][i], case.range.min, case.range.max),
        };
        // writing to a string cannot fail
        let _ = writeln!(
            table,
            "\"{scene}\",{plain},{quantity},{from},{to},\"{label}\",{expected:e},{:e},{},{}",
            case.uncertainty, case.offset, case.factor
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Options, Source, load, validate::FAMILIES};

    /// Whatever is written can be read again over the range that it tells.
    #[test]
    fn scenes_load_in_both_dialects() {
        for family in &FAMILIES {
            for dialect in [Dialect::Own, Dialect::Pbrt] {
                let cases = (family.cases)(dialect);
                let plain = |c: &&Case| dialect == Dialect::Own || c.beyond_pbrt().is_none();
                for case in cases.iter().filter(plain) {
                    let options = Options { range: case.range, ..Options::default() };
                    let loaded = load(Source::Text(&case.name, &case.text, Path::new("")), &options);
                    assert!(loaded.is_ok(), "{}: {}: {:?}", family.name, case.name, loaded.err());
                }
            }
        }
    }
}
