//! Shards: any cut and any order add up to the bits of one run; nothing else is accepted.
#![allow(clippy::unwrap_used)] // a failure here is a failed test

mod common;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use common::{Hashed, Shape, cropped, film, run};
use tyndall_engine::container::read;
use tyndall_engine::shard::{merge, save};
use tyndall_engine::{EngineError, Job, Shard, Target};
use tyndall_film::{ErrorMode, FilmSpec, Guide};

const LIMIT: u64 = 1 << 30;

fn pass() -> Hashed {
    Hashed::new(6, Shape::Mixed)
}

fn render(folder: &Path, job: &Job, index: u32, count: u32) -> PathBuf {
    let job = Job { shard: Some(Shard { index, count }), ..job.clone() };
    let outcome = run(&job, &pass(), 2).unwrap();
    let path = folder.join(format!("{index}of{count}.film"));
    save(&path, &job, &outcome.state).unwrap();
    path
}

fn jobs() -> Vec<Job> {
    let target =
        Job { target: Some(Target::luminance(0.1)), ..Job::new(cropped(ErrorMode::REPLICATED), 2000) };
    let guide: Guide = run(&target, &pass(), 2).unwrap().state.guide;
    assert!(guide.counts.is_some());
    vec![
        Job::new(cropped(ErrorMode::Conservative), 40),
        Job::new(cropped(ErrorMode::REPLICATED), 41),
        Job { guide, ..Job::new(cropped(ErrorMode::REPLICATED), 2000) },
    ]
}

#[test]
fn any_cut_and_order_gives_the_bits_of_one_run() {
    for job in jobs() {
        let whole = film(&job, &pass(), 1);
        for count in [1, 2, 3, 7] {
            let folder = tempfile::tempdir().unwrap();
            let mut paths: Vec<_> = (1..=count).map(|k| render(folder.path(), &job, k, count)).collect();
            for _ in 0..3 {
                paths.rotate_left(1);
                paths.swap(0, count as usize / 2);
                assert!(merge(&paths, LIMIT).unwrap().film.same_bits(&whole), "{count} shards");
            }
        }
    }
}

/// Films whose pixels share paths say so on disk, and do not mix with others; those of independent pixels are as ever.
#[test]
fn squares_are_kept_and_do_not_mix() {
    let folder = tempfile::tempdir().unwrap();
    let job = |square| {
        let film = FilmSpec { square, ..(*cropped(ErrorMode::REPLICATED)).clone() };
        Job::new(Arc::new(film), 40)
    };
    let version = |path: &Path| std::fs::read(path).unwrap()[8];
    let [a, b] = [1, 2].map(|k| render(folder.path(), &job(4), k, 2));
    let merged = merge(&[a.clone(), b], LIMIT).unwrap().film;
    assert_eq!((merged.spec().square, version(&a)), (4, 2));
    assert_eq!(merged.pooled(), film(&job(4), &pass(), 2).pooled());
    std::fs::create_dir(folder.path().join("alone")).unwrap();
    let alone = render(&folder.path().join("alone"), &job(1), 2, 2);
    assert_eq!(version(&alone), 1);
    let text = merge(&[a, alone.clone()], LIMIT).unwrap_err().to_string();
    assert!(text.contains("belongs to another job"), "{text}");
    let header = read(&alone, LIMIT, |_| Ok(())).unwrap().0;
    assert_eq!(header.film.square, 1);
    assert!(!serde_json::to_string(&header.film).unwrap().contains("square"));
}

#[test]
fn duplicates_gaps_and_strangers_are_refused_by_name() {
    let job = Job::new(cropped(ErrorMode::Conservative), 40);
    let folder = tempfile::tempdir().unwrap();
    let [a, b, c] = [1, 2, 3].map(|k| render(folder.path(), &job, k, 3));
    let other = render(folder.path(), &job, 1, 2);
    let mut stranger = job.clone();
    stranger.settings.push(("max depth".into(), "7".into()));
    std::fs::create_dir(folder.path().join("s")).unwrap();
    let s = render(&folder.path().join("s"), &stranger, 2, 3);
    let refused = |paths: &[&PathBuf], reasons: &[&str]| {
        let paths: Vec<PathBuf> = paths.iter().map(|p| (*p).clone()).collect();
        let text = merge(&paths, LIMIT).unwrap_err().to_string();
        reasons.iter().for_each(|r| assert!(text.contains(r), "{text}"));
    };
    refused(&[&a, &b, &a], &["1of3.film and", "both hold samples 0 to 12"]);
    refused(&[&b, &c, &other], &["2of3.film and", "1of2.film both hold samples 13 to 19"]);
    refused(&[&a, &c], &["samples 13 to 25 are in none of the films"]);
    refused(&[&b, &c], &["samples 0 to 12 are in none"]);
    refused(&[&a, &b], &["samples 26 to 39 are in none"]);
    refused(&[&a, &s, &c], &["s/2of3.film: belongs to another job", "max depth: `7` there, nothing here"]);
    refused(&[], &["no films given"]);
    refused(&[&a, &folder.path().join("missing.film")], &["missing.film: cannot read"]);
    let text = merge(&[a], 1000).unwrap_err();
    assert!(matches!(text, EngineError::Film(_)), "{text}");
}
