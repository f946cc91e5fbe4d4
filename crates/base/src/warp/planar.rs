/// Density proportional to `(1 - x) a + x b` on `[0, 1]`, `a, b >= 0` not both zero.
#[inline(always)]
pub fn sample_linear(u: f32, a: f32, b: f32) -> f32 {
    // root of the quadratic in the form that does not cancel
    let root = ((1.0 - u) * (a * a) + u * (b * b)).sqrt();
    let x = u * (a + b) / (a + root);
    if u == 0.0 { 0.0 } else { x.min(ONE_BELOW) }
}

/// The greatest `f32` below one.
const ONE_BELOW: f32 = 1.0 - f32::EPSILON / 2.0;

/// `2 ((1 - x) a + x b) / (a + b)`; zero outside `[0, 1]`.
#[inline(always)]
pub fn pdf_linear(x: f32, a: f32, b: f32) -> f32 {
    if (0.0..=1.0).contains(&x) { 2.0 * ((1.0 - x) * a + x * b) / (a + b) } else { 0.0 }
}

/// The `u` that [`sample_linear`] maps to `x`.
#[inline(always)]
pub fn invert_linear(x: f32, a: f32, b: f32) -> f32 {
    x * (a * (2.0 - x) + b * x) / (a + b)
}

/// Density proportional to the bilinear interpolant of `w = [w00, w10, w01, w11]` (x runs fastest).
#[inline(always)]
pub fn sample_bilinear(u: [f32; 2], w: [f32; 4]) -> [f32; 2] {
    let y = sample_linear(u[1], w[0] + w[1], w[2] + w[3]);
    let x = sample_linear(u[0], (1.0 - y) * w[0] + y * w[2], (1.0 - y) * w[1] + y * w[3]);
    [x, y]
}

/// Density of [`sample_bilinear`] per unit area.
#[inline(always)]
pub fn pdf_bilinear(p: [f32; 2], w: [f32; 4]) -> f32 {
    let [x, y] = p;
    let sum = w[0] + w[1] + w[2] + w[3];
    let at = (1.0 - y) * ((1.0 - x) * w[0] + x * w[1]) + y * ((1.0 - x) * w[2] + x * w[3]);
    if (0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y) { 4.0 * at / sum } else { 0.0 }
}

/// The `u` that [`sample_bilinear`] maps to `p`.
#[inline(always)]
pub fn invert_bilinear(p: [f32; 2], w: [f32; 4]) -> [f32; 2] {
    let y = p[1];
    [
        invert_linear(p[0], (1.0 - y) * w[0] + y * w[2], (1.0 - y) * w[1] + y * w[3]),
        invert_linear(y, w[0] + w[1], w[2] + w[3]),
    ]
}

/// Barycentric coordinates uniform over a triangle, by Heitz's (2019) folding of the square along its diagonal,
/// which keeps strata compact.
#[inline(always)]
pub fn sample_uniform_triangle(u: [f32; 2]) -> [f32; 3] {
    let (a, b) = if u[0] < u[1] {
        let h = 0.5 * u[0];
        (h, u[1] - h)
    } else {
        let h = 0.5 * u[1];
        (u[0] - h, h)
    };
    [a, b, 1.0 - a - b]
}
