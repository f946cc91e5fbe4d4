//! `subsurface`: a dielectric boundary filled with a scattering medium, in which light is followed as anywhere else.
//!
//! The medium is given by name (in 1/mm, as all of pbrt's presets), by `sigma_a` and `sigma_s`, or by the colour
//! `reflectance` that a thick body has under diffuse light and the mean free path `mfp` ([`albedo_of`]). Any of these but the
//! name may be a texture of the boundary: then the medium is [`Painted`].

use super::parts::eta;
use crate::scene::{
    context::{Context, at, refuse},
    spectrum::{Purpose, float_or_curve},
    texture::Textures,
};
use tyndall_pbrt::{Error, ParamSet, ParamType};
use tyndall_scatter::phase::{HenyeyGreenstein, PhaseFunction};
use tyndall_spectral::{Curve, Outside, SpaceName, media_presets, upsample};
use tyndall_transport::{
    media::{Homogeneous, Medium, Paint, Painted, albedo_of},
    texture::SpectrumTexture,
};

/// Step of the tables that an inversion makes \[nm\].
const STEP: f32 = 5.0;

/// Parameters that may be textures.
const PAINTS: [&str; 4] = ["sigma_a", "sigma_s", "reflectance", "mfp"];

/// The medium inside.
pub(super) fn medium(ctx: &Context<'_>, p: &ParamSet, textures: &Textures<'_>) -> Result<Medium, Error> {
    let g = p.float("g", 0.0)?;
    if !(g > -1.0 && g < 1.0) {
        return Err(refuse(p, "g", "must be between -1 and 1", g));
    }
    let scale = p.float("scale", 1.0)?;
    if !(scale >= 0.0 && scale.is_finite()) {
        return Err(refuse(p, "scale", "must be finite and >= 0", scale));
    }
    if PAINTS.iter().any(|name| p.type_of(name) == Some(ParamType::Texture)) {
        let paint = paint(ctx, p, textures)?;
        let made = Painted::new(paint, scale, g).map_err(|e| at(p, e))?;
        return Ok(Medium::Painted(Box::new(made)));
    }
    let ([sigma_a, sigma_s], g) = coefficients(ctx, p, g, scale)?;
    let phase = HenyeyGreenstein::new(Curve::Constant(g)).map_err(|e| at(p, e))?;
    let made = Homogeneous::new(sigma_a, sigma_s, None, PhaseFunction::HenyeyGreenstein(phase), ctx.range);
    made.map(Medium::Homogeneous).map_err(|e| at(p, e))
}

/// What textures say, some of which may be constant.
fn paint(ctx: &Context<'_>, p: &ParamSet, textures: &Textures<'_>) -> Result<Paint, Error> {
    if !p.string("name", "")?.is_empty() {
        return Err(p.error("both \"name\" and a texture of coefficients are given"));
    }
    let one = |name: &str, purpose| match p.type_of(name) {
        Some(ParamType::Texture) => textures.spectrum(p, name, purpose),
        _ => Ok(float_or_curve(ctx, p, name, purpose)?.map(SpectrumTexture::Constant)),
    };
    match (one("sigma_a", Purpose::Unbounded)?, one("sigma_s", Purpose::Unbounded)?) {
        (Some(sigma_a), Some(sigma_s)) => return Ok(Paint::Coefficients { sigma_a, sigma_s }),
        (Some(_), None) => return Err(p.missing("spectrum", "sigma_s")),
        (None, Some(_)) => return Err(p.missing("spectrum", "sigma_a")),
        (None, None) => {}
    }
    let Some(reflectance) = one("reflectance", Purpose::Albedo)? else {
        return Err(p.missing("spectrum", "reflectance"));
    };
    let mfp = one("mfp", Purpose::Unbounded)?.unwrap_or(SpectrumTexture::Constant(Curve::ONE));
    Ok(Paint::Colour { reflectance, mfp, eta: eta(ctx, p, "eta", 1.33)? })
}

/// sigma_a, sigma_s and g of a body that is the same everywhere.
fn coefficients(ctx: &Context<'_>, p: &ParamSet, g: f32, scale: f32) -> Result<([Curve; 2], f32), Error> {
    let rgb = |rgb| upsample::unbounded(SpaceName::Srgb, rgb).map_err(|e| at(p, e));
    let name = p.string("name", "")?;
    if !name.is_empty() {
        let Some(preset) = media_presets::medium_preset(&name) else {
            let names: Vec<_> = media_presets::names().collect();
            let hint = tyndall_pbrt::did_you_mean(&name, names.iter().copied())
                .unwrap_or_else(|| format!("known are {}", names.join(", ")));
            return Err(refuse(p, "name", "must be a known medium", format!("\"{name}\"")).hint(hint));
        };
        if g != 0.0 {
            p.warn_at("g", "g: ignored, the named coefficients are reduced ones", ctx.warnings);
        }
        let both = [rgb(preset.sigma_a)?, rgb(preset.sigma_prime_s)?];
        return Ok((both.map(|c| c.scaled(scale)), 0.0));
    }
    let one = |name| float_or_curve(ctx, p, name, Purpose::Unbounded);
    match (one("sigma_a")?, one("sigma_s")?) {
        (Some(a), Some(s)) => Ok(([a, s].map(|c| c.scaled(scale)), g)),
        (Some(_), None) => Err(p.missing("spectrum", "sigma_s")),
        (None, Some(_)) => Err(p.missing("spectrum", "sigma_a")),
        (None, None) => match float_or_curve(ctx, p, "reflectance", Purpose::Albedo)? {
            Some(reflectance) => Ok((inverted(ctx, p, &reflectance, g, scale)?, g)),
            None => {
                let both = [rgb([0.0011, 0.0024, 0.014])?, rgb([2.55, 3.21, 3.77])?];
                Ok((both.map(|c| c.scaled(scale)), g))
            }
        },
    }
}

/// Coefficients of a body of this colour; as in pbrt-v4 `scale` is a factor of the mean free path.
fn inverted(
    ctx: &Context<'_>,
    p: &ParamSet,
    reflectance: &Curve,
    g: f32,
    scale: f32,
) -> Result<[Curve; 2], Error> {
    let mfp = float_or_curve(ctx, p, "mfp", Purpose::Unbounded)?.unwrap_or(Curve::ONE);
    let eta = float_or_curve(ctx, p, "eta", Purpose::Unbounded)?.unwrap_or(Curve::Constant(1.33));
    let count = (ctx.range.width() / STEP).ceil().max(1.0) as usize;
    let lambda: Vec<f32> =
        (0..=count).map(|i| ctx.range.min + ctx.range.width() * (i as f32 / count as f32)).collect();
    let (mut absorbed, mut scattered) = (Vec::new(), Vec::new());
    for &l in &lambda {
        let length = scale * mfp.eval(l);
        if !(length > 0.0 && length.is_finite()) {
            return Err(refuse(
                p,
                "mfp",
                "times the scale must be > 0 at every wavelength of the film",
                length,
            ));
        }
        let albedo = albedo_of(f64::from(reflectance.eval(l)), f64::from(eta.eval(l)), f64::from(g)) as f32;
        absorbed.push((1.0 - albedo) / length);
        scattered.push(albedo / length);
    }
    let table = |values: &[f32]| Curve::linear(&lambda, values, Outside::Hold).map_err(|e| at(p, e));
    Ok([table(&absorbed)?, table(&scattered)?])
}
