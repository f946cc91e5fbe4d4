//! Cutting a triangle mesh until no edge is long, for displacement.
//!
//! Edges are cut at their middle, whatever triangle they belong to, so that neighbours agree and no crack opens.

use crate::dvec::DVec3;
use std::collections::HashMap;
use tyndall_base::{Vec2, Vec3, vec::vec2};

/// A triangle mesh with what its vertices carry.
#[derive(Clone, Debug, Default)]
pub struct Diceable {
    /// Three vertices a triangle.
    pub indices: Vec<[u32; 3]>,
    /// Positions.
    pub positions: Vec<Vec3>,
    /// Normals, one a vertex.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, one a vertex.
    pub uv: Vec<Vec2>,
}

impl Diceable {
    /// Cuts every edge for which `length` of its ends is over `longest`, until none is or there are `most` triangles;
    /// false in the latter case.
    #[must_use]
    pub fn dice(&mut self, longest: f32, most: usize, length: impl Fn(Vec3, Vec3) -> f32) -> bool {
        loop {
            let mut middles = HashMap::new();
            for f in self.indices.clone() {
                for k in 0..3 {
                    self.cut(f[k], f[(k + 1) % 3], longest, &length, &mut middles);
                }
            }
            if middles.values().all(Option::is_none) {
                return true;
            }
            let parts = |f: &[u32; 3]| split(*f, &|a, b| middles[&(a.min(b), a.max(b))]);
            self.indices = self.indices.iter().flat_map(parts).collect();
            if self.indices.len() > most {
                return false;
            }
        }
    }

    fn cut(
        &mut self,
        a: u32,
        b: u32,
        longest: f32,
        length: &impl Fn(Vec3, Vec3) -> f32,
        middles: &mut HashMap<(u32, u32), Option<u32>>,
    ) {
        let key = (a.min(b), a.max(b));
        if middles.contains_key(&key) {
            return;
        }
        let (i, j) = (key.0 as usize, key.1 as usize);
        let (p, q) = (self.positions[i], self.positions[j]);
        // ends that agree to the last digits have no middle of their own
        let middle = (p + q) * 0.5;
        let long = length(p, q) > longest && middle != p && middle != q;
        let new = long.then_some(self.positions.len() as u32);
        if long {
            self.positions.push(middle);
            self.normals.push((self.normals[i] + self.normals[j]) * 0.5);
            self.uv.push(vec2(0.5 * (self.uv[i].x + self.uv[j].x), 0.5 * (self.uv[i].y + self.uv[j].y)));
        }
        middles.insert(key, new);
    }

    /// Normals as the mean of the triangles' round each vertex, weighted by area.
    pub fn smooth_normals(&self) -> Vec<Vec3> {
        let mut sums = vec![DVec3::default(); self.positions.len()];
        for f in &self.indices {
            let [a, b, c] = f.map(|i| DVec3::from(self.positions[i as usize]));
            let n = (b - a).cross(c - a);
            for i in f {
                sums[*i as usize] = sums[*i as usize] + n;
            }
        }
        let unit = |n: &DVec3| if n.length_squared() > 0.0 { n.normalize().round() } else { Vec3::ZERO };
        sums.iter().map(unit).collect()
    }
}

/// The parts of a triangle whose edges have been cut, turned so that the cut edges come first.
fn split([a, b, c]: [u32; 3], middle: &dyn Fn(u32, u32) -> Option<u32>) -> Vec<[u32; 3]> {
    match (middle(a, b), middle(b, c), middle(c, a)) {
        (None, None, None) => vec![[a, b, c]],
        (Some(ab), Some(bc), Some(ca)) => vec![[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]],
        (Some(ab), Some(bc), None) => vec![[ab, b, bc], [a, ab, bc], [a, bc, c]],
        (Some(ab), None, None) => vec![[a, ab, c], [ab, b, c]],
        (None, _, _) | (Some(_), None, Some(_)) => split([b, c, a], middle),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_base::vec::vec3;

    #[test]
    fn edges_become_short_and_the_surface_stays() {
        let p = [(0.0, 0.0), (3.0, 0.0), (2.0, 1.0), (0.2, 0.7)];
        let mut mesh = Diceable {
            indices: vec![[0, 1, 2], [0, 2, 3]],
            positions: p.iter().map(|&(x, y)| vec3(x, y, 0.0)).collect(),
            normals: vec![vec3(0.0, 0.0, 1.0); 4],
            uv: p.iter().map(|&(x, y)| vec2(x, y)).collect(),
        };
        let area = |m: &Diceable| -> f32 {
            let one = |f: &[u32; 3]| {
                let [a, b, c] = f.map(|i| m.positions[i as usize]);
                0.5 * (b - a).cross(c - a).z
            };
            m.indices.iter().map(one).sum()
        };
        let before = area(&mesh);
        assert!(mesh.dice(0.1, 1 << 20, |a, b| (a - b).length()));
        assert!((area(&mesh) - before).abs() < 1e-4);
        for f in &mesh.indices {
            for k in 0..3 {
                let (a, b) = (f[k] as usize, f[(k + 1) % 3] as usize);
                assert!((mesh.positions[a] - mesh.positions[b]).length() <= 0.1);
            }
        }
        for (p, uv) in mesh.positions.iter().zip(&mesh.uv) {
            assert!((p.x - uv.x).abs() < 1e-6 && (p.y - uv.y).abs() < 1e-6);
        }
        // each inner edge belongs to two triangles: nothing hangs
        let mut edges = HashMap::new();
        for f in &mesh.indices {
            (0..3).for_each(|k| {
                *edges.entry((f[k].min(f[(k + 1) % 3]), f[k].max(f[(k + 1) % 3]))).or_insert(0) += 1
            });
        }
        let outer = edges.iter().filter(|e| *e.1 == 1).all(|(&(a, b), _)| {
            let m = (mesh.positions[a as usize] + mesh.positions[b as usize]) * 0.5;
            let on = |a: (f32, f32), b: (f32, f32)| {
                ((b.0 - a.0) * (m.y - a.1) - (b.1 - a.1) * (m.x - a.0)).abs() < 1e-5
            };
            (0..4).any(|k| on(p[k], p[(k + 1) % 4]))
        });
        assert!(outer && mesh.smooth_normals().iter().all(|n| n.z > 0.999));
        assert!(!mesh.dice(1e-3, 1000, |a, b| (a - b).length()));
    }
}
