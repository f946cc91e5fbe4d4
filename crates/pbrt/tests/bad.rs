//! Every scene in `tests/bad` gives the message in the text file beside it.
//!
//! `TYNDALL_BLESS=1 cargo test -p tyndall-pbrt --test bad` writes the messages anew; read them before committing.

#![allow(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

use std::fs;
use std::path::{Path, PathBuf};

use tyndall_pbrt::{Error, Parser, Scene};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join("bad")
}

/// Parses under the file's bare name, so that messages do not depend on where the project lies.
fn parse(path: &Path) -> Result<Scene, Error> {
    let name = path.file_name().unwrap().to_str().unwrap();
    Parser::from_bytes(name, fs::read(path).unwrap(), &folder())?.parse()
}

fn message(error: &Error) -> String {
    let folder = format!("{}{}", folder().display(), std::path::MAIN_SEPARATOR);
    error.plain().replace(&folder, "") + "\n"
}

fn scenes() -> Vec<PathBuf> {
    let entries = fs::read_dir(folder()).unwrap().map(|e| e.unwrap().path());
    let mut scenes: Vec<_> = entries.filter(|p| p.extension().is_some_and(|e| e == "pbrt")).collect();
    scenes.sort();
    scenes
}

#[test]
fn messages() {
    let bless = std::env::var_os("TYNDALL_BLESS").is_some();
    let mut wrong = Vec::new();
    for path in scenes() {
        let got = message(&parse(&path).expect_err(&path.display().to_string()));
        let expected = path.with_extension("txt");
        if bless {
            fs::write(&expected, &got).unwrap();
        } else if fs::read_to_string(&expected).unwrap_or_default().replace("\r\n", "\n") != got {
            wrong.push(format!("{}:\n{got}", path.display()));
        }
    }
    assert!(scenes().len() > 50, "the scenes are there");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Every message names the file, and where it has a place, line and column too.
#[test]
fn messages_name_the_place() {
    for path in scenes() {
        let error = parse(&path).unwrap_err();
        let name = path.file_name().unwrap().to_str().unwrap();
        let line = error.to_string();
        if let Some(at) = error.location() {
            assert!(line.starts_with(&at.to_string()), "{line}");
        } else {
            assert!(line.starts_with(name), "{line}");
        }
        assert!(!error.kind().to_string().contains('\n'));
    }
}

/// The report with the source line comes out for every error, whatever bytes are in the file.
#[test]
fn reports_render() {
    for path in scenes() {
        let error = parse(&path).unwrap_err();
        let message = error.kind().to_string();
        let handler = miette::GraphicalReportHandler::new_themed(miette::GraphicalTheme::none());
        let mut report = String::new();
        handler.render_report(&mut report, &error).unwrap();
        assert!(report.replace(['\n', ' ', '│'], "").contains(&message[..8].replace(' ', "")), "{report}");
    }
}
