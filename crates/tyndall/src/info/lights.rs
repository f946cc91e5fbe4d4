//! Lights and their shares of the power.

use super::media::wavelengths;
use serde::Serialize;
use tyndall_spectral::{Emission, LambdaRange};
use tyndall_transport::{LightId, Scene, light::Light};

/// A light, or all primitives of a shape that emits.
#[derive(Clone, Debug, Serialize)]
pub struct LightInfo {
    /// Its kind.
    pub kind: String,
    /// Emitting primitives.
    pub primitives: usize,
    /// Emitted power over the spectral range, as a share of all lights'.
    pub power_share: f64,
    /// Spectral lines.
    pub lines: usize,
}

pub(super) fn lights(scene: &Scene, range: LambdaRange) -> Vec<LightInfo> {
    let (_, radius) = scene.accel.bounds().bounding_sphere();
    let radius = if radius.is_finite() && radius > 0.0 { radius } else { 1.0 };
    let power = |l: &Light| l.extent(radius) * integral(l.spectrum(), range);
    let total: f64 = scene.lights.iter().map(power).sum();
    let share = |p: f64| if total > 0.0 { p / total } else { 0.0 };
    let of_shapes = scene.shapes.iter().zip(scene.accel.groups()).filter_map(|(binding, group)| {
        let first = binding.first_light?;
        let ids = first.0..first.0 + group.shape.prim_count() as u32;
        let all: f64 = ids.clone().map(|id| power(scene.lights.get(LightId(id)))).sum();
        let lines = scene.lights.get(first).spectrum().lines().len();
        Some(LightInfo { kind: "area".into(), primitives: ids.len(), power_share: share(all), lines })
    });
    let others = scene.lights.iter().filter(|l| !matches!(l, Light::Area(_))).map(|l| LightInfo {
        kind: kind(l).into(),
        primitives: 1,
        power_share: share(power(l)),
        lines: l.spectrum().lines().len(),
    });
    of_shapes.chain(others).collect()
}

const fn kind(light: &Light) -> &'static str {
    match light {
        Light::Area(_) => "area",
        Light::Point(_) => "point",
        Light::Spot(_) => "spot",
        Light::Distant(_) => "distant",
        Light::Infinite(_) => "infinite",
        Light::Image(_) => "infinite, image",
        Light::Portal(_) => "infinite, portal",
        Light::Goniometric(_) => "goniometric",
        Light::Projection(_) => "projection",
        Light::Volume(_) => "medium",
    }
}

/// Integral of the continuum over the range \[nm\] plus the lines in it.
fn integral(emission: &Emission, range: LambdaRange) -> f64 {
    let n = wavelengths(range).count();
    let sum: f64 = wavelengths(range).map(|l| f64::from(emission.continuum().eval(l))).sum();
    let lines = emission.lines().iter().filter(|l| range.contains(l.lambda));
    sum * f64::from(range.width()) / n as f64 + lines.map(|l| f64::from(l.power)).sum::<f64>()
}
