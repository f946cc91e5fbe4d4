//! Small rooms: the norm for the length of a source file.

use std::path::Path;

use crate::{Findings, workspace};

/// No source file may have more lines.
const MOST_LINES: usize = 600;

/// Prints median and 90th percentile; names the files that are too long.
pub fn check() -> Result<Findings, String> {
    let mut lengths = Vec::new();
    let mut findings = Findings::new();
    for file in workspace::files()?.iter().filter(|file| file.extension().is_some_and(|end| end == "rs")) {
        let lines = count(file)?;
        lengths.push(lines);
        if lines > MOST_LINES {
            findings.push(format!("{}: {lines} lines, at most {MOST_LINES} allowed", file.display()));
        }
    }
    lengths.sort_unstable();
    println!(
        "sizes: {} source files, {} lines; median {}, 90th percentile {}, longest {}",
        lengths.len(),
        lengths.iter().sum::<usize>(),
        percentile(&lengths, 50),
        percentile(&lengths, 90),
        percentile(&lengths, 100),
    );
    Ok(findings)
}

fn count(file: &Path) -> Result<usize, String> {
    let text = std::fs::read_to_string(workspace::root().join(file));
    text.map(|text| text.lines().count()).map_err(|error| format!("{}: {error}", file.display()))
}

/// The nearest-rank percentile of a sorted list; 0 for an empty one.
fn percentile(sorted: &[usize], per_cent: usize) -> usize {
    let rank = (sorted.len() * per_cent).div_ceil(100);
    sorted.get(rank.saturating_sub(1)).copied().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::percentile;

    #[test]
    fn nearest_rank() {
        let sorted: Vec<usize> = (1..=10).collect();
        assert_eq!([50, 90, 100].map(|per_cent| percentile(&sorted, per_cent)), [5, 9, 10]);
        assert_eq!(percentile(&[7], 50), 7);
        assert_eq!(percentile(&[], 90), 0);
    }
}
