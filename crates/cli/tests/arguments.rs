//! The program's arguments, as a shell sees them: exit codes, streams, texts.

use assert_cmd::Command;
use assert_cmd::assert::Assert;

fn tyndall(line: &str) -> Assert {
    Command::cargo_bin("tyndall").expect("built beside the tests").args(line.split_whitespace()).assert()
}

fn stdout(assert: &Assert) -> String {
    String::from_utf8_lossy(&assert.get_output().stdout).into_owned()
}

fn stderr(assert: &Assert) -> String {
    String::from_utf8_lossy(&assert.get_output().stderr).into_owned()
}

#[test]
fn help_is_no_error() {
    for line in ["", "--help", "-h", "help", "help render", "render --help", "merge -h", "--version"] {
        let assert = tyndall(line).code(0);
        assert!(!stdout(&assert).is_empty() && stderr(&assert).is_empty(), "{line}");
    }
    assert!(stdout(&tyndall("--version")).contains(env!("CARGO_PKG_VERSION")));
}

#[test]
fn help_tells_about_the_command() {
    let help = stdout(&tyndall("render --help"));
    for text in
        ["Render a scene", "Output:", "Light:", "Work:", "Messages:", "Examples:", "[default: the scene's]"]
    {
        assert!(help.contains(text), "{text}\n{help}");
    }
    assert!(!help.contains("How the work is done"), "a text of the source, not for users");
    assert!(stdout(&tyndall("")).contains("render"), "the commands are listed");
}

#[test]
fn bad_arguments_end_with_two() {
    for line in [
        "nonsense",
        "--nonsense",
        "render --spp 0",
        "render --time 90",
        "render --resolution 0x5",
        "render a.pbrt b.pbrt",
        "render --shard 1/2 --time 5s",
        "render -o picture.jpg",
        "merge",
        "diff a.exr",
        "completions nonsense",
    ] {
        let assert = tyndall(line).code(2);
        assert!(stderr(&assert).starts_with("error: "), "{line}: {}", stderr(&assert));
        assert!(stdout(&assert).is_empty(), "{line}");
    }
}

#[test]
fn errors_say_what_was_expected() {
    let error = stderr(&tyndall("render --time 90"));
    assert!(error.contains("90s, 5m or 1h30m") && error.contains("`90` without a unit"), "{error}");
    let error = stderr(&tyndall("render --shard 1/2 --time 5s"));
    assert!(error.contains("hint: give all shards the same --spp"), "{error}");
}

#[test]
fn completions_for_every_shell() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = stdout(&tyndall(&format!("completions {shell}")).code(0));
        assert!(script.contains("tyndall") && script.contains("wavelength-pdf"), "{shell}");
    }
}
