//! Value noise on a lattice: random numbers at the whole points, blended smoothly between them. Arithmetic alone, so that
//! it is the same on every machine.

use tyndall::base::hash;

fn at(seed: u32, p: [i64; 3]) -> f64 {
    f64::from(hash::to_unit_f32(hash::hash4(seed, p[0] as u32, p[1] as u32, p[2] as u32)))
}

/// Noise in \[0, 1) that varies over a distance of 1.
pub fn value(seed: u32, p: [f64; 3]) -> f64 {
    let low = p.map(|x| x.floor() as i64);
    let blend = |i: usize| {
        let f = p[i] - low[i] as f64;
        f * f * (3.0 - 2.0 * f)
    };
    let [fx, fy, fz] = [blend(0), blend(1), blend(2)];
    let corner = |dx, dy, dz| at(seed, [low[0] + dx, low[1] + dy, low[2] + dz]);
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let row = |dy, dz| mix(corner(0, dy, dz), corner(1, dy, dz), fx);
    let plane = |dz| mix(row(0, dz), row(1, dz), fy);
    mix(plane(0), plane(1), fz)
}

/// Octaves of noise about 0, each twice as fine and `gain` times as strong as the one before.
pub fn fractal(seed: u32, p: [f64; 3], octaves: u32, gain: f64) -> f64 {
    let (mut sum, mut scale, mut strength) = (0.0, 1.0, 1.0);
    for octave in 0..octaves {
        sum += strength * (value(seed + octave, p.map(|x| x * scale)) - 0.5);
        scale *= 2.0;
        strength *= gain;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooth_and_with_the_lattice_values() {
        assert_eq!(value(3, [2.0, -1.0, 5.0]), at(3, [2, -1, 5]));
        let step = value(3, [0.5 + 1e-6, 0.2, 0.7]) - value(3, [0.5, 0.2, 0.7]);
        assert!(step.abs() < 1e-5, "{step}");
        let many: Vec<f64> = (0..4000).map(|i| fractal(9, [f64::from(i) * 0.37, 0.1, 2.2], 4, 0.5)).collect();
        let mean = many.iter().sum::<f64>() / many.len() as f64;
        assert!(mean.abs() < 0.05 && many.iter().all(|v| v.abs() < 1.0), "{mean}");
    }
}
