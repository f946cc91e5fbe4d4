//! Media that vary in space and emit become lights.

use tyndall_pbrt::{Error, ErrorKind};
use tyndall_transport::{
    MediumId, ShapeBinding,
    light::{Light, MediumLights, VolumeLight},
    media::Medium,
};

/// The lights of those of `media` that a shape or the camera is in; `names` for messages.
pub fn volumes(
    media: &[Medium],
    names: &[String],
    shapes: &[ShapeBinding],
    camera: MediumId,
    which: MediumLights,
) -> Result<Vec<Light>, Error> {
    if which == MediumLights::Off {
        return Ok(Vec::new());
    }
    let used = |id: MediumId| {
        let bounds = |s: &ShapeBinding| s.boundary.is_some_and(|b| b.inside == id || b.outside == id);
        camera == id || shapes.iter().any(bounds)
    };
    let mut lights = Vec::new();
    for (i, medium) in media.iter().enumerate() {
        let id = MediumId(i as u32);
        let Medium::Heterogeneous(matter) = medium else { continue };
        if !used(id) {
            continue;
        }
        let light = VolumeLight::new(id, matter, which == MediumLights::Always).map_err(|e| {
            Error::in_file(ErrorKind::Other(format!("medium \"{}\": {e}", names[i])), "scene")
        })?;
        lights.extend(light.map(|l| Light::Volume(Box::new(l))));
    }
    Ok(lights)
}
