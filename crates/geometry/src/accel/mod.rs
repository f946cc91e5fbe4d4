//! The acceleration structure: two levels of an 8-wide bounding volume hierarchy.
//!
//! The world level holds every shape group that belongs to no object, and the instances; an object's level holds its
//! groups in the object's own space. A ray that meets an instance's box is transformed in `f64` and walks the
//! object's level with the same parameter `t`.

mod bins;
mod build;
mod bundle;
mod collect;
mod fan;
mod hull;
mod lanes;
#[cfg(target_arch = "x86_64")]
mod lanes_avx2;
mod node;
mod notes;
mod query;
mod slabs;
mod store;
mod traverse;
mod triangle;

pub use fan::Fan;

use crate::error::GeometryError;
use crate::shape::{LocalSurface, MASK_ALL, Shape, ShapeGroup, unit_change};
use crate::surface::Rounding;
use crate::{Bounds3, Motion, Ray, SurfacePoint, Transform};
use collect::{References, level};
use node::Bvh;
pub use notes::Notes;
use tyndall_base::{Vec3, vec::vec2};

/// What [`Hit::instance`] is outside every instance.
pub const NO_INSTANCE: u32 = u32::MAX;

/// Where a ray meets something; the geometry there is worked out by [`Accel::surface`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance in units of the ray's direction.
    pub t: f32,
    /// Index of the shape group as given to [`Accel::build`].
    pub shape: u32,
    /// Primitive within the group.
    pub prim: u32,
    /// Index of the instance, or [`NO_INSTANCE`].
    pub instance: u32,
    /// Triangle: barycentric weight of the second corner. Patch: u. Otherwise 0.
    pub u: f32,
    /// Triangle: barycentric weight of the third corner. Patch: v. Otherwise 0.
    pub v: f32,
}

/// An object placed in the world.
#[derive(Clone, Debug)]
pub struct InstanceDesc {
    /// Index of the object.
    pub object: u32,
    /// From the object's space to the world, at the shutter's start.
    pub to_world: Transform,
    /// How that changes while the shutter is open.
    pub motion: Option<Box<Motion>>,
}

impl InstanceDesc {
    /// An object at rest.
    pub fn at_rest(object: u32, to_world: Transform) -> Self {
        Self { object, to_world, motion: None }
    }

    /// The transform at `time`; `room` holds it where it is worked out.
    #[inline(always)]
    fn to_world<'a>(&'a self, time: f32, room: &'a mut Option<Transform>) -> &'a Transform {
        match &self.motion {
            None => &self.to_world,
            Some(motion) => room.insert(motion.at(time)),
        }
    }

    /// The box around the object while the shutter is open.
    fn bounds(&self, object: Bounds3) -> Bounds3 {
        match &self.motion {
            None => self.to_world.bounds(object),
            Some(motion) => motion.bounds(object),
        }
    }
}

/// Which instructions are used. All give the same bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Dispatch {
    /// The fastest that this processor has.
    #[default]
    Detect,
    /// Plain arrays, whatever the processor.
    Portable,
    /// AVX2 with FMA and BMI.
    Avx2,
    /// AVX-512 (F, VL, DQ, BW, CD).
    Avx512,
}

impl Dispatch {
    /// Whether this processor has the instructions.
    pub fn is_available(self) -> bool {
        #[cfg(target_arch = "x86_64")]
        let has = match self {
            Self::Detect | Self::Portable => true,
            Self::Avx2 => lanes_avx2::Avx2::detect().is_some(),
            Self::Avx512 => lanes_avx2::Avx2::detect().and_then(lanes_avx2::Avx2::wide).is_some(),
        };
        #[cfg(not(target_arch = "x86_64"))]
        let has = matches!(self, Self::Detect | Self::Portable);
        has
    }
}

/// How to build.
#[derive(Clone, Copy, Debug, Default)]
pub struct BuildOptions {
    /// Which instructions the traversal will use.
    pub dispatch: Dispatch,
}

/// What was built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BuildStats {
    /// Triangles and halves of flat patches in the tree.
    pub triangles: usize,
    /// Other primitives: spheres, disks, curved patches.
    pub others: usize,
    /// Triangles and patches left out because they have no area.
    pub degenerate: usize,
    /// Memory of nodes and triangle blocks \[bytes\].
    pub bytes: usize,
}

#[derive(Clone, Copy, Debug)]
enum Isa {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2(lanes_avx2::Avx2<false>),
    #[cfg(target_arch = "x86_64")]
    Avx512(lanes_avx2::Avx2<true>),
}

impl Isa {
    fn choose(dispatch: Dispatch) -> Self {
        #[cfg(target_arch = "x86_64")]
        if dispatch != Dispatch::Portable
            && let Some(l) = lanes_avx2::Avx2::detect()
        {
            let wide = if dispatch == Dispatch::Avx2 { None } else { l.wide() };
            return wide.map_or(Self::Avx2(l), Self::Avx512);
        }
        let _ = dispatch;
        Self::Portable
    }
}

/// Everything that rays can meet.
#[derive(Debug)]
pub struct Accel {
    groups: Vec<ShapeGroup>,
    instances: Vec<InstanceDesc>,
    objects: Vec<Bvh>,
    world: Bvh,
    isa: Isa,
    stats: BuildStats,
}

impl Accel {
    /// Builds the tree. `objects` lists the groups of each object; groups in no object are in the world. Hits name
    /// groups and instances by their index here.
    ///
    /// # Errors
    /// When an object or instance names something that does not exist, an instance's image is not finite, or there
    /// are more primitives than 2^27 in one level.
    pub fn build(
        groups: Vec<ShapeGroup>,
        objects: &[Vec<u32>],
        instances: Vec<InstanceDesc>,
        options: &BuildOptions,
    ) -> Result<Self, GeometryError> {
        let mut in_object = vec![false; groups.len()];
        for &group in objects.iter().flatten() {
            let slot = in_object.get_mut(group as usize);
            *slot.ok_or(GeometryError::NoSuch {
                what: "object's shape",
                index: group,
                count: groups.len(),
            })? = true;
        }
        let mut stats = BuildStats::default();
        let mut levels = Vec::with_capacity(objects.len());
        for members in objects {
            let mut refs = References::new(&groups, &mut stats, true);
            members.iter().for_each(|&g| refs.add_group(g));
            let refs = refs.refs;
            levels.push(level(&groups, refs, &mut stats)?);
        }
        let mut refs = References::new(&groups, &mut stats, false);
        (0..groups.len()).filter(|&g| !in_object[g]).for_each(|g| refs.add_group(g as u32));
        for (i, instance) in instances.iter().enumerate() {
            refs.add_instance(i, instance, &levels)?;
        }
        let refs = refs.refs;
        let world = level(&groups, refs, &mut stats)?;
        Ok(Self { groups, instances, objects: levels, world, isa: Isa::choose(options.dispatch), stats })
    }

    /// The nearest point along the ray that any group shows.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<Hit> {
        query::nearest(self, ray, MASK_ALL, |_| true)
    }

    /// The nearest point on a group whose mask shares a bit with `mask`.
    #[inline]
    pub fn intersect_masked(&self, ray: &Ray, mask: u8) -> Option<Hit> {
        query::nearest(self, ray, mask, |_| true)
    }

    /// The nearest point that `accept` lets pass. `accept` sees candidates in no particular order, each perhaps
    /// farther than one seen before, so it must depend on the hit alone.
    #[inline]
    pub fn intersect_filtered(&self, ray: &Ray, mask: u8, accept: impl FnMut(&Hit) -> bool) -> Option<Hit> {
        query::nearest(self, ray, mask, accept)
    }

    /// Whether anything lies on the ray.
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> bool {
        query::any(self, ray, MASK_ALL, |_| true)
    }

    /// Whether a group whose mask shares a bit with `mask` lies on the ray.
    #[inline]
    pub fn occluded_masked(&self, ray: &Ray, mask: u8) -> bool {
        query::any(self, ray, mask, |_| true)
    }

    /// Whether anything that `accept` lets pass lies on the ray.
    #[inline]
    pub fn occluded_filtered(&self, ray: &Ray, mask: u8, accept: impl FnMut(&Hit) -> bool) -> bool {
        query::any(self, ray, mask, accept)
    }

    /// The surface that `ray` meets at `hit`, worked out in `f64` from the primitive.
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let group = &self.groups[hit.shape as usize];
        let mut room = None;
        let to_world = self.placed(ray, hit, &mut room);
        let (o, d) = query::shape_ray(ray, to_world);
        let local = group.local_surface(hit.prim, o, d, f64::from(hit.t));
        finish(to_world.map_or(local, |t| place(&local, t)), ray.time)
    }

    /// Works out how the shading normal of `surface`, which `ray` meets at `hit`, changes along it.
    #[inline(never)]
    pub fn bend(&self, ray: &Ray, hit: &Hit, surface: &mut SurfacePoint) {
        let group = &self.groups[hit.shape as usize];
        let mut room = None;
        let to_world = self.placed(ray, hit, &mut room);
        let (o, d) = query::shape_ray(ray, to_world);
        let near = f64::from(hit.t);
        let local = group.local_surface(hit.prim, o, d, near);
        let dn = group.normal_change(hit.prim, (o, d), near, &local);
        surface.dn = dn.map(|dn| match to_world {
            None => dn.round(),
            Some(t) => unit_change(t.normal64(local.ns), t.normal64(dn)).round(),
        });
    }

    /// The map of the hit object's space to the world; `room` holds it where it is worked out.
    #[inline(always)]
    fn placed<'a>(&'a self, ray: &Ray, hit: &Hit, room: &'a mut Option<Transform>) -> Option<&'a Transform> {
        if hit.instance == NO_INSTANCE {
            return None;
        }
        Some(self.instances[hit.instance as usize].to_world(ray.time, room))
    }

    /// Whether the ray leaves `hit` on the side that the surface's geometric normal points to: as [`Accel::surface`] tells,
    /// without working out the point where a plain triangle is met.
    #[inline]
    pub fn leaves_outward(&self, ray: &Ray, hit: &Hit) -> bool {
        let group = &self.groups[hit.shape as usize];
        if let Shape::Triangles(mesh) = &group.shape
            && hit.instance == NO_INSTANCE
            && !mesh.has_normals()
        {
            let along = mesh.normal_along(hit.prim, ray.d.into());
            return (along > 0.0) != group.flips_normal() && along != 0.0;
        }
        ray.d.dot(self.surface(ray, hit).ng) > 0.0
    }

    /// Whether the ray meets the side that the surface's geometric normal points to.
    #[inline]
    pub fn is_front(ray: &Ray, surface: &SurfacePoint) -> bool {
        ray.d.dot(surface.ng) < 0.0
    }

    /// The box around everything.
    pub fn bounds(&self) -> Bounds3 {
        self.world.bounds
    }

    /// A shape group.
    pub fn group(&self, shape: u32) -> &ShapeGroup {
        &self.groups[shape as usize]
    }

    /// All shape groups in the order given.
    pub fn groups(&self) -> &[ShapeGroup] {
        &self.groups
    }

    /// All instances in the order given.
    pub fn instances(&self) -> &[InstanceDesc] {
        &self.instances
    }

    /// A hash of the trees (FNV-1a over nodes and blocks): equal trees have equal fingerprints on every machine of the
    /// same byte order.
    pub fn fingerprint(&self) -> u64 {
        let levels = self.objects.iter().chain([&self.world]);
        let bytes = levels.flat_map(|l| {
            let nodes: &[u8] = bytemuck::cast_slice(&l.nodes);
            nodes.iter().chain(bytemuck::cast_slice::<_, u8>(&l.blocks))
        });
        bytes.fold(0xcbf2_9ce4_8422_2325, |h, &b| (h ^ u64::from(b)).wrapping_mul(0x0000_0100_0000_01b3))
    }

    /// What was built.
    pub fn stats(&self) -> BuildStats {
        self.stats
    }
}

/// Rounds a world-space surface.
fn finish(s: LocalSurface, time: f32) -> SurfacePoint {
    let (p, rounding) = Rounding::of(s.p, s.noise + s.ng.abs() * s.lift);
    let uv = vec2(s.uv[0] as f32, s.uv[1] as f32);
    let (ng, ns) = (s.ng.round(), s.ns.round());
    let (dpdu, dpdv) = (s.dpdu.round(), s.dpdv.round());
    SurfacePoint { p, rounding, ng, ns, dpdu, dpdv, dn: [Vec3::ZERO; 2], uv, time }
}

/// An object's surface in the world.
fn place(s: &LocalSurface, to_world: &Transform) -> LocalSurface {
    let ng = to_world.normal64(s.ng).normalize();
    LocalSurface {
        p: to_world.point64(s.p),
        noise: to_world.point_noise(s.p) + to_world.spread(s.noise),
        lift: to_world.vector64(s.ng * s.lift).length(),
        ng,
        ns: to_world.normal64(s.ns).normalize(),
        dpdu: to_world.vector64(s.dpdu),
        dpdv: to_world.vector64(s.dpdv),
        uv: s.uv,
    }
}
