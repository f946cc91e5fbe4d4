//! Loop's subdivision of triangle meshes, with positions and normals of the limit surface.
//!
//! Each step cuts a triangle into four. New vertices on edges take 3/8 of both ends and 1/8 of both opposite corners (on
//! boundaries 1/2 of the ends), old ones `(1 - n beta) v + beta sum` of their n neighbours, `beta` = 3/16 for n = 3 and
//! 3/(8 n) otherwise (on boundaries 3/4 and 1/8 twice). Sources: Loop 1987; Hoppe et al. 1994 (limits).

use super::{check_coordinates, check_indices};
use crate::GeometryError;
use crate::dvec::DVec3;
use std::collections::HashMap;
use std::f64::consts::PI;
use tyndall_base::Vec3;
use tyndall_base::math::f64::{cos, sin};

/// The subdivided mesh.
#[derive(Clone, Debug)]
pub struct Subdivided {
    /// Three vertices a triangle.
    pub indices: Vec<[u32; 3]>,
    /// Positions on the limit surface.
    pub positions: Vec<Vec3>,
    /// Its normals, not of unit length.
    pub normals: Vec<Vec3>,
}

/// Subdivides `levels` times.
///
/// # Errors
/// When a coordinate or an index is out of range, or more than two triangles meet at an edge or in another order than
/// round a vertex.
pub fn loop_subdivide(
    indices: Vec<[u32; 3]>,
    positions: &[Vec3],
    levels: u32,
) -> Result<Subdivided, GeometryError> {
    check_coordinates(positions, "vertex")?;
    check_indices(indices.iter().flatten().copied(), 3, positions.len(), "triangle")?;
    let mut mesh = Mesh { faces: indices, points: positions.iter().map(|&p| p.into()).collect() };
    let mut rings = mesh.rings()?;
    for _ in 0..levels {
        mesh = mesh.refined(&rings);
        rings = mesh.rings()?;
    }
    let limit = |(v, ring): (usize, &Ring)| mesh.smoothed(v, ring, limit_weight(ring)).round();
    let positions: Vec<Vec3> = rings.iter().enumerate().map(limit).collect();
    mesh.points = positions.iter().map(|&p| p.into()).collect();
    let normals = rings.iter().enumerate().map(|(v, ring)| mesh.normal(v, ring).round()).collect();
    Ok(Subdivided { indices: mesh.faces, positions, normals })
}

/// The neighbours of a vertex in order; of a boundary vertex from one end of the boundary to the other.
struct Ring {
    around: Vec<u32>,
    boundary: bool,
}

struct Mesh {
    faces: Vec<[u32; 3]>,
    points: Vec<DVec3>,
}

impl Mesh {
    /// The rings of all vertices.
    fn rings(&self) -> Result<Vec<Ring>, GeometryError> {
        let mut spokes: Vec<Vec<[u32; 2]>> = vec![Vec::new(); self.points.len()];
        for f in &self.faces {
            for k in 0..3 {
                spokes[f[k] as usize].push([f[(k + 1) % 3], f[(k + 2) % 3]]);
            }
        }
        spokes.iter().enumerate().map(|(v, s)| ring(v, s)).collect()
    }

    /// The mean of a vertex and its ring, `weight` for each of the ring (of a boundary its two ends only).
    fn smoothed(&self, v: usize, ring: &Ring, weight: f64) -> DVec3 {
        let p = self.points[v];
        let n = ring.around.len();
        if n < 2 {
            return p;
        }
        let at = |k: usize| self.points[ring.around[k] as usize];
        if ring.boundary {
            return p * (1.0 - 2.0 * weight) + (at(0) + at(n - 1)) * weight;
        }
        let sum = (0..n).fold(DVec3::default(), |s, k| s + at(k));
        p * (1.0 - n as f64 * weight) + sum * weight
    }

    fn refined(&self, rings: &[Ring]) -> Self {
        let moved = |(v, ring): (usize, &Ring)| self.smoothed(v, ring, step_weight(ring));
        let mut points: Vec<DVec3> = rings.iter().enumerate().map(moved).collect();
        let mut opposite: HashMap<(u32, u32), Vec<u32>> = HashMap::new();
        let key = |a: u32, b: u32| (a.min(b), a.max(b));
        for f in &self.faces {
            for k in 0..3 {
                opposite.entry(key(f[k], f[(k + 1) % 3])).or_default().push(f[(k + 2) % 3]);
            }
        }
        let mut new: HashMap<(u32, u32), u32> = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *new.entry(key(a, b)).or_insert_with(|| {
                let ends = self.points[a as usize] + self.points[b as usize];
                let p = match opposite[&key(a, b)][..] {
                    [c, d] => ends * 0.375 + (self.points[c as usize] + self.points[d as usize]) * 0.125,
                    _ => ends * 0.5,
                };
                points.push(p);
                points.len() as u32 - 1
            })
        };
        let cut = |&[a, b, c]: &[u32; 3]| {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        let faces = self.faces.iter().flat_map(cut).collect();
        Self { faces, points }
    }

    /// The normal of the limit surface: the cross product of two tangents.
    fn normal(&self, v: usize, ring: &Ring) -> DVec3 {
        let n = ring.around.len();
        if n < 2 {
            return DVec3::default();
        }
        let at = |k: usize| self.points[ring.around[k] as usize];
        let sum = |f: &dyn Fn(usize) -> f64| (0..n).fold(DVec3::default(), |s, k| s + at(k) * f(k));
        let turn = |k: usize| 2.0 * PI * k as f64 / n as f64;
        let (s, t) = if ring.boundary {
            (at(0) - at(n - 1), self.inward(v, ring))
        } else {
            (sum(&|k| cos(turn(k))), sum(&|k| sin(turn(k))))
        };
        s.cross(t)
    }

    /// The tangent across a boundary.
    fn inward(&self, v: usize, ring: &Ring) -> DVec3 {
        let n = ring.around.len();
        let p = self.points[v];
        let at = |k: usize| self.points[ring.around[k] as usize];
        match n {
            2 => at(0) + at(1) - p * 2.0,
            3 => at(1) - p,
            4 => (at(1) + at(2)) * 2.0 - at(0) - at(3) - p * 2.0,
            _ => {
                let theta = PI / (n - 1) as f64;
                let ends = (at(0) + at(n - 1)) * sin(theta);
                let inner = (1..n - 1)
                    .fold(ends, |s, k| s + at(k) * ((2.0 * cos(theta) - 2.0) * sin(k as f64 * theta)));
                inner * -1.0
            }
        }
    }
}

/// Puts the corners opposite of a vertex, pairs in each triangle's order, into one round.
fn ring(vertex: usize, spokes: &[[u32; 2]]) -> Result<Ring, GeometryError> {
    let next: HashMap<u32, u32> = spokes.iter().map(|s| (s[0], s[1])).collect();
    let start = spokes.iter().map(|s| s[0]).find(|a| !spokes.iter().any(|s| s[1] == *a));
    let boundary = start.is_some();
    let mut around = Vec::with_capacity(spokes.len() + 1);
    let first = start.or_else(|| spokes.first().map(|s| s[0]));
    let mut at = first;
    while let Some(v) = at {
        around.push(v);
        at = next.get(&v).copied().filter(|v| Some(*v) != first && around.len() <= spokes.len());
    }
    let whole = around.len() == spokes.len() + usize::from(boundary);
    if (whole && next.len() == spokes.len()) || spokes.is_empty() {
        return Ok(Ring { around, boundary });
    }
    Err(GeometryError::NotManifold { vertex })
}

/// Weight of each neighbour in a step.
fn step_weight(ring: &Ring) -> f64 {
    match (ring.boundary, ring.around.len()) {
        (true, _) => 0.125,
        (false, 3) => 0.1875,
        (false, n) => 0.375 / n as f64,
    }
}

/// Weight of each neighbour in the limit: the step's fixed point.
fn limit_weight(ring: &Ring) -> f64 {
    if ring.boundary { 0.2 } else { 1.0 / (ring.around.len() as f64 + 0.375 / step_weight(ring)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::dice::Diceable;
    use tyndall_base::vec::vec3;

    fn octahedron() -> (Vec<[u32; 3]>, Vec<Vec3>) {
        let p = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
            .map(|(x, y, z)| vec3(x as f32, y as f32, z as f32));
        let faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
        (faces.to_vec(), p.to_vec())
    }

    #[test]
    fn a_closed_mesh_becomes_round() {
        let (faces, p) = octahedron();
        let m = loop_subdivide(faces, &p, 3).expect("manifold");
        assert_eq!((m.indices.len(), m.positions.len()), (512, 258));
        let radius: Vec<f32> = m.positions.iter().map(|p| p.length()).collect();
        let (low, high) = radius.iter().fold((9.0f32, 0.0f32), |(l, h), &r| (l.min(r), h.max(r)));
        // the old vertices are the farthest: 1 - 4/8 of the way out, since opposite neighbours cancel
        assert!((high - 0.5).abs() < 1e-6 && low > 0.4, "{low} {high}");
        // the limit's normals against those of the fine mesh, which differ by its curvature over an edge
        let mesh = Diceable { indices: m.indices, positions: m.positions, ..Diceable::default() };
        for ((p, n), flat) in mesh.positions.iter().zip(&m.normals).zip(mesh.smooth_normals()) {
            assert!(n.normalize().dot(flat) > 0.995 && n.dot(*p) > 0.0, "{p:?} {n:?} {flat:?}");
        }
    }

    /// The limit does not depend on how often the mesh was cut: vertices of the coarse mesh keep their limit.
    #[test]
    fn limits_stay() {
        let (faces, p) = octahedron();
        let [a, b] = [0, 2].map(|levels| loop_subdivide(faces.clone(), &p, levels).expect("manifold"));
        for k in 0..6 {
            assert!((a.positions[k] - b.positions[k]).length() < 1e-6);
            assert!(a.normals[k].normalize().dot(b.normals[k].normalize()) > 0.999_99);
        }
    }

    #[test]
    fn a_flat_sheet_stays_flat_and_faces_up() {
        let p: Vec<Vec3> = (0..9).map(|i| vec3((i % 3) as f32, (i / 3) as f32, 0.0)).collect();
        let quad = |i: u32| [[i, i + 1, i + 4], [i, i + 4, i + 3]];
        let faces: Vec<[u32; 3]> = [0, 1, 3, 4].into_iter().flat_map(quad).collect();
        let m = loop_subdivide(faces, &p, 2).expect("manifold");
        for (p, n) in m.positions.iter().zip(&m.normals) {
            assert!(p.z.abs() < 1e-6 && n.normalize().z > 0.999, "{p:?} {n:?}");
        }
    }

    #[test]
    fn fans_that_touch_at_a_vertex_are_refused() {
        let p: Vec<Vec3> = (0..5).map(|i| vec3(i as f32, (i * i) as f32, 0.0)).collect();
        assert!(loop_subdivide(vec![[0, 1, 2], [0, 3, 4]], &p, 1).is_err());
    }
}
