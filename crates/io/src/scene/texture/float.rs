//! `Texture ... "float"`: numbers over a surface.

use super::{KNOWN, Textures, mapping::mapping, unknown, weight::octaves};
use crate::scene::{collect::TextureRecord, spectrum::Purpose};
use std::sync::Arc;
use tyndall_pbrt::Error;
use tyndall_transport::texture::{FloatTexture, NoiseKind, NoiseTexture, Weight};

const CLASSES: &str =
    "constant, scale, mix, directionmix, bilerp, imagemap, checkerboard, dots, fbm, wrinkled and windy";

impl Textures<'_> {
    /// The texture of a directive.
    pub(super) fn make_float(&self, record: &TextureRecord) -> Result<FloatTexture, Error> {
        let p = &record.declared.params;
        let tex = |name: &str, default: f32| {
            Ok::<_, Error>(self.float(p, name)?.unwrap_or(FloatTexture::Constant(default)))
        };
        let noise = |kind| {
            let to_texture = record.declared.ctm.start.inverse();
            FloatTexture::Noise(Arc::new(NoiseTexture { to_texture, kind }))
        };
        let made = match record.declared.name.as_str() {
            "constant" => FloatTexture::Constant(p.float("value", 1.0)?),
            "scale" => FloatTexture::Scale(Arc::new((tex("tex", 1.0)?, tex("scale", 1.0)?))),
            "imagemap" => FloatTexture::Image(self.image(record, Purpose::Unbounded)?),
            "bilerp" => self.bilerp(record)?,
            "fbm" => {
                let (octaves, omega) = octaves(p)?;
                noise(NoiseKind::Fbm { omega, octaves })
            }
            "wrinkled" => {
                let (octaves, omega) = octaves(p)?;
                noise(NoiseKind::Wrinkled { omega, octaves })
            }
            "windy" => noise(NoiseKind::Windy),
            other => match self.blend(record)? {
                Some(b) => {
                    let [first, second] = [0, 1].map(|k| tex(b.names[k], b.defaults[k]));
                    FloatTexture::Mix(Arc::new((first?, second?, b.weight)))
                }
                None => return Err(unknown(p, other, "float", CLASSES)),
            },
        };
        self.ctx.finish(p, &KNOWN);
        Ok(made)
    }

    /// Bilinear between four corners: two mixes along s, mixed along t.
    fn bilerp(&self, record: &TextureRecord) -> Result<FloatTexture, Error> {
        let p = &record.declared.params;
        let map = mapping(p, &record.declared.ctm.start)?;
        let corner = |name, default| Ok::<_, Error>(FloatTexture::Constant(p.float(name, default)?));
        let mix = |a, b, axis| FloatTexture::Mix(Arc::new((a, b, Weight::Coordinate(map.clone(), axis))));
        let low = mix(corner("v00", 0.0)?, corner("v10", 0.0)?, 0);
        let high = mix(corner("v01", 1.0)?, corner("v11", 1.0)?, 0);
        Ok(mix(low, high, 1))
    }
}
