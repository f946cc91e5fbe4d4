//! Texture coordinates of a surface point, after pbrt's mappings.

use tyndall_base::{Vec2, Vec3, math, vec::vec2};
use tyndall_geometry::{SurfacePoint, Transform};

/// The surface point that a texture is evaluated at.
#[derive(Clone, Copy, Debug)]
pub struct TextureContext {
    /// Point \[m\].
    pub p: Vec3,
    /// Geometric normal.
    pub n: Vec3,
    /// Parametric coordinates.
    pub uv: Vec2,
}

impl TextureContext {
    /// No point of a surface: all coordinates are zero.
    pub const ORIGIN: Self = Self { p: Vec3::ZERO, n: Vec3::ZERO, uv: Vec2 { x: 0.0, y: 0.0 } };

    /// The point `s`.
    #[inline(always)]
    pub fn of(s: &SurfacePoint) -> Self {
        Self { p: s.p, n: s.ng, uv: s.uv }
    }
}

/// From a surface point to (s, t).
#[derive(Clone, Debug)]
pub enum Mapping {
    /// `(su u + du, sv v + dv)`.
    Uv {
        /// Factors of u and v.
        scale: [f32; 2],
        /// Offsets of u and v.
        delta: [f32; 2],
    },
    /// Polar angle and azimuth about the z axis of texture space.
    Spherical(Box<Transform>),
    /// Azimuth about, and height along, the z axis of texture space.
    Cylindrical(Box<Transform>),
    /// `(p . v1 + du, p . v2 + dv)` in texture space.
    Planar {
        /// The scene to texture space.
        to_texture: Box<Transform>,
        /// Axes.
        v: [Vec3; 2],
        /// Offsets.
        delta: [f32; 2],
    },
}

impl Default for Mapping {
    fn default() -> Self {
        Self::Uv { scale: [1.0; 2], delta: [0.0; 2] }
    }
}

impl Mapping {
    /// Texture coordinates at `at`.
    pub fn st(&self, at: &TextureContext) -> Vec2 {
        const INV_PI: f32 = std::f32::consts::FRAC_1_PI;
        match self {
            Self::Uv { scale, delta } => vec2(scale[0] * at.uv.x + delta[0], scale[1] * at.uv.y + delta[1]),
            Self::Spherical(to_texture) => {
                let d = to_texture.point(at.p).normalize();
                vec2(math::acos(d.z.clamp(-1.0, 1.0)) * INV_PI, azimuth(d) * 0.5 * INV_PI)
            }
            Self::Cylindrical(to_texture) => {
                let p = to_texture.point(at.p);
                vec2(0.5 + math::atan2(p.y, p.x) * 0.5 * INV_PI, p.z)
            }
            Self::Planar { to_texture, v, delta } => {
                let p = to_texture.point(at.p);
                vec2(delta[0] + p.dot(v[0]), delta[1] + p.dot(v[1]))
            }
        }
    }
}

/// Azimuth of `d` in \[0, 2 pi).
fn azimuth(d: Vec3) -> f32 {
    let phi = math::atan2(d.y, d.x);
    if phi < 0.0 { phi + 2.0 * std::f32::consts::PI } else { phi }
}
