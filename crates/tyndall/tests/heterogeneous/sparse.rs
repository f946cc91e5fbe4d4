//! A NanoVDB file is the uniform grid of the same voxels.

#[path = "../../../files/tests/volume/writer.rs"]
mod writer;

use super::common::{Run, judge::Family};
use super::media::{self, ALBEDO, BANDS};
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

#[test]
fn nanovdb_is_the_uniform_grid() {
    let edge = 1.0 / f64::from(N);
    let (first, last) = ([3; 3], [N + 2; 3]);
    let grid = |kind| Spec {
        name: "density",
        kind,
        class: 2,
        first,
        last,
        voxel_size: edge,
        offset: [-2.5 * edge; 3],
        value: &voxel,
    };
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
        let path = dir.path().join(format!("{kind}.nvdb"));
        std::fs::write(&path, writer::file(0, &[grid(kind)], |b| b)).unwrap();
        let parameters = format!(" \"string filename\" \"{}\"{spectra}", path.display());
        let got = Run::new(BANDS, 512).seed(seed).bands(&text(&media::medium("nanovdb", &parameters)));
        family.equal(&format!("grid of type {kind}"), &got, &expected);
    }
    family.assert(0.05);
}
