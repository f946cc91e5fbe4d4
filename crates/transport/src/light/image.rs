//! `infinite` with an image: an environment map in the equal-area octahedral parameterisation.
//!
//! Clarberg (2008), *Fast equal-area mapping of the (hemi)sphere using SIMD*: every texel of the square subtends the
//! same solid angle. Radiance is constant over a texel and sampled in proportion to it, so an unoccluded map has no
//! noise beyond its colours.
//!
//! A path that scatters meets the map by chance as well. Where it does, light sampling leaves out what chance finds as easily:
//! the map is sampled by what it has above its mean (MIS compensation, Karlik, Sik, Vevoda, Skrivan, Krivanek 2019,
//! *MIS compensation: optimizing sampling techniques in multiple importance sampling*), and a map of one radiance like a sky
//! without an image.

use super::{LiSample, UniformInfiniteLight};
use crate::TransportError;
use tyndall_base::{Vec3, distribution::Piecewise2d, math, vec::vec3, warp};
use tyndall_spectral::{Curve, Emission, Spectrum, Wavelengths, curve::SigmoidPolynomial};

/// A colour as a spectrum: `scale` times a smooth reflectance, to be multiplied by the map's white.
#[derive(Clone, Copy, Debug)]
pub struct RgbEmission {
    /// The smooth reflectance.
    pub sigmoid: SigmoidPolynomial,
    /// Its factor.
    pub scale: f32,
}

/// A square of emission spectra, one per texel, row by row from the top.
#[derive(Clone, Debug)]
pub struct EnvironmentImage {
    /// Texels a side.
    pub size: usize,
    /// `size^2` colours.
    pub texels: Vec<RgbEmission>,
    /// Spectrum of the colour space's white times the light's scale \[W m^-2 sr^-1 nm^-1\].
    pub white: Curve,
    /// Weight of each texel for sampling, about its luminance.
    pub weights: Vec<f32>,
    /// Mean emission over the sphere.
    pub mean: Emission,
}

/// What directions are drawn by where chance finds them, too.
#[derive(Clone, Debug)]
enum BesideChance {
    /// By radiance all the same.
    All,
    /// By what is above the mean.
    Peaks(Box<Piecewise2d>),
    /// Like those of a sky of one radiance, for all texels are alike.
    Even,
}

impl BesideChance {
    fn new(weights: &[f32], n: usize) -> Self {
        let mean = weights.iter().map(|&w| f64::from(w)).sum::<f64>() / (n * n) as f64;
        let peaks: Vec<f32> = weights.iter().map(|&w| (f64::from(w) - mean).max(0.0) as f32).collect();
        // rounding of the mean makes no peak
        if peaks.iter().all(|&p| f64::from(p) <= 1e-6 * mean) {
            return Self::Even;
        }
        Piecewise2d::new(&peaks, n, n).map_or(Self::All, |peaks| Self::Peaks(Box::new(peaks)))
    }
}

/// Parameters: see the module.
#[derive(Clone, Debug)]
pub struct ImageInfiniteLight {
    image: EnvironmentImage,
    /// By radiance.
    distribution: Box<Piecewise2d>,
    /// Where chance meets the map as well.
    beside_chance: BesideChance,
    /// Light space to the scene: a rotation, possibly with a reflection.
    axes: [Vec3; 3],
}

impl ImageInfiniteLight {
    /// `axes` are the images of the light's x, y and z in the scene, orthonormal.
    pub fn new(image: EnvironmentImage, axes: [Vec3; 3]) -> Result<Self, TransportError> {
        let n = image.size;
        if n == 0 || image.texels.len() != n * n || image.weights.len() != n * n {
            let why = format!("expected {n} x {n} texels, got {}", image.texels.len());
            return Err(TransportError::Unusable { what: "infinite light image", why });
        }
        let distribution = Piecewise2d::new(&image.weights, n, n)
            .map_err(|e| TransportError::Unusable { what: "infinite light image", why: e.to_string() })?;
        let distribution = Box::new(distribution);
        let beside_chance = BesideChance::new(&image.weights, n);
        Ok(Self { image, distribution, beside_chance, axes })
    }

    /// See [`super::Light::sample_li`].
    #[inline]
    pub fn sample_li<const N: usize>(&self, u: [f32; 2], w: &Wavelengths<N>) -> Option<LiSample<N>> {
        self.sample_by(&self.distribution, u, w)
    }

    /// See [`super::Light::sample_li_beside_chance`].
    #[inline]
    pub fn sample_li_beside_chance<const N: usize>(
        &self,
        half: Vec3,
        u: [f32; 2],
        w: &Wavelengths<N>,
    ) -> Option<LiSample<N>> {
        match &self.beside_chance {
            BesideChance::All => self.sample_by(&self.distribution, u, w),
            BesideChance::Peaks(peaks) => self.sample_by(peaks, u, w),
            BesideChance::Even => {
                let wi = UniformInfiniteLight::sample_direction(half, u);
                let (l, pdf) = (self.le(wi, w), UniformInfiniteLight::pdf(half, wi));
                (pdf > 0.0 && !l.is_zero()).then_some(LiSample { l, wi, target: None, pdf, delta: false })
            }
        }
    }

    #[inline(always)]
    fn sample_by<const N: usize>(
        &self,
        distribution: &Piecewise2d,
        u: [f32; 2],
        w: &Wavelengths<N>,
    ) -> Option<LiSample<N>> {
        let (uv, pdf) = distribution.sample(u);
        let d = square_to_sphere(uv);
        let wi = self.axes[0] * d.x + self.axes[1] * d.y + self.axes[2] * d.z;
        let l = self.radiance(uv, w);
        let pdf = pdf * warp::pdf_uniform_sphere();
        (pdf > 0.0 && !l.is_zero()).then_some(LiSample { l, wi, target: None, pdf, delta: false })
    }

    /// Radiance along the ray direction `d`.
    #[inline]
    pub fn le<const N: usize>(&self, d: Vec3, w: &Wavelengths<N>) -> Spectrum<N> {
        self.radiance(sphere_to_square(self.local(d)), w)
    }

    /// Density of [`Self::sample_li`] \[1/sr\].
    #[inline]
    pub fn pdf(&self, d: Vec3) -> f32 {
        self.distribution.pdf(sphere_to_square(self.local(d))) * warp::pdf_uniform_sphere()
    }

    /// Density of [`Self::sample_li_beside_chance`] \[1/sr\].
    #[inline]
    pub fn pdf_beside_chance(&self, half: Vec3, d: Vec3) -> f32 {
        match &self.beside_chance {
            BesideChance::All => self.pdf(d),
            BesideChance::Peaks(peaks) => {
                peaks.pdf(sphere_to_square(self.local(d))) * warp::pdf_uniform_sphere()
            }
            BesideChance::Even => UniformInfiniteLight::pdf(half, d),
        }
    }

    /// True when all texels are alike.
    pub(super) fn is_even(&self) -> bool {
        matches!(self.beside_chance, BesideChance::Even)
    }

    /// Light sampling leaves nothing to chance.
    pub(super) fn sample_all(&mut self) {
        self.beside_chance = BesideChance::All;
    }

    /// Mean emission over directions.
    pub fn mean_emission(&self) -> &Emission {
        &self.image.mean
    }

    #[inline(always)]
    fn local(&self, d: Vec3) -> Vec3 {
        vec3(d.dot(self.axes[0]), d.dot(self.axes[1]), d.dot(self.axes[2]))
    }

    #[inline(always)]
    fn radiance<const N: usize>(&self, uv: [f32; 2], w: &Wavelengths<N>) -> Spectrum<N> {
        let n = self.image.size;
        let cell = |t: f32| ((t * n as f32) as usize).min(n - 1);
        let texel = &self.image.texels[cell(uv[1]) * n + cell(uv[0])];
        let colour = Spectrum::from_fn(|k| texel.scale * texel.sigmoid.eval(w.lambda[k]));
        colour * self.image.white.sample(w)
    }
}

/// The unit square to the sphere, area preserving.
pub fn square_to_sphere(uv: [f32; 2]) -> Vec3 {
    let (u, v) = (2.0 * uv[0] - 1.0, 2.0 * uv[1] - 1.0);
    // distance to the diagonal: positive in the upper hemisphere
    let signed = 1.0 - (u.abs() + v.abs());
    let r = 1.0 - signed.abs();
    let phi = if r == 0.0 { 1.0 } else { (v.abs() - u.abs()) / r + 1.0 } * std::f32::consts::FRAC_PI_4;
    let (sin, cos) = math::sin_cos(phi);
    let z = (1.0 - r * r).copysign(signed);
    let rho = r * (2.0 - r * r).max(0.0).sqrt();
    vec3(cos.copysign(u) * rho, sin.copysign(v) * rho, z)
}

/// The inverse of [`square_to_sphere`].
pub fn sphere_to_square(d: Vec3) -> [f32; 2] {
    let r = (1.0 - d.z.abs()).max(0.0).sqrt();
    let phi = math::atan2(d.y.abs(), d.x.abs()) * std::f32::consts::FRAC_2_PI;
    let (mut v, mut u) = (phi * r, r - phi * r);
    if d.z < 0.0 {
        (u, v) = (1.0 - v, 1.0 - u);
    }
    [0.5 * (u.copysign(d.x) + 1.0), 0.5 * (v.copysign(d.y) + 1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_base::rng::Pcg32;

    #[test]
    fn octahedral_map_inverts() {
        let mut rng = Pcg32::new(3, 5);
        for _ in 0..10_000 {
            let d = warp::sample_uniform_sphere(rng.next_2d());
            let e = square_to_sphere(sphere_to_square(d));
            assert!((d - e).length() < 2e-3, "{d:?} {e:?}");
        }
    }

    #[test]
    fn octahedral_map_preserves_area() {
        // the z of uniform points of the square is uniform on [-1, 1]: compare its first two moments
        let n = 512;
        let (mut m1, mut m2) = (0.0, 0.0);
        for i in 0..n * n {
            let uv = [((i % n) as f32 + 0.5) / n as f32, ((i / n) as f32 + 0.5) / n as f32];
            let z = f64::from(square_to_sphere(uv).z);
            (m1, m2) = (m1 + z, m2 + z * z);
        }
        let count = f64::from(n * n);
        assert!((m1 / count).abs() < 1e-4 && (m2 / count - 1.0 / 3.0).abs() < 1e-3);
    }
}
