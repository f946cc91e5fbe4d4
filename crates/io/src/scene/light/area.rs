//! `AreaLightSource "diffuse"`: what an emitting shape emits.

use super::{KNOWN, image, powered};
use crate::scene::{
    context::Context,
    emission::{self, Units},
    state::AreaLight as AreaRecord,
};
use tyndall_pbrt::Error;
use tyndall_spectral::Emission;
use tyndall_transport::texture::ImageMap;

/// What the shapes of one directive emit.
pub struct AreaEmission {
    /// Radiance, or its mean over the image.
    pub emission: Emission,
    /// Both sides emit.
    pub two_sided: bool,
    /// Radiance over the shape's texture coordinates.
    pub image: Option<ImageMap>,
}

/// The emission of an area light of `area` square metres in all.
pub fn area(
    ctx: &Context<'_>,
    record: &AreaRecord,
    space: &str,
    area: f64,
    units: &mut Units,
) -> Result<AreaEmission, Error> {
    let p = &record.params;
    if record.class.as_str() != "diffuse" {
        let message = format!("area light \"{}\" is not known", record.class.as_str());
        return Err(p.error(message).hint("pbrt-v4's only area light is \"diffuse\""));
    }
    let two_sided = p.bool("twosided", false)?;
    let per_unit = area * std::f64::consts::PI * if two_sided { 2.0 } else { 1.0 };
    let made = if p.contains("filename") {
        if p.contains("L") {
            return Err(p.error("area light: expected \"L\" or \"filename\", got both"));
        }
        let lit = image::emission_image(ctx, p, space, units)?;
        let factor = image::factor(p, "power", lit.luminance * per_unit)?;
        let image = Some(lit.scaled(factor));
        AreaEmission { emission: lit.mean.scaled(factor as f32), two_sided, image }
    } else {
        let emission = emission::of_light(ctx, p, "L", space, units)?;
        AreaEmission { emission: powered(p, "power", emission, per_unit)?, two_sided, image: None }
    };
    ctx.finish(p, &KNOWN);
    Ok(made)
}
