//! `subsurface`: a dielectric boundary filled with a scattering medium, in which light is followed as anywhere else.
//!
//! The medium is given by name (in 1/mm, as all of pbrt's presets), by `sigma_a` and `sigma_s`, or by the colour
//! `reflectance` that a thick body has under diffuse light and the mean free path `mfp`. The latter is inverted by closed
//! forms: behind the boundary the body returns `R0 = R / (1 - F + F R)` of diffuse light, `F` being the boundary's
//! internal reflectance (Saunderson 1942; F after Egan & Hilgeman 1973), and a half-space does that with
//! `s = sqrt((1 - w)/(1 - g w))` where `R0 = (1 - s)(1 - 0.139 s)/(1 + 1.17 s)` (van de Hulst 1980), `w` its albedo.

use crate::scene::{
    context::{Context, at, refuse},
    spectrum::{Purpose, float_or_curve},
};
use tyndall_pbrt::{Error, ParamSet};
use tyndall_scatter::phase::{HenyeyGreenstein, PhaseFunction};
use tyndall_spectral::{Curve, Outside, SpaceName, media_presets, upsample};
use tyndall_transport::media::{Homogeneous, Medium};

/// Step of the tables that an inversion makes \[nm\].
const STEP: f32 = 5.0;

/// The medium inside.
pub(super) fn medium(ctx: &Context<'_>, p: &ParamSet) -> Result<Medium, Error> {
    let g = p.float("g", 0.0)?;
    if !(g > -1.0 && g < 1.0) {
        return Err(refuse(p, "g", "must be between -1 and 1", g));
    }
    let scale = p.float("scale", 1.0)?;
    if !(scale >= 0.0 && scale.is_finite()) {
        return Err(refuse(p, "scale", "must be finite and >= 0", scale));
    }
    let (coefficients, g) = coefficients(ctx, p, g)?;
    let [sigma_a, sigma_s] = coefficients.map(|c| c.scaled(scale));
    let phase = HenyeyGreenstein::new(Curve::Constant(g)).map_err(|e| at(p, e))?;
    let made = Homogeneous::new(sigma_a, sigma_s, None, PhaseFunction::HenyeyGreenstein(phase), ctx.range);
    made.map(Medium::Homogeneous).map_err(|e| at(p, e))
}

/// sigma_a, sigma_s and g.
fn coefficients(ctx: &Context<'_>, p: &ParamSet, g: f32) -> Result<([Curve; 2], f32), Error> {
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
        return Ok(([rgb(preset.sigma_a)?, rgb(preset.sigma_prime_s)?], 0.0));
    }
    let one = |name| float_or_curve(ctx, p, name, Purpose::Unbounded);
    match (one("sigma_a")?, one("sigma_s")?) {
        (Some(a), Some(s)) => Ok(([a, s], g)),
        (Some(_), None) => Err(p.missing("spectrum", "sigma_s")),
        (None, Some(_)) => Err(p.missing("spectrum", "sigma_a")),
        (None, None) => match float_or_curve(ctx, p, "reflectance", Purpose::Albedo)? {
            Some(reflectance) => Ok((inverted(ctx, p, &reflectance, g)?, g)),
            None => Ok(([rgb([0.0011, 0.0024, 0.014])?, rgb([2.55, 3.21, 3.77])?], g)),
        },
    }
}

/// Coefficients of a body of this colour.
fn inverted(ctx: &Context<'_>, p: &ParamSet, reflectance: &Curve, g: f32) -> Result<[Curve; 2], Error> {
    let mfp = float_or_curve(ctx, p, "mfp", Purpose::Unbounded)?.unwrap_or(Curve::ONE);
    let eta = float_or_curve(ctx, p, "eta", Purpose::Unbounded)?.unwrap_or(Curve::Constant(1.33));
    let count = (ctx.range.width() / STEP).ceil().max(1.0) as usize;
    let lambda: Vec<f32> =
        (0..=count).map(|i| ctx.range.min + ctx.range.width() * (i as f32 / count as f32)).collect();
    let (mut absorbed, mut scattered) = (Vec::new(), Vec::new());
    for &l in &lambda {
        let length = mfp.eval(l);
        if !(length > 0.0 && length.is_finite()) {
            return Err(refuse(p, "mfp", "must be > 0 at every wavelength of the film", length));
        }
        let albedo = albedo_of(f64::from(reflectance.eval(l)), f64::from(eta.eval(l)), f64::from(g)) as f32;
        absorbed.push((1.0 - albedo) / length);
        scattered.push(albedo / length);
    }
    let table = |values: &[f32]| Curve::linear(&lambda, values, Outside::Hold).map_err(|e| at(p, e));
    Ok([table(&absorbed)?, table(&scattered)?])
}

/// The albedo of a half-space behind a boundary of index `eta` that reflects `r` of diffuse light.
fn albedo_of(r: f64, eta: f64, g: f64) -> f64 {
    let internal = if eta > 1.0 { -1.4399 / (eta * eta) + 0.7099 / eta + 0.6681 + 0.0636 * eta } else { 0.0 };
    let r0 = r.clamp(0.0, 1.0) / (1.0 - internal + internal * r);
    // 0.139 s^2 - (1.139 + 1.17 R0) s + 1 - R0 = 0, the root below 1
    let b = 1.139 + 1.17 * r0;
    let s = 2.0 * (1.0 - r0) / (b + (b * b - 4.0 * 0.139 * (1.0 - r0)).sqrt());
    (1.0 - s * s) / (1.0 - g * s * s)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// There and back through the closed forms, and against H-functions: a half-space of isotropic scatterers with
    /// albedo 0.9 has the spherical albedo 0.4777 (Chandrasekhar 1950; van de Hulst 1980, table 12).
    #[test]
    fn colours_are_inverted() {
        for (r, g) in [(0.0, 0.0), (0.3, 0.5), (0.8, -0.4), (1.0, 0.7)] {
            let w = albedo_of(r, 1.0, g);
            let s = ((1.0 - w) / (1.0 - g * w)).sqrt();
            let back = (1.0 - s) * (1.0 - 0.139 * s) / (1.0 + 1.17 * s);
            assert!((back - r).abs() < 1e-9 && (0.0..=1.0).contains(&w), "{r} {g}: {w} {back}");
        }
        assert!((albedo_of(0.4777, 1.0, 0.0) - 0.9).abs() < 2e-3, "{}", albedo_of(0.4777, 1.0, 0.0));
        // behind a boundary a darker skin needs a whiter body
        assert!(albedo_of(0.5, 1.4, 0.0) > albedo_of(0.5, 1.0, 0.0));
    }
}
