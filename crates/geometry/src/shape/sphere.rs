//! Spheres and parts of them, with pbrt's parameters.
//!
//! In object space `x = r sin(theta) cos(phi)`, `z = r cos(theta)`; `u = phi / phi_max`, `v` runs from `z_min` to
//! `z_max` with theta. Intersections are solved in `f64` with the discriminant `r^2 - |o - (o.d/d.d) d|^2`, which does
//! not cancel for distant or small spheres (Haines, Guenther & Akenine-Moeller 2019, "Precision improvements for
//! ray/sphere intersection").

use super::light::gauss;
use super::{LocalSurface, NOISE, PrimHit, ShapeGroup, any_tangents, check, quadratic_half};
use crate::dvec::{DVec3, dvec3};
use crate::{Bounds3, GeometryError, ShapeSample, Transform};
use std::f64::consts::PI;
use tyndall_base::Vec3;
use tyndall_base::math::f64::{acos, atan2, sin_cos};

/// A sphere about the origin of its own space, cut at two heights and an angle.
#[derive(Clone, Debug)]
pub struct Sphere {
    pub(crate) to_world: Transform,
    pub(crate) radius: f64,
    pub(crate) z_min: f64,
    pub(crate) z_max: f64,
    pub(crate) phi_max: f64,
    theta_z_min: f64,
    theta_z_max: f64,
}

impl Sphere {
    /// `radius` \[m\]; the part with `z_min <= z <= z_max` (in either order, clamped to the sphere) and azimuth up to
    /// `phi_max` degrees.
    ///
    /// # Errors
    /// When the radius is not positive or a parameter is not finite.
    pub fn new(
        to_world: Transform,
        radius: f64,
        z_min: f64,
        z_max: f64,
        phi_max: f64,
    ) -> Result<Self, GeometryError> {
        check("sphere radius", "a finite length > 0", radius, radius > 0.0)?;
        check("sphere zmin", "a finite height", z_min, true)?;
        check("sphere zmax", "a finite height", z_max, true)?;
        check("sphere phimax", "degrees in (0, 360]", phi_max, phi_max > 0.0)?;
        let (z_min, z_max) =
            (z_min.min(z_max).clamp(-radius, radius), z_min.max(z_max).clamp(-radius, radius));
        check("sphere zmin, zmax", "zmin < zmax within the sphere", z_max - z_min, z_max > z_min)?;
        let phi_max = phi_max.min(360.0) * (PI / 180.0);
        let theta = |z: f64| acos((z / radius).clamp(-1.0, 1.0));
        let (theta_z_min, theta_z_max) = (theta(z_min), theta(z_max));
        Ok(Self { to_world, radius, z_min, z_max, phi_max, theta_z_min, theta_z_max })
    }

    /// The whole sphere about `centre`.
    ///
    /// # Errors
    /// When the radius is not positive or a parameter is not finite.
    pub fn whole(centre: [f64; 3], radius: f64) -> Result<Self, GeometryError> {
        for x in centre {
            check("sphere centre", "a finite position", x, true)?;
        }
        Self::new(Transform::translate(centre[0], centre[1], centre[2]), radius, -radius, radius, 360.0)
    }

    /// True when nothing is cut off.
    pub fn is_whole(&self) -> bool {
        self.z_min <= -self.radius && self.z_max >= self.radius && self.phi_max >= 2.0 * PI
    }

    /// Radius in the world when the transform is a similarity, so that the sphere is one there too.
    pub(crate) fn world_radius(&self) -> Option<f64> {
        let axes = [dvec3(1.0, 0.0, 0.0), dvec3(0.0, 1.0, 0.0), dvec3(0.0, 0.0, 1.0)];
        let [x, y, z] = axes.map(|a| self.to_world.vector64(a));
        let s = x.length_squared();
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-6 * s;
        let similar = near(y.length_squared(), s) && near(z.length_squared(), s);
        let orthogonal = near(x.dot(y), 0.0) && near(y.dot(z), 0.0) && near(z.dot(x), 0.0);
        (similar && orthogonal).then(|| self.radius * s.sqrt())
    }

    /// The box around the sphere or, when cut, around the part's box.
    pub fn prim_bounds(&self, _prim: u32) -> Bounds3 {
        let m = self.to_world.matrix();
        let r = self.radius;
        // the affine image of the slab box: half-extents per world axis
        let middle = 0.5 * (self.z_min + self.z_max);
        let half = 0.5 * (self.z_max - self.z_min);
        let centre = self.to_world.point64(dvec3(0.0, 0.0, middle));
        let reach = |k: usize| {
            if self.is_whole() {
                r * dvec3(m[k][0], m[k][1], m[k][2]).length()
            } else {
                r * dvec3(m[k][0], m[k][1], 0.0).length() + half * m[k][2].abs()
            }
        };
        let e = dvec3(reach(0), reach(1), reach(2));
        Bounds3::new((centre - e).round(), (centre + e).round()).padded(Vec3::ZERO)
    }

    /// The nearest point along `o + t d` (world), `t_min < t <= t_max`.
    pub(crate) fn intersect(&self, o: DVec3, d: DVec3, range: [f64; 2]) -> Option<PrimHit> {
        let to_object = self.to_world.inverse();
        self.intersect_local(to_object.point64(o), to_object.vector64(d), range)
    }

    fn intersect_local(&self, o: DVec3, d: DVec3, [t_min, t_max]: [f64; 2]) -> Option<PrimHit> {
        let r = self.radius;
        let (a, h) = (d.length_squared(), o.dot(d));
        let nearest = o - d * (h / a);
        let discriminant = a * (r * r - nearest.length_squared());
        let length = o.length();
        let roots = quadratic_half(a, h, discriminant, (length - r) * (length + r))?;
        let whole = self.is_whole();
        roots
            .into_iter()
            .find(|&t| t > t_min && t <= t_max && (whole || self.keeps(o + d * t)))
            .map(|t| PrimHit { t, u: 0.0, v: 0.0 })
    }

    /// Whether a point of the sphere belongs to the part.
    fn keeps(&self, p: DVec3) -> bool {
        let low = self.z_min > -self.radius && p.z < self.z_min;
        let high = self.z_max < self.radius && p.z > self.z_max;
        !low && !high && azimuth(p) <= self.phi_max
    }

    pub(crate) fn local_surface(&self, o: DVec3, d: DVec3, near: f64, group: &ShapeGroup) -> LocalSurface {
        let to_object = self.to_world.inverse();
        let (o, d) = (to_object.point64(o), to_object.vector64(d));
        // the traversal found a hit; a ray that the rounding of its record now takes past ends at its closest point
        let before = near - 1e-5 * near.abs();
        let t = self
            .intersect_local(o, d, [before, f64::INFINITY])
            .map_or_else(|| -o.dot(d) / d.length_squared(), |h| h.t);
        self.local_at(o + d * t, group)
    }

    /// The surface at the point of the sphere nearest to `q` (object space), in world space.
    pub(crate) fn local_at(&self, q: DVec3, group: &ShapeGroup) -> LocalSurface {
        let q = q * (self.radius / q.length());
        let phi = azimuth(q);
        let cos_theta = (q.z / self.radius).clamp(-1.0, 1.0);
        let span = self.theta_z_max - self.theta_z_min;
        let uv = [phi / self.phi_max, (acos(cos_theta) - self.theta_z_min) / span];
        let across = (q.x * q.x + q.y * q.y).sqrt();
        let n = q * (1.0 / self.radius);
        let (dpdu, dpdv) = if across > 0.0 {
            let (c, s) = (q.x / across, q.y / across);
            (dvec3(-q.y, q.x, 0.0) * self.phi_max, dvec3(q.z * c, q.z * s, -across) * span)
        } else {
            any_tangents(n)
        };
        let t = &self.to_world;
        let n = t.normal64(n).normalize();
        let n = if group.flips_normal() { -n } else { n };
        let rounding = dvec3(1.0, 1.0, 1.0) * (NOISE * self.radius);
        // the way there and back through the transform, and the root
        let noise = (t.point_noise(q) + t.spread(rounding)) * 16.0;
        LocalSurface {
            p: t.point64(q),
            noise,
            lift: 0.0,
            ng: n,
            ns: n,
            dpdu: t.vector64(dpdu),
            dpdv: t.vector64(dpdv),
            uv,
        }
    }
}

/// Azimuth of `p` in [0, 2 pi).
pub(crate) fn azimuth(p: DVec3) -> f64 {
    let phi = atan2(p.y, p.x);
    if phi < 0.0 { phi + 2.0 * PI } else { phi }
}

/// The cone of directions in which a whole sphere is seen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cone {
    reference: DVec3,
    centre: DVec3,
    radius: f64,
    distance: f64,
    /// `1 - cos(theta_max)`, without cancellation for distant spheres.
    one_minus_cos: f64,
}

impl Cone {
    /// Density per steradian, uniform.
    pub(crate) fn pdf(&self) -> f64 {
        1.0 / (2.0 * PI * self.one_minus_cos)
    }
}

/// Sampling.
impl Sphere {
    /// The cone from an outside point; `None` from inside, for parts and for ellipsoids.
    pub(crate) fn cone_from(&self, reference: DVec3) -> Option<Cone> {
        let radius = self.world_radius().filter(|_| self.is_whole())?;
        let centre = self.to_world.point64(DVec3::default());
        let distance = (centre - reference).length();
        let sin2 = (radius / distance) * (radius / distance);
        // just above the surface half the sphere of directions is right to every digit
        let cos = (1.0 - sin2).max(0.0).sqrt();
        (distance > radius).then(|| Cone {
            reference,
            centre,
            radius,
            distance,
            one_minus_cos: sin2 / (1.0 + cos),
        })
    }

    /// The point in a direction uniform over the cone.
    pub(crate) fn sample_cone(&self, cone: &Cone, u: [f32; 2], group: &ShapeGroup) -> ShapeSample {
        let off = f64::from(u[0]) * cone.one_minus_cos;
        let (cos, sin2) = (1.0 - off, off * (2.0 - off));
        let axis = (cone.centre - cone.reference) * (1.0 / cone.distance);
        let (x, y) = orthonormal(axis);
        let (sin_phi, cos_phi) = sin_cos(2.0 * PI * f64::from(u[1]));
        let w = axis * cos + (x * cos_phi + y * sin_phi) * sin2.sqrt();
        let inside = cone.radius * cone.radius - cone.distance * cone.distance * sin2;
        let t = cone.distance * cos - inside.max(0.0).sqrt();
        let q = self.to_world.inverse().point64(cone.reference + w * t);
        self.local_at(q, group).sampled(cone.pdf())
    }

    /// Area of the part in its own space.
    fn object_area(&self) -> f64 {
        self.phi_max * self.radius * (self.z_max - self.z_min)
    }

    /// World area per object area at the unit object normal `n`: `|det M| |M^-T n|`.
    fn stretch(&self, n: DVec3) -> f64 {
        let axis = |x, y, z| self.to_world.vector64(dvec3(x, y, z));
        let det = axis(1.0, 0.0, 0.0).dot(axis(0.0, 1.0, 0.0).cross(axis(0.0, 0.0, 1.0)));
        det.abs() * self.to_world.normal64(n).length()
    }

    /// The point at height and azimuth given by fractions; equal fractions have equal object area (Archimedes).
    fn at_fractions(&self, fz: f64, fphi: f64) -> DVec3 {
        let z = self.z_min + (self.z_max - self.z_min) * fz;
        let (sin, cos) = sin_cos(self.phi_max * fphi);
        let r = (self.radius * self.radius - z * z).max(0.0).sqrt();
        dvec3(r * cos, r * sin, z)
    }

    /// Area in the world \[m^2\]: closed form under similarities, quadrature on 16 x 16 panels otherwise.
    pub(crate) fn area(&self) -> f64 {
        if let Some(radius) = self.world_radius() {
            return self.object_area() * (radius / self.radius) * (radius / self.radius);
        }
        let stretch = |a, b| self.stretch(self.at_fractions(a, b) * (1.0 / self.radius));
        let panels = |f: &dyn Fn(f64) -> f64| {
            (0..16).map(|k| gauss(|x| f((f64::from(k) + x) / 16.0)) / 16.0).sum::<f64>()
        };
        self.object_area() * panels(&|a| panels(&|b| stretch(a, b)))
    }

    /// Uniform by area in object space.
    pub(crate) fn sample_area(&self, u: [f32; 2], group: &ShapeGroup) -> ShapeSample {
        let q = self.at_fractions(1.0 - f64::from(u[0]), f64::from(u[1]));
        let pdf = 1.0 / (self.object_area() * self.stretch(q * (1.0 / self.radius)));
        self.local_at(q, group).sampled(pdf)
    }

    /// Density per square metre of [`Self::sample_area`] at a world point of the sphere.
    pub(crate) fn pdf_area(&self, p: Vec3) -> f64 {
        let q = self.to_world.inverse().point64(p.into());
        1.0 / (self.object_area() * self.stretch(q.normalize()))
    }
}

/// Two unit vectors that complete the unit vector `z` (Duff et al. 2017), in `f64`.
fn orthonormal(z: DVec3) -> (DVec3, DVec3) {
    let sign = 1.0f64.copysign(z.z);
    let a = -1.0 / (sign + z.z);
    let b = z.x * z.y * a;
    (dvec3(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x), dvec3(b, sign + z.y * z.y * a, -z.y))
}
