//! `realistic`: the lens file, its focus and the shape of its stop.

use crate::scene::context::{Context, at, refuse};
use tyndall_files::{
    image::read_image,
    lens::{LensRow, read_lens},
};
use tyndall_pbrt::{Error, ParamSet};
use tyndall_transport::{
    camera::{Aperture, Camera, Element, Lens, Projective, Realistic},
    texture::Texels,
};

const MILLIMETRE: f64 = 1e-3;

/// The camera of `p`; `diagonal` is the film's \[mm\].
pub(super) fn camera(
    ctx: &Context<'_>,
    p: &ParamSet,
    projective: Projective,
    diagonal: f64,
) -> Result<Camera, Error> {
    let text = p.string_opt("lensfile")?.ok_or_else(|| p.missing("string", "lensfile"))?;
    let path = ctx.file(p, "lensfile", text)?;
    let rows = read_lens(&path).map_err(|e| at(p, e))?;
    let stop = p.float64("aperturediameter", 1.0)?;
    if stop <= 0.0 {
        return Err(refuse(p, "aperturediameter", "must be > 0 mm", stop));
    }
    let elements = rows.iter().map(|row| element(ctx, p, row, stop)).collect();
    let aperture = aperture(ctx, p)?;
    if !rows.iter().any(|row| row.radius == 0.0) {
        let why = "the lens has no stop (a row whose radius of curvature is 0)";
        p.ignore("aperturediameter", why);
        if !matches!(aperture, Aperture::Disk) {
            p.ignore("aperture", why);
        }
    }
    let lens = Lens::focused(elements, p.float64("focusdistance", 10.0)?).map_err(|e| at(p, e))?;
    let made = Realistic::new(projective, lens, aperture, diagonal * MILLIMETRE);
    made.map(|c| Camera::Realistic(Box::new(c))).map_err(|e| at(p, e))
}

fn element(ctx: &Context<'_>, p: &ParamSet, row: &LensRow, stop: f64) -> Element {
    let mut diameter = row.diameter;
    if row.radius == 0.0 {
        if stop > diameter {
            let message = format!(
                "aperturediameter: {stop} mm is more than the lens has, {diameter} mm, which is taken"
            );
            p.warn_at("aperturediameter", message, ctx.warnings);
        }
        diameter = diameter.min(stop);
    }
    Element {
        radius: row.radius * MILLIMETRE,
        thickness: row.thickness * MILLIMETRE,
        eta: row.eta,
        aperture: 0.5 * diameter * MILLIMETRE,
    }
}

/// A shape of pbrt's, or an image.
fn aperture(ctx: &Context<'_>, p: &ParamSet) -> Result<Aperture, Error> {
    let Some(text) = p.string_opt("aperture")? else { return Ok(Aperture::Disk) };
    match text.as_str() {
        "" => Ok(Aperture::Disk),
        "gaussian" => Ok(Aperture::Gaussian),
        "square" => Ok(Aperture::square()),
        "pentagon" => Ok(Aperture::pentagon()),
        "star" => Ok(Aperture::star()),
        _ => {
            let hint =
                "known shapes are gaussian, square, pentagon and star; anything else is the name of an image";
            let path = ctx.file(p, "aperture", text).map_err(|e| e.hint(hint))?;
            let pixels = read_image(&path).map_err(|e| at(p, e))?;
            let texels = crate::scene::image::texels(&pixels).map_err(|e| at(p, e))?;
            let mean = |c: &[f32]| c.iter().map(|v| v.max(0.0)).sum::<f32>() / c.len() as f32;
            let data = texels.data.chunks_exact(texels.channels).map(mean).collect();
            let texels = Texels { channels: 1, data, ..texels };
            Aperture::image(texels)
                .ok_or_else(|| refuse(p, "aperture", "must let some light through", "a black image"))
        }
    }
}
