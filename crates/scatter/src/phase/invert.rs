//! Inversion of a cumulative distribution that has no closed inverse.

/// The `x` in \[`lo`, `hi`\] where an increasing function reaches `target`; `f(x)` gives value and slope.
///
/// Newton's steps from `x`, halved into the bracket where they leave it: it always ends, within 1e-10 of the bracket.
pub(super) fn invert_increasing(
    f: impl Fn(f64) -> (f64, f64),
    target: f64,
    mut x: f64,
    [mut lo, mut hi]: [f64; 2],
) -> f64 {
    let tolerance = 1e-10 * (hi - lo);
    for _ in 0..64 {
        let (value, slope) = f(x);
        if value < target {
            lo = x;
        } else {
            hi = x;
        }
        let newton = x - (value - target) / slope;
        let next = if newton > lo && newton < hi { newton } else { 0.5 * (lo + hi) };
        if (next - x).abs() <= tolerance {
            return next;
        }
        x = next;
    }
    x
}
