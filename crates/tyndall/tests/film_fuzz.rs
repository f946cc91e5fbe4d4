//! Films with forged headers: refused or developed, never a panic, never more memory than the file can justify.

use std::path::Path;
use std::sync::Arc;
use tyndall::{Image, Options, RunOptions, Source, cube, engine::shard, plan, render, table};
use tyndall_engine::Silent;
use tyndall_testkit::Rng;

/// A film with bands, layers and replicates.
fn film(path: &Path) -> Vec<u8> {
    let options = Options {
        spp: Some(16),
        resolution: Some([4, 4]),
        band_edges: Some(vec![400.0, 500.0, 600.0]),
        errors: tyndall::film::ErrorMode::REPLICATED,
        ..Options::default()
    };
    let plan = plan(Source::BuiltIn, &options).expect("plans");
    let outcome = render(&plan, &RunOptions::default(), &mut Silent).expect("renders");
    shard::save(path, &plan.job, &outcome.state).expect("writable");
    std::fs::read(path).expect("written")
}

/// With a few bytes of the header changed and a checksum that fits.
fn forged(film: &[u8], rng: &mut Rng) -> Vec<u8> {
    let size = u64::from_le_bytes(*film[12..].first_chunk().expect("a film")) as usize;
    let mut header = film[20..20 + size].to_vec();
    for _ in 0..1 + rng.below(3) {
        let at = rng.below(header.len() as u32) as usize;
        // digits for digits keep the JSON whole, so that what is behind it is reached
        match header[at] {
            b'0'..=b'9' => header[at] = b'0' + rng.below(10) as u8,
            _ if rng.below(8) == 0 => header[at] = rng.u32() as u8,
            _ => {}
        }
    }
    let mut bytes = film[..12].to_vec();
    bytes.extend((header.len() as u64).to_le_bytes());
    bytes.extend(header);
    bytes.extend(&film[20 + size..film.len() - 32]);
    let hash = *blake3::hash(&bytes).as_bytes();
    bytes.extend(hash);
    bytes
}

#[test]
fn forged_films_never_panic() {
    let folder = Arc::new(tempfile::tempdir().expect("writable"));
    let original = film(&folder.path().join("a.film"));
    let path = folder.path().join("forged.film");
    let (mut read, mut rng) = (0, Rng::new(3));
    for _ in 0..1000 {
        std::fs::write(&path, forged(&original, &mut rng)).expect("writable");
        let Ok(image) = Image::read(&path) else { continue };
        read += 1;
        if read % 16 == 0 {
            let _ = table::write(&folder.path().join("a.csv"), &image, &table::Rows::All);
            let _ = cube::write(&folder.path().join("a.nc"), &image);
        }
        let _ = shard::merge(std::slice::from_ref(&path), 1 << 24);
    }
    assert!(read > 50 && read < 1000, "{read} were read");
}
