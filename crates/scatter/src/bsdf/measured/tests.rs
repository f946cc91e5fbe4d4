use super::*;
use tyndall_testkit::{Rng, Welford, z_max};

fn table(rng: &mut Rng, n: usize, low: f32) -> Vec<f32> {
    (0..n).map(|_| low + rng.f32()).collect()
}

/// Tables of no material, but of one that could be: everything positive and none of it symmetric.
fn tables(azimuths: &[f32]) -> MeasuredTables {
    let mut rng = Rng::new(17);
    let (phi, theta) = (azimuths.to_vec(), vec![0.0, 0.3, 0.8, 1.2, 1.5]);
    let axes = || vec![phi.clone(), theta.clone()];
    let slices = phi.len() * theta.len();
    let lambda = vec![400.0, 500.0, 700.0];
    let spectral = vec![phi.clone(), theta.clone(), lambda];
    MeasuredTables {
        ndf: Grid2d::new([6, 5], Vec::new(), table(&mut rng, 30, 0.3)).expect("valid"),
        sigma: Grid2d::new([4, 3], Vec::new(), table(&mut rng, 12, 0.8)).expect("valid"),
        vndf: Grid2d::density([7, 6], axes(), table(&mut rng, 42 * slices, 0.05)).expect("valid"),
        luminance: Grid2d::density([5, 5], axes(), table(&mut rng, 25 * slices, 0.1)).expect("valid"),
        spectra: Grid2d::new([5, 5], spectral, table(&mut rng, 75 * slices, 0.0)).expect("valid"),
        isotropic: azimuths.len() <= 2,
    }
}

const ANISOTROPIC: [f32; 4] = [-PI, -1.0, 1.5, PI];

fn directions() -> [Vec3; 3] {
    [vec3(0.1, 0.05, 1.0), vec3(0.6, -0.5, 0.7), vec3(-0.9, 0.3, -0.4)].map(Vec3::normalize)
}

#[test]
fn drawing_is_undone() {
    let mut rng = Rng::new(3);
    for azimuths in [&[0.0][..], &ANISOTROPIC] {
        let grid = tables(azimuths).vndf;
        for _ in 0..2000 {
            let slices = grid.at(&[rng.f32() * 6.0 - 3.0, rng.f32() * 1.6]);
            let u = [rng.f32(), rng.f32()];
            let (p, pdf) = grid.sample(u, &slices);
            let (back, density) = grid.invert(p, &slices);
            assert!((back[0] - u[0]).abs() < 1e-4 && (back[1] - u[1]).abs() < 1e-4, "{u:?} {back:?}");
            assert!((pdf / density - 1.0).abs() < 1e-3 && (grid.eval(p, &slices) / pdf - 1.0).abs() < 1e-3);
        }
        // the integral of the density by the midpoint rule, exact for cells that it divides
        let slices = grid.at(&[0.4, 0.9]);
        let n = 60;
        let at = |i: usize| (i as f32 + 0.5) / n as f32;
        let sum: f64 = (0..n * n).map(|i| f64::from(grid.eval([at(i % n), at(i / n)], &slices))).sum();
        assert!((sum / (n * n) as f64 - 1.0).abs() < 1e-4, "{sum}");
    }
}

#[test]
fn samples_carry_their_value_and_density() {
    let mut rng = Rng::new(5);
    for azimuths in [&[0.0][..], &ANISOTROPIC] {
        let tables = tables(azimuths);
        let bsdf = Measured { tables: &tables, lambda: [380.0, 450.0, 610.0, 720.0] };
        for wo in directions() {
            for _ in 0..500 {
                let Some(s) = bsdf.sample(wo, [rng.f32(), rng.f32()]) else { continue };
                assert!(s.wi.z * wo.z > 0.0 && (s.wi.length() - 1.0).abs() < 1e-4);
                let (f, pdf) = bsdf.eval_pdf(wo, s.wi);
                // the half vector loses digits near the pole
                if (wo + s.wi).normalize().z.abs() < 0.999 {
                    assert!((pdf[0] / s.pdf[0] - 1.0).abs() < 0.01, "{pdf:?} {s:?}");
                    for k in 0..4 {
                        assert!((f[k] - s.f[k]).abs() < 0.01 * s.f[k] + 1e-4, "{f:?} {s:?}");
                    }
                }
            }
        }
    }
}

/// What is reflected, by its own sampling and by uniform directions: a density that is off would be off here.
#[test]
fn sampling_and_evaluation_agree() {
    let mut rng = Rng::new(11);
    for azimuths in [&[0.0][..], &ANISOTROPIC] {
        let tables = tables(azimuths);
        let bsdf = Measured { tables: &tables, lambda: [420.0, 480.0, 560.0, 650.0] };
        for wo in directions() {
            let (mut drawn, mut uniform) = ([Welford::default(); 4], [Welford::default(); 4]);
            for _ in 0..30_000 {
                let u = [rng.f32(), rng.f32()];
                let s = bsdf.sample(wo, u);
                let weight =
                    |k: usize| s.as_ref().map_or(0.0, |s| f64::from(s.f[k] * s.wi.z.abs() / s.pdf[k]));
                (0..4).for_each(|k| drawn[k].add(weight(k)));
                let (z, phi) = (u[0], 2.0 * PI * u[1]);
                let sin = (1.0 - z * z).sqrt();
                let wi = vec3(sin * phi.cos(), sin * phi.sin(), z.copysign(wo.z));
                let (f, _) = bsdf.eval_pdf(wo, wi);
                (0..4).for_each(|k| uniform[k].add(f64::from(f[k] * z * 2.0 * PI)));
            }
            for (a, b) in drawn.iter().zip(&uniform) {
                let se = (a.se() * a.se() + b.se() * b.se()).sqrt();
                assert!((a.mean() - b.mean()).abs() < z_max(24) * se, "{wo:?}: {a:?} {b:?}");
            }
        }
    }
}

#[test]
fn tables_that_make_no_sense_are_refused() {
    assert!(Grid2d::new([2, 2], Vec::new(), vec![1.0; 3]).is_err());
    assert!(Grid2d::new([1, 2], Vec::new(), vec![1.0; 2]).is_err());
    assert!(Grid2d::new([2, 2], vec![vec![1.0, 1.0]], vec![1.0; 8]).is_err());
    assert!(Grid2d::new([2, 2], Vec::new(), vec![f32::NAN; 4]).is_err());
    assert!(Grid2d::density([2, 2], Vec::new(), vec![0.0; 4]).is_err());
    assert!(Grid2d::density([2, 2], Vec::new(), vec![-1.0, 2.0, 2.0, 2.0]).is_err());
}
