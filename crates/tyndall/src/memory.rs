//! Memory that a film may take, asked of the system before it is taken.

use crate::Error;
use std::fs;
use tyndall_film::{ErrorMode, FilmSpec};

/// Taken for granted where the system does not tell: 64 GiB.
const UNKNOWN: u64 = 64 << 30;

/// Bytes that this process can still get: free memory of the machine, or what is left of its control group.
pub fn available() -> u64 {
    let group =
        [("memory.max", "memory.current"), ("memory/memory.limit_in_bytes", "memory/memory.usage_in_bytes")]
            .iter()
            .filter_map(|(limit, used)| Some(group_number(limit)?.saturating_sub(group_number(used)?)));
    group.chain(machine()).min().unwrap_or(UNKNOWN)
}

fn group_number(name: &str) -> Option<u64> {
    fs::read_to_string(format!("/sys/fs/cgroup/{name}")).ok()?.trim().parse().ok()
}

/// `MemAvailable` of Linux.
fn machine() -> Option<u64> {
    let text = fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|l| l.strip_prefix("MemAvailable:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

/// Bytes of a film's sums and of the planes it is developed to.
pub fn needed(spec: &FilmSpec) -> u128 {
    spec.bytes() + planes(spec)
}

/// Means and errors in f64, then in f32, then as channels of a file, with luminance, counts and flags.
fn planes(spec: &FilmSpec) -> u128 {
    let replicated = matches!(spec.mode, ErrorMode::Replicated { .. });
    let values = spec.channels() + spec.channels_with_errors();
    // errors of squares are never in f64
    let squares = if spec.square > 1 && replicated { spec.channels_with_errors() } else { 0 };
    u128::from(spec.bounds.area()) * (values as u128 * 16 + squares as u128 * 12 + 64)
}

/// Refuses a film that the memory cannot hold; nothing is allocated.
///
/// # Errors
/// With the bytes needed and available.
pub fn check(spec: &FilmSpec) -> Result<(), Error> {
    let (needed, free) = (needed(spec), available());
    if needed <= u128::from(free) {
        return Ok(());
    }
    let (width, height, channels) = (spec.bounds.width(), spec.bounds.height(), spec.channels());
    let gib = |bytes: f64| bytes / (1u64 << 30) as f64;
    Err(Error::options(
        format!(
            "a film of {width} x {height} pixels with {channels} channels needs {:.1} GiB of memory, and {:.1} GiB are free",
            gib(needed as f64),
            gib(free as f64)
        ),
        Some("lower the resolution, crop, or use fewer bands and layers".into()),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn some_memory_is_left() {
        let free = available();
        assert!(free > 1 << 20 && free < 1 << 50, "{free}");
    }

    #[test]
    fn absurd_films_are_refused_with_numbers() {
        let small = FilmSpec::xyz([64, 64], ErrorMode::Conservative);
        assert!(check(&small).is_ok());
        let huge = FilmSpec::xyz([1 << 20, 1 << 20], ErrorMode::Conservative);
        assert!(needed(&huge) > 1 << 46);
        let text = check(&huge).expect_err("refused").to_string();
        assert!(text.contains("1048576 x 1048576") && text.contains("GiB are free"), "{text}");
    }
}
