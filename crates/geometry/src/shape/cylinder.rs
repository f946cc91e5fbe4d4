//! Cylinders and parts of them, with pbrt's parameters: in object space the radius `r` about the z axis between two
//! heights, without caps; `u = phi / phi_max`, `v` runs from `z_min` to `z_max`, the normal points outwards.

use super::light::gauss;
use super::{LocalSurface, NOISE, PrimHit, ShapeGroup, check, quadratic_half, sphere::azimuth};
use crate::dvec::{DVec3, dvec3};
use crate::{Bounds3, GeometryError, ShapeSample, Transform};
use std::f64::consts::PI;
use tyndall_base::Vec3;
use tyndall_base::math::f64::sin_cos;

/// A cylinder about the z axis of its own space.
#[derive(Clone, Debug)]
pub struct Cylinder {
    pub(crate) to_world: Transform,
    radius: f64,
    z_min: f64,
    z_max: f64,
    phi_max: f64,
}

impl Cylinder {
    /// Lengths in metres, heights in either order, `phi_max` in degrees.
    ///
    /// # Errors
    /// When the radius is not positive, the heights coincide or a parameter is not finite.
    pub fn new(
        to_world: Transform,
        radius: f64,
        z_min: f64,
        z_max: f64,
        phi_max: f64,
    ) -> Result<Self, GeometryError> {
        check("cylinder radius", "a finite length > 0", radius, radius > 0.0)?;
        check("cylinder zmin", "a finite height", z_min, true)?;
        check("cylinder zmax", "a finite height other than zmin", z_max, z_max != z_min)?;
        check("cylinder phimax", "degrees in (0, 360]", phi_max, phi_max > 0.0)?;
        let phi_max = phi_max.min(360.0) * (PI / 180.0);
        Ok(Self { to_world, radius, z_min: z_min.min(z_max), z_max: z_min.max(z_max), phi_max })
    }

    /// The box around the whole cylinder.
    pub fn prim_bounds(&self, _prim: u32) -> Bounds3 {
        let m = self.to_world.matrix();
        let centre = self.to_world.point64(dvec3(0.0, 0.0, 0.5 * (self.z_min + self.z_max)));
        let half = 0.5 * (self.z_max - self.z_min);
        let reach = |k: usize| self.radius * dvec3(m[k][0], m[k][1], 0.0).length() + half * m[k][2].abs();
        let e = dvec3(reach(0), reach(1), reach(2));
        Bounds3::new((centre - e).round(), (centre + e).round()).padded(Vec3::ZERO)
    }

    /// The nearest point along `o + t d` (world), `t_min < t <= t_max`.
    pub(crate) fn intersect(&self, o: DVec3, d: DVec3, [t_min, t_max]: [f64; 2]) -> Option<PrimHit> {
        let to_object = self.to_world.inverse();
        let (o, d) = (to_object.point64(o), to_object.vector64(d));
        let keeps = |t: f64| {
            let q = o + d * t;
            q.z >= self.z_min && q.z <= self.z_max && (self.phi_max >= 2.0 * PI || azimuth(q) <= self.phi_max)
        };
        let t = self.roots(o, d)?.into_iter().find(|&t| t > t_min && t <= t_max && keeps(t))?;
        Some(PrimHit { t, u: 0.0, v: 0.0 })
    }

    /// Where the line (object space) meets the infinite cylinder, in ascending order.
    fn roots(&self, o: DVec3, d: DVec3) -> Option<[f64; 2]> {
        let (a, h) = (d.x * d.x + d.y * d.y, o.x * d.x + o.y * d.y);
        if a == 0.0 {
            return None;
        }
        let (x, y) = (o.x - d.x * (h / a), o.y - d.y * (h / a));
        let discriminant = a * (self.radius * self.radius - (x * x + y * y));
        let from_axis = (o.x * o.x + o.y * o.y).sqrt();
        quadratic_half(a, h, discriminant, (from_axis - self.radius) * (from_axis + self.radius))
    }

    /// The surface where the line meets the cylinder nearest to the parameter `near`.
    pub(crate) fn local_surface(&self, o: DVec3, d: DVec3, near: f64, group: &ShapeGroup) -> LocalSurface {
        let to_object = self.to_world.inverse();
        let (o, d) = (to_object.point64(o), to_object.vector64(d));
        let t =
            self.roots(o, d).map_or(near, |[a, b]| if (a - near).abs() <= (b - near).abs() { a } else { b });
        self.local_at(o + d * t, group)
    }

    /// The surface at the point of the cylinder nearest to `q` (object space), in world space.
    pub(crate) fn local_at(&self, q: DVec3, group: &ShapeGroup) -> LocalSurface {
        let scale = self.radius / (q.x * q.x + q.y * q.y).sqrt();
        let height = self.z_max - self.z_min;
        let q = dvec3(q.x * scale, q.y * scale, q.z.clamp(self.z_min, self.z_max));
        let t = &self.to_world;
        let n = t.normal64(dvec3(q.x, q.y, 0.0)).normalize();
        let n = if group.flips_normal() { -n } else { n };
        let rounding = dvec3(1.0, 1.0, 1.0) * (NOISE * (self.radius + q.z.abs()));
        LocalSurface {
            p: t.point64(q),
            noise: (t.point_noise(q) + t.spread(rounding)) * 16.0,
            lift: 0.0,
            ng: n,
            ns: n,
            dpdu: t.vector64(dvec3(-q.y, q.x, 0.0) * self.phi_max),
            dpdv: t.vector64(dvec3(0.0, 0.0, height)),
            uv: [azimuth(q) / self.phi_max, (q.z - self.z_min) / height],
        }
    }
}

/// Sampling.
impl Cylinder {
    /// World area per object area at azimuth `phi`.
    fn stretch(&self, phi: f64) -> f64 {
        let (sin, cos) = sin_cos(phi);
        let round = self.to_world.vector64(dvec3(-sin, cos, 0.0));
        round.cross(self.to_world.vector64(dvec3(0.0, 0.0, 1.0))).length()
    }

    fn object_area(&self) -> f64 {
        self.phi_max * self.radius * (self.z_max - self.z_min)
    }

    /// Area in the world \[m^2\]: quadrature round the axis, exact where the map stretches all sides alike.
    pub(crate) fn area(&self) -> f64 {
        let panel = |k: i32| gauss(|x| self.stretch(self.phi_max * (f64::from(k) + x) / 16.0)) / 16.0;
        self.object_area() * (0..16).map(panel).sum::<f64>()
    }

    /// Uniform by area in object space.
    pub(crate) fn sample_area(&self, u: [f32; 2], group: &ShapeGroup) -> ShapeSample {
        let phi = self.phi_max * f64::from(u[1]);
        let (sin, cos) = sin_cos(phi);
        let z = self.z_min + (self.z_max - self.z_min) * f64::from(u[0]);
        let q = dvec3(self.radius * cos, self.radius * sin, z);
        self.local_at(q, group).sampled(1.0 / (self.object_area() * self.stretch(phi)))
    }

    /// Density per square metre of [`Self::sample_area`] at a world point of the cylinder.
    pub(crate) fn pdf_area(&self, p: Vec3) -> f64 {
        let q = self.to_world.inverse().point64(p.into());
        1.0 / (self.object_area() * self.stretch(azimuth(q)))
    }
}
