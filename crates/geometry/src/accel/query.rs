//! The state of one query, the entry points by instruction set, and primitives that are not triangles.

use super::lanes::{Lanes, Portable};
#[cfg(target_arch = "x86_64")]
use super::lanes_avx2::Avx2;
use super::node::{Bvh, Child, Node, Other, WIDTH};
use super::traverse::{WORLD, walk};
use super::{Accel, Isa};
use crate::dvec::DVec3;
use crate::shape::Shape;
use crate::{Hit, Ray, Transform};
use std::ops::Range;
use tyndall_base::Vec3;

/// A ray in the space of the level that is walked, in both precisions.
pub(crate) struct LocalRay {
    pub o: [f32; 3],
    pub d: [f32; 3],
    pub o64: DVec3,
    pub d64: DVec3,
}

impl LocalRay {
    #[inline(always)]
    pub fn new(ray: &Ray) -> Self {
        Self { o: ray.o.to_array(), d: ray.d.to_array(), o64: ray.o.into(), d64: ray.d.into() }
    }

    /// In the object's space; the direction keeps its scale, so `t` means the same.
    fn in_object(&self, to_world: &Transform) -> Self {
        let to_object = to_world.inverse();
        let (o64, d64) = (to_object.point64(self.o64), to_object.vector64(self.d64));
        Self { o: o64.round().to_array(), d: d64.round().to_array(), o64, d64 }
    }
}

/// One query: whom it may meet and what it has met.
pub(crate) struct Query<'a, F> {
    accel: &'a Accel,
    mask: u32,
    /// The only bit of `mask`, if there is but one.
    bit: Option<usize>,
    filter: F,
    time: f32,
    /// Nearest accepted hit, or the ray's end.
    t: f64,
    /// The same, rounded up by a bit or two.
    t_max: f32,
    hit: Option<Hit>,
}

impl<'a, F: FnMut(&Hit) -> bool> Query<'a, F> {
    #[inline(always)]
    pub fn new(accel: &'a Accel, ray: &Ray, mask: u8, filter: F) -> Self {
        let t_max = ray.t_max;
        let bit = mask.is_power_of_two().then_some(mask.trailing_zeros() as usize);
        Self {
            accel,
            mask: u32::from(mask),
            bit,
            filter,
            time: ray.time,
            t: f64::from(t_max),
            t_max,
            hit: None,
        }
    }

    #[inline(always)]
    pub fn t_max(&self) -> f32 {
        self.t_max
    }

    /// Slots of a node behind which something may take part.
    #[inline(always)]
    pub fn slots(&self, node: &Node) -> u32 {
        // a query of one bit looks it up; others look everywhere
        self.bit.map_or(u32::MAX, |bit| node.slots_with[bit & (WIDTH - 1)])
    }

    /// Whether a primitive with this mask takes part.
    #[inline(always)]
    pub fn candidate(&self, mask: u32) -> bool {
        mask & self.mask & 0xff != 0
    }

    /// Takes the hit when it is in front, nearer than all before (at equal distance: of lower rank), and not filtered.
    #[inline(always)]
    pub fn offer(&mut self, t: f64, hit: Hit) -> bool {
        if !(t > 0.0 && t <= self.t) {
            return false;
        }
        if t == self.t && self.hit.is_some_and(|best| best.rank() <= hit.rank()) {
            return false;
        }
        if !(self.filter)(&hit) {
            return false;
        }
        self.t = t;
        // not less than t, without a branch: whether t was rounded down is as good as random
        self.t_max = hit.t * (1.0 + f32::EPSILON) + f32::MIN_POSITIVE;
        self.hit = Some(hit);
        true
    }
}

impl Hit {
    /// Order among hits at the same distance.
    #[inline(always)]
    fn rank(&self) -> (u32, u32, u32) {
        (self.instance, self.shape, self.prim)
    }
}

/// An instruction set's own copy of the walk, so that all below is compiled for it.
pub(crate) trait Kernel: Lanes {
    /// The walk from the node `from` on.
    fn level<const ANY: bool, F: FnMut(&Hit) -> bool>(
        self,
        bvh: &Bvh,
        from: Child,
        ray: &LocalRay,
        query: &mut Query<'_, F>,
        instance: u32,
    ) -> bool;
}

impl Kernel for Portable {
    #[inline(never)]
    fn level<const ANY: bool, F: FnMut(&Hit) -> bool>(
        self,
        bvh: &Bvh,
        from: Child,
        ray: &LocalRay,
        query: &mut Query<'_, F>,
        instance: u32,
    ) -> bool {
        walk::<Self, ANY, F>(self, bvh, from, ray, query, instance)
    }
}

/// A kernel and the function that is compiled for its instructions.
#[cfg(target_arch = "x86_64")]
macro_rules! kernel {
    ($wide:literal, $level:ident, $features:literal) => {
        impl Kernel for Avx2<$wide> {
            #[inline(always)]
            fn level<const ANY: bool, F: FnMut(&Hit) -> bool>(
                self,
                bvh: &Bvh,
                from: Child,
                ray: &LocalRay,
                query: &mut Query<'_, F>,
                instance: u32,
            ) -> bool {
                // SAFETY: `self` exists only where the processor has these instructions.
                unsafe { $level::<ANY, F>(self, bvh, from, ray, query, instance) }
            }
        }

        #[target_feature(enable = $features)]
        fn $level<const ANY: bool, F: FnMut(&Hit) -> bool>(
            l: Avx2<$wide>,
            bvh: &Bvh,
            from: Child,
            ray: &LocalRay,
            query: &mut Query<'_, F>,
            instance: u32,
        ) -> bool {
            walk::<Avx2<$wide>, ANY, F>(l, bvh, from, ray, query, instance)
        }
    };
}

#[cfg(target_arch = "x86_64")]
kernel!(false, level_avx2, "avx2,fma,bmi1,bmi2,lzcnt,popcnt");
#[cfg(target_arch = "x86_64")]
kernel!(true, level_avx512, "avx2,fma,bmi1,bmi2,lzcnt,popcnt,avx512f,avx512vl,avx512dq,avx512bw,avx512cd");

/// Meets the primitives that are not triangles.
#[inline(never)]
pub(crate) fn others<K: Kernel, const ANY: bool, F: FnMut(&Hit) -> bool>(
    k: K,
    bvh: &Bvh,
    range: Range<usize>,
    ray: &LocalRay,
    query: &mut Query<'_, F>,
    instance: u32,
) -> bool {
    let mut found = false;
    for other in &bvh.others[range] {
        let hit = match *other {
            Other::Shape { shape, prim, mask } => {
                query.candidate(mask.into()) && meet_shape(shape, prim, ray, query, instance)
            }
            Other::Instance(index) => {
                let accel = query.accel;
                let placed = &accel.instances[index as usize];
                let mut room = None;
                let local = ray.in_object(placed.to_world(query.time, &mut room));
                k.level::<ANY, F>(&accel.objects[placed.object as usize], Child::ROOT, &local, query, index)
            }
        };
        if ANY && hit {
            return true;
        }
        found |= hit;
    }
    found
}

/// Meets one curved primitive.
fn meet_shape<F: FnMut(&Hit) -> bool>(
    shape: u32,
    prim: u32,
    ray: &LocalRay,
    query: &mut Query<'_, F>,
    instance: u32,
) -> bool {
    let geometry = &query.accel.groups[shape as usize].shape;
    let mut t_min = 0.0;
    loop {
        let range = [t_min, query.t];
        let met = match geometry {
            // flat primitives are in the blocks
            Shape::Triangles(_) => None,
            Shape::Bilinear(m) => m.patch(prim).intersect(ray.o64, ray.d64, range),
            Shape::Sphere(s) => s.intersect(ray.o64, ray.d64, range),
            Shape::Disk(s) => s.intersect(ray.o64, ray.d64, range),
            Shape::Cylinder(s) => s.intersect(ray.o64, ray.d64, range),
            Shape::Curves(c) => c.intersect(prim, ray.o64, ray.d64, range),
        };
        let Some(m) = met else { return false };
        let hit = Hit { t: m.t as f32, shape, prim, instance, u: m.u as f32, v: m.v as f32 };
        if query.offer(m.t, hit) {
            return true;
        }
        // what the filter does not let pass may have another side behind it
        t_min = m.t;
    }
}

/// The nearest accepted hit.
#[inline(always)]
pub(crate) fn nearest<F: FnMut(&Hit) -> bool>(accel: &Accel, ray: &Ray, mask: u8, filter: F) -> Option<Hit> {
    let mut query = Query::new(accel, ray, mask, filter);
    run::<false, F>(accel, ray, &mut query);
    query.hit
}

/// Whether anything is accepted.
#[inline(always)]
pub(crate) fn any<F: FnMut(&Hit) -> bool>(accel: &Accel, ray: &Ray, mask: u8, filter: F) -> bool {
    run::<true, F>(accel, ray, &mut Query::new(accel, ray, mask, filter))
}

#[inline(always)]
fn run<const ANY: bool, F: FnMut(&Hit) -> bool>(accel: &Accel, ray: &Ray, query: &mut Query<'_, F>) -> bool {
    let local = LocalRay::new(ray);
    match accel.isa {
        Isa::Portable => Portable.level::<ANY, F>(&accel.world, Child::ROOT, &local, query, WORLD),
        #[cfg(target_arch = "x86_64")]
        Isa::Avx2(l) => l.level::<ANY, F>(&accel.world, Child::ROOT, &local, query, WORLD),
        #[cfg(target_arch = "x86_64")]
        Isa::Avx512(l) => l.level::<ANY, F>(&accel.world, Child::ROOT, &local, query, WORLD),
    }
}

/// The ray in the space of `hit`'s shape, for working out the surface.
pub(crate) fn shape_ray(ray: &Ray, instance: Option<&Transform>) -> (DVec3, DVec3) {
    let local = LocalRay::new(ray);
    let local = instance.map_or(local.o64, |t| t.inverse().point64(local.o64));
    let d: Vec3 = ray.d;
    (local, instance.map_or(d.into(), |t| t.inverse().vector64(d.into())))
}
