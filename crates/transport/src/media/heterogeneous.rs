//! A medium whose coefficients vary in space: a model in the space of its grid, the grid's place, and majorants.

use super::{
    Cloud, Dense,
    coarse::Coarse,
    density::{Bricks, Extrema},
    length,
    majorant::Majorants,
    model::{MediumModel, Mixed, Point, RgbGrid, Separable, SpectralGrid},
};
use crate::{TransportError, error::check};
use std::sync::OnceLock;
use tyndall_base::Vec3;
use tyndall_geometry::{Bounds3, Ray, Transform};
use tyndall_spectral::{Emission, LambdaRange, Spectrum, Wavelengths};

/// Points of a segment between which optical depths are summed, at most.
const MOST_STEPS: f32 = 65_536.0;

/// The kinds of medium, each with its own loop.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "one of it per medium, behind a pointer")]
pub enum Model {
    /// Spectra times a regular grid.
    Dense(Separable<Dense>),
    /// Spectra times a sparse grid.
    Sparse(Separable<Bricks>),
    /// Spectra times a procedural cloud.
    Cloud(Separable<Cloud>),
    /// RGB coefficients per voxel.
    Rgb(RgbGrid),
    /// Bands per voxel.
    Spectral(SpectralGrid),
    /// Several of these.
    Mixed(Mixed),
}

/// Runs `$body` with the concrete model.
macro_rules! with_model {
    ($of:expr, $m:ident => $body:expr) => {
        match $of {
            Model::Dense($m) => $body,
            Model::Sparse($m) => $body,
            Model::Cloud($m) => $body,
            Model::Rgb($m) => $body,
            Model::Spectral($m) => $body,
            Model::Mixed($m) => $body,
        }
    };
}

/// What a loop over a medium does, for any model.
pub trait Visitor<'m> {
    /// What comes out.
    type Output;
    /// Runs on the model, with the majorants; both live in the space that [`Heterogeneous::local`] leads to.
    fn visit<M: MediumModel>(self, model: &'m M, majorants: &'m Majorants) -> Self::Output;
}

/// See the module.
#[derive(Clone, Debug)]
pub struct Heterogeneous {
    to_world: Transform,
    to_grid: Transform,
    /// Length in the world of one unit of the grid.
    unit: f32,
    model: Model,
    majorants: Majorants,
    range: LambdaRange,
    measurable: bool,
    coarse: OnceLock<Coarse>,
}

impl Heterogeneous {
    /// `model` placed by `to_world`; `majorant_scale` >= 1 widens the majorants, which changes the noise but no mean.
    pub fn new(
        model: Model,
        to_world: Transform,
        majorant_scale: f32,
        range: LambdaRange,
    ) -> Result<Self, TransportError> {
        let ok = majorant_scale >= 1.0 && majorant_scale.is_finite();
        check(ok, "majorantscale", "finite and >= 1", f64::from(majorant_scale))?;
        // length in the world of one unit of the grid, along the longest of its axes
        let axis = |v| to_world.vector(v).length();
        let unit = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|v| axis(Vec3::from(v)));
        let unit = unit[0].max(unit[1]).max(unit[2]);
        let majorants = with_model!(&model, m => {
            let thickness = m.thickness(range) * unit;
            Majorants::new(m.bounds(), m.cells(), thickness, majorant_scale, |b| m.extrema(b))
        });
        let measurable = length::is_measurable(&model, &majorants);
        let coarse = OnceLock::new();
        Ok(Self { to_world, to_grid: to_world.inverse(), unit, model, majorants, range, measurable, coarse })
    }

    /// Whether [`Self::length`] serves: a grid of densities that does not emit.
    #[inline(always)]
    pub fn is_measurable(&self) -> bool {
        self.measurable
    }

    /// Coarse means of the density of a medium that is measurable.
    #[inline(always)]
    pub(super) fn coarse(&self) -> &Coarse {
        self.coarse.get_or_init(|| match &self.model {
            Model::Dense(m) => Coarse::new(&self.majorants, &m.density),
            Model::Sparse(m) => Coarse::new(&self.majorants, &m.density),
            _ => unreachable!("the medium is not measurable"),
        })
    }

    /// The kind of medium.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The same ray parameter for parameter in the grid's space; its direction has no unit length there.
    #[inline(always)]
    pub fn local(&self, ray: &Ray) -> (Vec3, Vec3) {
        (self.to_grid.point(ray.o), self.to_grid.vector(ray.d))
    }

    /// Chooses the loop for the model.
    #[inline(always)]
    pub fn visit<'m, V: Visitor<'m>>(&'m self, visitor: V) -> V::Output {
        with_model!(&self.model, m => visitor.visit(m, &self.majorants))
    }

    /// The coefficients at a point of the world; zero outside.
    pub fn at<const N: usize>(&self, p: Vec3, w: &Wavelengths<N>) -> Point<N> {
        let p = self.to_grid.point(p);
        if !self.majorants.bounds().contains(p) {
            return Point::NOTHING;
        }
        with_model!(&self.model, m => m.at(p, &m.prepare(w)))
    }

    /// Draws a direction of scattering at a point of the world with the hero's density.
    pub fn scatter<const N: usize>(
        &self,
        p: Vec3,
        wo: Vec3,
        uc: f32,
        u: [f32; 2],
        w: &Wavelengths<N>,
    ) -> Option<Vec3> {
        let p = self.to_grid.point(p);
        with_model!(&self.model, m => {
            let prepared = m.prepare(w);
            let sigma_s = m.at(p, &prepared).sigma_s;
            m.scattering(p, sigma_s, &prepared).sample(wo, uc, u, w).map(|s| s.wi)
        })
    }

    /// Mean cosine of scattering at a point of the world at the hero's wavelength.
    pub fn mean_cosine<const N: usize>(&self, p: Vec3, w: &Wavelengths<N>) -> f32 {
        let p = self.to_grid.point(p);
        with_model!(&self.model, m => {
            let prepared = m.prepare(w);
            let sigma_s = m.at(p, &prepared).sigma_s;
            m.scattering(p, sigma_s, &prepared).mean_cosine(w, 0)
        })
    }

    /// Phase function \[1/sr\] at a point of the world, the mixture of what scatters there.
    pub fn phase<const N: usize>(&self, p: Vec3, wo: Vec3, wi: Vec3, w: &Wavelengths<N>) -> Spectrum<N> {
        let p = self.to_grid.point(p);
        with_model!(&self.model, m => {
            let prepared = m.prepare(w);
            let sigma_s = m.at(p, &prepared).sigma_s;
            m.scattering(p, sigma_s, &prepared).eval(wo, wi, w)
        })
    }

    /// Majorant \[1/m\] of the whole medium per lane.
    pub fn majorant<const N: usize>(&self, w: &Wavelengths<N>) -> Spectrum<N> {
        with_model!(&self.model, m => m.unit(&m.prepare(w)) * self.majorants.max())
    }

    /// The parameters at which the ray is in the medium's box, up to `t_max`.
    pub fn clip(&self, ray: &Ray, t_max: f32) -> Option<(f32, f32)> {
        let (o, d) = self.local(ray);
        self.majorants.bounds().clip(o, d, t_max)
    }

    /// The box in the world.
    pub fn bounds(&self) -> Bounds3 {
        self.to_world.bounds(self.majorants.bounds())
    }

    /// Optical depth along the ray up to `t_max` per lane, by two Gauss points per half voxel: exact but for kinks.
    pub fn optical_depth<const N: usize>(&self, ray: &Ray, t_max: f32, w: &Wavelengths<N>) -> Spectrum<N> {
        /// Places of the two points of Gauss's rule on (0, 1): (1 -+ 1/sqrt 3) / 2.
        const GAUSS: [f32; 2] = [0.211_324_87, 0.788_675_13];
        let (o, d) = self.local(ray);
        let Some((t0, t1)) = self.majorants.bounds().clip(o, d, t_max) else { return Spectrum::ZERO };
        with_model!(&self.model, m => {
            let prepared = m.prepare(w);
            let steps = (2.0 * (t1 - t0) * d.length() / m.detail()).ceil().clamp(1.0, MOST_STEPS);
            let dt = (t1 - t0) / steps;
            let mut tau = Spectrum::ZERO;
            for i in 0..steps as usize {
                for g in GAUSS {
                    tau += m.extinction(o + d * (t0 + (i as f32 + g) * dt), &prepared) * (0.5 * dt);
                }
            }
            tau
        })
    }

    /// The bounds of the density.
    pub(super) fn majorants(&self) -> &Majorants {
        &self.majorants
    }

    /// Length in the world over which the medium varies.
    pub fn detail(&self) -> f32 {
        with_model!(&self.model, m => m.detail() * self.unit)
    }

    /// Runs `body` with a function that tells what a point of the grid's box emits, `sigma_a le`.
    pub(crate) fn with_emission<const N: usize, R>(
        &self,
        w: &Wavelengths<N>,
        body: impl FnOnce(&dyn Fn(Vec3) -> Spectrum<N>) -> R,
    ) -> R {
        with_model!(&self.model, m => {
            let prepared = m.prepare(w);
            body(&|p| m.at(p, &prepared).emitted)
        })
    }

    /// What a point of the world emits, `sigma_a le` \[W m^-3 sr^-1 nm^-1\], and the majorant \[1/m\] there; `None` outside.
    #[inline(never)]
    pub fn glow_at<const N: usize>(&self, p: Vec3, w: &Wavelengths<N>) -> Option<[Spectrum<N>; 2]> {
        let p = self.to_grid.point(p);
        if !self.majorants.bounds().contains(p) {
            return None;
        }
        Some(with_model!(&self.model, m => {
            let prepared = m.prepare(w);
            [m.at(p, &prepared).emitted, m.unit(&prepared) * self.majorants.at(p).max]
        }))
    }

    /// Volume in the world of a unit of volume of the grid's space.
    pub(crate) fn volume_scale(&self) -> f64 {
        let axis = |v: [f32; 3]| self.to_world.vector(Vec3::from(v));
        let (x, y, z) = (axis([1.0, 0.0, 0.0]), axis([0.0, 1.0, 0.0]), axis([0.0, 0.0, 1.0]));
        f64::from(x.cross(y).dot(z).abs())
    }

    /// Length in the grid's space over which the medium varies.
    pub(crate) fn grid_detail(&self) -> f32 {
        with_model!(&self.model, m => m.detail())
    }

    /// A point of the grid's space in the world.
    #[inline(always)]
    pub(crate) fn world_of(&self, p: Vec3) -> Vec3 {
        self.to_world.point(p)
    }

    /// A box of the grid's space in the world.
    pub(crate) fn to_world_bounds(&self, b: Bounds3) -> Bounds3 {
        self.to_world.bounds(b)
    }

    /// A point of the world in the space of the grid.
    #[inline(always)]
    pub(crate) fn to_grid(&self, p: Vec3) -> Vec3 {
        self.to_grid.point(p)
    }

    /// The box in the space of the grid.
    #[inline(always)]
    pub(crate) fn grid_bounds(&self) -> Bounds3 {
        self.majorants.bounds()
    }

    /// Bounds of `sigma_t` \[1/m\] over all wavelengths in a box of the world.
    pub(crate) fn extinction_bounds(&self, world: Bounds3) -> Extrema {
        let own = self.majorants.bounds();
        let b = self.to_grid.bounds(world);
        let common = Bounds3 { lo: b.lo.max(own.lo), hi: b.hi.min(own.hi) };
        if common.is_empty() {
            return Extrema { max: 0.0, min: 0.0 };
        }
        with_model!(&self.model, m => {
            let ([least, greatest], e) = (m.unit_bounds(self.range), m.extrema(common));
            let within = b.lo == common.lo && b.hi == common.hi;
            Extrema { max: greatest * e.max, min: if within { least * e.min } else { 0.0 } }
        })
    }

    /// The wavelengths that the majorants hold for.
    pub fn range(&self) -> LambdaRange {
        self.range
    }

    /// An emission of the kind found in the medium, if it emits.
    pub fn emission(&self) -> Option<&Emission> {
        with_model!(&self.model, m => m.emission())
    }

    /// The class in a scene's words.
    pub fn class(&self) -> &'static str {
        match &self.model {
            Model::Dense(_) => "uniformgrid",
            Model::Sparse(_) => "nanovdb",
            Model::Cloud(_) => "cloud",
            Model::Rgb(_) => "rgbgrid",
            Model::Spectral(_) => "spectralgrid",
            Model::Mixed(_) => "mixture",
        }
    }
}
