//! Rays through a system of spherical lenses with a common axis (Kolb, Mitchell, Hanrahan 1995).
//!
//! Camera space in metres: the film is the plane z = 0, light comes from +z. Refraction is Snell's law with one index
//! for all wavelengths, as in pbrt; nothing is lost to reflection.

use super::aperture::Aperture;
use crate::{TransportError, error::check};

/// A point or direction in double precision: a ray passes a dozen interfaces.
pub type V = [f64; 3];

/// An interface between two media, or the stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Element {
    /// Radius of curvature \[m\], positive where the centre lies towards the film; 0 for the stop.
    pub radius: f64,
    /// Distance to the next element towards the film \[m\]; of the last one, to the film.
    pub thickness: f64,
    /// Index of refraction on the side of the film.
    pub eta: f64,
    /// Half the diameter \[m\].
    pub aperture: f64,
}

impl Element {
    /// True for the aperture stop.
    pub fn is_stop(&self) -> bool {
        self.radius == 0.0
    }
}

/// The elements from the scene to the film.
#[derive(Clone, Debug)]
pub struct Lens {
    elements: Vec<Element>,
}

/// Which way a ray goes.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    ToScene,
    ToFilm,
}

impl Lens {
    /// The lens, moved so that the plane at `focus` \[m\] from the film is sharp.
    ///
    /// # Errors
    /// When there is no element, nothing gets through near the axis, light does not converge, or `focus` is too near.
    pub fn focused(elements: Vec<Element>, focus: f64) -> Result<Self, TransportError> {
        let unusable = |why: &str| TransportError::Unusable { what: "lens", why: why.into() };
        if elements.is_empty() {
            return Err(unusable("expected at least one element, got none"));
        }
        check(focus > 0.0, "focusdistance", "> 0 m", focus)?;
        let mut lens = Self { elements };
        let [near, far] = lens.cardinal_points().ok_or_else(|| {
            unusable("no ray near the axis gets through, or it does not converge to a focus: is the aperture extremely small?")
        })?;
        lens.move_to(focus, near, far)?;
        Ok(lens)
    }

    /// The distance of the last element by the Gaussian lens equation with the principal planes apart: with `p`, `p'` the
    /// principal points, `f` the focal length and both conjugates moved alike.
    fn move_to(
        &mut self,
        focus: f64,
        [p_film, f_film]: [f64; 2],
        [p_scene, _]: [f64; 2],
    ) -> Result<(), TransportError> {
        // z towards the film, as the cardinal points are
        let (z, f) = (-focus, f_film - p_film);
        let c = (p_scene - z - p_film) * (p_scene - z - 4.0 * f - p_film);
        check(c > 0.0, "focusdistance", "far enough for the lens to focus at", focus)?;
        let moved = 0.5 * (p_scene - z + p_film - c.sqrt());
        let rear = self.elements.last_mut().map(|e| {
            e.thickness += moved;
            e.thickness
        });
        let rear = rear.unwrap_or_default();
        check(rear > 0.0, "focusdistance", "a lens in front of the film", rear)
    }

    /// Principal and focal point, z towards the film, for light from the scene and for light from the film.
    fn cardinal_points(&self) -> Option<[[f64; 2]; 2]> {
        let front: f64 = self.elements.iter().map(|e| e.thickness).sum();
        let smallest = self.elements.iter().map(|e| e.aperture).fold(f64::INFINITY, f64::min);
        let height = 1e-3 * smallest;
        let points = |from: f64, way: Way| {
            let dz = if way == Way::ToScene { 1.0 } else { -1.0 };
            let (o, d, _) = self.trace([height, 0.0, from], [0.0, 0.0, dz], way, &Aperture::Disk)?;
            let z_at = |x: f64| -(o[2] + (x - o[0]) / d[0] * d[2]);
            let found = [z_at(height), z_at(0.0)];
            found.iter().all(|z| z.is_finite()).then_some(found)
        };
        let rear = self.rear() - 1.0;
        Some([points(front + 1.0, Way::ToFilm)?, points(rear, Way::ToScene)?])
    }

    /// The same lens with its stop `factor` times as wide.
    pub(super) fn opened(&self, factor: f64) -> Self {
        let wider = |e: &Element| Element {
            aperture: if e.is_stop() { e.aperture * factor } else { e.aperture },
            ..*e
        };
        Self { elements: self.elements.iter().map(wider).collect() }
    }

    /// Distance of the last element from the film \[m\].
    pub fn rear(&self) -> f64 {
        self.elements.last().map_or(0.0, |e| e.thickness)
    }

    /// Half the diameter of the last element \[m\].
    pub fn rear_aperture(&self) -> f64 {
        self.elements.last().map_or(0.0, |e| e.aperture)
    }

    /// The ray that leaves towards the scene, with the stop's transmission; `None` when the lens blocks it.
    pub fn to_scene(&self, o: V, d: V, aperture: &Aperture) -> Option<(V, V, f64)> {
        self.trace(o, d, Way::ToScene, aperture)
    }

    fn trace(&self, mut o: V, mut d: V, way: Way, aperture: &Aperture) -> Option<(V, V, f64)> {
        let n = self.elements.len();
        let mut z = if way == Way::ToScene { 0.0 } else { self.elements.iter().map(|e| e.thickness).sum() };
        let mut transmission = 1.0;
        for step in 0..n {
            let i = if way == Way::ToScene { n - 1 - step } else { step };
            let e = &self.elements[i];
            if way == Way::ToScene {
                z += e.thickness;
            }
            let t = if e.is_stop() { plane(o, d, z)? } else { sphere(o, d, z, e.radius)? };
            let p = [o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]];
            if e.is_stop() {
                transmission *= aperture.transmission(p[0] / e.aperture, p[1] / e.aperture);
                if transmission <= 0.0 {
                    return None;
                }
            } else {
                if p[0] * p[0] + p[1] * p[1] > e.aperture * e.aperture {
                    return None;
                }
                let behind = air(e.eta);
                let before = if i > 0 { air(self.elements[i - 1].eta) } else { 1.0 };
                let ratio = if way == Way::ToScene { behind / before } else { before / behind };
                let centre = z - e.radius;
                d = refract(d, [p[0], p[1], p[2] - centre], ratio)?;
            }
            o = p;
            if way == Way::ToFilm {
                z -= e.thickness;
            }
        }
        Some((o, d, transmission))
    }
}

/// Files write the index of air as 0 or 1.
fn air(eta: f64) -> f64 {
    if eta == 0.0 { 1.0 } else { eta }
}

fn plane(o: V, d: V, z: f64) -> Option<f64> {
    let t = (z - o[2]) / d[2];
    (t >= 0.0).then_some(t)
}

/// Distance along the ray to the vertex's side of the sphere through (0, 0, z).
fn sphere(o: V, d: V, z: f64, radius: f64) -> Option<f64> {
    let p = [o[0], o[1], o[2] - (z - radius)];
    let a = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    let b = p[0] * d[0] + p[1] * d[1] + p[2] * d[2];
    let c = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] - radius * radius;
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    let near = (d[2] < 0.0) != (radius < 0.0);
    let t = if near { (-b - root) / a } else { (-b + root) / a };
    (t >= 0.0).then_some(t)
}

/// The refracted direction, unit, for the relative index `ratio` of the near over the far side.
fn refract(d: V, n: V, ratio: f64) -> Option<V> {
    let unit = |v: V| {
        let l = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        [v[0] / l, v[1] / l, v[2] / l]
    };
    let (d, mut n) = (unit(d), unit(n));
    let mut cos = -(d[0] * n[0] + d[1] * n[1] + d[2] * n[2]);
    if cos < 0.0 {
        cos = -cos;
        n = [-n[0], -n[1], -n[2]];
    }
    let sin2 = ratio * ratio * (1.0 - cos * cos);
    if sin2 >= 1.0 {
        return None;
    }
    let k = ratio * cos - (1.0 - sin2).sqrt();
    Some([ratio * d[0] + k * n[0], ratio * d[1] + k * n[1], ratio * d[2] + k * n[2]])
}
