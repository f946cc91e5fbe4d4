//! `LightSource` and `AreaLightSource`.

mod area;
mod goniometric;
mod image;
mod infinite;
mod projection;
mod volume;

pub use area::area;
pub use volume::volumes;

use super::{
    collect::{Collected, LightRecord},
    context::{Context, at, refuse},
    emission::{self, Units},
};
use tyndall_base::Vec3;
use tyndall_pbrt::{Error, ParamSet};
use tyndall_spectral::Emission;
use tyndall_transport::light::{DistantLight, Light, PointLight, SpotLight};

const KNOWN: [&str; 19] = [
    "L",
    "I",
    "scale",
    "power",
    "illuminance",
    "from",
    "to",
    "coneangle",
    "conedeltaangle",
    "filename",
    "portal",
    "twosided",
    "absolute",
    "lines",
    "extrapolate",
    "interpolation",
    "fov",
    "mapname",
    "spectrum",
];

/// All light sources but emitting shapes.
pub fn lights(ctx: &Context<'_>, collected: &Collected, units: &mut Units) -> Result<Vec<Light>, Error> {
    collected.lights.iter().map(|record| light(ctx, record, units)).collect()
}

fn light(ctx: &Context<'_>, record: &LightRecord, units: &mut Units) -> Result<Light, Error> {
    let declared = &record.declared;
    let (p, space) = (&declared.params, &*declared.color_space);
    let to_world = &declared.ctm.start;
    if declared.ctm.moves() {
        ctx.warnings.warn(p.place(), "lights do not move: the transformation at the shutter's start counts");
    }
    let point = |name, default: [f32; 3]| {
        let v = p.point3_opt(name)?.map_or(default, |v| v.map(|x| x as f32));
        Ok::<_, Error>(to_world.point(v.into()))
    };
    let light = match declared.name.as_str() {
        "point" => {
            let intensity = emission::of_light(ctx, p, "I", space, units)?;
            let intensity = powered(p, "power", intensity, 4.0 * std::f64::consts::PI)?;
            Light::Point(PointLight { p: point("from", [0.0; 3])?, intensity })
        }
        "spot" => spot(ctx, p, space, units, [point("from", [0.0; 3])?, point("to", [0.0, 0.0, 1.0])?])?,
        "distant" => {
            let towards = point("from", [0.0; 3])? - point("to", [0.0, 0.0, 1.0])?;
            if towards.length_squared() == 0.0 {
                return Err(refuse(p, "from", "must differ from \"to\"", "the same point"));
            }
            let emission = emission::of_light(ctx, p, "L", space, units)?;
            let emission = powered(p, "illuminance", emission, 1.0)?;
            Light::Distant(DistantLight { towards: towards.normalize(), emission })
        }
        "infinite" => infinite::light(ctx, record, units)?,
        "goniometric" => goniometric::light(ctx, record, units)?,
        "projection" => projection::light(ctx, record, units)?,
        other => {
            let hint = "known are point, spot, distant, infinite, goniometric and projection";
            return Err(p.error(format!("light \"{other}\" is not known")).hint(hint));
        }
    };
    ctx.finish(p, &KNOWN);
    Ok(light)
}

/// pbrt's `power` and `illuminance`: the target over what a unit of the normalised emission gives.
fn powered(p: &ParamSet, name: &str, emission: Emission, per_unit: f64) -> Result<Emission, Error> {
    let Some(target) = p.float64_opt(name)?.filter(|v| *v > 0.0) else { return Ok(emission) };
    if p.bool("absolute", false)? {
        return Err(p.error_at(name, "must not be given with \"bool absolute\" true", &target.to_string()));
    }
    Ok(emission.scaled((target / per_unit) as f32))
}

fn spot(
    ctx: &Context<'_>,
    p: &ParamSet,
    space: &str,
    units: &mut Units,
    [from, to]: [Vec3; 2],
) -> Result<Light, Error> {
    let (angle, delta) = (p.float("coneangle", 30.0)?, p.float("conedeltaangle", 5.0)?);
    let intensity = emission::of_light(ctx, p, "I", space, units)?;
    let spot = SpotLight::new(from, to - from, intensity.clone(), angle, delta).map_err(|e| at(p, e))?;
    let intensity = powered(p, "power", intensity, spot.solid_angle())?;
    Ok(Light::Spot(SpotLight { intensity, ..spot }))
}
