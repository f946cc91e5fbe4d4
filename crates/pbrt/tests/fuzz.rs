//! No input makes the parser panic, and what it accepts it writes back and reads again as the same.

#![allow(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

use std::path::Path;

use proptest::prelude::*;
use tyndall_pbrt::{DirectiveKind, Error, ParamSet, Parser, Scene, to_text};

fn parse(bytes: Vec<u8>) -> Result<Scene, Error> {
    Parser::from_bytes("fuzz", bytes, Path::new("/nowhere"))?.fragment().parse()
}

/// Parses; renders the error or checks the round trip; uses every getter on every parameter.
fn exercise(bytes: Vec<u8>) {
    match parse(bytes) {
        Ok(scene) => {
            let text = to_text(&scene.directives);
            let again = parse(text.clone().into_bytes());
            let again = again.unwrap_or_else(|e| panic!("{e}\n{text}"));
            assert_eq!(again.directives, scene.directives, "{text}");
            scene.directives.iter().for_each(|d| match &d.kind {
                DirectiveKind::Entity(e) => read_all(&e.params),
                DirectiveKind::Texture(t) => read_all(&t.params),
                DirectiveKind::Attribute(_, params) => read_all(params),
                _ => {}
            });
            scene.diagnostics.to_vec().iter().for_each(|d| render(d));
        }
        Err(error) => {
            assert!(!error.plain().is_empty());
            render(&error);
        }
    }
}

fn render(report: &dyn miette::Diagnostic) {
    let handler = miette::GraphicalReportHandler::new_themed(miette::GraphicalTheme::unicode_nocolor());
    handler.render_report(&mut String::new(), report).unwrap();
}

/// Every getter answers or errs, and errors have a place.
fn read_all(params: &ParamSet) {
    let located =
        |result: Result<(), Error>| result.err().iter().for_each(|e| assert!(e.location().is_some()));
    for param in params.iter() {
        let name = &*param.info.name;
        located(params.float(name, 0.0).map(|_| ()));
        located(params.integer(name, 0).map(|_| ()));
        located(params.bool(name, false).map(|_| ()));
        located(params.string(name, "").map(|_| ()));
        located(params.floats(name).map(|_| ()));
        located(params.point3s(name).map(|_| ()));
        located(params.point2_opt(name).map(|_| ()));
        located(params.spectra(name).map(|_| ()));
        located(params.float_or_texture(name).map(|_| ()));
        located(params.spectrum_or_texture(name).map(|_| ()));
        render(&params.error_at_index(name, 3, "must be", "not"));
    }
    assert!(params.unused().len() <= params.len());
}

/// Pieces of scenes, sound and unsound.
const PIECES: &[&str] = &[
    "WorldBegin",
    "AttributeBegin",
    "AttributeEnd",
    "TransformBegin",
    "ObjectBegin",
    "ObjectEnd",
    "ObjectInstance",
    "Shape",
    "Camera",
    "Texture",
    "Attribute",
    "\"shape\"",
    "\"float\"",
    "\"spectrum\"",
    "\"imagemap\"",
    "\"sphere\"",
    "\"float radius\"",
    "\"integer n\"",
    "\"point3 P\"",
    "\"rgb L\"",
    "\"spectrum eta\"",
    "\"blackbody T\"",
    "\"bool b\"",
    "\"string s\"",
    "\"texture t\"",
    "\"normal N\"",
    "\"\"",
    "\"a\\\"b\\w\\n\"",
    "[",
    "]",
    "1",
    "-2.5",
    "3e7",
    "1e-30",
    "0x1F",
    "2147483648",
    "nan",
    "true",
    "\"true\"",
    "false",
    "#c\n",
    "\n",
    "\r\n",
    "\t",
    "Include",
    "Import",
    "Identity",
    "Translate",
    "Rotate",
    "LookAt",
    "Transform",
    "ActiveTransform",
    "All",
    "EndTime",
    "MediumInterface",
    "\"fog\"",
    "Option",
    "ColorSpace",
    "CoordinateSystem",
    "ReverseOrientation",
    "WorldEnd",
    "Wörld",
    "\u{0}",
    "\\",
    "\"",
];

const SCENE: &str = include_str!("good/everything.pbrt");

/// One change to a text: at a fraction of its length, cut some bytes out and put a piece in.
fn mutated(edits: &[(f64, usize, usize)]) -> Vec<u8> {
    let mut bytes = SCENE.replace("Include", "# Include").replace("Import", "# Import").into_bytes();
    for &(at, cut, piece) in edits {
        let start = (at * bytes.len() as f64) as usize;
        let end = (start + cut).min(bytes.len());
        bytes.splice(start..end, PIECES[piece % PIECES.len()].bytes());
    }
    bytes
}

/// 2000, or what `PROPTEST_CASES` says.
fn cases() -> u32 {
    std::env::var("PROPTEST_CASES").map_or(2000, |n| n.parse().unwrap())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), ..ProptestConfig::default() })]

    #[test]
    fn random_bytes(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        exercise(bytes);
    }

    #[test]
    fn random_text(text in "[ -~\n\t\"\\[\\]#]{0,200}") {
        exercise(text.into_bytes());
    }

    #[test]
    fn random_pieces(pieces in prop::collection::vec(0..PIECES.len(), 0..40), glue in any::<bool>()) {
        let words: Vec<&str> = pieces.iter().map(|&i| PIECES[i]).collect();
        exercise(words.join(if glue { "" } else { " " }).into_bytes());
    }

    #[test]
    fn mutated_scenes(edits in prop::collection::vec((0.0..1.0f64, 0usize..20, 0usize..1000), 1..4)) {
        exercise(mutated(&edits));
    }

    #[test]
    fn truncated_scenes(length in 0..SCENE.len()) {
        exercise(SCENE.as_bytes()[..length].to_vec());
    }

    #[test]
    fn numbers_survive(values in prop::collection::vec(any::<f32>(), 1..100), wide in any::<f64>()) {
        let finite: Vec<f32> = values.into_iter().filter(|x| x.is_finite()).collect();
        let list: Vec<String> = finite.iter().map(|x| format!("{x:e}")).collect();
        let wide = wide % 1e30;
        let text = format!("Shape \"s\" \"float a\" [ {} ] \"float w\" {wide:e}", list.join(" "));
        let scene = parse(text.clone().into_bytes()).unwrap();
        let DirectiveKind::Entity(shape) = &scene.directives[0].kind else { panic!("a shape") };
        if let Some(read) = shape.params.floats("a").ok().flatten() {
            prop_assert_eq!(&*read, &finite[..]);
        }
        prop_assert_eq!(shape.params.float("w", 0.0).unwrap(), format!("{wide:e}").parse::<f32>().unwrap());
        exercise(text.into_bytes());
    }
}
