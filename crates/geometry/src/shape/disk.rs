//! Disks, annuli and sectors, with pbrt's parameters: in object space the plane `z = height`, normal +z;
//! `u = phi / phi_max`, `v` runs from the rim to the inner radius.

use super::{LocalSurface, PrimHit, ShapeGroup, any_tangents, check, sphere::azimuth};
use crate::dvec::{DVec3, dvec3};
use crate::{Bounds3, GeometryError, ShapeSample, Transform};
use std::f64::consts::PI;
use tyndall_base::math::f64::sin_cos;
use tyndall_base::warp::sample_concentric_disk;

/// A disk in the plane `z = height` of its own space.
#[derive(Clone, Debug)]
pub struct Disk {
    pub(crate) to_world: Transform,
    pub(crate) height: f64,
    pub(crate) radius: f64,
    pub(crate) inner_radius: f64,
    pub(crate) phi_max: f64,
}

impl Disk {
    /// Lengths in metres, `phi_max` in degrees.
    ///
    /// # Errors
    /// When a radius is out of range or a parameter is not finite.
    pub fn new(
        to_world: Transform,
        height: f64,
        radius: f64,
        inner_radius: f64,
        phi_max: f64,
    ) -> Result<Self, GeometryError> {
        check("disk height", "a finite height", height, true)?;
        check("disk radius", "a finite length > 0", radius, radius > 0.0)?;
        let inner_ok = inner_radius >= 0.0 && inner_radius < radius;
        check("disk innerradius", "a length in [0, radius)", inner_radius, inner_ok)?;
        check("disk phimax", "degrees in (0, 360]", phi_max, phi_max > 0.0)?;
        Ok(Self { to_world, height, radius, inner_radius, phi_max: phi_max.min(360.0) * (PI / 180.0) })
    }

    /// True for a disk without hole or cut.
    pub(crate) fn is_whole(&self) -> bool {
        self.inner_radius == 0.0 && self.phi_max >= 2.0 * PI
    }

    /// The box around the whole disk.
    pub fn prim_bounds(&self, _prim: u32) -> Bounds3 {
        let m = self.to_world.matrix();
        let centre = self.to_world.point64(dvec3(0.0, 0.0, self.height));
        let reach = |k: usize| self.radius * dvec3(m[k][0], m[k][1], 0.0).length();
        let e = dvec3(reach(0), reach(1), reach(2));
        Bounds3::new((centre - e).round(), (centre + e).round()).padded(tyndall_base::Vec3::ZERO)
    }

    /// The point along `o + t d` (world), `t_min < t <= t_max`.
    pub(crate) fn intersect(&self, o: DVec3, d: DVec3, [t_min, t_max]: [f64; 2]) -> Option<PrimHit> {
        let to_object = self.to_world.inverse();
        let (o, d) = (to_object.point64(o), to_object.vector64(d));
        let t = (self.height - o.z) / d.z;
        let q = o + d * t;
        let r2 = q.x * q.x + q.y * q.y;
        let in_ring = r2 <= self.radius * self.radius && r2 >= self.inner_radius * self.inner_radius;
        let hit =
            t > t_min && t <= t_max && in_ring && (self.phi_max >= 2.0 * PI || azimuth(q) <= self.phi_max);
        hit.then_some(PrimHit { t, u: 0.0, v: 0.0 })
    }

    pub(crate) fn local_surface(&self, o: DVec3, d: DVec3, group: &ShapeGroup) -> LocalSurface {
        let to_object = self.to_world.inverse();
        let (o, d) = (to_object.point64(o), to_object.vector64(d));
        let q = o + d * ((self.height - o.z) / d.z);
        self.local_at(q.x, q.y, group)
    }

    /// The surface at (x, y) of the plane, in world space.
    pub(crate) fn local_at(&self, x: f64, y: f64, group: &ShapeGroup) -> LocalSurface {
        let t = &self.to_world;
        let q = dvec3(x, y, self.height);
        let r = (x * x + y * y).sqrt();
        let width = self.radius - self.inner_radius;
        let n = t.normal64(dvec3(0.0, 0.0, 1.0)).normalize();
        let n = if group.flips_normal() { -n } else { n };
        let (dpdu, dpdv) = if r > 0.0 {
            let inward = dvec3(x, y, 0.0) * (-width / r);
            (t.vector64(dvec3(-y, x, 0.0) * self.phi_max), t.vector64(inward))
        } else {
            any_tangents(n)
        };
        let uv = [azimuth(q) / self.phi_max, (self.radius - r) / width];
        LocalSurface { p: t.point64(q), noise: self.noise(q), lift: 0.0, ng: n, ns: n, dpdu, dpdv, uv }
    }

    /// Rounding of the map, there and back; none along an axis normal to the disk in which the map is exact.
    fn noise(&self, q: DVec3) -> DVec3 {
        let m = self.to_world.matrix();
        let noise = self.to_world.point_noise(q) * 16.0;
        let returns = self.to_world.inverse().point64(self.to_world.point64(q)).z == self.height;
        let exact = |k: usize| returns && m[k][0] == 0.0 && m[k][1] == 0.0;
        let pick = |k: usize, n: f64| if exact(k) { 0.0 } else { n };
        dvec3(pick(0, noise.x), pick(1, noise.y), pick(2, noise.z))
    }
}

impl Disk {
    /// Area in the world \[m^2\]; the map stretches a plane evenly.
    pub(crate) fn area(&self) -> f64 {
        let ring = self.radius * self.radius - self.inner_radius * self.inner_radius;
        0.5 * self.phi_max * ring * self.stretch()
    }

    fn stretch(&self) -> f64 {
        let edge = |x, y| self.to_world.vector64(dvec3(x, y, 0.0));
        edge(1.0, 0.0).cross(edge(0.0, 1.0)).length()
    }

    /// Uniform by area.
    pub(crate) fn sample_area(&self, u: [f32; 2], group: &ShapeGroup) -> ShapeSample {
        let (x, y) = if self.is_whole() {
            let d = sample_concentric_disk(u);
            (f64::from(d.x) * self.radius, f64::from(d.y) * self.radius)
        } else {
            let (inner, outer) = (self.inner_radius * self.inner_radius, self.radius * self.radius);
            let r = (inner + (outer - inner) * f64::from(u[0])).sqrt();
            let (sin, cos) = sin_cos(self.phi_max * f64::from(u[1]));
            (r * cos, r * sin)
        };
        self.local_at(x, y, group).sampled(1.0 / self.area())
    }
}
