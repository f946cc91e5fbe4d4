//! Lights: radiance towards a point, and how to sample it.
//!
//! `sample_li` draws a direction towards the light from a reference point, in solid angle; `sample_position` draws a
//! point of a light of finite size in area, which is what equiangular sampling needs before it knows where along a
//! ray the light will be seen from.

mod area;
mod bounds;
mod distant;
mod emit;
mod goniometric;
mod image;
mod infinite;
mod point;
mod portal;
mod projection;
mod set;
mod spot;
mod tree;
mod volume;

pub use area::{AreaExtra, AreaLight};
pub use distant::DistantLight;
pub use emit::Particle;
pub use goniometric::{GoniometricLight, PhotometricWeb, Profile};
pub use image::{EnvironmentImage, ImageInfiniteLight, RgbEmission, sphere_to_square, square_to_sphere};
pub use infinite::UniformInfiniteLight;
pub use point::PointLight;
pub use portal::{Portal, PortalLight, Sky};
pub use projection::ProjectionLight;
pub use set::{LightRules, LightSet, MediumLights, Selected, Selection, Skies};
pub use spot::SpotLight;
pub use volume::{VolumeLight, VolumePoint};

use tyndall_base::Vec3;
use tyndall_geometry::{Accel, Bounds3, Hit, Ray, Rounding, SurfacePoint, segment, spawn_origin};
use tyndall_spectral::{Spectrum, Wavelengths};

/// Light that arrives at a reference point from a sampled direction.
#[derive(Clone, Copy, Debug)]
pub struct LiSample<const N: usize> {
    /// Unoccluded incident radiance \[W m^-2 sr^-1 nm^-1\] (for delta lights: irradiance-like, so that `l / pdf` with
    /// `pdf = 1` is the estimate).
    pub l: Spectrum<N>,
    /// Unit direction from the reference point to the light.
    pub wi: Vec3,
    /// Where the shadow ray ends; `None` for lights at infinity.
    pub target: Option<Target>,
    /// Density per solid angle \[1/sr\]; 1 for delta lights.
    pub pdf: f32,
    /// True when no ray of chance can meet the light.
    pub delta: bool,
}

/// A point on a light, with what a shadow ray needs to stop short of it.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// The point \[m\].
    pub p: Vec3,
    /// How far `p` is from the exact point.
    pub rounding: Rounding,
    /// Geometric normal, or zero for a point light.
    pub n: Vec3,
    /// Density per area with which [`Light::sample_position`] draws the point \[1/m^2\]; 1 for point lights.
    pub pdf_area: f32,
}

impl Target {
    /// A point in empty space.
    #[inline(always)]
    pub fn free(p: Vec3) -> Self {
        Self { p, rounding: Rounding::NONE, n: Vec3::ZERO, pdf_area: 1.0 }
    }

    /// The ray from `o` that ends just short of the point; `None` when they coincide.
    #[inline(always)]
    pub fn ray_from(&self, o: Vec3, time: f32) -> Option<Ray> {
        segment(o, spawn_origin(self.p, &self.rounding, self.n, o - self.p), time)
    }
}

/// A point of a light, drawn without regard to who looks at it.
#[derive(Clone, Copy, Debug)]
pub struct PositionSample {
    /// The point.
    pub target: Target,
    /// Texture coordinates on the light.
    pub uv: [f32; 2],
}

/// Any light.
#[derive(Clone, Debug)]
pub enum Light {
    /// An emitting primitive of a shape.
    Area(AreaLight),
    /// A point that emits equally in all directions.
    Point(PointLight),
    /// A point that emits into a cone.
    Spot(SpotLight),
    /// Parallel light from infinity.
    Distant(DistantLight),
    /// The same radiance from all directions.
    Infinite(UniformInfiniteLight),
    /// An environment map.
    Image(ImageInfiniteLight),
    /// Light from infinity through a rectangle.
    Portal(Box<PortalLight>),
    /// A point whose intensity depends on the direction.
    Goniometric(Box<GoniometricLight>),
    /// A point that projects an image.
    Projection(Box<ProjectionLight>),
    /// A medium: its points are drawn by [`VolumeLight::sample`], per volume.
    Volume(Box<VolumeLight>),
}

impl Light {
    /// Draws a direction towards the light from `p`, or `None` where no light arrives.
    #[inline]
    pub fn sample_li<const N: usize>(
        &self,
        accel: &Accel,
        p: Vec3,
        u: [f32; 2],
        w: &Wavelengths<N>,
    ) -> Option<LiSample<N>> {
        match self {
            Self::Image(l) => l.sample_li(u, w),
            _ => self.sample_li_beside_chance(accel, (p, Vec3::ZERO), u, w),
        }
    }

    /// The same for a path that may meet the light by chance, too, and weighs both: what chance finds as easily need not be
    /// drawn. Only light from the half of the sphere around the unit vector `half` counts; zero for all of it.
    #[inline]
    pub fn sample_li_beside_chance<const N: usize>(
        &self,
        accel: &Accel,
        (p, half): (Vec3, Vec3),
        u: [f32; 2],
        w: &Wavelengths<N>,
    ) -> Option<LiSample<N>> {
        match self {
            Self::Area(l) => l.sample_li(accel, p, u, w),
            Self::Point(l) => l.sample_li(p, w),
            Self::Spot(l) => l.sample_li(p, w),
            Self::Distant(l) => Some(l.sample_li(w)),
            Self::Infinite(l) => Some(l.sample_li(half, u, w)),
            Self::Image(l) => l.sample_li_beside_chance(half, u, w),
            Self::Portal(l) => l.sample_li(p, u, w),
            Self::Goniometric(l) => l.sample_li(p, w),
            Self::Projection(l) => l.sample_li(p, w),
            // has no density per solid angle alone
            Self::Volume(_) => None,
        }
    }

    /// Draws a point of the light in area; `None` for lights at infinity and for media.
    #[inline]
    pub fn sample_position(&self, accel: &Accel, u: [f32; 2]) -> Option<PositionSample> {
        let at = |p| PositionSample { target: Target::free(p), uv: [0.0; 2] };
        match self {
            Self::Area(l) => Some(l.sample_position(accel, u)),
            Self::Point(l) => Some(at(l.p)),
            Self::Spot(l) => Some(at(l.p)),
            Self::Goniometric(l) => Some(at(l.p)),
            Self::Projection(l) => Some(at(l.p())),
            Self::Distant(_) | Self::Infinite(_) | Self::Image(_) | Self::Portal(_) | Self::Volume(_) => None,
        }
    }

    /// Radiance (area lights) or intensity (point lights) that leaves `y` along the unit direction `d`.
    #[inline]
    pub fn emitted_along<const N: usize>(
        &self,
        y: &PositionSample,
        d: Vec3,
        w: &Wavelengths<N>,
    ) -> Spectrum<N> {
        match self {
            Self::Area(l) => l.radiance(y.target.n, y.uv, d, w) * l.share(y.target.p, y.target.n, y.uv),
            Self::Point(l) => l.intensity.sample(w),
            Self::Spot(l) => l.intensity_along(d, w),
            Self::Goniometric(l) => l.intensity_along(d, w),
            Self::Projection(l) => l.intensity_along(d, w),
            Self::Distant(_) | Self::Infinite(_) | Self::Image(_) | Self::Portal(_) | Self::Volume(_) => {
                Spectrum::ZERO
            }
        }
    }

    /// Density per solid angle with which [`Self::sample_li`] draws `target` from `p`; 1 for delta lights.
    #[inline]
    pub fn pdf_li(&self, accel: &Accel, p: Vec3, wi: Vec3, target: &Target) -> f32 {
        match self {
            Self::Area(l) => l.pdf_li(accel, p, target),
            Self::Point(_)
            | Self::Spot(_)
            | Self::Distant(_)
            | Self::Goniometric(_)
            | Self::Projection(_) => 1.0,
            Self::Infinite(_) | Self::Image(_) | Self::Portal(_) => self.pdf_infinite(p, wi),
            Self::Volume(_) => 0.0,
        }
    }

    /// The target at a point where a ray met the light.
    #[inline]
    pub fn target(&self, accel: &Accel, hit: &Hit, s: &SurfacePoint) -> Target {
        match self {
            Self::Area(l) => l.target(accel, hit, s),
            _ => Target::free(s.p),
        }
    }

    /// Radiance that leaves an area light at a point with normal `n` along `d`; zero for other lights.
    #[inline]
    pub fn radiance_at<const N: usize>(
        &self,
        n: Vec3,
        uv: [f32; 2],
        d: Vec3,
        w: &Wavelengths<N>,
    ) -> Spectrum<N> {
        if let Self::Area(l) = self { l.radiance(n, uv, d, w) } else { Spectrum::ZERO }
    }

    /// Radiance from infinity that reaches `p` along the ray direction `d` (zero for lights of finite extent); `p` is the
    /// last point where the path scattered.
    #[inline]
    pub fn le_infinite<const N: usize>(&self, p: Vec3, d: Vec3, w: &Wavelengths<N>) -> Spectrum<N> {
        match self {
            Self::Infinite(l) => l.emission.sample(w),
            Self::Image(l) => l.le(d, w),
            Self::Portal(l) => l.le(p, d, w),
            _ => Spectrum::ZERO,
        }
    }

    /// Density per solid angle with which `sample_li` draws direction `d` from `p` (lights at infinity only).
    #[inline]
    pub fn pdf_infinite(&self, p: Vec3, d: Vec3) -> f32 {
        match self {
            Self::Image(l) => l.pdf(d),
            _ => self.pdf_infinite_beside_chance((p, Vec3::ZERO), d),
        }
    }

    /// The same of [`Self::sample_li_beside_chance`].
    #[inline]
    pub fn pdf_infinite_beside_chance(&self, (p, half): (Vec3, Vec3), d: Vec3) -> f32 {
        match self {
            Self::Infinite(_) => UniformInfiniteLight::pdf(half, d),
            Self::Image(l) => l.pdf_beside_chance(half, d),
            Self::Portal(l) => l.pdf(p, d),
            _ => 0.0,
        }
    }

    /// True for points and single directions.
    pub fn is_delta(&self) -> bool {
        !matches!(self, Self::Area(_) | Self::Volume(_)) && !self.is_sky()
    }

    /// True when no ray of chance can meet the light.
    pub fn is_hidden(&self) -> bool {
        self.is_delta() || matches!(self, Self::Area(l) if l.is_invisible())
    }

    /// Light sampling leaves nothing to chance; see [`Skies::Always`].
    fn sample_all(&mut self) {
        if let Self::Image(l) = self {
            l.sample_all();
        }
    }

    /// True for a sky of one radiance.
    pub(super) fn is_even_sky(&self) -> bool {
        match self {
            Self::Infinite(_) => true,
            Self::Image(l) => l.is_even(),
            _ => false,
        }
    }

    /// True for lights that rays which leave the scene may meet.
    pub const fn is_sky(&self) -> bool {
        matches!(self, Self::Infinite(_) | Self::Image(_) | Self::Portal(_))
    }

    /// True for surfaces and points of finite extent.
    pub fn is_local(&self) -> bool {
        self.has_place() && !matches!(self, Self::Volume(_))
    }

    /// True for all that is not at infinity.
    pub const fn has_place(&self) -> bool {
        !matches!(self, Self::Distant(_)) && !self.is_sky()
    }

    /// A box that holds the light; `None` for those at infinity.
    pub fn bounds(&self, accel: &Accel) -> Option<Bounds3> {
        match self {
            Self::Area(l) => Some(accel.group(l.shape).shape.prim_bounds(l.prim)),
            Self::Volume(l) => Some(l.bounds()),
            Self::Point(_) | Self::Spot(_) | Self::Goniometric(_) | Self::Projection(_) => {
                let p = self.sample_position(accel, [0.5, 0.5])?.target.p;
                Some(Bounds3::new(p, p))
            }
            Self::Distant(_) | Self::Infinite(_) | Self::Image(_) | Self::Portal(_) => None,
        }
    }

    /// Emitted power over the light's emission spectrum: area times solid angle (times pi, the projected one).
    pub fn extent(&self, scene_radius: f32) -> f64 {
        const PI: f64 = std::f64::consts::PI;
        let disk = PI * f64::from(scene_radius) * f64::from(scene_radius);
        match self {
            Self::Area(l) => PI * f64::from(l.area) * l.sides(),
            Self::Point(_) => 4.0 * PI,
            Self::Spot(l) => l.solid_angle(),
            Self::Goniometric(l) => l.solid_angle(),
            Self::Projection(l) => l.solid_angle(),
            Self::Distant(_) => disk,
            Self::Infinite(_) | Self::Image(_) => 4.0 * PI * disk,
            Self::Portal(l) => PI * f64::from(l.area()),
            Self::Volume(l) => 4.0 * PI * l.cross_section(),
        }
    }

    /// The light's emission spectrum up to a factor, for densities of wavelengths.
    pub fn spectrum(&self) -> &tyndall_spectral::Emission {
        match self {
            Self::Area(l) => &l.emission,
            Self::Point(l) => &l.intensity,
            Self::Spot(l) => &l.intensity,
            Self::Distant(l) => &l.emission,
            Self::Infinite(l) => &l.emission,
            Self::Image(l) => l.mean_emission(),
            Self::Portal(l) => l.mean_emission(),
            Self::Goniometric(l) => &l.intensity,
            Self::Projection(l) => l.mean_emission(),
            Self::Volume(l) => l.spectrum(),
        }
    }
}
