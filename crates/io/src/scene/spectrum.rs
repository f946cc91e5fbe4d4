//! Spectra of a scene: values in the file, files, names, colours.
//!
//! pbrt's rule outside a table: zero for values and files, held for named spectra. Our parameters on any directive:
//! `"string extrapolate" "hold"|"zero"`, `"string interpolation" "linear"|"step"` (step: values of N+1 edges, the last
//! value unused).

use super::{
    color_space,
    context::{Context, at, refuse},
};
use tyndall_pbrt::{Error, ParamSet, SpectrumValue};
use tyndall_spectral::{Curve, cie, colour::ColourSpace, named, range::Outside, upsample};

/// What a spectrum is for: decides how a colour becomes one, and its range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Emission.
    Illuminant,
    /// Reflectance, in \[0, 1\].
    Albedo,
    /// Coefficient or index, >= 0.
    Unbounded,
}

/// A spectrum and its integral with y-bar by pbrt's rule (of a colour: that of the space's white).
#[derive(Clone, Debug)]
pub struct Light {
    /// The spectrum.
    pub curve: Curve,
    /// pbrt's normalisation: 1 over this makes the luminance 1.
    pub photometric: f64,
}

/// The spectrum parameter `name`, checked against its purpose; `None` if absent.
pub fn curve(
    ctx: &Context<'_>,
    params: &ParamSet,
    name: &str,
    purpose: Purpose,
) -> Result<Option<Curve>, Error> {
    Ok(light(ctx, params, name, purpose)?.map(|l| l.curve))
}

/// The same with its photometric integral.
pub fn light(
    ctx: &Context<'_>,
    params: &ParamSet,
    name: &str,
    purpose: Purpose,
) -> Result<Option<Light>, Error> {
    let Some(value) = params.spectrum(name)? else { return Ok(None) };
    one(ctx, params, name, &value, purpose).map(Some)
}

/// A float or spectrum parameter as a curve.
pub fn float_or_curve(
    ctx: &Context<'_>,
    params: &ParamSet,
    name: &str,
    purpose: Purpose,
) -> Result<Option<Curve>, Error> {
    if params.type_of(name) == Some(tyndall_pbrt::ParamType::Float) {
        return Ok(params.float_opt(name)?.map(Curve::Constant));
    }
    curve(ctx, params, name, purpose)
}

/// One spectrum value of parameter `name`.
pub fn one(
    ctx: &Context<'_>,
    params: &ParamSet,
    name: &str,
    value: &SpectrumValue,
    purpose: Purpose,
) -> Result<Light, Error> {
    let curve = match value {
        SpectrumValue::Rgb { rgb, color_space } => {
            return colour(params, name, *rgb, color_space.as_deref(), purpose);
        }
        SpectrumValue::Blackbody(kelvin) => Curve::blackbody(*kelvin as f32).map_err(|e| at(params, e))?,
        SpectrumValue::Samples { lambda, values } => tabulated(params, name, lambda, values, Outside::Zero)?,
        SpectrumValue::Named(text) => match named::named_spectrum(text.as_str()) {
            Some(curve) => curve,
            None => file(ctx, params, name, text)?,
        },
    };
    ctx.check_range(params, name, &curve)?;
    check_values(ctx, params, name, &curve, purpose)?;
    let photometric = cie::y_integral(&curve);
    // an even table where that is exact: its look-up costs half
    let curve = curve.bake(ctx.range).unwrap_or(curve);
    Ok(Light { curve, photometric })
}

fn colour(
    params: &ParamSet,
    name: &str,
    rgb: [f64; 3],
    space: Option<&str>,
    purpose: Purpose,
) -> Result<Light, Error> {
    let space = color_space::name(space.unwrap_or("srgb"));
    let limit = if purpose == Purpose::Albedo { 1.0 } else { f64::INFINITY };
    if let Some(bad) = rgb.iter().find(|v| !(0.0..=limit).contains(*v)) {
        let expected = if purpose == Purpose::Albedo { "must be between 0 and 1" } else { "must be >= 0" };
        return Err(refuse(params, name, expected, bad));
    }
    let narrow = rgb.map(|c| c as f32);
    let curve = match purpose {
        Purpose::Illuminant => upsample::illuminant(space, narrow),
        Purpose::Albedo => upsample::albedo(space, narrow),
        Purpose::Unbounded => upsample::unbounded(space, narrow),
    };
    let curve = curve.map_err(|e| at(params, e))?;
    Ok(Light { curve, photometric: cie::y_integral(&ColourSpace::get(space).illuminant) })
}

/// The rule outside a table.
pub fn outside(params: &ParamSet, default: Outside) -> Result<Outside, Error> {
    match params.string("extrapolate", "")?.as_str() {
        "" => Ok(default),
        "hold" => Ok(Outside::Hold),
        "zero" => Ok(Outside::Zero),
        other => Err(refuse(params, "extrapolate", "must be \"hold\" or \"zero\"", format!("\"{other}\""))),
    }
}

/// A table by the directive's `interpolation` and `extrapolate`; `default` rules outside it where that is absent.
pub fn tabulated(
    params: &ParamSet,
    name: &str,
    lambda: &[f64],
    values: &[f64],
    default: Outside,
) -> Result<Curve, Error> {
    let outside = outside(params, default)?;
    let narrow = |v: &[f64]| v.iter().map(|&x| x as f32).collect::<Vec<f32>>();
    let (lambda, values) = (narrow(lambda), narrow(values));
    let made = match params.string("interpolation", "linear")?.as_str() {
        "linear" => Curve::linear(&lambda, &values, outside),
        "step" => Curve::step(&lambda, &values[..values.len().saturating_sub(1)], outside),
        other => {
            let got = format!("\"{other}\"");
            return Err(refuse(params, "interpolation", "must be \"linear\" or \"step\"", got));
        }
    };
    made.map_err(|e| params.error(format!("{name}: {e}")))
}

/// pbrt's text files of spectra: pairs of wavelength and value, `#` comments.
fn file(ctx: &Context<'_>, params: &ParamSet, name: &str, text: &tyndall_pbrt::Text) -> Result<Curve, Error> {
    let path = ctx.file(params, name, text).map_err(|e| {
        e.hint("a string that names a spectrum is a built-in name such as \"metal-Cu-eta\", \"glass-BK7\", \"stdillum-D65\", or a file")
    })?;
    let shown = path.display();
    let io = |e: std::io::Error| params.error(format!("{name}: cannot read {shown}: {e}"));
    let content = std::fs::read_to_string(&path).map_err(io)?;
    let mut numbers = Vec::new();
    for (row, line) in content.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default();
        for word in line.split(|c: char| c.is_whitespace() || c == ',').filter(|w| !w.is_empty()) {
            let number = word.parse::<f64>().ok().filter(|v| v.is_finite());
            numbers.push(number.ok_or_else(|| {
                params.error(format!("{name}: {shown}:{}: expected a number, got \"{word}\"", row + 1))
            })?);
        }
    }
    if numbers.len() % 2 == 1 || numbers.is_empty() {
        let message =
            format!("{name}: {shown}: expected pairs of wavelength and value, got {} numbers", numbers.len());
        return Err(params.error(message));
    }
    let (lambda, values): (Vec<f64>, Vec<f64>) =
        numbers.as_chunks::<2>().0.iter().map(|p| (p[0], p[1])).unzip();
    tabulated(params, name, &lambda, &values, Outside::Zero)
}

fn check_values(
    ctx: &Context<'_>,
    params: &ParamSet,
    name: &str,
    curve: &Curve,
    purpose: Purpose,
) -> Result<(), Error> {
    let [low, high] = curve.bounds(ctx.range);
    if low < 0.0 || !low.is_finite() {
        return Err(refuse(params, name, "must be >= 0 at every wavelength", low));
    }
    // blackbodies are scaled to 1 at their peak, give or take a rounding
    if purpose == Purpose::Albedo && high > 1.0 + 1e-5 {
        let message = format!(
            "{name}: expected a reflectance <= 1, got {high}; clamped at each wavelength, as in pbrt"
        );
        if ctx.strict {
            return Err(params.error(message));
        }
        params.warn_at(name, message, ctx.warnings);
    }
    if !high.is_finite() {
        return Err(refuse(params, name, "must be finite", high));
    }
    Ok(())
}
