//! `infinite` with `portal`: light from infinity that comes in through a rectangle, and nowhere else.
//!
//! Directions are charted by the angles (alpha, beta) = (atan(x/z), atan(y/z)) in the rectangle's frame, z outwards, in
//! which the rectangle covers an axis-parallel window from every point: Bitterli, Novák, Jarosz 2015, "Portal-masked
//! environment map sampling". The unit square is `u = alpha / pi + 1/2`, `v = beta / pi + 1/2`, with
//! `du dv / d omega = (1 - x^2) (1 - y^2) / (pi^2 z)`. Radiance is constant over a texel of that chart, as in pbrt.

use super::{LiSample, image::RgbEmission};
use crate::{TransportError, error::check};
use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, PI};
use tyndall_base::{
    Vec3,
    distribution::{Window, Windowed2d},
    math,
    vec::vec3,
};
use tyndall_geometry::Frame;
use tyndall_spectral::{Curve, Emission, Spectrum, Wavelengths};

/// Cosine up to which edges pass for perpendicular, and one minus the cosine up to which they pass for parallel; pbrt's.
const SQUARE: f32 = 1e-3;

/// A rectangle that light comes in through.
#[derive(Clone, Copy, Debug)]
pub struct Portal {
    corner: Vec3,
    opposite: Vec3,
    frame: Frame,
    area: f32,
}

impl Portal {
    /// The rectangle `[a, b, c, d]` in order around it \[m\]; light travels against `(d - a) x (b - a)`.
    ///
    /// # Errors
    /// When it is not a rectangle.
    pub fn new([a, b, c, d]: [Vec3; 4]) -> Result<Self, TransportError> {
        let sides = [b - a, c - b, c - d, d - a].map(Vec3::normalize);
        let [ab, bc, dc, ad] = sides;
        let parallel = ab.dot(dc).min(bc.dot(ad));
        check(
            1.0 - parallel <= SQUARE,
            "portal",
            "a rectangle: opposite sides parallel",
            f64::from(parallel),
        )?;
        let across = ab.dot(ad).abs().max(bc.dot(dc).abs());
        check(across <= SQUARE, "portal", "a rectangle: right angles", f64::from(across))?;
        let x = ad;
        let y = (ab - x * ab.dot(x)).normalize();
        let area = (b - a).length() * (d - a).length();
        Ok(Self { corner: a, opposite: c, frame: Frame { x, y, z: x.cross(y) }, area })
    }

    /// The direction at a point of the chart, and `du dv / d omega` there \[1/sr\].
    pub fn direction(&self, uv: [f32; 2]) -> (Vec3, f32) {
        let tan = uv.map(|t| math::tan(PI * t - FRAC_PI_2));
        let local = vec3(tan[0], tan[1], 1.0).normalize();
        (self.frame.from_local(local), jacobian(local))
    }

    /// The inverse, for the unit direction `d`; `None` for directions that do not lead outwards.
    #[inline]
    fn chart(&self, d: Vec3) -> Option<([f32; 2], f32)> {
        let local = self.frame.to_local(d);
        if local.z <= 0.0 {
            return None;
        }
        let of = |t: f32| (math::atan2(t, local.z) * FRAC_1_PI + 0.5).clamp(0.0, 1.0);
        Some(([of(local.x), of(local.y)], jacobian(local)))
    }

    /// The part of the chart that the rectangle covers as seen from `p`; `None` from behind it.
    #[inline]
    fn window(&self, p: Vec3) -> Option<Window> {
        let seen = |q: Vec3| self.chart((q - p).normalize()).map(|(uv, _)| uv);
        let (a, b) = (seen(self.corner)?, seen(self.opposite)?);
        Some([[a[0].min(b[0]), a[1].min(b[1])], [a[0].max(b[0]), a[1].max(b[1])]])
    }
}

#[inline(always)]
fn jacobian(w: Vec3) -> f32 {
    FRAC_1_PI * FRAC_1_PI * w.z / ((w.y * w.y + w.z * w.z) * (w.x * w.x + w.z * w.z))
}

/// What shines behind the portal.
#[derive(Clone, Debug)]
pub enum Sky {
    /// The same radiance from all directions \[W m^-2 sr^-1 nm^-1\].
    Uniform(Emission),
    /// An image over the chart.
    Image {
        /// Texels a side.
        size: usize,
        /// `size^2` colours, from v = 0.
        texels: Vec<RgbEmission>,
        /// Weight of each texel for sampling per solid angle, about its luminance.
        weights: Vec<f32>,
        /// Spectrum of the colour space's white times the light's scale \[W m^-2 sr^-1 nm^-1\].
        white: Curve,
        /// Mean emission.
        mean: Emission,
    },
}

/// Texels a side of the table that directions of a uniform sky are drawn with.
const UNIFORM: usize = 64;

/// Parameters: see the module.
#[derive(Clone, Debug)]
pub struct PortalLight {
    portal: Portal,
    sky: Sky,
    distribution: Windowed2d,
}

impl PortalLight {
    /// A sky behind a rectangle.
    ///
    /// # Errors
    /// When the image has not `size^2` texels or is black.
    pub fn new(portal: Portal, sky: Sky) -> Result<Self, TransportError> {
        let (n, weight): (usize, &dyn Fn(usize) -> f32) = match &sky {
            Sky::Uniform(_) => (UNIFORM, &|_| 1.0),
            Sky::Image { size, texels, weights, .. } => {
                if texels.len() != size * size || weights.len() != size * size {
                    let why = format!("expected {size} x {size} texels, got {}", texels.len());
                    return Err(TransportError::Unusable { what: "portal's image", why });
                }
                (*size, &|i| weights[i])
            }
        };
        // importance per area of the chart
        let weights: Vec<f32> = (0..n * n)
            .map(|i| {
                let uv = [((i % n) as f32 + 0.5) / n as f32, ((i / n) as f32 + 0.5) / n as f32];
                weight(i) / portal.direction(uv).1
            })
            .collect();
        let distribution = Windowed2d::new(&weights, n, n)
            .map_err(|e| TransportError::Unusable { what: "portal's image", why: e.to_string() })?;
        Ok(Self { portal, sky, distribution })
    }

    /// See [`super::Light::sample_li`].
    #[inline(never)]
    pub fn sample_li<const N: usize>(&self, p: Vec3, u: [f32; 2], w: &Wavelengths<N>) -> Option<LiSample<N>> {
        let (uv, density, cell) = self.distribution.sample(u, &self.portal.window(p)?)?;
        let (wi, jacobian) = self.portal.direction(uv);
        let pdf = density * jacobian;
        let l = self.radiance(cell, w);
        (pdf > 0.0 && pdf.is_finite() && !l.is_zero()).then_some(LiSample {
            l,
            wi,
            target: None,
            pdf,
            delta: false,
        })
    }

    /// Radiance that reaches `p` along the ray direction `d`.
    #[inline(never)]
    pub fn le<const N: usize>(&self, p: Vec3, d: Vec3, w: &Wavelengths<N>) -> Spectrum<N> {
        let (Some((uv, _)), Some([low, high])) = (self.portal.chart(d), self.portal.window(p)) else {
            return Spectrum::ZERO;
        };
        if (0..2).any(|k| uv[k] < low[k] || uv[k] > high[k]) {
            return Spectrum::ZERO;
        }
        self.radiance(self.distribution.cell(uv), w)
    }

    /// Density of [`Self::sample_li`] \[1/sr\].
    #[inline(never)]
    pub fn pdf(&self, p: Vec3, d: Vec3) -> f32 {
        let (Some((uv, jacobian)), Some(window)) = (self.portal.chart(d), self.portal.window(p)) else {
            return 0.0;
        };
        self.distribution.pdf(uv, &window) * jacobian
    }

    /// Mean emission over directions.
    pub fn mean_emission(&self) -> &Emission {
        match &self.sky {
            Sky::Uniform(emission) => emission,
            Sky::Image { mean, .. } => mean,
        }
    }

    /// Area of the rectangle \[m^2\].
    pub fn area(&self) -> f32 {
        self.portal.area
    }

    #[inline(always)]
    fn radiance<const N: usize>(&self, [x, y]: [usize; 2], w: &Wavelengths<N>) -> Spectrum<N> {
        match &self.sky {
            Sky::Uniform(emission) => emission.sample(w),
            Sky::Image { size, texels, white, .. } => {
                let texel = &texels[y * size + x];
                Spectrum::from_fn(|k| texel.scale * texel.sigmoid.eval(w.lambda[k])) * white.sample(w)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_base::rng::Pcg32;
    use tyndall_spectral::curve::SigmoidPolynomial;
    use tyndall_testkit::{Welford, z_max};

    /// A window of 2 m x 1 m in the plane y = 3, light from +y.
    fn portal() -> Portal {
        Portal::new([[1.0, 3.0, 0.0], [1.0, 3.0, 1.0], [-1.0, 3.0, 1.0], [-1.0, 3.0, 0.0]].map(Vec3::from))
            .expect("a rectangle")
    }

    fn image() -> PortalLight {
        let mut rng = Pcg32::new(8, 1);
        let size = 16;
        let texels: Vec<RgbEmission> = (0..size * size)
            .map(|i| {
                let slope = rng.next_f32() * 4.0 - 2.0;
                let scale = if i % 5 == 0 { 0.0 } else { 0.1 + rng.next_f32() };
                RgbEmission { sigmoid: SigmoidPolynomial { c: [0.0, slope, -1.0] }, scale }
            })
            .collect();
        let weights = texels.iter().map(|t| t.scale).collect();
        let sky = Sky::Image { size, texels, weights, white: Curve::ONE, mean: Curve::ONE.into() };
        PortalLight::new(portal(), sky).expect("valid")
    }

    fn wavelengths() -> Wavelengths<4> {
        Wavelengths::continuum([420.0, 500.0, 580.0, 660.0], [1.0; 4])
    }

    /// The solid angle of the rectangle from below it: by quadrature over its surface.
    fn solid_angle(p: Vec3) -> f64 {
        let n = 400;
        let mut sum = 0.0;
        for i in 0..n {
            for j in 0..n {
                let x = -1.0 + 2.0 * (f64::from(i) + 0.5) / f64::from(n);
                let z = (f64::from(j) + 0.5) / f64::from(n);
                let d = [x - f64::from(p.x), 3.0 - f64::from(p.y), z - f64::from(p.z)];
                let r2 = d.iter().map(|v| v * v).sum::<f64>();
                sum += d[1] / (r2 * r2.sqrt());
            }
        }
        sum * 2.0 / f64::from(n * n)
    }

    #[test]
    fn samples_carry_their_density_and_the_whole_window() {
        let w = wavelengths();
        let uniform = PortalLight::new(portal(), Sky::Uniform(Curve::ONE.into())).expect("valid");
        for (k, light) in [uniform, image()].iter().enumerate() {
            for p in [vec3(0.3, 1.0, 0.2), vec3(-2.0, 2.0, 3.0)] {
                let mut rng = Pcg32::new(21, 5);
                let mut apart = 0;
                let mut mean = [Welford::default(); 4];
                for _ in 0..40_000 {
                    let Some(s) = light.sample_li(p, rng.next_2d(), &w) else {
                        mean.iter_mut().for_each(|m| m.add(0.0));
                        continue;
                    };
                    let pdf = light.pdf(p, s.wi);
                    let same = (pdf / s.pdf - 1.0).abs() < 1e-3 && light.le(p, s.wi, &w) == s.l;
                    apart += u32::from(!same);
                    mean.iter_mut().enumerate().for_each(|(c, m)| m.add(f64::from(s.l[c] / s.pdf)));
                }
                // a direction on the edge of a texel may round into its neighbour
                assert!(apart < 40, "{apart} of 40000");
                for (c, m) in mean.iter().enumerate() {
                    let exact = if k == 0 {
                        solid_angle(p)
                    } else {
                        integrate_chart(|d| f64::from(light.le(p, d, &w)[c]), p)
                    };
                    // quadrature of a piecewise constant function: 1e-3
                    assert!(
                        (m.mean() - exact).abs() < z_max(16) * m.se() + 1e-3 * exact,
                        "{k} {c}: {} +- {} {exact}",
                        m.mean(),
                        m.se()
                    );
                }
            }
        }
    }

    /// Integral over directions by the midpoint rule over the rectangle.
    fn integrate_chart(f: impl Fn(Vec3) -> f64, p: Vec3) -> f64 {
        let n = 600;
        let mut sum = 0.0;
        for i in 0..n {
            for j in 0..n {
                let q = vec3(-1.0 + 2.0 * (i as f32 + 0.5) / n as f32, 3.0, (j as f32 + 0.5) / n as f32);
                let d = q - p;
                let r2 = f64::from(d.length_squared());
                sum += f(d.normalize()) * f64::from(d.y) / (r2 * r2.sqrt());
            }
        }
        sum * 2.0 / f64::from(n * n)
    }

    #[test]
    fn densities_have_norm_one() {
        let light = image();
        let p = vec3(0.3, 1.0, 0.2);
        let norm = integrate_chart(|d| f64::from(light.pdf(p, d)), p);
        assert!((norm - 1.0).abs() < 2e-3, "{norm}");
    }

    #[test]
    fn nothing_comes_from_beside_or_behind() {
        let (light, w) = (image(), wavelengths());
        let p = vec3(0.0, 1.0, 0.5);
        assert!(light.le(p, vec3(0.0, -1.0, 0.0), &w).is_zero());
        assert!(light.le(p, vec3(0.9, 0.1, 0.0).normalize(), &w).is_zero());
        let outside = vec3(0.0, 4.0, 0.5);
        assert!(light.sample_li(outside, [0.5, 0.5], &w).is_none());
        assert!(light.le(outside, vec3(0.0, 1.0, 0.0), &w).is_zero());
        assert_eq!(light.pdf(outside, vec3(0.0, 1.0, 0.0)), 0.0);
    }

    #[test]
    fn only_rectangles_are_portals() {
        let skew = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.5, 1.0, 0.0], [0.5, 1.0, 0.0]].map(Vec3::from);
        assert!(Portal::new(skew).is_err());
        let point = [[0.0; 3]; 4].map(Vec3::from);
        assert!(Portal::new(point).is_err());
    }
}
