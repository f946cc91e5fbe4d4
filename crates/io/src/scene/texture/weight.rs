//! Classes that mix two textures: `mix`, `checkerboard`, `dots`, `directionmix`, for numbers and spectra alike.

use super::{Textures, mapping::mapping};
use crate::scene::{collect::TextureRecord, context::refuse};
use tyndall_pbrt::{Error, ParamSet};
use tyndall_transport::texture::{FloatTexture, Weight};

/// Names of the two textures, their defaults, and the share of the second.
pub(super) struct Blend {
    pub names: [&'static str; 2],
    pub defaults: [f32; 2],
    pub weight: Weight,
}

impl Textures<'_> {
    /// `None` for classes that mix nothing.
    pub(super) fn blend(&self, record: &TextureRecord) -> Result<Option<Blend>, Error> {
        let p = &record.declared.params;
        let to_world = &record.declared.ctm.start;
        let blend = |names, defaults, weight| Some(Blend { names, defaults, weight });
        Ok(match record.declared.name.as_str() {
            "mix" => {
                let amount = self.float(p, "amount")?.unwrap_or(FloatTexture::Constant(0.5));
                blend(["tex1", "tex2"], [0.0, 1.0], Weight::Amount(amount))
            }
            "checkerboard" => {
                let weight = match p.integer("dimension", 2)? {
                    2 => Weight::Squares(mapping(p, to_world)?),
                    3 => Weight::Cubes(Box::new(to_world.inverse())),
                    other => return Err(refuse(p, "dimension", "must be 2 or 3", other)),
                };
                blend(["tex1", "tex2"], [1.0, 0.0], weight)
            }
            "dots" => blend(["outside", "inside"], [0.0, 1.0], Weight::Dots(mapping(p, to_world)?)),
            "directionmix" => {
                let given = p.vector3_opt("dir")?.unwrap_or([0.0, 1.0, 0.0]).map(|x| x as f32);
                let dir = to_world.vector(given.into());
                if dir.length_squared() == 0.0 {
                    return Err(refuse(p, "dir", "must not be zero", "0 0 0"));
                }
                blend(["tex2", "tex1"], [1.0, 0.0], Weight::Direction(dir.normalize()))
            }
            _ => None,
        })
    }
}

/// Most octaves of noise: beyond them a frequency is past any float's digits.
const MOST_OCTAVES: i32 = 64;

/// `octaves` and `roughness` of a texture made of noise.
pub(super) fn octaves(p: &ParamSet) -> Result<(u32, f32), Error> {
    let count = p.integer("octaves", 8)?;
    if !(0..=MOST_OCTAVES).contains(&count) {
        return Err(refuse(p, "octaves", "must be between 0 and 64", count));
    }
    Ok((count as u32, p.float("roughness", 0.5)?))
}
