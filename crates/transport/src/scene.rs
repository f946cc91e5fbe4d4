//! The scene: geometry and what is bound to it.

use crate::{
    camera::{Camera, Orthographic, Projective},
    guiding::Field,
    ids::{LightId, MaterialId, MediumId},
    light::LightSet,
    material::Material,
    media::Medium,
    texture::{FloatTexture, TextureContext},
};
use tyndall_base::{
    Vec3,
    hash::{hash3, hash4, to_unit_f32},
};
use tyndall_geometry::{Accel, Hit, MASK_ALL, Notes, Ray, SurfacePoint};
use tyndall_spectral::Emission;

/// Mask of shapes that stop light or bend it.
pub const OPAQUE: u8 = 1;
/// Mask of boundaries that light passes unbent.
pub const BOUNDARY: u8 = 2;

/// What a shape group carries besides its geometry.
#[derive(Clone, Debug)]
pub struct ShapeBinding {
    /// Its material, or [`MaterialId::INTERFACE`].
    pub material: MaterialId,
    /// Media inside (against the normal) and outside, where the shape names two different ones; `None` keeps the
    /// ray's medium, as in pbrt.
    pub boundary: Option<Boundary>,
    /// The light of its first primitive, if it emits; one light a primitive, in order.
    pub first_light: Option<LightId>,
    /// Probability that a ray sees the surface at a point; `None` where it always does.
    pub alpha: Option<FloatTexture>,
}

/// The media on the two sides of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Boundary {
    /// On the side away from the normal.
    pub inside: MediumId,
    /// On the side of the normal.
    pub outside: MediumId,
}

/// Everything that a path needs. Immutable while rendering.
#[derive(Debug)]
pub struct Scene {
    /// Geometry.
    pub accel: Accel,
    /// One entry per shape group of `accel`.
    pub shapes: Vec<ShapeBinding>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Media.
    pub media: Vec<Medium>,
    /// Lights.
    pub lights: LightSet,
    /// The camera.
    pub camera: Camera,
    /// The medium that the camera is in.
    pub camera_medium: MediumId,
    /// Some shape is a boundary without material.
    pub has_boundaries: bool,
    /// Some of those may share faces.
    pub has_touching_boundaries: bool,
    /// Some shape is seen in part only.
    pub has_alpha: bool,
    /// Some material is a mix of others.
    pub has_mixes: bool,
    /// Some material is a bump map over another.
    pub has_bumps: bool,
    /// Where light comes from, if that was learned: steers paths, moves no mean.
    pub guiding: Option<Field>,
}

/// A surface point as a path meets it.
#[derive(Clone, Copy, Debug)]
pub struct Interaction<'s> {
    /// Geometry of the point.
    pub surface: SurfacePoint,
    /// What is bound to the shape.
    pub binding: &'s ShapeBinding,
    /// Its material, decided where it is a mix.
    pub material: MaterialId,
    /// The light of the primitive, if it emits.
    pub light: Option<LightId>,
    /// The media on its two sides, where it is between different ones.
    pub boundary: Option<Boundary>,
}

/// What lies on a shadow ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Obstacles {
    /// A surface with a material.
    pub blocked: bool,
    /// Boundaries without one; complete only where nothing blocks.
    pub boundaries: Notes,
}

impl Obstacles {
    /// Something that blocks.
    pub const BLOCKED: Self = Self { blocked: true, boundaries: Notes::NONE };
}

impl Scene {
    /// A scene with nothing in it.
    pub fn empty() -> Self {
        let accel = Accel::build(Vec::new(), &[], Vec::new(), &tyndall_geometry::BuildOptions::default())
            .expect("nothing is nothing wrong");
        let projective = Projective {
            resolution: [1, 1],
            screen: [-1.0, 1.0, -1.0, 1.0],
            lens_radius: 0.0,
            focal_distance: 1.0,
            to_world: tyndall_geometry::Transform::IDENTITY,
            motion: None,
        };
        let camera = Camera::Orthographic(Orthographic::new(projective).expect("a valid camera"));
        Self {
            accel,
            shapes: Vec::new(),
            materials: Vec::new(),
            media: Vec::new(),
            lights: LightSet::default(),
            camera,
            camera_medium: MediumId::VACUUM,
            has_boundaries: false,
            has_touching_boundaries: false,
            has_alpha: false,
            has_mixes: false,
            has_bumps: false,
            guiding: None,
        }
    }

    /// Every emission of the scene with a weight that makes them comparable: about the power per unit of spectrum.
    pub fn emitters(&self) -> Vec<(f32, &Emission)> {
        let (_, radius) = self.accel.bounds().bounding_sphere();
        let radius = if radius.is_finite() && radius > 0.0 { radius } else { 1.0 };
        let lights = self.lights.iter().map(|l| (l.extent(radius) as f32, l.spectrum()));
        // a medium that fills the scene: 4 pi times its volume, per metre of absorption; those that are lights know better
        let volume = 4.0 / 3.0 * std::f32::consts::PI * radius * radius * radius;
        let unknown = |i: usize| self.lights.of_medium(MediumId(i as u32)).is_none();
        let media =
            self.media.iter().enumerate().filter(|(i, _)| unknown(*i)).filter_map(|(_, m)| m.emission());
        lights.chain(media.map(|e| (4.0 * std::f32::consts::PI * volume, e))).collect()
    }

    /// The nearest surface along `ray`.
    #[inline(always)]
    pub fn intersect(&self, ray: &Ray) -> Option<Hit> {
        if self.has_alpha { self.nearest_opaque(ray, MASK_ALL) } else { self.accel.intersect(ray) }
    }

    /// The nearest surface along `ray` that a path has to stop at, with boundaries before it that it may pass by, and maybe
    /// some behind it.
    #[inline(always)]
    pub fn intersect_noting(&self, ray: &Ray) -> (Option<Hit>, Notes) {
        let mut notes = Notes::NONE;
        if self.has_alpha || !self.has_boundaries {
            return (self.intersect(ray), notes);
        }
        let met = self.accel.intersect_filtered(ray, MASK_ALL, |hit| {
            let shape = &self.shapes[hit.shape as usize];
            let passes = shape.material.is_interface() && shape.first_light.is_none();
            if passes {
                notes.push(*hit);
            }
            !passes
        });
        (met, notes)
    }

    /// Whether a surface with a material lies on `ray`, and whether a boundary without one does.
    #[inline(always)]
    pub fn obstacles(&self, ray: &Ray) -> Obstacles {
        let mut boundaries = Notes::NONE;
        if !self.has_boundaries {
            let blocked = if self.has_alpha {
                self.accel.occluded_filtered(ray, OPAQUE, |hit| self.sees(ray, hit))
            } else {
                self.accel.occluded_masked(ray, OPAQUE)
            };
            return Obstacles { blocked, boundaries };
        }
        // one walk answers both: it ends at the first material and notes every boundary on its way
        let blocked = self.accel.occluded_filtered(ray, OPAQUE | BOUNDARY, |hit| {
            if self.has_alpha && !self.sees(ray, hit) {
                return false;
            }
            let passes = self.shapes[hit.shape as usize].material.is_interface();
            if passes {
                boundaries.push(*hit);
            }
            !passes
        });
        Obstacles { blocked, boundaries }
    }

    /// [`Scene::obstacles`] of up to 16 rays of one time, written to `out` in their order: much faster than one by one for
    /// rays that are near each other along their whole way.
    ///
    /// # Panics
    /// With more than 16 rays, or more rays than room.
    #[inline(always)]
    pub fn obstacles_fan(&self, rays: &[Ray], out: &mut [Obstacles]) {
        if self.has_alpha {
            for i in 0..rays.len() {
                out[i] = self.obstacles(&rays[i]);
            }
            return;
        }
        let noted = if self.has_boundaries { BOUNDARY } else { 0 };
        let fan = self.accel.occluded_fan(rays, OPAQUE, noted);
        for i in 0..rays.len() {
            out[i] = Obstacles { blocked: fan.blocked >> i & 1 != 0, boundaries: fan.noted[i] };
        }
    }

    #[inline(never)]
    fn nearest_opaque(&self, ray: &Ray, mask: u8) -> Option<Hit> {
        self.accel.intersect_filtered(ray, mask, |hit| self.sees(ray, hit))
    }

    /// Whether `ray` sees the shape at `hit`: with the probability `alpha`, by a number that the ray and the hit fix.
    fn sees(&self, ray: &Ray, hit: &Hit) -> bool {
        let Some(alpha) = &self.shapes[hit.shape as usize].alpha else { return true };
        let a = alpha.constant().unwrap_or_else(|| {
            let s = self.accel.surface(ray, hit);
            alpha.eval(&TextureContext { p: s.p, n: s.ng, uv: s.uv })
        });
        if a <= 0.0 || a >= 1.0 {
            return a > 0.0;
        }
        let bits = |v: Vec3| hash3(v.x.to_bits(), v.y.to_bits(), v.z.to_bits());
        let what = hash4(hit.t.to_bits(), hit.shape, hit.prim, hit.instance);
        to_unit_f32(hash3(bits(ray.o), bits(ray.d), what)) < a
    }

    /// The nearest boundary without material along `ray`.
    #[inline(always)]
    pub fn next_boundary(&self, ray: &Ray) -> Option<Hit> {
        if self.has_alpha {
            self.nearest_opaque(ray, BOUNDARY)
        } else {
            self.accel.intersect_masked(ray, BOUNDARY)
        }
    }

    /// What stands at `hit`.
    #[inline(always)]
    pub fn interaction(&self, ray: &Ray, hit: &Hit) -> Interaction<'_> {
        let binding = &self.shapes[hit.shape as usize];
        let light = binding.first_light.map(|first| LightId(first.0 + hit.prim));
        let mut surface = self.accel.surface(ray, hit);
        let material = self.material_of(binding, &surface, ray.d);
        if self.has_bumps && !material.is_interface() && self.materials[material.index()].is_bumped() {
            self.accel.bend(ray, hit, &mut surface);
        }
        let mut boundary = binding.boundary;
        if self.has_touching_boundaries
            && material.is_interface()
            && let Some(own) = boundary
        {
            boundary = Some(self.joint_boundary(ray, hit, &surface, own));
        }
        Interaction { surface, binding, material, light, boundary }
    }

    /// The material that a path along `d` meets at `s`, [`MaterialId::INTERFACE`] for none; mixes are decided here.
    #[inline(always)]
    fn material_of(&self, binding: &ShapeBinding, s: &SurfacePoint, d: Vec3) -> MaterialId {
        let id = binding.material;
        if self.has_mixes && !id.is_interface() { self.unmixed(id, s, d) } else { id }
    }

    #[inline(never)]
    fn unmixed(&self, mut id: MaterialId, s: &SurfacePoint, d: Vec3) -> MaterialId {
        // readers refuse mixes within themselves, so this ends
        while !id.is_interface() {
            let Material::Mix(mix) = &self.materials[id.index()] else { break };
            id = mix.choose(s, d);
        }
        id
    }

    /// The medium behind `hit`, a boundary that coincides with no other, for a ray that came through `current`.
    #[inline(always)]
    pub fn medium_behind(&self, ray: &Ray, hit: &Hit, current: MediumId) -> MediumId {
        let binding = &self.shapes[hit.shape as usize];
        if binding.boundary.is_none() {
            return current;
        }
        medium_beyond(binding.boundary, self.accel.leaves_outward(ray, hit), current)
    }

    /// The medium `id`, or `None` for vacuum.
    #[inline(always)]
    pub fn medium(&self, id: MediumId) -> Option<&Medium> {
        if id.is_vacuum() { None } else { Some(&self.media[id.index()]) }
    }
}

impl Interaction<'_> {
    /// The medium that a ray leaving along `d` travels in; `current` is the one it came in.
    #[inline(always)]
    pub fn medium_towards(&self, d: Vec3, current: MediumId) -> MediumId {
        medium_beyond(self.boundary, d.dot(self.surface.ng) > 0.0, current)
    }
}

/// The medium of a ray that leaves a shape on the side of its normal, if `outward`, or on the other one.
#[inline(always)]
fn medium_beyond(boundary: Option<Boundary>, outward: bool, current: MediumId) -> MediumId {
    match boundary {
        None => current,
        Some(b) if outward => b.outside,
        Some(b) => b.inside,
    }
}
