/// The chance that a correct program fails one family of tests: small, since the workspace has hundreds of them.
pub const ALPHA: f64 = 1e-4;

/// The level of each of `n` tests so that all together hold `alpha` (Sidak 1967): `1 - (1 - alpha)^(1/n)`.
pub fn sidak(alpha: f64, n: usize) -> f64 {
    assert!(
        n > 0 && (0.0..1.0).contains(&alpha),
        "sidak: expected n > 0 and alpha in [0, 1), got {n}, {alpha}"
    );
    -f64::exp_m1(f64::ln_1p(-alpha) / n as f64)
}

/// Which hypotheses fall at the family-wise level `alpha` (Holm 1979, step-down, valid under any dependence).
pub fn holm(alpha: f64, p: &[f64]) -> Vec<bool> {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|&a, &b| p[a].total_cmp(&p[b]));
    let mut rejected = vec![false; p.len()];
    for (rank, &i) in order.iter().enumerate() {
        if p[i] > alpha / (p.len() - rank) as f64 {
            break;
        }
        rejected[i] = true;
    }
    rejected
}
