//! The command line of `cargo xtask bench`.

use std::path::PathBuf;

/// What `cargo xtask bench --help` prints.
pub const HELP: &str = "\
cargo xtask bench [OPTION]...

Measures Tyndall and, where they are installed, Mitsuba 3, pbrt-v4 and Embree 4 on scenes that come with the project. Writes
bench.json, bench.md and bench.html (tables and plots) into target/bench; docs/benchmarks.md tells what they mean. Everything
takes about two hours on one core; leave the machine alone meanwhile.

What to measure (default: everything):
  --quick           tiny pictures and few seeds, in minutes: shows that everything runs, its figures mean nothing
  --only A,B,...    these stages alone; results of earlier stages stay in the report. The stages, in order:
                      ours        the defaults on every scene: error, CPU time, efficiency
                      techniques  each technique switched off
                      mitsuba     Mitsuba 3 on its own copies of the scenes
                      pbrt        pbrt-v4 on the same files
                      start       time to the first pixel and peak memory, of all three
                      threads     1, 2, 4, ... threads
                      growth      cost against triangles; bytes per triangle, voxel, pixel and band
                      inner       nanoseconds of phase functions, BSDFs, wavelengths, samplers, whole samples
                      rays        rays per second, beside Embree
                      counts      instructions under callgrind
                      report      the report alone
  --inner           short for --only inner,rays
  --counts          short for --only counts
  --defaults        everything but techniques
  --scene NAME      this scene alone; may be repeated
  --seeds N         seeds for each figure (8; half of them at 256 samples per pixel)
  --full            ten million triangles, too (growth)
  --against FILE    an earlier bench.json: change of instruction counts

With what:
  --peers           install Mitsuba 3 and Embree 4 (Python wheels `mitsuba`, `numpy`, `embreex`) into target/peers first
  --built FOLDER    measure programs built before, as target/release, instead of building them
  --out FOLDER      where everything is written (target/bench)

Environment:
  TYNDALL_BENCH_PYTHON   a Python that has Mitsuba 3 (default: that of target/peers)
  TYNDALL_BENCH_EMBREE   Embree's shared library (default: that of `embreex` in target/peers)
  TYNDALL_BENCH_PBRT     pbrt-v4 (default: `pbrt` on the PATH)
  DRJIT_LIBLLVM_PATH     LLVM for Mitsuba's vectorised variants (default: Debian's LLVM 19)

What is not installed is left out, and the run says so.";

/// The stages, in order; `scenes` and `report` always run.
pub const STAGES: [&str; 11] = [
    "ours",
    "techniques",
    "mitsuba",
    "pbrt",
    "start",
    "threads",
    "growth",
    "inner",
    "rays",
    "counts",
    "report",
];

/// What the command line asks for.
#[derive(Debug, Default)]
pub struct Wanted {
    /// Tiny.
    pub quick: bool,
    /// Install the others.
    pub peers: bool,
    /// Stages; none for all.
    pub only: Vec<&'static str>,
    /// Everything but techniques.
    pub defaults: bool,
    /// Scenes; none for all.
    pub scenes: Vec<String>,
    /// Programs built before.
    pub built: Option<PathBuf>,
    /// Where everything is written.
    pub out: Option<PathBuf>,
    /// Handed on as they are.
    pub more: Vec<String>,
    /// Print the help text.
    pub help: bool,
}

impl Wanted {
    /// Reads the words.
    pub fn parse(arguments: &[String]) -> Result<Self, String> {
        let mut wanted = Self::default();
        let mut rest = arguments.iter();
        while let Some(argument) = rest.next() {
            let mut value = || rest.next().cloned().ok_or_else(|| format!("{argument} needs a value"));
            match argument.as_str() {
                "--help" | "-h" => wanted.help = true,
                "--quick" => wanted.quick = true,
                "--inner" => wanted.only.extend(["inner", "rays"]),
                "--counts" => wanted.only.push("counts"),
                "--peers" => wanted.peers = true,
                "--defaults" => wanted.defaults = true,
                "--scene" => wanted.scenes.push(value()?),
                "--only" => wanted.only.extend(stages(&value()?)?),
                "--built" => wanted.built = Some(value()?.into()),
                "--out" => wanted.out = Some(value()?.into()),
                "--full" => wanted.more.push("--full".into()),
                "--seeds" | "--against" => wanted.more.extend([argument.clone(), value()?]),
                stranger => return Err(format!("no option `{stranger}`\nhint: `cargo xtask bench --help`")),
            }
        }
        Ok(wanted)
    }

    /// Whether a stage runs.
    pub fn runs(&self, stage: &str) -> bool {
        let asked = self.only.is_empty() || self.only.contains(&stage);
        asked && !(self.defaults && stage == "techniques")
    }
}

fn stages(list: &str) -> Result<Vec<&'static str>, String> {
    let known = |name: &str| {
        let found = STAGES.iter().find(|s| **s == name).copied();
        found.ok_or_else(|| format!("no stage `{name}`\nhint: the stages are {}", STAGES.join(", ")))
    };
    list.split(',').map(|name| known(name.trim())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Wanted, String> {
        Wanted::parse(&text.split_whitespace().map(str::to_owned).collect::<Vec<_>>())
    }

    #[test]
    fn stages_and_values() {
        let wanted = parse("--only rays,pbrt --counts --scene beam --seeds 4").expect("good options");
        let run: Vec<&str> = STAGES.into_iter().filter(|s| wanted.runs(s)).collect();
        assert_eq!(run, ["pbrt", "rays", "counts"]);
        assert_eq!((wanted.scenes, wanted.more), (vec!["beam".into()], vec!["--seeds".into(), "4".into()]));
        let all = parse("--defaults").expect("good options");
        assert!(all.runs("growth") && !all.runs("techniques"));
    }

    #[test]
    fn strangers_are_errors_with_a_hint() {
        for words in ["--fast", "--only ray", "--seeds"] {
            let error = parse(words).expect_err("not known");
            assert!(error.contains("hint") || error.contains("needs a value"), "{error}");
        }
        assert!(STAGES.iter().all(|s| HELP.contains(&format!("  {s} "))));
    }
}
