//! The matrices that pbrt-v4 writes beside an image: world to camera, and world to normalised device coordinates.
//!
//! Both act on column vectors. Normalised device coordinates span 0 to 1 over the screen window and, in depth, from the
//! near to the far plane that pbrt-v4 gives its cameras (0.01 and 1000 m in perspective, 0 and 1 m in parallel).

use tyndall_transport::camera::{Camera, Projective};

type Matrix = [[f64; 4]; 4];

/// Near and far plane of pbrt-v4's perspective camera \[m\].
const NEAR: f64 = 1e-2;
const FAR: f64 = 1000.0;

/// See the module.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CameraMatrices {
    /// World to camera.
    pub world_to_camera: [[f32; 4]; 4],
    /// World to normalised device coordinates.
    pub world_to_ndc: [[f32; 4]; 4],
}

impl CameraMatrices {
    /// Of a camera.
    pub fn of(camera: &Camera) -> Self {
        let to_camera = *camera.to_world().inverse().matrix();
        let projection = match camera {
            Camera::Perspective(c) => perspective(f64::from(c.tan_half())),
            Camera::Orthographic(_) | Camera::Spherical(_) | Camera::Realistic(_) => IDENTITY,
        };
        let window = window(camera.projective());
        Self {
            world_to_camera: narrow(&to_camera),
            world_to_ndc: narrow(&product(&window, &product(&projection, &to_camera))),
        }
    }

    /// From the numbers of [`Self::numbers`].
    pub fn from_numbers(n: &[f32; 32]) -> Self {
        let matrix = |first: usize| std::array::from_fn(|i| std::array::from_fn(|j| n[first + 4 * i + j]));
        Self { world_to_camera: matrix(0), world_to_ndc: matrix(16) }
    }

    /// Both matrices in rows.
    pub fn numbers(&self) -> Vec<f32> {
        self.world_to_camera.iter().chain(&self.world_to_ndc).flatten().copied().collect()
    }
}

const IDENTITY: Matrix =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// Camera space to the screen window, depth to 0 at the near and 1 at the far plane.
fn perspective(tan_half: f64) -> Matrix {
    let (f, depth) = (1.0 / tan_half, FAR / (FAR - NEAR));
    [[f, 0.0, 0.0, 0.0], [0.0, f, 0.0, 0.0], [0.0, 0.0, depth, -depth * NEAR], [0.0, 0.0, 1.0, 0.0]]
}

/// Screen window to the unit square, y downwards as the image's rows.
fn window(p: &Projective) -> Matrix {
    let [x0, x1, y0, y1] = p.screen.map(f64::from);
    let (sx, sy) = (1.0 / (x1 - x0), 1.0 / (y0 - y1));
    [[sx, 0.0, 0.0, -x0 * sx], [0.0, sy, 0.0, -y1 * sy], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let entry = |i: usize, j: usize| (0..4).map(|k| a[i][k] * b[k][j]).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
}

fn narrow(m: &Matrix) -> [[f32; 4]; 4] {
    m.map(|row| row.map(|v| v as f32))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_base::vec::vec2;
    use tyndall_geometry::Transform;
    use tyndall_transport::camera::{CameraSample, Orthographic, Perspective};

    fn projective() -> Projective {
        Projective {
            resolution: [40, 20],
            screen: [-2.0, 2.0, -1.0, 1.0],
            lens_radius: 0.0,
            focal_distance: 1.0,
            to_world: Transform::look_at([1.0, 2.0, 3.0], [0.5, 0.0, -1.0], [0.1, 1.0, 0.0])
                .expect("regular")
                .inverse(),
            motion: None,
        }
    }

    /// A point along the ray through a pixel comes back to that pixel.
    #[test]
    fn points_on_rays_return_to_their_pixels() {
        let cameras = [
            Camera::Perspective(Perspective::new(projective(), 50.0).expect("valid")),
            Camera::Orthographic(Orthographic::new(projective()).expect("valid")),
        ];
        for camera in cameras {
            let m = CameraMatrices::of(&camera).world_to_ndc;
            for film in [[0.5, 0.5], [39.0, 3.0], [20.0, 10.0]] {
                let sample = CameraSample { film: vec2(film[0], film[1]), lens: vec2(0.0, 0.0), time: 0.0 };
                let ray = camera.sample_ray(&sample);
                let p = (ray.o + ray.d * 0.7).to_array();
                let h = m.map(|r| r[0] * p[0] + r[1] * p[1] + r[2] * p[2] + r[3]);
                let (x, y, z) = (40.0 * h[0] / h[3], 20.0 * h[1] / h[3], h[2] / h[3]);
                assert!((x - film[0]).abs() < 2e-4 && (y - film[1]).abs() < 2e-4, "{x} {y} for {film:?}");
                assert!(z > 0.0 && z < 1.0, "depth {z}");
            }
        }
    }

    #[test]
    fn numbers_return() {
        let matrices =
            CameraMatrices::of(&Camera::Orthographic(Orthographic::new(projective()).expect("valid")));
        let numbers: [f32; 32] = matrices.numbers().try_into().expect("two matrices");
        assert_eq!(CameraMatrices::from_numbers(&numbers), matrices);
    }
}
