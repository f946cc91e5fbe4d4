//! A binary tree over the lights of finite extent: each choice between two children by what they may send to the point
//! that is lit. Built by the surface area and orientation heuristic of Conty Estevez & Kulla 2018.

use super::bounds::LightBounds;
use tyndall_base::Vec3;

/// Candidates for a cut along an axis.
const BINS: usize = 12;

/// Beyond this depth lists are cut in the middle, so that a light's way fits into 64 bits.
const DEEP: u32 = 40;

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: LightBounds,
    /// The second child (the first is the next node), or the light of a leaf.
    next: u32,
    leaf: bool,
}

/// See the module.
#[derive(Clone, Debug, Default)]
pub(super) struct LightTree {
    nodes: Vec<Node>,
    /// The way to each light from the root, a bit a level: 1 is the second child.
    ways: Vec<u64>,
}

impl LightTree {
    /// Over `lights`, given by index and bounds, of a scene of `count` lights.
    pub fn new(mut lights: Vec<(u32, LightBounds)>, count: usize) -> Self {
        let mut tree = Self { nodes: Vec::new(), ways: vec![0; count] };
        lights.retain(|l| l.1.power > 0.0);
        if !lights.is_empty() {
            tree.add(&mut lights, 0, 0);
        }
        tree
    }

    fn add(&mut self, lights: &mut [(u32, LightBounds)], way: u64, depth: u32) {
        let bounds = lights[1..].iter().fold(lights[0].1, |all, l| all.union(&l.1));
        let at = self.nodes.len();
        let leaf = lights.len() == 1;
        self.nodes.push(Node { bounds, next: lights[0].0, leaf });
        if leaf {
            self.ways[lights[0].0 as usize] = way;
            return;
        }
        let middle = cut(lights, &bounds, depth);
        let (first, second) = lights.split_at_mut(middle);
        self.add(first, way, depth + 1);
        self.nodes[at].next = self.nodes.len() as u32;
        self.add(second, way | 1 << depth, depth + 1);
    }

    /// What all lights together may send to `p` with normal `n`; see [`LightBounds::importance`].
    #[inline(always)]
    pub fn importance(&self, p: Vec3, n: Vec3) -> f32 {
        self.nodes.first().map_or(0.0, |root| root.bounds.importance(p, n))
    }

    /// Probability of the first child.
    #[inline]
    fn first_share(&self, at: usize, p: Vec3, n: Vec3) -> Option<f32> {
        let [a, b] = [at + 1, self.nodes[at].next as usize].map(|k| self.nodes[k].bounds.importance(p, n));
        let sum = a + b;
        (sum > 0.0).then(|| a / sum)
    }

    /// A light for `p` with normal `n` (zero for none) and its probability; `None` where nothing arrives.
    #[inline]
    pub fn select(&self, p: Vec3, n: Vec3, mut u: f32) -> Option<(u32, f32)> {
        if self.nodes.is_empty() {
            return None;
        }
        let (mut at, mut pmf) = (0, 1.0);
        while !self.nodes[at].leaf {
            let share = self.first_share(at, p, n)?;
            // the first child has [0, share), the second the rest; the number goes on within its part
            if u < share {
                u /= share;
                pmf *= share;
                at += 1;
            } else {
                u = (u - share) / (1.0 - share);
                pmf *= 1.0 - share;
                at = self.nodes[at].next as usize;
            }
            u = u.clamp(0.0, 1.0 - f32::EPSILON);
        }
        (pmf > 0.0 && self.nodes[at].bounds.importance(p, n) > 0.0).then_some((self.nodes[at].next, pmf))
    }

    /// Probability with which [`Self::select`] returns `light`.
    #[inline]
    pub fn pmf(&self, p: Vec3, n: Vec3, light: u32) -> f32 {
        let mut way = self.ways[light as usize];
        let (mut at, mut pmf) = (0, 1.0);
        if self.nodes.is_empty() {
            return 0.0;
        }
        while !self.nodes[at].leaf {
            let Some(share) = self.first_share(at, p, n) else { return 0.0 };
            let second = way & 1 == 1;
            pmf *= if second { 1.0 - share } else { share };
            at = if second { self.nodes[at].next as usize } else { at + 1 };
            way >>= 1;
        }
        let found = self.nodes[at].next == light && self.nodes[at].bounds.importance(p, n) > 0.0;
        if found { pmf } else { 0.0 }
    }
}

/// Orders `lights` and says where the second child begins.
fn cut(lights: &mut [(u32, LightBounds)], all: &LightBounds, depth: u32) -> usize {
    let middle = lights.len() / 2;
    if depth >= DEEP {
        return middle;
    }
    let centre = |l: &LightBounds, k: usize| 0.5 * (l.bounds.lo[k] + l.bounds.hi[k]);
    let mut best = (f32::INFINITY, 0, 0);
    for k in 0..3 {
        let ends = lights.iter().fold([f32::INFINITY, f32::NEG_INFINITY], |e, l| {
            [e[0].min(centre(&l.1, k)), e[1].max(centre(&l.1, k))]
        });
        if ends[1] <= ends[0] {
            continue;
        }
        let mut bins: [Option<LightBounds>; BINS] = [None; BINS];
        for (_, l) in lights.iter() {
            let bin = &mut bins[bin_of(centre(l, k), ends)];
            *bin = Some(bin.map_or(*l, |b| b.union(l)));
        }
        for split in 1..BINS {
            let side = |range: &[Option<LightBounds>]| {
                range.iter().flatten().copied().reduce(|a, b| a.union(&b)).map_or(0.0, |b| cost(&b, all, k))
            };
            let cost = side(&bins[..split]) + side(&bins[split..]);
            if cost < best.0 {
                best = (cost, k, split);
            }
        }
    }
    let (cost, k, split) = best;
    if !cost.is_finite() {
        return middle;
    }
    let ends = lights.iter().fold([f32::INFINITY, f32::NEG_INFINITY], |e, l| {
        [e[0].min(centre(&l.1, k)), e[1].max(centre(&l.1, k))]
    });
    // stable, so that the tree is the same on every machine
    lights.sort_by_key(|l| bin_of(centre(&l.1, k), ends) >= split);
    let at = lights.partition_point(|l| bin_of(centre(&l.1, k), ends) < split);
    if at == 0 || at == lights.len() { middle } else { at }
}

fn bin_of(x: f32, [low, high]: [f32; 2]) -> usize {
    (((x - low) / (high - low) * BINS as f32) as usize).min(BINS - 1)
}

/// Power times area times solid angle, with long boxes cut across their length first.
fn cost(b: &LightBounds, all: &LightBounds, axis: usize) -> f32 {
    let size = all.bounds.hi - all.bounds.lo;
    let shape = size.max_component() / size[axis].max(f32::MIN_POSITIVE);
    let d = b.bounds.hi - b.bounds.lo;
    let area = 2.0 * (d.x * d.y + d.y * d.z + d.z * d.x);
    // points have no area: their extent then decides
    let area = area + 1e-3 * d.length_squared() + 1e-12;
    b.power * b.orientation_cost() * shape * area
}
