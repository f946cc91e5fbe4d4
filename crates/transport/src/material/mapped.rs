//! Normal maps and bump maps: a material seen in a turned shading frame.

use super::Material;
use crate::texture::{FloatTexture, ImageMap, TextureContext};
use tyndall_base::{Vec3, vec::vec2, vec::vec3};
use tyndall_geometry::{Frame, SurfacePoint};

/// How the frame is turned.
#[derive(Clone, Debug)]
pub enum Relief {
    /// `normalmap`: the image's colours, from -1 to 1, are normals in the frame of dp/du, dp/dv and the normal.
    Normals(ImageMap),
    /// `displacement`: the height of the surface over itself; its slope turns the normal (Blinn 1978).
    Heights(FloatTexture),
}

/// A material with relief.
#[derive(Clone, Debug)]
pub struct MappedMaterial {
    /// What the surface is made of.
    pub material: Material,
    /// Its relief.
    pub relief: Relief,
}

/// Step in u and v over which slopes are measured, pbrt's where it knows no pixel size.
const STEP: f32 = 0.0005;

impl MappedMaterial {
    /// The shading frame.
    pub fn frame(&self, s: &SurfacePoint) -> Frame {
        match &self.relief {
            Relief::Normals(image) => from_map(image, s),
            Relief::Heights(height) => bumped(height, s),
        }
    }
}

fn from_map(image: &ImageMap, s: &SurfacePoint) -> Frame {
    let n = image.vector(&TextureContext { p: s.p, n: s.ng, uv: s.uv }).map(|c| 2.0 * c - 1.0);
    let local = Frame::from_xz(s.dpdu, s.ns);
    let n = local.from_local(vec3(n[0], n[1], n[2]));
    if n.length_squared() > 0.0 { towards(s, s.dpdu, n) } else { local }
}

/// The frame of the surface `p + h n`, of which `p` has the shading normal n:
/// `d(p + h n)/du = dp/du + dh/du n + h dn/du`.
fn bumped(height: &FloatTexture, s: &SurfacePoint) -> Frame {
    let at = |p: Vec3, du: f32, dv: f32| {
        height.eval(&TextureContext { p, n: s.ng, uv: vec2(s.uv.x + du, s.uv.y + dv) })
    };
    // the smooth surface that the shading normals belong to: without heights its normal is theirs
    let [along_u, along_v] = [s.dpdu, s.dpdv].map(|t| t - s.ns * s.ns.dot(t));
    let here = at(s.p, 0.0, 0.0);
    let (u, v) = (at(s.p + along_u * STEP, STEP, 0.0), at(s.p + along_v * STEP, 0.0, STEP));
    let dpdu = along_u + s.ns * ((u - here) / STEP) + s.dn[0] * here;
    let dpdv = along_v + s.ns * ((v - here) / STEP) + s.dn[1] * here;
    let n = dpdu.cross(dpdv);
    if n.length_squared() > 0.0 && n.is_finite() { towards(s, dpdu, n) } else { Frame::from_xz(s.dpdu, s.ns) }
}

/// The frame about `n`, turned to the side of the surface's own normal.
fn towards(s: &SurfacePoint, dpdu: Vec3, n: Vec3) -> Frame {
    let n = n.normalize();
    Frame::from_xz(dpdu, if n.dot(s.ns) < 0.0 { -n } else { n })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::{Mapping, Weight};
    use std::sync::Arc;
    use tyndall_geometry::Rounding;

    fn point() -> SurfacePoint {
        let z = vec3(0.0, 0.0, 1.0);
        SurfacePoint {
            p: Vec3::ZERO,
            rounding: Rounding::NONE,
            ng: z,
            ns: z,
            dpdu: vec3(2.0, 0.0, 0.0),
            dpdv: vec3(0.0, 4.0, 0.0),
            dn: [Vec3::ZERO; 2],
            uv: vec2(0.3, 0.4),
            time: 0.0,
        }
    }

    /// A height of 3 u over a side of 2 per u is a slope of 1.5.
    #[test]
    fn a_slope_turns_the_normal() {
        let mapping = Mapping::Uv { scale: [3.0, 0.0], delta: [0.0; 2] };
        let (zero, one) = (FloatTexture::Constant(0.0), FloatTexture::Constant(1.0));
        let ramp = FloatTexture::Mix(Arc::new((zero, one, Weight::Coordinate(mapping, 0))));
        let frame = bumped(&ramp, &point());
        let want = vec3(-1.5, 0.0, 1.0).normalize();
        assert!((frame.z - want).length() < 1e-3, "{:?}", frame.z);
        assert!(frame.x.dot(frame.z).abs() < 1e-5);
        let flat = bumped(&FloatTexture::Constant(7.0), &point());
        assert!((flat.z - vec3(0.0, 0.0, 1.0)).length() < 1e-6);
    }

    /// Without slope the normal is the shading normal, whatever the facet beneath.
    #[test]
    fn an_even_height_leaves_the_shading_normal() {
        let ns = vec3(0.3, -0.2, 1.0).normalize();
        let frame = bumped(&FloatTexture::Constant(0.7), &SurfacePoint { ns, ..point() });
        assert!((frame.z - ns).length() < 1e-6, "{:?}", frame.z);
    }

    /// `h = k u` on a sphere of radius 2 is the surface `r = 2 + k u`: at the equator its tangents are
    /// `(r phi-hat + dr/dphi r-hat)` and `r theta-hat`, so the slope is over the radius with the height on it.
    #[test]
    fn heights_on_a_sphere_are_another_radius() {
        let mapping = Mapping::Uv { scale: [3.0, 0.0], delta: [0.0; 2] };
        let (zero, one) = (FloatTexture::Constant(0.0), FloatTexture::Constant(1.0));
        let ramp = FloatTexture::Mix(Arc::new((zero, one, Weight::Coordinate(mapping, 0))));
        let (radius, turn) = (2.0, std::f32::consts::TAU);
        let [round, up] = [vec3(0.0, turn, 0.0), vec3(0.0, 0.0, -0.5 * turn)];
        let x = vec3(1.0, 0.0, 0.0);
        let s = SurfacePoint {
            ng: -x,
            ns: -x,
            dpdu: round * radius,
            dpdv: up * radius,
            dn: [-round, -up],
            ..point()
        };
        // the normal points inwards, and so do heights
        let slope = 3.0 / ((radius - 3.0 * 0.3) * turn);
        let want = vec3(-1.0, -slope, 0.0).normalize();
        let got = bumped(&ramp, &s).z;
        assert!((got - want).length() < 1e-3, "{got:?} {want:?}");
    }
}
