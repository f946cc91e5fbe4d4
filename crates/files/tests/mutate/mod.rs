//! Damaged copies of sound files, the same on every run.
//!
//! Each test that uses them has a short version, which always runs, and a long one behind `--ignored`, of as many copies as
//! the environment's `TYNDALL_FUZZ` says.

use std::{
    panic::{AssertUnwindSafe, catch_unwind, resume_unwind},
    time::{Duration, Instant},
};
use tyndall_base::rng::Pcg32;

/// Copies of the short versions.
pub const SHORT: u32 = 400;
/// Copies of the long ones unless told otherwise.
const LONG: u32 = 100_000;
/// No copy of a small file may keep a reader busy for longer.
const PATIENCE: Duration = Duration::from_secs(10);
/// Whole numbers that readers trip over, little-endian.
const NUMBERS: [u64; 12] = [
    0,
    1,
    7,
    0x7f,
    0xff,
    0x7fff,
    0xffff,
    0x7fff_ffff,
    0xffff_ffff,
    0x7f80_0000,
    0x7fff_ffff_ffff_ffff,
    u64::MAX,
];
/// Words that readers of text trip over.
const WORDS: [&str; 16] = [
    " ",
    "\n",
    "-",
    "0",
    "1e39",
    "-1",
    "nan",
    "inf",
    "4294967296",
    "18446744073709551616",
    "1e-50",
    "#",
    "\u{0}",
    "é",
    "0x1",
    ".",
];

/// What the environment asks for.
pub fn long() -> u32 {
    std::env::var("TYNDALL_FUZZ").map_or(LONG, |n| n.parse().expect("TYNDALL_FUZZ is a number"))
}

/// Reads `count` damaged copies of `seeds`; whatever `read` does but panic or dawdle is right.
pub fn survive(seeds: &[Vec<u8>], count: u32, read: impl Fn(&[u8])) {
    let mut rng = Pcg32::new(u64::from(count), 77);
    for n in 0..count {
        let bytes = damaged(seeds, &mut rng);
        let start = Instant::now();
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| read(&bytes))) {
            let path = std::env::temp_dir().join(format!("tyndall-mutation-{}-{n}", std::process::id()));
            std::fs::write(&path, &bytes).expect("a temporary file");
            eprintln!("copy {n} of {count} is in {}", path.display());
            resume_unwind(panic);
        }
        assert!(start.elapsed() < PATIENCE, "copy {n} of {count} took {:?}", start.elapsed());
    }
}

/// One to six changes to one of `seeds`.
fn damaged(seeds: &[Vec<u8>], rng: &mut Pcg32) -> Vec<u8> {
    let mut bytes = seeds[rng.below(seeds.len() as u32) as usize].clone();
    for _ in 0..1 + rng.below(6) {
        let length = bytes.len() as u32;
        if length == 0 {
            break;
        }
        // heads decide more than bodies
        let span = if rng.below(2) == 0 { length.min(512) } else { length };
        let at = rng.below(span) as usize;
        match rng.below(8) {
            0 => bytes[at] ^= 1 << rng.below(8),
            1 => bytes[at] = rng.next_u32() as u8,
            2 | 3 => overwrite(&mut bytes, at, rng),
            4 => bytes.truncate(at),
            5 => {
                // a piece again, elsewhere
                let end = (at + 1 + rng.below(64) as usize).min(bytes.len());
                let piece = bytes[at..end].to_vec();
                let to = rng.below(length) as usize;
                bytes.splice(to..to, piece);
            }
            6 => {
                let end = (at + 1 + rng.below(16) as usize).min(bytes.len());
                bytes.drain(at..end);
            }
            _ => {
                let word = WORDS[rng.below(WORDS.len() as u32) as usize];
                let end = (at + rng.below(4) as usize).min(bytes.len());
                bytes.splice(at..end, word.bytes());
            }
        }
    }
    bytes
}

/// A number of 1, 2, 4 or 8 bytes.
fn overwrite(bytes: &mut [u8], at: usize, rng: &mut Pcg32) {
    let mut value = NUMBERS[rng.below(NUMBERS.len() as u32) as usize].to_le_bytes();
    let size = 1 << rng.below(4);
    if rng.below(4) == 0 {
        value[..size].reverse();
    }
    for (to, from) in bytes[at..].iter_mut().zip(&value[..size]) {
        *to = *from;
    }
}
