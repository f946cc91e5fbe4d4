//! The program as users run it: time to the first pixel, memory, threads.

use crate::{efficiency::median, measure::OURS, process, setup::Setup, store};
use serde_json::{Value, json};
use std::{
    path::{Path, PathBuf},
    process::Command,
};

/// Renders `scene` with `more` options into the benchmark's folder.
pub fn render(program: &Path, setup: &Setup, scene: &Path, more: &[String]) -> Command {
    let mut c = Command::new(program);
    c.args(["render", "--quiet", "--force", "--checkpoint", "off", "-o"])
        .arg(image(setup))
        .arg(scene)
        .args(more);
    c
}

fn image(setup: &Setup) -> PathBuf {
    setup.folder.join("run.exr")
}

/// The program, or an error that says how to name it.
pub fn program(setup: &Setup) -> Result<&Path, String> {
    setup.program.as_deref().ok_or_else(|| "--program is missing: where is `tyndall`?".into())
}

/// `--name value` pairs as arguments.
pub fn words(text: &str) -> Vec<String> {
    text.split_whitespace().map(str::to_owned).collect()
}

/// Time to the first pixel and peak memory on every scene.
pub fn starts(setup: &Setup) -> Result<(), String> {
    let program = program(setup)?;
    let rounds = if setup.quick { 3 } else { 15 };
    for scene in &setup.scenes {
        eprintln!("{}: start-up", scene.name);
        let path = scene.path(&setup.scene_folder());
        let one = words("--resolution 1x1 --spp 1 --threads 1");
        let seconds: Result<Vec<f64>, String> =
            (0..rounds).map(|_| process::timed(&mut render(program, setup, &path, &one))).collect();
        let first = process::watched(&mut render(program, setup, &path, &one))?;
        let side = setup.resolution();
        let whole = words(&format!("--resolution {side}x{side} --spp 4 --threads 1"));
        let bytes = process::watched(&mut render(program, setup, &path, &whole))?.bytes;
        store::line(
            &setup.folder,
            &json!({
                "kind": "start", "renderer": OURS, "scene": scene.name, "seconds": median(&seconds?),
                "user_seconds": first.user_seconds, "bytes": bytes,
            }),
        )?;
    }
    Ok(())
}

/// 1, 2, 4, ... and as many threads as the machine has.
pub fn thread_counts(most: usize) -> Vec<usize> {
    let mut counts: Vec<usize> =
        std::iter::successors(Some(1), |n| Some(2 * n)).take_while(|&n| n < most).collect();
    counts.push(most);
    counts
}

/// Wall clock of rendering against threads, on the first scene; rounds take turns.
pub fn threads(setup: &Setup) -> Result<(), String> {
    let program = program(setup)?;
    let most = std::thread::available_parallelism().map_err(|e| format!("number of threads: {e}"))?.get();
    let (rounds, spp, side) = if setup.quick { (2, 16, 64) } else { (5, 64, 256) };
    let scene = setup.scenes[0];
    eprintln!("{}: threads", scene.name);
    let counts = thread_counts(most);
    let mut seconds = vec![Vec::new(); counts.len()];
    for _ in 0..rounds {
        for (n, seconds) in counts.iter().zip(&mut seconds) {
            let more = words(&format!("--resolution {side}x{side} --spp {spp} --threads {n}"));
            process::timed(&mut render(program, setup, &scene.path(&setup.scene_folder()), &more))?;
            seconds.push(rendering_seconds(setup)?);
        }
    }
    for (n, seconds) in counts.iter().zip(&seconds) {
        store::line(
            &setup.folder,
            &json!({
                "kind": "threads", "renderer": OURS, "scene": scene.name, "threads": n, "spp": spp,
                "resolution": side, "seconds": median(seconds),
            }),
        )?;
    }
    Ok(())
}

/// What the run's record says.
fn rendering_seconds(setup: &Setup) -> Result<f64, String> {
    let path = image(setup).with_extension("run.json");
    let text = std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let record: Value = serde_json::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))?;
    record["seconds"]["render"].as_f64().ok_or_else(|| format!("{}: no seconds of rendering", path.display()))
}

#[cfg(test)]
mod tests {
    use super::thread_counts;

    #[test]
    fn powers_of_two_and_the_machine() {
        assert_eq!(thread_counts(1), [1]);
        assert_eq!(thread_counts(2), [1, 2]);
        assert_eq!(thread_counts(6), [1, 2, 4, 6]);
        assert_eq!(thread_counts(8), [1, 2, 4, 8]);
    }
}
