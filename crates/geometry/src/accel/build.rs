//! Top-down construction of the 8-wide tree by a binned surface area heuristic whose leaf cost counts *blocks* of four
//! triangles, `ceil(n/4)`, so that leaves come out full.
//!
//! Deterministic for any number of threads: a subtree is a function of its range of references alone, and bins are
//! combined by minimum, maximum and integer sums.

use super::bins::best_plane;
use super::node::{Block, Bvh, Child, LANES, LEAF_MAX, MAX_DEPTH, Node, Other, WIDTH};
use super::slabs::SLACK;
use super::store::Store;
use crate::{Bounds3, GeometryError};
use rayon::prelude::*;
use tyndall_base::Vec3;

/// Triangles that a leaf may hold; more than a few blocks never pay.
const LEAF_TRIANGLES: u32 = 8;
/// Cost of a primitive that is not a triangle, in blocks.
pub(super) const OTHER_COST: u32 = 3;
/// From this depth on ranges are halved by count, which bounds the depth whatever the input.
const BALANCE_FROM: usize = 32;
/// Ranges below this are built on one thread.
pub(super) const PARALLEL: usize = 8192;

/// What a reference stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Triangle,
    /// The half p11, p01, p10 of a flat patch.
    SecondHalf,
    Shape,
    Instance,
}

/// A primitive to be placed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ref {
    pub bounds: Bounds3,
    pub shape: u32,
    pub prim: u32,
    pub kind: Kind,
}

impl Ref {
    pub(super) fn is_triangle(&self) -> bool {
        matches!(self.kind, Kind::Triangle | Kind::SecondHalf)
    }

    /// Twice the box's centre.
    pub(super) fn middle(&self) -> Vec3 {
        self.bounds.lo + self.bounds.hi
    }
}

/// Box, extent of centres and counts of a set of references.
#[derive(Clone, Copy, Debug)]
struct Summary {
    bounds: Bounds3,
    middles: Bounds3,
    triangles: u32,
    others: u32,
}

impl Summary {
    const EMPTY: Self = Self { bounds: Bounds3::EMPTY, middles: Bounds3::EMPTY, triangles: 0, others: 0 };

    fn with(self, r: &Ref) -> Self {
        let triangle = u32::from(r.is_triangle());
        Self {
            bounds: self.bounds.union(r.bounds),
            middles: self.middles.with_point(r.middle()),
            triangles: self.triangles + triangle,
            others: self.others + (1 - triangle),
        }
    }

    fn union(self, b: Self) -> Self {
        Self {
            bounds: self.bounds.union(b.bounds),
            middles: self.middles.union(b.middles),
            triangles: self.triangles + b.triangles,
            others: self.others + b.others,
        }
    }

    fn of(refs: &[Ref]) -> Self {
        if refs.len() < PARALLEL {
            return refs.iter().fold(Self::EMPTY, Self::with);
        }
        let parts = refs.par_chunks(PARALLEL).map(|c| c.iter().fold(Self::EMPTY, Self::with));
        parts.reduce(|| Self::EMPTY, Self::union)
    }

    fn count(&self) -> u32 {
        self.triangles + self.others
    }

    /// Cost of testing all, in blocks.
    fn work(&self) -> f32 {
        (self.triangles.div_ceil(LANES as u32) + OTHER_COST * self.others) as f32
    }

    /// One kind only and few enough.
    fn fits_a_leaf(&self) -> bool {
        (self.others == 0 && self.triangles <= LEAF_TRIANGLES)
            || (self.triangles == 0 && self.others <= LEAF_MAX as u32)
    }

    /// Nothing to gain from splitting.
    fn is_atomic(&self) -> bool {
        (self.others == 0 && self.triangles <= LANES as u32) || (self.triangles == 0 && self.others <= 1)
    }
}

/// A contiguous range of references.
#[derive(Clone, Copy, Debug)]
struct Span {
    from: usize,
    to: usize,
    summary: Summary,
}

impl Span {
    fn of(refs: &[Ref], from: usize, to: usize) -> Self {
        Self { from, to, summary: Summary::of(&refs[from..to]) }
    }
}

/// A built subtree; leaves name ranges of the sorted references.
enum Tree {
    Leaf { from: usize, to: usize },
    Inner(Vec<(Bounds3, Tree)>),
}

/// Builds the tree over `refs`; `corners` gives a triangle's (or half patch's) corners and `mask` a group's mask.
pub(crate) fn build(
    mut refs: Vec<Ref>,
    corners: &(dyn Fn(&Ref) -> [Vec3; 3] + Sync),
    mask: &dyn Fn(u32) -> u8,
) -> Result<Bvh, GeometryError> {
    let root = Span::of(&refs, 0, refs.len());
    let needed = refs.len();
    // every leaf holds at least one reference, so blocks, other primitives and nodes are all below this
    if needed >= Child::INDEX_LIMIT {
        return Err(GeometryError::TooManyPrimitives { limit: Child::INDEX_LIMIT, got: needed });
    }
    let tree = match subtree(&mut refs, 0, root, 0) {
        leaf @ Tree::Leaf { .. } if needed > 0 => Tree::Inner(vec![(root.summary.bounds, leaf)]),
        Tree::Leaf { .. } => Tree::Inner(vec![]),
        inner => inner,
    };
    let mut out = Output { refs: &refs, corners, mask, nodes: vec![], blocks: vec![], others: vec![] };
    out.emit(&tree);
    Ok(Bvh {
        nodes: Store::new(out.nodes),
        blocks: Store::new(out.blocks),
        others: out.others,
        bounds: root.summary.bounds,
    })
}

/// The subtree over `refs`, which are the references from `offset` on.
fn subtree(refs: &mut [Ref], offset: usize, span: Span, depth: usize) -> Tree {
    let leaf = Tree::Leaf { from: offset + span.from, to: offset + span.to };
    let children = children(refs, span, depth);
    if children.len() == 1 {
        return leaf;
    }
    assert!(depth < MAX_DEPTH, "balancing by count from depth {BALANCE_FROM} bounds the depth");
    let mut rest = refs;
    let mut jobs = Vec::with_capacity(children.len());
    let mut start = span.from;
    rest = &mut rest[span.from..];
    for child in children {
        let (mine, other) = rest.split_at_mut(child.to - child.from);
        jobs.push((mine, offset + start, child));
        start = child.to;
        rest = other;
    }
    let build = |(mine, offset, child): (&mut [Ref], usize, Span)| {
        let local = Span { from: 0, to: child.to - child.from, summary: child.summary };
        (child.summary.bounds, subtree(mine, offset, local, depth + 1))
    };
    let parallel = span.to - span.from >= PARALLEL;
    Tree::Inner(if parallel {
        jobs.into_par_iter().map(build).collect()
    } else {
        jobs.into_iter().map(build).collect()
    })
}

/// Up to eight consecutive spans that make up `span`: always the one with the greatest box is split next.
fn children(refs: &mut [Ref], span: Span, depth: usize) -> Vec<Span> {
    let balance = depth >= BALANCE_FROM;
    let mut spans = vec![(span, false)];
    while spans.len() < WIDTH {
        let weight = |s: &Span| if balance { s.summary.count() as f32 } else { s.summary.bounds.half_area() };
        let open = spans.iter().enumerate().filter(|(_, (_, closed))| !closed);
        let Some(next) = open.map(|(i, (s, _))| (i, weight(s))).max_by(|a, b| a.1.total_cmp(&b.1)) else {
            break;
        };
        let i = next.0;
        match split(refs, &spans[i].0, balance) {
            Some((a, b)) => {
                spans[i] = (a, false);
                spans.push((b, false));
            }
            None => spans[i].1 = true,
        }
    }
    let mut spans: Vec<Span> = spans.into_iter().map(|(s, _)| s).collect();
    spans.sort_by_key(|s| s.from);
    spans
}

/// Two parts, or `None` when `span` is best left as a leaf.
fn split(refs: &mut [Ref], span: &Span, balance: bool) -> Option<(Span, Span)> {
    let s = &span.summary;
    if s.count() == 0 || s.is_atomic() {
        return None;
    }
    let part = &mut refs[span.from..span.to];
    let plane = if balance { None } else { best_plane(part, s.middles) };
    let leaf = s.bounds.half_area() * s.work();
    let traversed = s.bounds.half_area() + plane.map_or(f32::INFINITY, |p| p.cost);
    if s.fits_a_leaf() && (balance || leaf <= traversed) {
        return None;
    }
    let mixed = s.triangles > 0 && s.others > 0;
    let left = match plane {
        _ if mixed && s.count() <= LANES as u32 => partition(part, Ref::is_triangle),
        Some(p) => partition(part, |r| p.bin(r) < p.at),
        None if mixed => partition(part, Ref::is_triangle),
        None => part.len() / 2,
    };
    let middle = span.from + left;
    Some((Span::of(refs, span.from, middle), Span::of(refs, middle, span.to)))
}

/// Moves those that satisfy `first` to the front and returns how many they are.
fn partition(refs: &mut [Ref], first: impl Fn(&Ref) -> bool) -> usize {
    let (mut i, mut j) = (0, refs.len());
    while i < j {
        if first(&refs[i]) {
            i += 1;
        } else {
            j -= 1;
            refs.swap(i, j);
        }
    }
    i
}

/// The arrays in the making, depth first.
struct Output<'a> {
    refs: &'a [Ref],
    corners: &'a (dyn Fn(&Ref) -> [Vec3; 3] + Sync),
    mask: &'a dyn Fn(u32) -> u8,
    nodes: Vec<Node>,
    blocks: Vec<Block>,
    others: Vec<Other>,
}

impl Output<'_> {
    /// The child that `tree` becomes, and the mask bits of its primitives.
    fn emit(&mut self, tree: &Tree) -> (Child, u8) {
        match tree {
            Tree::Leaf { from, to } => {
                let refs = &self.refs[*from..*to];
                (self.leaf(refs), refs.iter().fold(0, |bits, r| bits | self.mask_of(r)))
            }
            Tree::Inner(children) => {
                let id = self.nodes.len();
                self.nodes.push(Node::EMPTY);
                let mut bits = 0;
                for (slot, (bounds, child)) in children.iter().enumerate() {
                    let (child, mask) = self.emit(child);
                    self.nodes[id].set(slot, *bounds, child, mask);
                    bits |= mask;
                }
                (Child(id as u32), bits)
            }
        }
    }

    /// An instance may hold anything.
    fn mask_of(&self, r: &Ref) -> u8 {
        if r.kind == Kind::Instance { u8::MAX } else { (self.mask)(r.shape) }
    }

    fn leaf(&mut self, refs: &[Ref]) -> Child {
        if refs.iter().all(Ref::is_triangle) {
            let first = self.blocks.len();
            let blocks = refs.chunks(LANES).map(|c| self.block(c));
            let blocks: Vec<Block> = blocks.collect();
            self.blocks.extend(blocks);
            return Child::triangles(first, self.blocks.len() - first);
        }
        let first = self.others.len();
        for r in refs {
            let mask = if r.kind == Kind::Instance { 0 } else { (self.mask)(r.shape) };
            self.others.push(match r.kind {
                Kind::Instance => Other::Instance(r.shape),
                _ => Other::Shape { shape: r.shape, prim: r.prim, mask },
            });
        }
        Child::others(first, refs.len())
    }

    fn block(&self, refs: &[Ref]) -> Block {
        let mut block = Block::EMPTY;
        for (lane, r) in refs.iter().enumerate() {
            for (k, corner) in (self.corners)(r).into_iter().enumerate() {
                for axis in 0..3 {
                    block.corner[k][axis][lane] = corner[axis];
                }
            }
            block.prim[lane] = r.prim;
            block.shape[lane] = r.shape;
            let half = if r.kind == Kind::SecondHalf { Block::SECOND_HALF } else { 0 };
            block.mask[lane] = u32::from((self.mask)(r.shape)) | half;
        }
        block
    }
}

/// A primitive's box as the walk needs it: wider by the error of its own edge tests, and by `coordinate_error` for
/// objects whose rays arrive rounded.
pub(crate) fn widen(b: Bounds3, coordinate_error: f32) -> Bounds3 {
    b.padded(Vec3::splat(b.extent().max_component() * SLACK + coordinate_error))
}
