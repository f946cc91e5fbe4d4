//! `Camera`.

use super::{
    collect::Declared,
    context::{Context, at, refuse},
};
use tyndall_pbrt::Error;
use tyndall_transport::camera::{Camera, Orthographic, Perspective, Projective};

const KNOWN: [&str; 10] = [
    "fov",
    "halffov",
    "screenwindow",
    "lensradius",
    "focaldistance",
    "frameaspectratio",
    "shutteropen",
    "shutterclose",
    "type",
    "filename",
];

/// The camera, and the shutter's opening and closing times.
pub fn camera(
    ctx: &Context<'_>,
    declared: &Declared,
    resolution: [u32; 2],
) -> Result<(Camera, [f64; 2]), Error> {
    let p = &declared.params;
    let shutter = [p.float64("shutteropen", 0.0)?, p.float64("shutterclose", 1.0)?];
    if shutter[1] <= shutter[0] {
        return Err(refuse(p, "shutterclose", "must be after \"shutteropen\"", shutter[1]));
    }
    if declared.ctm.moves() {
        ctx.warnings.warn(p.place(), "moving cameras are not supported in this version: the start counts");
    }
    let screen = match p.floats("screenwindow")? {
        Some(w) if w.len() == 4 => [w[0], w[1], w[2], w[3]],
        Some(w) => return Err(refuse(p, "screenwindow", "must be 4 numbers", w.len())),
        None => Projective::default_screen(resolution, p.float_opt("frameaspectratio")?),
    };
    let class = declared.name.as_str();
    let projective = Projective {
        resolution,
        screen,
        lens_radius: p.float("lensradius", 0.0)?,
        focal_distance: p.float("focaldistance", 1e6)?,
        to_world: declared.ctm.start.inverse(),
    };
    let camera = match class {
        "perspective" => {
            let fov = p.float("fov", 90.0)?;
            let fov = p.float_opt("halffov")?.map_or(fov, |half| 2.0 * half);
            Camera::Perspective(Perspective::new(projective, fov).map_err(|e| at(p, e))?)
        }
        "orthographic" => Camera::Orthographic(Orthographic::new(projective).map_err(|e| at(p, e))?),
        other => {
            let hint = "this version has perspective and orthographic";
            return Err(p.error(format!("camera \"{other}\" is not supported")).hint(hint));
        }
    };
    ctx.finish(p, &KNOWN);
    Ok((camera, shutter))
}
