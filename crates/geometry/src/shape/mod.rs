//! Shapes: what they are made of, where a ray meets them, how points are sampled on them.
//!
//! Every shape works in `f64` on its `f32` input. A [`ShapeGroup`] is one `Shape` directive of a scene.

mod bend;
pub mod bilinear;
pub mod curve;
pub mod cylinder;
pub mod dice;
pub mod disk;
mod light;
pub mod loopsubdiv;

pub mod sphere;
pub mod triangle;

pub use bilinear::BilinearMesh;
pub use curve::{CurveKind, CurveSegment, Curves};
pub use cylinder::Cylinder;
pub use disk::Disk;
pub use sphere::Sphere;
pub use triangle::TriangleMesh;

pub(crate) use bend::unit_change;

use crate::dvec::DVec3;
use crate::error::{GeometryError, Place};
use crate::{Bounds3, Frame};
use tyndall_base::Vec3;

/// Coordinates up to this size cannot overflow the traversal's products of three lengths \[m\].
pub const COORDINATE_LIMIT: f32 = 1e12;

/// Every ray sees a group with this mask, and a ray with this mask sees every group.
pub const MASK_ALL: u8 = 0xff;

/// One shape of a scene: a mesh or a quadric, with its orientation.
#[derive(Clone, Debug)]
pub struct ShapeGroup {
    /// The geometry.
    pub shape: Shape,
    /// pbrt's `ReverseOrientation`: turns normals round.
    pub reverse_orientation: bool,
    /// Whether the shape's transform mirrors; meshes come transformed, so their maker has to say.
    pub transform_swaps_handedness: bool,
    /// The group takes part in a query when `mask & query mask != 0`.
    pub mask: u8,
}

/// The geometry of a [`ShapeGroup`].
#[derive(Clone, Debug)]
pub enum Shape {
    /// Triangles with shared vertices.
    Triangles(TriangleMesh),
    /// Bilinear patches with shared vertices.
    Bilinear(BilinearMesh),
    /// A sphere or a part of one.
    Sphere(Sphere),
    /// A disk, an annulus or a sector.
    Disk(Disk),
    /// A cylinder or a part of one, without caps.
    Cylinder(Cylinder),
    /// Thin curves.
    Curves(Curves),
}

impl From<Shape> for ShapeGroup {
    /// Seen by every ray, orientation untouched.
    fn from(shape: Shape) -> Self {
        Self { shape, reverse_orientation: false, transform_swaps_handedness: false, mask: MASK_ALL }
    }
}

macro_rules! each {
    ($self:expr, $s:ident => $e:expr) => {
        match $self {
            Shape::Triangles($s) => $e,
            Shape::Bilinear($s) => $e,
            Shape::Sphere($s) => $e,
            Shape::Disk($s) => $e,
            Shape::Cylinder($s) => $e,
            Shape::Curves($s) => $e,
        }
    };
}

impl Shape {
    /// Number of primitives: triangles, patches, or one.
    pub fn prim_count(&self) -> usize {
        match self {
            Self::Triangles(m) => m.indices().len(),
            Self::Bilinear(m) => m.indices().len(),
            Self::Curves(c) => c.prim_count(),
            Self::Sphere(_) | Self::Disk(_) | Self::Cylinder(_) => 1,
        }
    }

    /// The box around primitive `prim`.
    pub fn prim_bounds(&self, prim: u32) -> Bounds3 {
        each!(self, s => s.prim_bounds(prim))
    }

    /// The box around all primitives.
    pub fn bounds(&self) -> Bounds3 {
        (0..self.prim_count()).fold(Bounds3::EMPTY, |b, i| b.union(self.prim_bounds(i as u32)))
    }
}

impl ShapeGroup {
    /// Whether the geometric normal is turned round: reverse orientation XOR a change of handedness.
    #[inline]
    pub fn flips_normal(&self) -> bool {
        self.reverse_orientation != self.transform_swaps_handedness
    }

    /// Local geometry where `o + t d` meets `prim`, next to the parameter `near` if it does so more than once.
    pub(crate) fn local_surface(&self, prim: u32, o: DVec3, d: DVec3, near: f64) -> LocalSurface {
        match &self.shape {
            Shape::Triangles(m) => m.local_surface(prim, o, d, self),
            Shape::Bilinear(m) => m.local_surface(prim, o, d, near, self),
            Shape::Sphere(s) => s.local_surface(o, d, near, self),
            Shape::Disk(s) => s.local_surface(o, d, self),
            Shape::Cylinder(s) => s.local_surface(o, d, near, self),
            Shape::Curves(c) => c.local_surface(prim, o, d, near, self),
        }
    }
}

/// A surface point in the shape's own coordinates, before rounding.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalSurface {
    pub p: DVec3,
    /// Bound on the error of `p` per axis.
    pub noise: DVec3,
    /// How far along its normal a ray that leaves starts, for bodies that are drawn as bands.
    pub lift: f64,
    /// Unit geometric normal, oriented.
    pub ng: DVec3,
    /// Unit shading normal.
    pub ns: DVec3,
    pub dpdu: DVec3,
    pub dpdv: DVec3,
    pub uv: [f64; 2],
}

/// Where a ray meets a primitive that is not a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PrimHit {
    pub t: f64,
    pub u: f64,
    pub v: f64,
}

/// Some orthogonal pair across `n`, for surfaces without a usable parametrisation.
pub(crate) fn any_tangents(n: DVec3) -> (DVec3, DVec3) {
    let f = Frame::from_z(n.round());
    (f.x.into(), f.y.into())
}

/// Sum of three products' rounding error, relative to the sum of magnitudes; generous.
pub(crate) const NOISE: f64 = 4.0 * f64::EPSILON;

pub(crate) fn check_coordinates(points: &[Vec3], element: &'static str) -> Result<(), GeometryError> {
    for (index, p) in points.iter().enumerate() {
        for value in p.to_array() {
            if !(value.abs() <= COORDINATE_LIMIT) {
                return Err(GeometryError::BadCoordinate {
                    place: Place { group: None, element, index },
                    value,
                });
            }
        }
    }
    Ok(())
}

pub(crate) fn check_indices(
    indices: impl Iterator<Item = u32>,
    corners: usize,
    count: usize,
    element: &'static str,
) -> Result<(), GeometryError> {
    for (k, index) in indices.enumerate() {
        if index as usize >= count {
            let place = Place { group: None, element, index: k / corners };
            return Err(GeometryError::IndexOutOfRange { place, index, count });
        }
    }
    Ok(())
}

pub(crate) fn check_length(array: &'static str, got: usize, expected: usize) -> Result<(), GeometryError> {
    if got == 0 || got == expected {
        Ok(())
    } else {
        Err(GeometryError::LengthMismatch { array, expected, got })
    }
}

/// A scalar that must be finite and satisfy `ok`.
pub(crate) fn check(
    parameter: &'static str,
    expected: &'static str,
    got: f64,
    ok: bool,
) -> Result<(), GeometryError> {
    if got.is_finite() && ok { Ok(()) } else { Err(GeometryError::BadParameter { parameter, expected, got }) }
}

/// Both solutions of `a x^2 + 2 h x + c = 0` in ascending order, without cancellation between `h` and the root
/// (Press et al., Numerical Recipes, 5.6); the discriminant is refined as a difference of products.
#[inline]
pub(crate) fn quadratic_half(a: f64, h: f64, discriminant: f64, c: f64) -> Option<[f64; 2]> {
    if !(discriminant >= 0.0) {
        return None;
    }
    let q = -(h + discriminant.sqrt().copysign(h));
    let (x0, x1) = (q / a, if q == 0.0 { 0.0 } else { c / q });
    Some(if x0 < x1 { [x0, x1] } else { [x1, x0] })
}

/// Componentwise linear interpolation.
#[inline]
pub(crate) fn lerp(t: f64, a: DVec3, b: DVec3) -> DVec3 {
    a * (1.0 - t) + b * t
}
