//! CIE L*a*b* (1976) and colour differences.

use tyndall_base::math::f64 as m;

/// L*, a*, b* of X, Y, Z relative to a white. CIE 15:2018.
pub fn lab(xyz: [f64; 3], white: [f64; 3]) -> [f64; 3] {
    let f = |t: f64| {
        let edge = 6.0 / 29.0;
        if t > edge * edge * edge { m::cbrt(t) } else { t / (3.0 * edge * edge) + 4.0 / 29.0 }
    };
    let [x, y, z] = [0, 1, 2].map(|i| f(xyz[i] / white[i]));
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Euclidean distance in L*a*b*.
pub fn delta_e_76(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum::<f64>().sqrt()
}

/// CIEDE2000 with unit weights. Source: Sharma, Wu, Dalal, "The CIEDE2000 color-difference formula", Color Research and
/// Application 30(1), 2005.
pub fn delta_e_2000(a: [f64; 3], b: [f64; 3]) -> f64 {
    let chroma = |v: [f64; 3]| m::hypot(v[1], v[2]);
    let g = 0.5 * (1.0 - saturation((chroma(a) + chroma(b)) / 2.0));
    let ([c1, h1], [c2, h2]) = (polar(a, g), polar(b, g));
    let d_l = b[0] - a[0];
    let d_c = c2 - c1;
    let turn = hue_difference(c1 * c2, h1, h2);
    let d_h = 2.0 * (c1 * c2).sqrt() * m::sin(turn.to_radians() / 2.0);
    let (l, c, h) = ((a[0] + b[0]) / 2.0, (c1 + c2) / 2.0, mean_hue(c1 * c2, h1, h2));
    let cos = |degrees: f64| m::cos(degrees.to_radians());
    let t = 1.0 - 0.17 * cos(h - 30.0) + 0.24 * cos(2.0 * h) + 0.32 * cos(3.0 * h + 6.0)
        - 0.20 * cos(4.0 * h - 63.0);
    let l50 = (l - 50.0) * (l - 50.0);
    let s_l = 1.0 + 0.015 * l50 / (20.0 + l50).sqrt();
    let (s_c, s_h) = (1.0 + 0.045 * c, 1.0 + 0.015 * c * t);
    let bump = (h - 275.0) / 25.0;
    let r_t = -m::sin((60.0 * m::exp(-bump * bump)).to_radians()) * 2.0 * saturation(c);
    let (l, c, h) = (d_l / s_l, d_c / s_c, d_h / s_h);
    (l * l + c * c + h * h + r_t * c * h).max(0.0).sqrt()
}

/// `sqrt(c^7 / (c^7 + 25^7))`.
fn saturation(c: f64) -> f64 {
    let c7 = m::pow(c, 7.0);
    (c7 / (c7 + 6_103_515_625.0)).sqrt()
}

/// Chroma and hue in degrees \[0, 360) with a* stretched by 1 + g.
fn polar(v: [f64; 3], g: f64) -> [f64; 2] {
    let a = (1.0 + g) * v[1];
    let hue = if a == 0.0 && v[2] == 0.0 { 0.0 } else { m::atan2(v[2], a).to_degrees() };
    [m::hypot(a, v[2]), if hue < 0.0 { hue + 360.0 } else { hue }]
}

fn hue_difference(chromas: f64, h1: f64, h2: f64) -> f64 {
    match h2 - h1 {
        _ if chromas == 0.0 => 0.0,
        d if d > 180.0 => d - 360.0,
        d if d < -180.0 => d + 360.0,
        d => d,
    }
}

fn mean_hue(chromas: f64, h1: f64, h2: f64) -> f64 {
    let sum = h1 + h2;
    if chromas == 0.0 {
        sum
    } else if (h1 - h2).abs() <= 180.0 {
        sum / 2.0
    } else if sum < 360.0 {
        (sum + 360.0) / 2.0
    } else {
        (sum - 360.0) / 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pairs of table 1 of Sharma, Wu and Dalal 2005 that reach every branch, with the published differences.
    const SHARMA: [([f64; 3], [f64; 3], f64); 14] = [
        ([50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485], 2.0425),
        ([50.0, 3.1571, -77.2803], [50.0, 0.0, -82.7485], 2.8615),
        ([50.0, -1.3802, -84.2814], [50.0, 0.0, -82.7485], 1.0000),
        ([50.0, 0.0, 0.0], [50.0, -1.0, 2.0], 2.3669),
        ([50.0, 2.4900, -0.0010], [50.0, -2.4900, 0.0009], 7.1792),
        ([50.0, 2.4900, -0.0010], [50.0, -2.4900, 0.0011], 7.2195),
        ([50.0, -0.0010, 2.4900], [50.0, 0.0009, -2.4900], 4.8045),
        ([50.0, 2.5, 0.0], [50.0, 0.0, -2.5], 4.3065),
        ([50.0, 2.5, 0.0], [73.0, 25.0, -18.0], 27.1492),
        ([50.0, 2.5, 0.0], [56.0, -27.0, -3.0], 31.9030),
        ([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387], 1.2644),
        ([22.7233, 20.0904, -46.6940], [23.0331, 14.9730, -42.5619], 2.0373),
        ([90.8027, -2.0831, 1.4410], [91.1528, -1.6435, 0.0447], 1.4441),
        ([2.0776, 0.0795, -1.1350], [0.9033, -0.0636, -0.5514], 0.9082),
    ];

    #[test]
    fn ciede2000_published_pairs() {
        for (a, b, expected) in SHARMA {
            for got in [delta_e_2000(a, b), delta_e_2000(b, a)] {
                assert!((got - expected).abs() < 5.1e-5, "{a:?} {b:?}: {got} against {expected}");
            }
            assert_eq!(delta_e_2000(a, a), 0.0);
        }
    }

    #[test]
    fn lab_of_white_grey_and_black() {
        let white = [95.047, 100.0, 108.883];
        let close = |a: [f64; 3], b: [f64; 3]| delta_e_76(a, b) < 1e-9;
        assert!(close(lab(white, white), [100.0, 0.0, 0.0]));
        assert!(close(lab([0.0; 3], white), [0.0, 0.0, 0.0]));
        let grey = lab(white.map(|w| 0.184186518512444 * w), white);
        assert!((grey[0] - 50.0).abs() < 1e-9 && grey[1].abs() < 1e-9);
    }
}
