//! Where light comes from, learned: a field of directional densities over positions (Jensen 1995, *Importance driven
//! path tracing using the photon map*; the trees after Müller, Gross, Novák 2017).
//!
//! Particles that lights sent out left records: where, from which direction, how much. Positions are cut in halves until
//! a part holds few enough of them to be one place; each place has a quadtree of directions. Points in media have a tree
//! of their own, points on surfaces one for each of six ways to face. The field only steers where paths look:
//! whatever it holds, means stay.

mod quadtree;

pub use quadtree::Directions;

use quadtree::{Node, sphere_to_octahedron};
use tyndall_base::Vec3;

/// Records that a place has at most.
const PLACE: usize = 1500;
/// Fewer records in all teach nothing.
const TOO_FEW: usize = 200;
/// Halvings at most.
const DEEPEST: u32 = 28;

/// What a particle left.
#[derive(Clone, Copy, Debug)]
pub struct Record {
    /// Where \[m\].
    pub p: Vec3,
    /// The direction that it came from, as a point of the square.
    pub uv: [f32; 2],
    /// How much light it carried, in any unit.
    pub weight: f32,
}

impl Record {
    /// Light of `weight` that reached `p` from the unit direction `from`.
    pub fn new(p: Vec3, from: Vec3, weight: f32) -> Self {
        Self { p, uv: sphere_to_octahedron(from), weight }
    }
}

/// What is not a place by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// A point of a medium.
    Medium,
    /// A point of a surface with the normal on the side of the light.
    Surface(u8),
}

impl Class {
    /// Number of classes.
    pub const COUNT: usize = 7;

    /// A surface with normal `n`: the axis that the normal is nearest to, and its sign.
    #[inline(always)]
    pub fn facing(n: Vec3) -> Self {
        let (x, y, z) = (n.x.abs(), n.y.abs(), n.z.abs());
        let (axis, value) = if x >= y && x >= z {
            (0, n.x)
        } else if y >= z {
            (2, n.y)
        } else {
            (4, n.z)
        };
        Self::Surface(axis + u8::from(value < 0.0))
    }

    /// Position in a table of all classes.
    #[inline(always)]
    pub const fn index(self) -> usize {
        match self {
            Self::Medium => 0,
            Self::Surface(way) => 1 + way as usize,
        }
    }
}

/// A cut of space at `at` along `axis`, or a place (axis 3) whose quadtree starts at `low`.
#[derive(Clone, Copy, Debug)]
struct Cut {
    at: f32,
    axis: u32,
    low: u32,
    high: u32,
}

/// The field.
#[derive(Clone, Debug)]
pub struct Field {
    /// Root of each class among the cuts; `None` where too little was learned.
    roots: [Option<u32>; Class::COUNT],
    cuts: Vec<Cut>,
    nodes: Vec<Node>,
}

impl Field {
    /// From the records of each class; `None` when they teach nothing.
    pub fn new(records: [Vec<Record>; Class::COUNT]) -> Option<Self> {
        let nothing = Node::EVEN;
        let mut field = Self { roots: [None; Class::COUNT], cuts: Vec::new(), nodes: vec![nothing] };
        for (class, records) in records.into_iter().enumerate() {
            if records.len() >= TOO_FEW {
                field.roots[class] = Some(field.divide(records, 0));
            }
        }
        field.roots.iter().any(Option::is_some).then_some(field)
    }

    fn divide(&mut self, records: Vec<Record>, depth: u32) -> u32 {
        let at = self.cuts.len();
        self.cuts.push(Cut { at: 0.0, axis: PLACE_AXIS, low: 0, high: 0 });
        let halves = if records.len() > PLACE && depth < DEEPEST { halve(&records) } else { None };
        let Some((axis, middle, [low, high])) = halves else {
            self.cuts[at].low = quadtree::grow(&records, &mut self.nodes);
            return at as u32;
        };
        drop(records);
        let (low, high) = (self.divide(low, depth + 1), self.divide(high, depth + 1));
        self.cuts[at] = Cut { at: middle, axis, low, high };
        at as u32
    }

    /// What was learned at `p`.
    #[inline]
    pub fn at(&self, class: Class, p: Vec3) -> Option<Directions<'_>> {
        let mut cut = &self.cuts[self.roots[class.index()]? as usize];
        while cut.axis != PLACE_AXIS {
            let x = match cut.axis {
                0 => p.x,
                1 => p.y,
                _ => p.z,
            };
            cut = &self.cuts[if x < cut.at { cut.low } else { cut.high } as usize];
        }
        Some(Directions { nodes: &self.nodes, root: cut.low })
    }

    /// Places and quadtree nodes.
    pub fn size(&self) -> (usize, usize) {
        (self.cuts.iter().filter(|c| c.axis == PLACE_AXIS).count(), self.nodes.len() - 1)
    }

    /// Bytes of memory.
    pub fn bytes(&self) -> usize {
        self.cuts.len() * size_of::<Cut>() + self.nodes.len() * size_of::<Node>()
    }
}

const PLACE_AXIS: u32 = 3;

/// Halves of the box around the records, across its longest side; `None` when they are all at one point.
fn halve(records: &[Record]) -> Option<(u32, f32, [Vec<Record>; 2])> {
    let (mut low, mut high) = (records[0].p, records[0].p);
    for r in records {
        low = low.min(r.p);
        high = high.max(r.p);
    }
    let size = high - low;
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    let coordinate = |p: Vec3| p.to_array()[axis as usize];
    let middle = 0.5 * (coordinate(low) + coordinate(high));
    let (below, above): (Vec<_>, Vec<_>) = records.iter().partition(|r| coordinate(r.p) < middle);
    (!below.is_empty() && !above.is_empty()).then_some((axis, middle, [below, above]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_base::{rng::Pcg32, vec::vec3, warp};

    /// Light of a point at the origin, seen from all over a box.
    fn around() -> Vec<Record> {
        let mut rng = Pcg32::new(3, 1);
        (0..40_000)
            .map(|_| {
                let p = warp::sample_uniform_sphere(rng.next_2d()) * (1.0 + 3.0 * rng.next_f32());
                Record::new(p, -p.normalize(), 1.0)
            })
            .collect()
    }

    #[test]
    fn every_place_knows_its_own_directions() {
        let mut records: [Vec<Record>; Class::COUNT] = Default::default();
        records[Class::Medium.index()] = around();
        let field = Field::new(records).expect("enough records");
        assert!(field.size().0 > 20 && field.bytes() > 0);
        for p in [vec3(2.0, 0.3, 0.1), vec3(-0.5, -2.0, 1.0), vec3(0.2, 0.1, 3.0)] {
            let place = field.at(Class::Medium, p).expect("learned");
            let (to, away) = (place.pdf(-p.normalize()), place.pdf(p.normalize()));
            assert!(to > 10.0 * away, "{p:?}: {to} {away}");
        }
        assert!(field.at(Class::facing(vec3(0.0, 1.0, 0.0)), Vec3::ZERO).is_none());
    }

    #[test]
    fn too_little_teaches_nothing() {
        let mut records: [Vec<Record>; Class::COUNT] = Default::default();
        records[0] = around()[..100].to_vec();
        assert!(Field::new(records).is_none());
    }

    #[test]
    fn one_point_is_one_place() {
        let mut records: [Vec<Record>; Class::COUNT] = Default::default();
        records[1] = vec![Record::new(vec3(1.0, 2.0, 3.0), vec3(0.0, 0.0, 1.0), 2.0); 10_000];
        let field = Field::new(records).expect("enough records");
        assert_eq!(field.size().0, 1);
        let up = field.at(Class::facing(vec3(1.0, 0.1, 0.2)), Vec3::ZERO).expect("learned");
        assert!(up.pdf(vec3(0.0, 0.0, 1.0)) > up.pdf(vec3(0.0, 0.0, -1.0)));
    }

    #[test]
    fn six_ways_to_face() {
        let ways = [
            (vec3(1.0, 0.2, 0.1), 0),
            (vec3(-1.0, 0.2, 0.1), 1),
            (vec3(0.1, 1.0, 0.3), 2),
            (vec3(0.1, -1.0, 0.3), 3),
            (vec3(0.1, 0.2, 1.0), 4),
            (vec3(0.1, 0.2, -1.0), 5),
        ];
        for (n, way) in ways {
            assert_eq!(Class::facing(n), Class::Surface(way));
        }
    }
}
