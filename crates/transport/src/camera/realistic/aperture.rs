//! Shapes of the aperture stop, as in pbrt: what share of the light passes at a point of the stop.
//!
//! Coordinates run from -1 to 1 over the stop's diameter. Shapes are scaled so that they pass as much light as the disk:
//! their mean over the square is pi / 4.

use crate::texture::Texels;
use std::f64::consts::{E, FRAC_PI_4, PI};
use tyndall_base::math::f64 as math;

/// The shape of a stop.
#[derive(Clone, Debug, Default)]
pub enum Aperture {
    /// All that passes the stop.
    #[default]
    Disk,
    /// `exp(-r^2) - exp(-1)`.
    Gaussian,
    /// Straight edges between corners, with the factor that makes up for the area.
    Polygon(Vec<[f64; 2]>, f64),
    /// An image with one channel, bilinear, black beyond its edges, with the factor that makes up for its mean.
    Image(Texels, f64),
}

impl Aperture {
    /// A square of half the stop's width.
    pub fn square() -> Self {
        Self::polygon(vec![[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])
    }

    /// A regular pentagon of radius 0.8 with a corner at the top of the picture of a point out of focus.
    pub fn pentagon() -> Self {
        Self::polygon(corners(5, &|_| 0.8, 0.5 * PI))
    }

    /// A star of five points.
    pub fn star() -> Self {
        let inner = math::cos(0.4 * PI) / math::cos(0.2 * PI);
        Self::polygon(corners(10, &|i| if i % 2 == 0 { inner } else { 1.0 }, 0.0))
    }

    /// The image, unless it is black.
    pub fn image(texels: Texels) -> Option<Self> {
        let sum: f64 = texels.data.iter().map(|v| f64::from(*v)).sum();
        let mean = sum / texels.data.len() as f64;
        (texels.channels == 1 && mean > 0.0 && mean.is_finite())
            .then(|| Self::Image(texels, FRAC_PI_4 / mean))
    }

    fn polygon(corners: Vec<[f64; 2]>) -> Self {
        let twice: f64 = edges(&corners).map(|[a, b]| a[0] * b[1] - a[1] * b[0]).sum();
        let mean = 0.5 * twice.abs() / 4.0;
        Self::Polygon(corners, FRAC_PI_4 / mean)
    }

    /// What passes at a point of the stop, relative to the open disk.
    pub fn transmission(&self, x: f64, y: f64) -> f64 {
        let r2 = x * x + y * y;
        match self {
            Self::Disk => f64::from(u8::from(r2 <= 1.0)),
            // the mean over the square of max(0, exp(-r^2) - 1/e) is (1 - 2/e) pi / 4
            Self::Gaussian => (math::exp(-r2) - 1.0 / E).max(0.0) / (1.0 - 2.0 / E),
            // the lens turns the picture over
            Self::Polygon(corners, scale) => {
                if holds(corners, [x, -y]) {
                    *scale
                } else {
                    0.0
                }
            }
            Self::Image(texels, scale) => scale * bilinear(texels, 0.5 * (x + 1.0), 0.5 * (1.0 - y)).max(0.0),
        }
    }

    /// The radius beyond which nothing passes.
    pub fn reach(&self) -> f64 {
        match self {
            Self::Disk | Self::Gaussian => 1.0,
            Self::Polygon(corners, _) => {
                corners.iter().map(|c| (c[0] * c[0] + c[1] * c[1]).sqrt()).fold(0.0, f64::max)
            }
            // bilinear texels fade over half of one beyond the edge
            Self::Image(texels, _) => {
                std::f64::consts::SQRT_2 * (1.0 + 1.0 / texels.width.min(texels.height) as f64)
            }
        }
    }
}

fn corners(n: usize, radius: &dyn Fn(usize) -> f64, first: f64) -> Vec<[f64; 2]> {
    let corner = |i: usize| {
        let (sin, cos) = math::sin_cos(first + 2.0 * PI * i as f64 / n as f64);
        [radius(i) * cos, radius(i) * sin]
    };
    (0..n).map(corner).collect()
}

fn edges(corners: &[[f64; 2]]) -> impl Iterator<Item = [[f64; 2]; 2]> {
    (0..corners.len()).map(|i| [corners[i], corners[(i + 1) % corners.len()]])
}

/// A ray to the right of an inner point meets an odd number of edges.
fn holds(corners: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let crossed = |[a, b]: [[f64; 2]; 2]| {
        (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
    };
    edges(corners).filter(|e| crossed(*e)).count() % 2 == 1
}

fn bilinear(texels: &Texels, u: f64, v: f64) -> f64 {
    let (x, y) = (u * texels.width as f64 - 0.5, v * texels.height as f64 - 0.5);
    let (x0, y0) = (x.floor(), y.floor());
    let (fx, fy) = (x - x0, y - y0);
    let texel = |x: f64, y: f64| {
        let inside = x >= 0.0 && y >= 0.0 && x < texels.width as f64 && y < texels.height as f64;
        if inside { f64::from(texels.data[y as usize * texels.width + x as usize]) } else { 0.0 }
    };
    let row = |y: f64| (1.0 - fx) * texel(x0, y) + fx * texel(x0 + 1.0, y);
    (1.0 - fy) * row(y0) + fy * row(y0 + 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every shape passes as much light as the disk, and none beyond its reach.
    #[test]
    fn shapes_pass_the_light_of_the_disk() {
        let ramp = (0..64).map(|i| (i % 8) as f32).collect();
        let image =
            Aperture::image(Texels { width: 8, height: 8, channels: 1, data: ramp }).expect("not black");
        let shapes =
            [Aperture::Disk, Aperture::Gaussian, Aperture::square(), Aperture::pentagon(), Aperture::star()];
        // edges of the disk's and the square's boxes fall between points
        let n = 1200;
        for shape in shapes.iter().chain([&image]) {
            let mut sum = 0.0;
            for i in 0..n * n {
                let at = |k: i32| -1.5 + 3.0 * (f64::from(k) + 0.5) / f64::from(n);
                let (x, y) = (at(i % n), at(i / n));
                let passed = shape.transmission(x, y);
                assert!(passed == 0.0 || (x * x + y * y).sqrt() <= shape.reach() + 1e-9, "{shape:?}");
                sum += passed * 9.0 / f64::from(n * n);
            }
            // a midpoint rule with slanted edges: of order 1 / n
            assert!((sum / PI - 1.0).abs() < 4e-3, "{shape:?}: {sum}");
        }
    }

    #[test]
    fn pentagons_point_down_on_the_stop() {
        let pentagon = Aperture::pentagon();
        assert!(pentagon.transmission(0.0, -0.79) > 0.0 && pentagon.transmission(0.0, 0.7) == 0.0);
        assert!(Aperture::image(Texels { width: 1, height: 1, channels: 1, data: vec![0.0] }).is_none());
    }
}
