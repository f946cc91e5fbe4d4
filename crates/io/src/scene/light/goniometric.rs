//! `goniometric`, with an image as in pbrt or an IES file of a luminaire.

use super::powered;
use crate::scene::{
    collect::LightRecord,
    context::{Context, at, refuse},
    emission::{self, Units},
};
use std::path::Path;
use tyndall_base::Vec3;
use tyndall_files::{image::read_image, photometry::read_ies};
use tyndall_pbrt::{Error, ParamSet};
use tyndall_transport::{
    light::{GoniometricLight, Light, PhotometricWeb, Profile},
    texture::Texels,
};

/// A point with a profile.
pub(super) fn light(ctx: &Context<'_>, record: &LightRecord, units: &mut Units) -> Result<Light, Error> {
    let declared = &record.declared;
    let p = &declared.params;
    let text = p.string_opt("filename")?.ok_or_else(|| p.missing("string", "filename"))?;
    let path = ctx.file(p, "filename", text)?;
    let measured = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("ies"));
    let profile = if measured { web(p, &path)? } else { image(p, &path)? };
    let sum = profile.integral();
    if sum <= 0.0 {
        return Err(refuse(p, "filename", "must hold some intensity > 0", "none"));
    }
    let intensity = emission::of_light(ctx, p, "I", &declared.color_space, units)?;
    let intensity = powered(p, "power", intensity, sum)?;
    let to_world = &declared.ctm.start;
    let light =
        GoniometricLight { p: to_world.point(Vec3::ZERO), intensity, to_light: to_world.inverse(), profile };
    Ok(Light::Goniometric(Box::new(light)))
}

/// One channel: the mean of R, G and B, or the only one.
fn image(p: &ParamSet, path: &Path) -> Result<Profile, Error> {
    let pixels = read_image(path).map_err(|e| at(p, e))?;
    let texels = crate::scene::image::texels(&pixels).map_err(|e| at(p, e))?;
    if texels.width != texels.height {
        let got = format!("{} x {}", texels.width, texels.height);
        let hint = "the directions of a goniometric light are an equal-area octahedral map";
        return Err(refuse(p, "filename", "must be a square image", got).hint(hint));
    }
    let mean = |c: &[f32]| c.iter().map(|v| v.max(0.0)).sum::<f32>() / c.len() as f32;
    let data = texels.data.chunks_exact(texels.channels).map(mean).collect();
    Ok(Profile::Image(Texels { channels: 1, data, ..texels }))
}

/// Candelas of an IES file; in absolute units relative to the greatest, since `I` then has the unit.
fn web(p: &ParamSet, path: &Path) -> Result<Profile, Error> {
    let ies = read_ies(path).map_err(|e| at(p, e))?;
    let radians = |v: &[f32]| v.iter().map(|d| d * (std::f32::consts::PI / 180.0)).collect();
    let greatest = ies.candela.iter().copied().fold(0.0, f32::max);
    let unit = if p.bool("absolute", false)? && greatest > 0.0 { 1.0 / greatest } else { 1.0 };
    let values = ies.candela.iter().map(|c| c * unit).collect();
    Ok(Profile::Web(PhotometricWeb {
        polar: radians(&ies.vertical),
        azimuth: radians(&ies.horizontal),
        values,
    }))
}
