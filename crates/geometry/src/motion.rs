//! A transform that changes while the shutter is open.
//!
//! The maps at both ends are taken apart, `M = T R S` (translation, rotation, stretch; Shoemake & Duff 1992, *Matrix
//! animation and polar decomposition*); T and S change linearly, R along the shortest turn (Shoemake 1985), as in pbrt.

use crate::dvec::{DVec3, dvec3};
use crate::transform::{Matrix, Transform};
use crate::{Bounds3, GeometryError};
use tyndall_base::Vec3;
use tyndall_base::math::f64::{acos, sin};

type Linear = [[f64; 3]; 3];
type Quaternion = [f64; 4];

/// A map in parts.
#[derive(Clone, Copy, Debug)]
struct Parts {
    t: DVec3,
    q: Quaternion,
    s: Linear,
}

/// Two maps and the times, as fractions of the shutter, at which they hold.
#[derive(Clone, Debug)]
pub struct Motion {
    ends: [Transform; 2],
    parts: [Parts; 2],
    times: [f64; 2],
}

impl Motion {
    /// `start` holds until `times[0]`, `end` from `times[1]` on.
    ///
    /// # Errors
    /// When a map is singular or not affine.
    pub fn new(start: Transform, end: Transform, times: [f64; 2]) -> Result<Self, GeometryError> {
        let mut parts = [taken_apart(&start)?, taken_apart(&end)?];
        if dot(&parts[0].q, &parts[1].q) < 0.0 {
            parts[1].q = parts[1].q.map(|x| -x);
        }
        Ok(Self { ends: [start, end], parts, times })
    }

    /// The map at `time` within the shutter, 0 to 1.
    pub fn at(&self, time: f32) -> Transform {
        self.between(self.fraction(f64::from(time)))
    }

    fn fraction(&self, time: f64) -> f64 {
        let [t0, t1] = self.times;
        if t1 > t0 { ((time - t0) / (t1 - t0)).clamp(0.0, 1.0) } else { f64::from(u8::from(time >= t1)) }
    }

    fn between(&self, u: f64) -> Transform {
        if u <= 0.0 || u >= 1.0 {
            return self.ends[usize::from(u >= 1.0)];
        }
        let [a, b] = &self.parts;
        let r = rotation(&slerp(u, &a.q, &b.q));
        let s: Linear =
            std::array::from_fn(|i| std::array::from_fn(|k| (1.0 - u) * a.s[i][k] + u * b.s[i][k]));
        let m = product(&r, &s);
        let t = a.t * (1.0 - u) + b.t * u;
        // stretches that change sign on the way are flat at one instant: what holds at the start holds there
        Transform::new(affine(&m, t)).unwrap_or(self.ends[0])
    }

    /// The box around all images of a box while the shutter is open: boxes at close times, each wider by how far a
    /// point may leave the chord of its way, `|p''| dt^2 / 8`.
    pub fn bounds(&self, b: Bounds3) -> Bounds3 {
        const STEPS: u32 = 64;
        if b.is_empty() {
            return b;
        }
        let [first, last] = [0.0, 1.0].map(|t| self.fraction(t));
        let at = |k: u32| first + (last - first) * f64::from(k) / f64::from(STEPS);
        let boxes = (0..=STEPS).fold(Bounds3::EMPTY, |all, k| all.union(self.between(at(k)).bounds(b)));
        let step = (last - first) / f64::from(STEPS);
        let [p, q] = &self.parts;
        let angle = 2.0 * acos(dot(&p.q, &q.q).clamp(-1.0, 1.0));
        let far =
            |s: &Linear| b.corners().iter().map(|c| apply(s, DVec3::from(*c)).length()).fold(0.0, f64::max);
        let change: Linear = std::array::from_fn(|i| std::array::from_fn(|k| q.s[i][k] - p.s[i][k]));
        let second = angle * angle * far(&p.s).max(far(&q.s)) + 2.0 * angle * far(&change);
        let off = (second * step * step / 8.0 * 1.01) as f32;
        boxes.padded(Vec3::splat(off))
    }
}

fn taken_apart(m: &Transform) -> Result<Parts, GeometryError> {
    let rows = m.matrix();
    let linear: Linear = std::array::from_fn(|i| std::array::from_fn(|k| rows[i][k]));
    // the nearest rotation: the mean with the inverse transpose, again and again
    let mut r = linear;
    for _ in 0..100 {
        let inverse = Transform::new(affine(&r, DVec3::default()))?.inverse();
        let turned = inverse.matrix();
        let next: Linear = std::array::from_fn(|i| std::array::from_fn(|k| 0.5 * (r[i][k] + turned[k][i])));
        let change = (0..9).map(|n| (next[n / 3][n % 3] - r[n / 3][n % 3]).abs()).fold(0.0, f64::max);
        r = next;
        if change < 1e-14 {
            break;
        }
    }
    if determinant(&r) < 0.0 {
        r = r.map(|row| row.map(|x| -x));
    }
    let back: Linear = std::array::from_fn(|i| std::array::from_fn(|k| r[k][i]));
    let t = dvec3(rows[0][3], rows[1][3], rows[2][3]);
    Ok(Parts { t, q: quaternion(&r), s: product(&back, &linear) })
}

fn affine(m: &Linear, t: DVec3) -> Matrix {
    let t = t.to_array();
    let row = |i: usize| [m[i][0], m[i][1], m[i][2], t[i]];
    [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]]
}

fn product(a: &Linear, b: &Linear) -> Linear {
    std::array::from_fn(|i| {
        std::array::from_fn(|k| a[i][0] * b[0][k] + a[i][1] * b[1][k] + a[i][2] * b[2][k])
    })
}

fn apply(m: &Linear, v: DVec3) -> DVec3 {
    let row = |i: usize| m[i][0] * v.x + m[i][1] * v.y + m[i][2] * v.z;
    dvec3(row(0), row(1), row(2))
}

fn determinant(m: &Linear) -> f64 {
    let [a, b, c] = m.map(|r| dvec3(r[0], r[1], r[2]));
    a.dot(b.cross(c))
}

fn dot(a: &Quaternion, b: &Quaternion) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

/// (x, y, z, w) of a rotation, by its greatest component (Shepperd 1978).
fn quaternion(r: &Linear) -> Quaternion {
    let trace = r[0][0] + r[1][1] + r[2][2];
    if trace > 0.0 {
        let s = (trace + 1.0).sqrt() * 2.0;
        return [(r[2][1] - r[1][2]) / s, (r[0][2] - r[2][0]) / s, (r[1][0] - r[0][1]) / s, 0.25 * s];
    }
    let i = (0..3).fold(0, |best, k| if r[k][k] > r[best][best] { k } else { best });
    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
    let s = (1.0 + r[i][i] - r[j][j] - r[k][k]).max(0.0).sqrt() * 2.0;
    let mut q = [0.0; 4];
    q[i] = 0.25 * s;
    q[j] = (r[j][i] + r[i][j]) / s;
    q[k] = (r[k][i] + r[i][k]) / s;
    q[3] = (r[k][j] - r[j][k]) / s;
    q
}

fn rotation(q: &Quaternion) -> Linear {
    let n = dot(q, q).sqrt();
    let [x, y, z, w] = q.map(|c| c / n);
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
    ]
}

fn slerp(u: f64, a: &Quaternion, b: &Quaternion) -> Quaternion {
    let cos = dot(a, b).clamp(-1.0, 1.0);
    let (wa, wb) = if cos > 1.0 - 1e-9 {
        (1.0 - u, u)
    } else {
        let angle = acos(cos);
        (sin((1.0 - u) * angle) / sin(angle), sin(u * angle) / sin(angle))
    };
    std::array::from_fn(|k| wa * a[k] + wb * b[k])
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_base::vec::vec3;

    fn near(a: Vec3, b: Vec3) -> bool {
        (a - b).length() < 1e-5
    }

    #[test]
    fn turns_and_moves_evenly() {
        let end = Transform::translate(4.0, 0.0, 0.0) * Transform::rotate(90.0, [0.0, 0.0, 1.0]).unwrap();
        let m = Motion::new(Transform::IDENTITY, end, [0.0, 1.0]).unwrap();
        let p = vec3(1.0, 0.0, 0.0);
        assert!(near(m.at(0.0).point(p), p) && near(m.at(1.0).point(p), vec3(4.0, 1.0, 0.0)));
        let half = 0.5f32.sqrt();
        assert!(near(m.at(0.5).point(p), vec3(2.0 + half, half, 0.0)), "{:?}", m.at(0.5).point(p));
    }

    #[test]
    fn times_outside_hold_the_ends() {
        let m = Motion::new(Transform::IDENTITY, Transform::translate(1.0, 0.0, 0.0), [0.25, 0.75]).unwrap();
        let x = |t: f32| m.at(t).point(Vec3::ZERO).x;
        assert_eq!([x(0.1), x(0.25), x(0.5), x(0.9)], [0.0, 0.0, 0.5, 1.0]);
    }

    #[test]
    fn ends_with_stretches_and_mirrors_come_back() {
        let start =
            Transform::rotate(200.0, [1.0, 2.0, 3.0]).unwrap() * Transform::scale(1.0, -2.0, 0.5).unwrap();
        let end = Transform::translate(1.0, 2.0, 3.0)
            * Transform::rotate(30.0, [0.0, 1.0, 0.0]).unwrap()
            * Transform::scale(2.0, -2.0, 0.7).unwrap();
        let m = Motion::new(start, end, [0.0, 1.0]).unwrap();
        for (t, whole) in [(1e-6f32, start), (1.0 - 1e-6, end)] {
            for p in [vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), vec3(0.3, -0.2, 1.0)] {
                assert!((m.at(t).point(p) - whole.point(p)).length() < 1e-4);
            }
        }
    }

    #[test]
    fn bounds_hold_every_instant() {
        let end = Transform::translate(-1.0, 0.5, 2.0)
            * Transform::rotate(170.0, [1.0, 0.2, 0.0]).unwrap()
            * Transform::scale(1.5, 1.0, 1.0).unwrap();
        let m = Motion::new(Transform::IDENTITY, end, [0.0, 1.0]).unwrap();
        let b = Bounds3::new(vec3(2.0, 1.0, -1.0), vec3(3.0, 4.0, 1.0));
        let all = m.bounds(b);
        for k in 0..=1000 {
            let t = k as f32 / 1000.0;
            assert!(b.corners().iter().all(|c| all.contains(m.at(t).point(*c))), "{t}");
        }
        // and not by much more than it has to
        assert!((all.hi - all.lo).max_component() < 14.0);
    }
}
