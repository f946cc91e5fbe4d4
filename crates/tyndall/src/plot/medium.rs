//! Media: coefficients, albedo and mean cosine, mean free path, phase function; of a medium that varies in space, at the
//! point of a lattice where it is densest.

use super::curve;
use crate::{
    Error, Options, Source, load,
    page::{Axis, Chart, Series, side_by_side},
};
use std::path::Path;
use tyndall_base::{Vec3, vec::vec3};
use tyndall_spectral::{LambdaRange, Wavelengths};
use tyndall_transport::{
    media::{Heterogeneous, Medium, Painted},
    texture::TextureContext,
};

/// Wavelengths of the polar plot \[nm\]; those outside the range are left out.
const WAVELENGTHS: [f32; 4] = [400.0, 500.0, 600.0, 700.0];
/// Ratio of greatest to least value above which the radius of the polar plot is logarithmic.
const WIDE: f64 = 20.0;

/// Four charts a medium; all media of the scene when `name` is `None`.
///
/// # Errors
/// When the scene cannot be read or has no such medium.
pub fn medium(scene: &Path, name: Option<&str>, options: &Options) -> Result<String, Error> {
    let loaded = load(Source::File(scene), options)?;
    let all = loaded.media.iter().zip(&loaded.scene.media);
    let chosen: Vec<(&String, &Medium)> = all.filter(|(n, _)| name.is_none_or(|name| name == *n)).collect();
    if chosen.is_empty() {
        let known = loaded.media.join(", ");
        let hint =
            if known.is_empty() { "the scene has no media".into() } else { format!("media are {known}") };
        let what = name.map_or_else(|| "no medium".to_owned(), |n| format!("no medium \"{n}\""));
        return Err(Error::options(format!("{}: there is {what}", scene.display()), hint));
    }
    let charts =
        chosen.iter().flat_map(|(name, medium)| charts(name, medium, options.range)).collect::<Vec<_>>();
    Ok(side_by_side(&charts, 2))
}

fn charts(name: &str, medium: &Medium, range: LambdaRange) -> [String; 4] {
    let place = Place::of(medium, range);
    let at = |f: fn(f64, f64) -> f64| {
        curve(range, |lambda| {
            let (a, s) = place.coefficients(lambda);
            f(a, s)
        })
    };
    let nm = || super::wavelength(range);
    let coefficients = Chart::new(&format!("{name}: coefficients"), nm(), Axis::new("[1/m]"))
        .with(Series::line("sigma_a", at(|a, _| a)))
        .with(Series::line("sigma_s", at(|_, s| s)))
        .with(Series::dashed("sigma_t", at(|a, s| a + s)));
    let cosine = curve(range, |lambda| place.mean_cosine(lambda));
    let albedo = Chart::new(&format!("{name}: albedo and mean cosine"), nm(), Axis::new(""))
        .with(Series::line("albedo", at(|a, s| if a + s > 0.0 { s / (a + s) } else { 0.0 })))
        .with(Series::dashed("mean cosine", cosine));
    // where nothing is extinguished the path has no end, and the curve a gap
    let free = at(|a, s| 1.0 / (a + s)).into_iter().filter(|p| p[1].is_finite()).collect();
    let free =
        Chart::new(&format!("{name}: mean free path"), nm(), Axis::new("[m]")).with(Series::line("", free));
    [coefficients.to_svg(), albedo.to_svg(), free.to_svg(), polar(name, &place, range)]
}

fn polar(name: &str, place: &Place<'_>, range: LambdaRange) -> String {
    let curves: Vec<(f32, Vec<[f64; 2]>)> = WAVELENGTHS
        .into_iter()
        .filter(|l| range.contains(*l))
        .map(|lambda| (lambda, (-180..=180).map(|deg| [f64::from(deg), place.phase(lambda, deg)]).collect()))
        .collect();
    let values = || curves.iter().flat_map(|(_, c)| c).map(|p| p[1]).filter(|v| *v > 0.0);
    let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max));
    let log = high > WIDE * low;
    let (what, radius) = if log {
        ("log10 of the phase function [1/sr]", [low.log10().floor(), high.log10().ceil()])
    } else {
        ("phase function [1/sr]", [0.0, 1.05 * high])
    };
    let scaled = |v: f64| if log { v.max(low).log10() } else { v };
    let chart =
        Chart::new(&format!("{name}: {what}"), Axis::new(""), Axis::new("").range(radius[0], radius[1]));
    let series = |(lambda, curve): &(f32, Vec<[f64; 2]>)| {
        Series::line(&format!("{lambda} nm"), curve.iter().map(|p| [p[0], scaled(p[1])]).collect())
    };
    curves.iter().map(series).fold(chart, Chart::with).to_polar_svg()
}

/// What is plotted of a medium.
enum Place<'a> {
    Anywhere(&'a Medium),
    At(&'a Heterogeneous, Vec3),
    /// Where texture coordinates are zero.
    Corner(&'a Painted),
}

impl<'a> Place<'a> {
    fn of(medium: &'a Medium, range: LambdaRange) -> Self {
        match medium {
            Medium::Homogeneous(_) => Self::Anywhere(medium),
            Medium::Painted(m) => Self::Corner(m),
            Medium::Heterogeneous(m) => Self::At(m, densest(m, 0.5 * (range.min + range.max))),
        }
    }

    /// `sigma_a`, `sigma_s` \[1/m\].
    fn coefficients(&self, lambda: f32) -> (f64, f64) {
        let w = Wavelengths::continuum([lambda], [1.0]);
        let (a, s) = match self {
            Self::Anywhere(m) => {
                m.homogeneous(&w).map_or((0.0, 0.0), |m| (m.sigma_a.hero(), m.sigma_s.hero()))
            }
            Self::At(m, p) => {
                let point = m.at(*p, &w);
                (point.sigma_a.hero(), point.sigma_s.hero())
            }
            Self::Corner(m) => {
                let inside = m.at(&TextureContext::ORIGIN, &w);
                (inside.sigma_a.hero(), inside.sigma_s.hero())
            }
        };
        (f64::from(a), f64::from(s))
    }

    fn mean_cosine(&self, lambda: f32) -> f64 {
        let w = Wavelengths::continuum([lambda], [1.0]);
        f64::from(match self {
            Self::Anywhere(m) => m.homogeneous(&w).map_or(0.0, |m| m.phase.mean_cosine(lambda)),
            Self::At(m, p) => m.mean_cosine(*p, &w),
            Self::Corner(m) => m.g,
        })
    }

    /// Phase function at an angle of scattering \[degrees\].
    fn phase(&self, lambda: f32, degrees: i32) -> f64 {
        let w = Wavelengths::continuum([lambda], [1.0]);
        let angle = f64::from(degrees).to_radians();
        // directions point away from the point of scattering: light that goes on came from -z
        let (wo, wi) = (vec3(0.0, 0.0, -1.0), vec3(angle.sin() as f32, 0.0, angle.cos() as f32));
        f64::from(match self {
            Self::Anywhere(m) => m.homogeneous(&w).map_or(0.0, |m| m.phase.eval(wo, wi, &w).hero()),
            Self::At(m, p) => m.phase(*p, wo, wi, &w).hero(),
            Self::Corner(m) => m.phase.eval(wo, wi, &w).hero(),
        })
    }
}

/// The point of a lattice over the medium's box where extinction is greatest.
fn densest(m: &Heterogeneous, lambda: f32) -> Vec3 {
    const LATTICE: usize = 32;
    let (b, w) = (m.bounds(), Wavelengths::continuum([lambda], [1.0]));
    let at = |n: usize| ((n % LATTICE) as f32 + 0.5) / LATTICE as f32;
    let point =
        |i: usize| b.lo + b.extent().hadamard(vec3(at(i), at(i / LATTICE), at(i / LATTICE / LATTICE)));
    let sigma_t = |i: &usize| {
        let p = m.at(point(*i), &w);
        p.sigma_a.hero() + p.sigma_s.hero()
    };
    let best = (0..LATTICE * LATTICE * LATTICE).max_by(|i, j| sigma_t(i).total_cmp(&sigma_t(j)));
    point(best.unwrap_or(0))
}
