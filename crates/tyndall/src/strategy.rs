//! From the spectral strategy and the integrator to lanes, wavelengths and what they share.

use crate::{
    Error, Options,
    options::{Spectral, WavelengthPdf},
};
use std::sync::Arc;
use tyndall_film::{Channels, Sensor};
use tyndall_integrators::{
    Settings,
    opaw::AllWavelengths,
    pixel::{Lanes, Method, Sharing},
};
use tyndall_io::{LoadedScene, scene::FilmDescription};
use tyndall_spectral::{
    Curve, Emission, LambdaRange, WavelengthSampler, Wavelengths, cie,
    strategy::{Density, FixedSet, Rule},
};
use tyndall_transport::{Scene, media::Medium};

/// What runs: `analog` and `wang-chern` carry one wavelength unless told to carry a set.
pub(crate) fn effective(asked: Spectral, method: Method) -> Result<Spectral, Error> {
    match (asked, method) {
        (Spectral::Hero { .. }, Method::Analog | Method::WangChern) => Ok(Spectral::Opow { set: None }),
        (Spectral::Opaw { .. } | Spectral::Swc { .. }, Method::Analog) => Err(Error::options(
            format!(
                "--integrator analog: its absorption is an event at one wavelength, so that it cannot carry --spectral {}",
                asked.name()
            ),
            Some("use --spectral opow, or --integrator volpath or wang-chern".into()),
        )),
        _ => Ok(asked),
    }
}

/// The density where none is asked for.
pub(crate) fn density(asked: WavelengthPdf, method: Method) -> WavelengthPdf {
    match (asked, method) {
        (WavelengthPdf::Auto, Method::WangChern) => WavelengthPdf::Uniform,
        (WavelengthPdf::Auto, _) => WavelengthPdf::Light,
        (asked, _) => asked,
    }
}

/// Without light sampling lights are met by chance only.
pub(crate) fn check_method(method: Method, settings: &Settings, scene: &Scene) -> Result<(), Error> {
    let delta = scene.lights.iter().any(|l| l.is_hidden());
    let (name, hint) = match method {
        Method::Analog if delta => ("analog", "give the light a size, or use --integrator volpath"),
        Method::WangChern if delta && !settings.light_sampling => {
            ("wang-chern", "give the light a size, or add --light-sampling on")
        }
        _ => return Ok(()),
    };
    Err(Error::options(
        format!(
            "--integrator {name}: the scene has point, spot or distant lights, which no path meets by chance"
        ),
        Some(hint.into()),
    ))
}

/// What needs the optical depth in closed form.
pub(crate) fn check_media(method: Method, spectral: Spectral, loaded: &LoadedScene) -> Result<(), Error> {
    let asked = match (method, spectral) {
        (_, Spectral::Opaw { .. } | Spectral::Swc { .. }) => format!("--spectral {}", spectral.name()),
        (Method::WangChern, _) => "--integrator wang-chern".into(),
        _ => return Ok(()),
    };
    let media = loaded.media.iter().zip(&loaded.scene.media);
    let varying: Vec<String> = media
        .filter(|(_, m)| !matches!(m, Medium::Homogeneous(_)))
        .map(|(name, _)| format!("\"{name}\""))
        .collect();
    let (named, vary) = match varying.len() {
        0 => return Ok(()),
        1 => ("the medium", "varies"),
        _ => ("the media", "vary"),
    };
    Err(Error::options(
        format!("{asked}: expected homogeneous media, and {named} {} {vary} in space", varying.join(", ")),
        Some("use --integrator volpath with --spectral hero or opow".into()),
    ))
}

/// Orders and layers are recorded once a path, so the set must be one full group.
pub(crate) fn check_layers(spectral: Spectral, options: &Options) -> Result<(), Error> {
    let Spectral::Opaw { set: (count, _) } = spectral else { return Ok(()) };
    if [4, 8, 16].contains(&count) || (options.aovs.is_empty() && options.orders.is_empty()) {
        return Ok(());
    }
    Err(Error::options(
        format!("--spectral opaw with {count} wavelengths cannot split orders or record layers"),
        Some("with --wavelengths 4, 8 or 16 it can".into()),
    ))
}

/// Wavelengths that a path carries.
pub(crate) fn lanes(method: Method, spectral: Spectral) -> Result<Lanes, Error> {
    let count = match spectral {
        Spectral::Opaw { set: (count, _) } => return Ok(Sharing::lanes_for(count as usize)),
        Spectral::Hero { wavelengths } if method == Method::Volpath => wavelengths,
        Spectral::Swc { wavelengths } => wavelengths,
        _ => 1,
    };
    Lanes::from_count(count).ok_or_else(|| {
        Error::options(
            format!(
                "--wavelengths {count}: a path of --spectral {} carries 1, 4, 8 or 16 wavelengths",
                spectral.name()
            ),
            Some("for a fixed set of any size use --spectral opow".into()),
        )
    })
}

/// What the wavelengths of a path share.
pub(crate) fn sharing(spectral: Spectral, wavelengths: &WavelengthSampler, scene: &Scene) -> Sharing {
    match (spectral, wavelengths) {
        (Spectral::Swc { .. }, _) => Sharing::Clusters,
        (Spectral::Opaw { .. }, WavelengthSampler::Fixed(set)) => {
            Sharing::Means(Arc::new(AllWavelengths::new(scene, Arc::clone(set))))
        }
        _ => Sharing::Hero,
    }
}

/// OPAW says once that it is wrong where media have colour.
pub(crate) fn notes(spectral: Spectral, scene: &Scene, range: LambdaRange) -> Vec<String> {
    let Spectral::Opaw { .. } = spectral else { return Vec::new() };
    let at = |k: u8| range.min + range.width() * f32::from(k) / 64.0;
    let chromatic = scene.media.iter().any(|m| {
        let sigma_t = |k| m.homogeneous(&Wavelengths::continuum([at(k)], [1.0])).map(|m| m.sigma_t()[0]);
        (1..=64).any(|k| sigma_t(k) != sigma_t(0))
    });
    if !chromatic {
        return Vec::new();
    }
    vec![
        "--spectral opaw is biased here: all wavelengths travel by the mean extinction, and a medium's extinction \
         varies with wavelength; hero, swc and opow are right"
            .into(),
    ]
}

/// The film's responses; Meyer's rule brings its own.
pub(crate) fn channels(film: &FilmDescription, options: &Options) -> Result<Channels, Error> {
    let Some((count, Rule::Meyer)) = options.spectral.set() else { return Ok(film.channels()?) };
    if !film.band_edges.is_empty() {
        return Err(Error::options(
            "Meyer's four wavelengths give X, Y and Z and no bands",
            Some("leave out --bands, or use another --wavelength-rule".into()),
        ));
    }
    let curves = fixed_set(options, count, Rule::Meyer)?.responses()?;
    let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    Ok(film.channels_of(Sensor::new(curves, identity, film.imaging_ratio, options.range))?)
}

/// A fixed set of wavelengths.
fn fixed_set(options: &Options, count: u32, rule: Rule) -> Result<FixedSet, Error> {
    Ok(FixedSet::new(options.range, count as usize, rule)?)
}

/// The density of wavelengths, with every spectral line of the scene.
pub(crate) fn sampler(
    loaded: &LoadedScene,
    options: &Options,
    spectral: Spectral,
    pdf: WavelengthPdf,
) -> Result<WavelengthSampler, Error> {
    let sources = loaded.scene.emitters();
    let lines = sources.iter().any(|(_, e)| !e.lines().is_empty());
    if let Some((count, rule)) = spectral.set() {
        if lines {
            return Err(Error::options(
                "a fixed set of wavelengths misses the scene's spectral lines",
                Some("--spectral opow without --wavelengths draws from the continuum and the lines".into()),
            ));
        }
        return Ok(fixed_set(options, count, rule)?.into());
    }
    let weighted: Vec<(f32, &Emission)> = sources.iter().map(|(w, e)| (*w, *e)).collect();
    let responses = responses(&loaded.film.band_edges)?;
    let density = match pdf {
        WavelengthPdf::Uniform | WavelengthPdf::Visible if lines => {
            let all: Vec<_> = sources.iter().flat_map(|(_, e)| e.lines().iter().copied()).collect();
            Density::uniform_with_lines(options.range, &all, 0.3)?
        }
        WavelengthPdf::Uniform => Density::uniform(options.range),
        WavelengthPdf::Visible => Density::visible(options.range)?,
        WavelengthPdf::Light | WavelengthPdf::Auto if weighted.is_empty() => Density::uniform(options.range),
        // light that no response sees leaves the density to the range alone
        WavelengthPdf::Light | WavelengthPdf::Auto => Density::light(options.range, &responses, &weighted)
            .or_else(|_| Density::uniform_with_lines(options.range, &[], 0.0))?,
    };
    Ok(density.into())
}

/// What the film sees: the colour matching functions and, for bands, each band.
fn responses(edges: &[f32]) -> Result<Vec<Curve>, Error> {
    let mut all = cie::matching_functions().to_vec();
    for e in edges.windows(2) {
        all.push(Curve::step(e, &[1.0 / (e[1] - e[0])], tyndall_spectral::Outside::Zero)?);
    }
    Ok(all)
}
