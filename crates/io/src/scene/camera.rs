//! `Camera`.

mod realistic;

use super::{
    build::{fractions, moving},
    collect::Declared,
    context::{Context, at, refuse},
    film,
    state::Moving,
};
use tyndall_pbrt::{Error, ParamSet};
use tyndall_transport::camera::{Camera, Orthographic, Perspective, Projective, Spherical, SphericalMapping};

const KNOWN: [&str; 16] = [
    "focusdistance",
    "mapping",
    "lensfile",
    "aperturediameter",
    "aperture",
    "scale",
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

/// The camera, and the shutter's opening and closing times; `times` are those of moving transformations.
pub fn camera(
    ctx: &Context<'_>,
    declared: &Declared,
    times: [f64; 2],
    film: &Declared,
) -> Result<(Camera, [f64; 2]), Error> {
    let p = &declared.params;
    let shutter = [p.float64("shutteropen", 0.0)?, p.float64("shutterclose", 1.0)?];
    if shutter[1] <= shutter[0] {
        return Err(refuse(p, "shutterclose", "must be after \"shutteropen\"", shutter[1]));
    }
    let resolution = film::resolution(&film.params)?;
    let class = declared.name.as_str();
    if class == "realistic" {
        for name in ["lensradius", "focaldistance", "screenwindow", "frameaspectratio", "fov"] {
            p.ignore(name, "the lens file and the film's size say it");
        }
        let placed = placed(declared, times, shutter, resolution)?;
        let camera = realistic::camera(ctx, p, placed, film.params.float64("diagonal", 35.0)?)?;
        ctx.finish(p, &KNOWN);
        return Ok((camera, shutter));
    }
    film.params.ignore("diagonal", "only a realistic camera has use for the film's size");
    let made = match class {
        "perspective" => {
            let fov = p.float("fov", 90.0)?;
            let fov = p.float_opt("halffov")?.map_or(fov, |half| 2.0 * half);
            let projective = projective(declared, times, shutter, resolution)?;
            Perspective::new(projective, fov).map(Camera::Perspective)
        }
        "orthographic" => {
            Orthographic::new(projective(declared, times, shutter, resolution)?).map(Camera::Orthographic)
        }
        "spherical" => {
            let mapping = mapping(p)?;
            for name in ["lensradius", "focaldistance", "screenwindow", "frameaspectratio", "fov"] {
                p.ignore(name, "a spherical camera sees all directions, all of them sharp");
            }
            Spherical::new(placed(declared, times, shutter, resolution)?, mapping).map(Camera::Spherical)
        }
        other => {
            let hint = "known are perspective, orthographic, spherical and realistic";
            return Err(p.error(format!("camera \"{other}\" is not supported")).hint(hint));
        }
    };
    let camera = made.map_err(|e| at(p, e))?;
    ctx.finish(p, &KNOWN);
    Ok((camera, shutter))
}

fn mapping(p: &ParamSet) -> Result<SphericalMapping, Error> {
    match p.string("mapping", "equalarea")?.as_str() {
        "equalarea" => Ok(SphericalMapping::EqualArea),
        "equirectangular" => Ok(SphericalMapping::Equirectangular),
        other => Err(refuse(p, "mapping", "must be equalarea or equirectangular", format!("\"{other}\""))),
    }
}

/// A camera without window or lens.
fn placed(
    declared: &Declared,
    times: [f64; 2],
    shutter: [f64; 2],
    resolution: [u32; 2],
) -> Result<Projective, Error> {
    let ctm = Moving { start: declared.ctm.start.inverse(), end: declared.ctm.end.inverse() };
    let motion = moving(&ctm, fractions(times, shutter)).map_err(|e| at(&declared.params, e))?;
    Ok(Projective {
        resolution,
        screen: Projective::default_screen(resolution, None),
        lens_radius: 0.0,
        focal_distance: 1e6,
        to_world: ctm.start,
        motion,
    })
}

fn projective(
    declared: &Declared,
    times: [f64; 2],
    shutter: [f64; 2],
    resolution: [u32; 2],
) -> Result<Projective, Error> {
    let p = &declared.params;
    let screen = match p.floats("screenwindow")? {
        Some(w) if w.len() == 4 => [w[0], w[1], w[2], w[3]],
        Some(w) => return Err(refuse(p, "screenwindow", "must be 4 numbers", w.len())),
        None => Projective::default_screen(resolution, p.float_opt("frameaspectratio")?),
    };
    Ok(Projective {
        screen,
        lens_radius: p.float("lensradius", 0.0)?,
        focal_distance: p.float("focaldistance", 1e6)?,
        ..placed(declared, times, shutter, resolution)?
    })
}
