//! `projection`.

use super::image;
use crate::scene::{
    collect::LightRecord,
    context::{Context, at},
    emission::Units,
};
use tyndall_pbrt::Error;
use tyndall_transport::{
    light::{Light, ProjectionLight},
    texture::Lookup,
};

/// A slide projector.
pub(super) fn light(ctx: &Context<'_>, record: &LightRecord, units: &mut Units) -> Result<Light, Error> {
    let declared = &record.declared;
    let p = &declared.params;
    if p.contains("I") {
        p.ignore("I", "the image has the colours");
        p.warn_at(
            "I",
            "I: ignored, as in pbrt: the image of a projection light has its colours",
            ctx.warnings,
        );
    }
    let lit = image::emission_image(ctx, p, &declared.color_space, units)?;
    let fov = p.float("fov", 90.0)?;
    let make = |factor: f64| {
        let mut map = lit.scaled(factor);
        map.lookup = Lookup::Point;
        ProjectionLight::new(&declared.ctm.start, map, lit.mean.scaled(factor as f32), fov)
            .map_err(|e| at(p, e))
    };
    let light = make(1.0)?;
    let factor = image::factor(p, "power", power(&lit, light.half()) * p.float64("scale", 1.0)?)?;
    Ok(Light::Projection(Box::new(make(factor)?)))
}

/// Luminous power for a unit of the light's scale: texels by the solid angle they are thrown into.
fn power(lit: &image::EmissionImage, [a, b]: [f32; 2]) -> f64 {
    let (w, h) = (lit.texels().width, lit.texels().height);
    let (a, b) = (f64::from(a), f64::from(b));
    let mut sum = 0.0;
    for y in 0..h {
        for x in 0..w {
            let px = a * (2.0 * (x as f64 + 0.5) / w as f64 - 1.0);
            let py = b * (2.0 * (y as f64 + 0.5) / h as f64 - 1.0);
            let r2 = 1.0 + px * px + py * py;
            sum += lit.luminance_of(x, y) / (r2 * r2.sqrt());
        }
    }
    sum * 4.0 * a * b / (w * h) as f64
}
