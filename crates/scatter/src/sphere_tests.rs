//! Fixed product rules for the tests: BSDFs have edges (horizons, critical angles) that adaptive rules chase at great
//! cost.

use std::f64::consts::{PI, TAU};
use tyndall_base::vec::{Vec3, vec3};
use tyndall_testkit::{ChiSquare, Rng, chi2_test};

fn direction(theta: f64, phi: f64) -> Vec3 {
    let ((sin_t, cos_t), (sin_p, cos_p)) = (theta.sin_cos(), phi.sin_cos());
    vec3((sin_t * cos_p) as f32, (sin_t * sin_p) as f32, cos_t as f32)
}

/// A density per steradian over the unit square of the angles.
fn on_square(f: impl Fn(Vec3) -> f64) -> impl Fn(f64, f64) -> f64 {
    move |s, t| f(direction(PI * s, TAU * t)) * (PI * s).sin() * PI * TAU
}

/// Midpoint rule over a rectangle, `n` by `n` points.
fn midpoint(f: &impl Fn(f64, f64) -> f64, s: [f64; 2], t: [f64; 2], n: usize) -> f64 {
    let (ds, dt) = ((s[1] - s[0]) / n as f64, (t[1] - t[0]) / n as f64);
    let row = |i: usize| -> f64 {
        (0..n).map(|j| f(s[0] + ds * (i as f64 + 0.5), t[0] + dt * (j as f64 + 0.5))).sum()
    };
    (0..n).map(row).sum::<f64>() * ds * dt
}

/// `int f dw` over the sphere.
pub(crate) fn integrate(f: impl Fn(Vec3) -> f64) -> f64 {
    integrate_square(on_square(f))
}

/// As [`integrate`] with four times the points.
pub(crate) fn integrate_finely(f: impl Fn(Vec3) -> f64) -> f64 {
    midpoint(&on_square(f), [0.0, 1.0], [0.0, 1.0], 1200)
}

/// `int f` over the unit square.
pub(crate) fn integrate_square(f: impl Fn(f64, f64) -> f64) -> f64 {
    midpoint(&f, [0.0, 1.0], [0.0, 1.0], 600)
}

/// `n` draws against a density over the unit square in 32 x 48 bins. Failed draws, and those to bins that expect less than
/// one (where an edge may hide a sliver from the rule), share the bin of what the others lack.
pub(crate) fn chi2_square(
    sample: impl Fn(&mut Rng) -> Option<[f64; 2]>,
    pdf: impl Fn(f64, f64) -> f64,
    n: usize,
    seed: u64,
) -> ChiSquare {
    const N: [usize; 2] = [32, 48];
    let edges = |i: usize, n: usize| [i, i + 1].map(|i| i as f64 / n as f64);
    let count = |bin: usize| {
        let (s, t) = (edges(bin / N[1], N[0]), edges(bin % N[1], N[1]));
        let [coarse, fine] = [8, 16].map(|sub| n as f64 * midpoint(&pdf, s, t, sub));
        // an edge inside the bin shows as a difference that is not small beside the noise of the count
        if (fine - coarse).abs() < 0.02 * fine.max(1.0).sqrt() {
            fine
        } else {
            n as f64 * midpoint(&pdf, s, t, 80)
        }
    };
    let mut expected: Vec<f64> = (0..N[0] * N[1]).map(count).collect();
    expected.iter_mut().filter(|e| **e < 1.0).for_each(|e| *e = 0.0);
    let lost = n as f64 - expected.iter().sum::<f64>();
    assert!(lost > -1e-3 * n as f64, "the density integrates to more than one");
    expected.push(lost.max(0.0));
    let mut observed = vec![0.0; expected.len()];
    let mut rng = Rng::new(seed);
    let place = |x: f64, n: usize| ((x * n as f64) as usize).min(n - 1);
    for _ in 0..n {
        let bin = sample(&mut rng).map(|[s, t]| place(s, N[0]) * N[1] + place(t, N[1]));
        observed[bin.filter(|&b| expected[b] > 0.0).unwrap_or(N[0] * N[1])] += 1.0;
    }
    chi2_test(&observed, &expected, 10.0)
}

/// `phi / 2 pi` in \[0, 1\].
pub(crate) fn turn(y: f64, x: f64) -> f64 {
    let turn = y.atan2(x) / TAU;
    turn - turn.floor()
}

/// `n` directions against their density per steradian.
pub(crate) fn chi2(
    sample: impl Fn(&mut Rng) -> Option<Vec3>,
    pdf: impl Fn(Vec3) -> f64,
    n: usize,
    seed: u64,
) -> ChiSquare {
    let angles = |w: Vec3| {
        let [x, y, z] = w.to_array().map(f64::from);
        [x.hypot(y).atan2(z) / PI, turn(y, x)]
    };
    chi2_square(|rng| sample(rng).map(angles), on_square(pdf), n, seed)
}
