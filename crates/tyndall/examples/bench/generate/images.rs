//! Pictures for floor and wall of the room, 64 x 64 pixels, linear values of sRGB's primaries.

use super::noise;
use tyndall::base::hash;

/// Pixels along each side; few, so that every pixel of the bench's films sees less than one of them.
pub const SIDE: usize = 64;

fn picture(at: impl Fn(usize, usize) -> [f64; 3]) -> Vec<[f32; 3]> {
    (0..SIDE * SIDE).map(|i| at(i % SIDE, i / SIDE).map(|v| v.clamp(0.02, 0.9) as f32)).collect()
}

/// Eight by eight tiles of their own shades with dark joints.
pub fn tiles() -> Vec<[f32; 3]> {
    picture(|x, y| {
        if x % 8 == 0 || y % 8 == 0 {
            return [0.06; 3];
        }
        let shade = |k: u32| f64::from(hash::to_unit_f32(hash::hash3(k, x as u32 / 8, y as u32 / 8)));
        let grain = 0.15 * noise::fractal(5, [x as f64 / 6.0, y as f64 / 6.0, 0.5], 3, 0.6);
        [0.35 + 0.3 * shade(1) + grain, 0.25 + 0.25 * shade(2) + grain, 0.15 + 0.2 * shade(3) + grain]
    })
}

/// Blue and ochre stripes that lie aslant, with a weave.
pub fn cloth() -> Vec<[f32; 3]> {
    picture(|x, y| {
        let wave = 4.0 * noise::value(11, [x as f64 / 9.0, y as f64 / 9.0, 0.5]);
        let stripe = ((x as f64 + 2.0 * y as f64) / 12.0 + wave).floor() as i64 % 2 == 0;
        let weave = if (x + y) % 2 == 0 { 0.05 } else { 0.0 };
        let shade = if stripe { [0.1, 0.22, 0.5] } else { [0.55, 0.4, 0.12] };
        shade.map(|v| v + weave)
    })
}
