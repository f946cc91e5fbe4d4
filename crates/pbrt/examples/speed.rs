//! Measures how fast a large mesh is read: CPU time of this thread, best and median of several rounds.

use std::fmt::Write as _;

use tyndall_pbrt::Parser;

/// Seconds of CPU time that this thread has used (Linux; elsewhere elapsed time).
fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = stat.and_then(|s| s.split(' ').next()?.parse::<u64>().ok());
    nanoseconds.map_or_else(elapsed, |ns| ns as f64 * 1e-9)
}

fn elapsed() -> f64 {
    use std::sync::OnceLock;
    use std::time::Instant;
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_secs_f64()
}

/// A mesh of about 30 MB: coordinates with the given number of decimals, and indices.
fn mesh(decimals: usize) -> String {
    let mut text = String::from("WorldBegin\nShape \"trianglemesh\"\n  \"point3 P\" [\n");
    let mut state = 1u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state >> 8
    };
    while text.len() < 20_000_000 {
        let [x, y, z] = [(); 3].map(|()| f64::from(next()) * 1e-5 - 80.0);
        writeln!(text, "{x:.decimals$} {y:.decimals$} {z:.decimals$}").expect("strings take text");
    }
    text.push_str("]\n  \"integer indices\" [\n");
    while text.len() < 30_000_000 {
        writeln!(text, "{} {} {}", next() >> 4, next() >> 4, next() >> 4).expect("strings take text");
    }
    text + "]\n"
}

fn main() -> Result<(), tyndall_pbrt::Error> {
    for decimals in [4, 6, 9, 17] {
        let text = mesh(decimals);
        let mut seconds = Vec::new();
        for _ in 0..7 {
            let bytes = text.clone().into_bytes();
            let start = cpu_seconds();
            let scene = Parser::from_bytes("mesh.pbrt", bytes, "".as_ref())?.parse()?;
            seconds.push(cpu_seconds() - start);
            assert_eq!(scene.directives.len(), 2);
        }
        seconds.sort_by(f64::total_cmp);
        let megabytes = text.len() as f64 * 1e-6;
        println!(
            "{decimals:2} decimals: {megabytes:.1} MB, best {:.0} MB/s, median {:.0} MB/s of CPU time",
            megabytes / seconds[0],
            megabytes / seconds[3]
        );
    }
    Ok(())
}
