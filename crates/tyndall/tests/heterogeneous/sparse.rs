//! A NanoVDB file is the uniform grid of the same voxels.

#[path = "../../../files/tests/volume/writer.rs"]
mod writer;

use super::common::{Run, judge::Family};
use super::media::{self, ALBEDO, BANDS};
use std::path::Path;
use writer::Spec;

const N: i32 = 20;

/// Zero at the faces: there a uniform grid fades over half a voxel, a NanoVDB grid over a whole one on one side.
fn voxel(v: [i32; 3]) -> f32 {
    let at = v.map(|x| x - 3);
    if at.iter().any(|x| *x <= 0 || *x >= N - 1) {
        return 0.0;
    }
    0.25 * ((at[0] * 5 + at[1] * 3 + at[2] * 7) % 9) as f32
}

/// The medium "m" of the grid of a type, written into `dir`, with spectra times `scale`.
pub fn grid(dir: &Path, kind: u32, scale: f64) -> String {
    let edge = 1.0 / f64::from(N);
    let grid = Spec {
        name: "density",
        kind,
        class: 2,
        first: [3; 3],
        last: [N + 2; 3],
        voxel_size: edge,
        offset: [-2.5 * edge; 3],
        value: &voxel,
    };
    let path = dir.join(format!("{kind}.nvdb"));
    std::fs::write(&path, writer::file(0, &[grid], |b| b)).expect("a file");
    let spectra = format!("{}{}", media::spectra(&ALBEDO, scale), media::phase());
    media::medium("nanovdb", &format!(" \"string filename\" \"{}\"{spectra}", path.display()))
}

#[test]
fn nanovdb_is_the_uniform_grid() {
    let dir = tempfile::tempdir().unwrap();
    let spectra = format!("{}{}", media::spectra(&ALBEDO, 2.0), media::phase());
    let index = |i: i32| [3 + i % N, 3 + i / N % N, 3 + i / N / N];
    let density: Vec<f64> = (0..N * N * N).map(|i| f64::from(voxel(index(i)))).collect();
    let dims = format!(" \"integer nx\" {N} \"integer ny\" {N} \"integer nz\" {N}");
    let uniform =
        media::medium("uniformgrid", &format!("{dims}{}{spectra}", media::numbers("density", &density)));
    let text = |medium: &str| {
        let camera = media::camera();
        format!("{camera}WorldBegin\n{}{medium}{}", media::sky(), media::cube())
    };
    let expected = Run::new(BANDS, 1024).bands(&text(&uniform));
    let mut family = Family::default();
    // codes of 16 bits keep these values to 1e-5
    for (kind, seed) in [(1, 2), (2, 3), (15, 4)] {
        let medium = grid(dir.path(), kind, 2.0);
        let got = Run::new(BANDS, 512).seed(seed).bands(&text(&medium));
        family.equal(&format!("grid of type {kind}"), &got, &expected);
    }
    family.assert(0.05);
}
