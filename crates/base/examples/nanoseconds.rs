//! Prints the cost in nanoseconds of the functions that inner loops call: `cargo run --release --example nanoseconds`.

use std::hint::black_box;
use std::time::Instant;
use tyndall_base::{exact::ExactSum, hash, math, rng::Pcg32, sobol, vec::vec3, warp};

/// Best of many runs of `f` over a thousand inputs, in nanoseconds a call.
fn time<T: Copy, R: Copy>(name: &str, input: impl Fn(u32) -> T, f: impl Fn(T) -> R) {
    let inputs: Vec<T> = (0..1000).map(input).collect();
    let mut results = vec![f(inputs[0]); inputs.len()];
    let mut run = || {
        let start = Instant::now();
        for (result, &x) in results.iter_mut().zip(black_box(&inputs)) {
            *result = f(x);
        }
        black_box(&mut results);
        start.elapsed().as_secs_f64() * 1e9 / inputs.len() as f64
    };
    let best = (0..2000).map(|_| run()).fold(f64::INFINITY, f64::min);
    println!("{name:28} {best:7.2} ns");
}

/// A number in `[0, 1)`.
fn unit(i: u32) -> f32 {
    hash::to_unit_f32(hash::hash2(i, 0))
}

fn square(i: u32) -> [f32; 2] {
    [unit(i), unit(!i)]
}

fn lanes(i: u32) -> [f32; 8] {
    std::array::from_fn(|j| -unit(8 * i + j as u32))
}

fn main() {
    time("exp", unit, |x| math::exp(-10.0 * x));
    time("exp_n<8>", lanes, math::exp_n);
    time("ln", unit, |x| math::ln(1.0 - x));
    time("ln_n<8>", |i| lanes(i).map(|x| -x), math::ln_n);
    time("sin_cos", |i| 10.0 * unit(i), math::sin_cos);
    time("sin_cos_turns", unit, math::sin_cos_turns);
    time("tan", unit, math::tan);
    time("atan2", unit, |x| math::atan2(x - 0.5, 0.3));
    time("acos", unit, math::acos);
    time("pow", unit, |x| math::pow(x, 0.42));
    time("f64::exp", |i| -10.0 * f64::from(unit(i)), math::f64::exp);
    time("f64::ln", |i| f64::from(unit(i)), math::f64::ln);
    time("hash2", |i| i, |i| hash::hash2(i, 7));
    time("hash4", |i| i, |i| hash::hash4(i, 7, 9, 11));
    time("Pcg32, keyed, one number", u64::from, |i| Pcg32::from_key(i).next_f32());
    time("sobol_1d", |i| (i, 7), |(i, seed)| black_box(sobol::sobol_1d(i, seed)));
    time("sobol_2d", |i| (i, 7), |(i, seed)| black_box(sobol::sobol_2d(i, seed)));
    time("ExactSum::add_f32", unit, |x| {
        let mut sum = ExactSum::from_bits(1);
        sum.add_f32(x);
        sum
    });
    let of = |i| (sobol::SobolIndex::new(i), i);
    time("SobolIndex::d2", of, |(i, seed)| black_box(i.d2(seed)));
    time("sobol_4d", |i| (i, 7), |(i, seed)| black_box(sobol::sobol_4d(i, seed)));
    time("concentric disk", square, warp::sample_concentric_disk);
    time("cosine hemisphere", square, warp::sample_cosine_hemisphere);
    time("uniform sphere", square, warp::sample_uniform_sphere);
    let triangle = [vec3(1.0, 2.0, 3.0), vec3(-2.0, 1.5, 0.5), vec3(0.3, -1.0, 2.0)];
    time("spherical triangle, whole", square, |u| {
        warp::SphericalTriangle::new(black_box(triangle)).map(|t| t.sample(u))
    });
    time("spherical rectangle, whole", square, |u| {
        let [p, x, y] = black_box([vec3(-1.0, -1.0, 1.0), vec3(2.0, 0.0, 0.0), vec3(0.0, 2.0, 0.0)]);
        warp::SphericalRectangle::new(p, x, y).map(|r| r.sample(u))
    });
    time("exponential", unit, |u| warp::sample_exponential(u, 0.7));
    time("equiangular, whole", square, |[u, v]| {
        let e = warp::Equiangular::new(2.0 + v, 0.5, 0.0, 5.0);
        let t = e.sample(u);
        (t, e.pdf(t))
    });
}
