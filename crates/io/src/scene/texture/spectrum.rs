//! `Texture ... "spectrum"`: spectra over a surface.

use super::{KNOWN, Textures, mapping::mapping, unknown, weight::octaves};
use crate::scene::{
    collect::TextureRecord,
    context::refuse,
    spectrum::{Purpose, curve},
};
use std::sync::Arc;
use tyndall_pbrt::Error;
use tyndall_spectral::Curve;
use tyndall_transport::texture::{FloatTexture, Marble, SpectrumTexture, Weight};

const CLASSES: &str = "constant, scale, mix, directionmix, bilerp, imagemap, checkerboard, dots and marble";

impl Textures<'_> {
    /// The texture of a directive, for `purpose`.
    pub(super) fn make_spectrum(
        &self,
        record: &TextureRecord,
        purpose: Purpose,
    ) -> Result<SpectrumTexture, Error> {
        let p = &record.declared.params;
        let tex = |name: &str, default: f32| {
            let default = SpectrumTexture::Constant(Curve::Constant(default));
            Ok::<_, Error>(self.spectrum(p, name, purpose)?.unwrap_or(default))
        };
        let made = match record.declared.name.as_str() {
            "constant" => tex("value", 1.0)?,
            "scale" => {
                let factor = self.float(p, "scale")?.unwrap_or(FloatTexture::Constant(1.0));
                SpectrumTexture::Scale(Arc::new((tex("tex", 1.0)?, factor)))
            }
            "imagemap" => SpectrumTexture::Image(self.image(record, purpose)?),
            "bilerp" => self.spectrum_bilerp(record, purpose)?,
            "marble" => SpectrumTexture::Marble(Arc::new(marble(record)?)),
            other => match self.blend(record)? {
                Some(b) => {
                    let [first, second] = [0, 1].map(|k| tex(b.names[k], b.defaults[k]));
                    SpectrumTexture::Mix(Arc::new((first?, second?, b.weight)))
                }
                None => return Err(unknown(p, other, "spectrum", CLASSES)),
            },
        };
        self.ctx.finish(p, &KNOWN);
        Ok(made)
    }

    fn spectrum_bilerp(&self, record: &TextureRecord, purpose: Purpose) -> Result<SpectrumTexture, Error> {
        let p = &record.declared.params;
        let map = mapping(p, &record.declared.ctm.start)?;
        let corner = |name, default| {
            let given = curve(&self.ctx, p, name, purpose)?;
            Ok::<_, Error>(SpectrumTexture::Constant(given.unwrap_or(Curve::Constant(default))))
        };
        let mix = |a, b, axis| SpectrumTexture::Mix(Arc::new((a, b, Weight::Coordinate(map.clone(), axis))));
        let low = mix(corner("v00", 0.0)?, corner("v10", 0.0)?, 0);
        let high = mix(corner("v01", 1.0)?, corner("v11", 1.0)?, 0);
        Ok(mix(low, high, 1))
    }
}

fn marble(record: &TextureRecord) -> Result<Marble, Error> {
    let p = &record.declared.params;
    let (octaves, omega) = octaves(p)?;
    let scale = p.float("scale", 1.0)?;
    if !scale.is_finite() {
        return Err(refuse(p, "scale", "must be finite", scale));
    }
    let to_texture = record.declared.ctm.start.inverse();
    Ok(Marble { to_texture, octaves, omega, scale, variation: p.float("variation", 0.2)? })
}
