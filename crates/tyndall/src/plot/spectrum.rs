//! A spectrum from a file of pairs, or one that scenes can name.

use super::curve;
use crate::{
    Error, Options, Source, load,
    page::{Axis, Chart, Series},
};
use std::path::Path;
use tyndall_spectral::{Curve, Wavelengths, named::named_spectrum};

/// The curve of a spectrum over the spectral range.
///
/// # Errors
/// When there is neither such a name nor such a file, or the file holds no pairs.
pub fn spectrum(name: &str, options: &Options) -> Result<String, Error> {
    let points = match named_spectrum(name) {
        Some(known) => curve(options.range, |lambda| f64::from(Curve::eval(&known, lambda))),
        None => from_file(name, options)?,
    };
    let y = if name.starts_with("glass-") || name.ends_with("-eta") { "refractive index" } else { "value" };
    Ok(Chart::new(name, super::wavelength(options.range), Axis::new(y))
        .with(Series::line("", points))
        .to_svg())
}

/// Read as a scene would read it: the same rules, the same messages.
fn from_file(name: &str, options: &Options) -> Result<Vec<[f64; 2]>, Error> {
    let path = Path::new(name);
    if !path.is_file() {
        return Err(Error::options(
            format!("{name}: there is no such file, scene, image or spectrum"),
            "names of spectra are such as stdillum-D65, glass-BK7, metal-Au-eta; media are written SCENE.pbrt:MEDIUM, pixels IMAGE.exr@x,y"
                .to_owned(),
        ));
    }
    let quoted = name.replace('\\', "\\\\").replace('"', "\\\"");
    let text = format!(
        "Camera \"perspective\"\nWorldBegin\nMakeNamedMedium \"spectrum\" \"string type\" \"homogeneous\" \
         \"spectrum sigma_a\" \"{quoted}\"\n"
    );
    let loaded = load(Source::Text(name, &text, Path::new("")), options)?;
    let medium = loaded.scene.media.first().expect("the text makes a medium");
    Ok(curve(options.range, |lambda| {
        let w = Wavelengths::continuum([lambda], [1.0]);
        medium.homogeneous(&w).map_or(f64::NAN, |m| f64::from(m.sigma_a.hero()))
    }))
}
