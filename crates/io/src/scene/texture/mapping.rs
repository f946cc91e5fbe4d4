//! `mapping` and its parameters.

use crate::scene::context::refuse;
use tyndall_geometry::Transform;
use tyndall_pbrt::{Error, ParamSet};
use tyndall_transport::texture::Mapping;

/// From a surface point to texture coordinates.
pub(super) fn mapping(p: &ParamSet, to_world: &Transform) -> Result<Mapping, Error> {
    let to_texture = Box::new(to_world.inverse());
    Ok(match p.string("mapping", "uv")?.as_str() {
        "uv" => Mapping::Uv {
            scale: [p.float("uscale", 1.0)?, p.float("vscale", 1.0)?],
            delta: [p.float("udelta", 0.0)?, p.float("vdelta", 0.0)?],
        },
        "spherical" => Mapping::Spherical(to_texture),
        "cylindrical" => Mapping::Cylindrical(to_texture),
        "planar" => {
            let v = |name, default| {
                let v = p.vector3_opt(name)?.unwrap_or(default);
                Ok::<_, Error>(v.map(|x: f64| x as f32).into())
            };
            Mapping::Planar {
                to_texture,
                v: [v("v1", [1.0, 0.0, 0.0])?, v("v2", [0.0, 1.0, 0.0])?],
                delta: [p.float("udelta", 0.0)?, p.float("vdelta", 0.0)?],
            }
        }
        other => {
            let expected = "must be uv, spherical, cylindrical or planar";
            return Err(refuse(p, "mapping", expected, format!("\"{other}\"")));
        }
    })
}
