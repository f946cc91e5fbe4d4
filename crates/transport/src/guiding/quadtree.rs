//! A density of directions as a quadtree over the square that the sphere is mapped to (Müller, Gross, Novák 2017,
//! *Practical path guiding for efficient light-transport simulation*).
//!
//! The map goes through an octahedron: with `l = |x| + |y| + |z|` an area of the square is `4 l^3` times as large on the
//! sphere's side of it, so that a density over the square becomes one over the sphere by division by `4 l^3`. A quadrant
//! that holds much of the light is cut further, as long as there are records enough to tell its parts apart.

use super::Record;
use tyndall_base::{Vec3, vec::vec3};

/// A quadrant that holds more than this share of the light is cut.
const BRIGHT: f32 = 0.01;
/// A quadrant of fewer records is not.
const FEW: usize = 16;

/// Cuts at most: sides of 1/128, 1.6 degrees near the equator.
const DEEPEST: u32 = 7;
/// Light that every quadrant is given beside its own, as a share of what one record brings on average.
const PRIOR: f32 = 0.5;

/// One cut: quadrants in the order (low, low), (high, low), (low, high), (high, high).
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// Share of the light in each quadrant; the sum is 1.
    share: [f32; 4],
    /// The cut of each quadrant, 0 where it is even.
    child: [u32; 4],
}

impl Node {
    /// The same from everywhere.
    pub(super) const EVEN: Self = Self { share: [0.25; 4], child: [0; 4] };
}

/// A density of directions \[1/sr\].
#[derive(Clone, Copy, Debug)]
pub struct Directions<'f> {
    pub(super) nodes: &'f [Node],
    pub(super) root: u32,
}

/// Cuts the whole square by `records` and returns the root, which is never 0: there must be a node already.
pub(super) fn grow(records: &[Record], nodes: &mut Vec<Node>) -> u32 {
    let total = records.iter().map(|r| r.weight).sum();
    cut(records, total, 0, nodes)
}

fn cut(records: &[Record], total: f32, depth: u32, nodes: &mut Vec<Node>) -> u32 {
    let mut parts: [Vec<Record>; 4] = Default::default();
    for r in records {
        let (quadrant, uv) = descend(r.uv);
        parts[quadrant].push(Record { uv, ..*r });
    }
    let light: Vec<f32> = parts.iter().map(|part| part.iter().map(|r| r.weight).sum()).collect();
    let sum = light[0] + light[1] + light[2] + light[3];
    let prior = PRIOR * sum / records.len().max(1) as f32;
    let mut node = Node::EVEN;
    if sum > 0.0 {
        for (share, l) in node.share.iter_mut().zip(&light) {
            *share = (l + prior) / (sum + 4.0 * prior);
        }
    }
    let at = nodes.len();
    nodes.push(node);
    for q in 0..4 {
        if depth < DEEPEST && parts[q].len() > FEW && light[q] > BRIGHT * total {
            nodes[at].child[q] = cut(&parts[q], total, depth + 1, nodes);
        }
    }
    at as u32
}

/// The quadrant of a point of the square, and the point within it.
#[inline(always)]
fn descend(uv: [f32; 2]) -> (usize, [f32; 2]) {
    let bit = |t: f32| usize::from(t >= 0.5);
    let (i, j) = (bit(uv[0]), bit(uv[1]));
    (2 * j + i, [2.0 * uv[0] - i as f32, 2.0 * uv[1] - j as f32])
}

impl Directions<'_> {
    /// A direction drawn from the density.
    #[inline]
    pub fn sample(&self, mut u: [f32; 2]) -> Vec3 {
        let (mut corner, mut size, mut at) = ([0.0f32; 2], 1.0f32, self.root);
        loop {
            let node = &self.nodes[at as usize];
            let s = &node.share;
            let i = part(&mut u[0], s[0] + s[2]);
            let j = part(&mut u[1], s[i] / (s[i] + s[2 + i]));
            size *= 0.5;
            corner = [corner[0] + size * i as f32, corner[1] + size * j as f32];
            at = node.child[2 * j + i];
            if at == 0 {
                return octahedron_to_sphere([corner[0] + size * u[0], corner[1] + size * u[1]]);
            }
        }
    }

    /// Density of `d` \[1/sr\].
    #[inline]
    pub fn pdf(&self, d: Vec3) -> f32 {
        let l = d.x.abs() + d.y.abs() + d.z.abs();
        let (mut uv, mut pdf, mut at) = (sphere_to_octahedron(d), 0.25 / (l * l * l), self.root);
        loop {
            let node = &self.nodes[at as usize];
            let (quadrant, inside) = descend(uv);
            pdf *= 4.0 * node.share[quadrant];
            (uv, at) = (inside, node.child[quadrant]);
            if at == 0 {
                return pdf;
            }
        }
    }
}

/// The unit square to the sphere through an octahedron; areas change by `4 (|x| + |y| + |z|)^3`.
#[inline(always)]
pub(super) fn octahedron_to_sphere(uv: [f32; 2]) -> Vec3 {
    let (mut x, mut y) = (2.0 * uv[0] - 1.0, 2.0 * uv[1] - 1.0);
    let z = 1.0 - x.abs() - y.abs();
    if z < 0.0 {
        (x, y) = ((1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y));
    }
    vec3(x, y, z).normalize()
}

/// The inverse of [`octahedron_to_sphere`].
#[inline(always)]
pub(super) fn sphere_to_octahedron(d: Vec3) -> [f32; 2] {
    let scale = 1.0 / (d.x.abs() + d.y.abs() + d.z.abs());
    let (mut x, mut y) = (d.x * scale, d.y * scale);
    if d.z < 0.0 {
        (x, y) = ((1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y));
    }
    [0.5 * (x + 1.0), 0.5 * (y + 1.0)]
}

/// 0 with probability `low`, else 1; `u` is what remains of the random number.
#[inline(always)]
fn part(u: &mut f32, low: f32) -> usize {
    let high = *u >= low;
    *u = if high { (*u - low) / (1.0 - low) } else { *u / low };
    *u = u.clamp(0.0, 1.0 - f32::EPSILON);
    usize::from(high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_base::{Vec3, vec::vec3, warp};
    use tyndall_geometry::Frame;
    use tyndall_testkit::{Rng, Welford, chi2_sphere};

    /// Records of a narrow and a wide source, and some from everywhere.
    fn records() -> Vec<Record> {
        let mut rng = Rng::new(4);
        let narrow = Frame::from_z(vec3(0.3, -0.8, 0.5).normalize());
        let wide = Frame::from_z(vec3(-0.7, 0.1, -0.2).normalize());
        (0..4000)
            .map(|i| {
                let d = match i % 4 {
                    0 | 1 => narrow.from_local(warp::sample_uniform_cone(rng.f32x2(), 0.003)),
                    2 => wide.from_local(warp::sample_cosine_hemisphere(rng.f32x2())),
                    _ => warp::sample_uniform_sphere(rng.f32x2()),
                };
                Record { p: Vec3::ZERO, uv: sphere_to_octahedron(d), weight: 0.5 + (i % 3) as f32 }
            })
            .collect()
    }

    #[test]
    fn directions_follow_their_density() {
        let mut nodes = vec![Node::EVEN];
        let root = grow(&records(), &mut nodes);
        let directions = Directions { nodes: &nodes, root };
        let draw = |rng: &mut Rng| Some(directions.sample(rng.f32x2()).to_array());
        let pdf = |[x, y, z]: [f32; 3]| f64::from(directions.pdf(vec3(x, y, z)));
        chi2_sphere(draw, pdf, 200_000, 7).assert_ok("quadtree of directions", 1);
    }

    /// The integral over the sphere is 1, by points of it; half of the light comes from a cone of 0.0015 of the sphere.
    #[test]
    fn the_density_is_one_and_knows_where_light_comes_from() {
        let mut nodes = vec![Node::EVEN];
        let root = grow(&records(), &mut nodes);
        let directions = Directions { nodes: &nodes, root };
        let mut rng = Rng::new(6);
        let mut mean = Welford::default();
        for _ in 0..400_000 {
            let d = warp::sample_uniform_sphere(rng.f32x2());
            mean.add(4.0 * std::f64::consts::PI * f64::from(directions.pdf(d)));
        }
        mean.z_test(1.0).assert_ok("integral of the density", 1);
        let towards = directions.pdf(vec3(0.3, -0.8, 0.5).normalize());
        assert!(towards > 5.0 && directions.pdf(vec3(0.9, 0.1, 0.1).normalize()) < 0.1, "{towards}");
    }
}
