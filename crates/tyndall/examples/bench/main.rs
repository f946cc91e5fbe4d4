//! What the benchmark measures and how it reports; `cargo xtask bench` runs it stage by stage and sets other renderers
//! beside it.
//!
//! `bench STAGE FOLDER [--quick] [--full] [--seeds N] [--scene NAME]... [--program PATH] [--against FILE]`: each stage
//! appends lines of JSON to `FOLDER/measured.jsonl`; `report` turns them into `bench.json`, `bench.md` and `bench.html`.
//!
//! Efficiency is `E = 1 / (MSE_Y x CPU seconds)`, with MSE_Y the variance of pixel luminances over seeds. The headline
//! leaves out the pixels that see a lamp, and their neighbours: the lamp's rim holds half of the error of a picture
//! whose rest is what one looks at.

mod agree;
mod counts;
mod efficiency;
mod generate;
mod growth;
mod inner;
mod mask;
mod measure;
mod pbrt;
mod process;
mod program;
mod report;
mod scenes;
mod setup;
mod store;
mod techniques;
mod variants;

use setup::Setup;
use std::process::ExitCode;

/// What a stage does.
type Stage = fn(&Setup) -> Result<(), String>;

/// The stages by name.
const STAGES: [(&str, Stage); 10] = [
    ("scenes", |s| generate::all(&s.scene_folder())),
    ("ours", measure::defaults),
    ("techniques", techniques::all),
    ("pbrt", pbrt::measure),
    ("start", program::starts),
    ("threads", program::threads),
    ("growth", growth::all),
    ("inner", inner::times),
    ("counts", counts::all),
    ("report", report::all),
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &[String]) -> Result<(), String> {
    let names = || STAGES.map(|(name, _)| name).join(", ");
    let (stage, rest) = arguments
        .split_first()
        .ok_or_else(|| format!("bench STAGE FOLDER ...\nhint: the stages are {}", names()))?;
    if stage == "count-one" {
        let [folder, index, calls] = rest else { return Err("count-one FOLDER INDEX CALLS".into()) };
        let number = |text: &String| text.parse::<u32>().map_err(|e| format!("`{text}`: {e}"));
        return counts::one(
            &Setup::parse(std::slice::from_ref(folder))?,
            number(index)? as usize,
            number(calls)?,
        );
    }
    let known = STAGES.iter().find(|(name, _)| name == stage);
    let (_, action) = known.ok_or_else(|| format!("no stage `{stage}`\nhint: the stages are {}", names()))?;
    action(&Setup::parse(rest)?)
}
