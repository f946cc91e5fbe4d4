//! `infinite`: the same radiance from everywhere, an image, or either seen through a portal.

use crate::scene::{
    collect::LightRecord,
    color_space,
    context::{Context, at, refuse},
    emission::{self, Units},
};
use tyndall_base::{
    Vec3,
    vec::{vec2, vec3},
};
use tyndall_files::image::read_image;
use tyndall_pbrt::{Error, ParamSet};
use tyndall_spectral::{Curve, Emission, cie, upsample};
use tyndall_transport::{
    light::{
        EnvironmentImage, ImageInfiniteLight, Light, Portal, PortalLight, RgbEmission, Sky,
        UniformInfiniteLight, sphere_to_square,
    },
    texture::{ImageMap, Lookup, Mapping, RgbKind, RgbRule, Texels, TextureContext, Wrap},
};

/// `infinite`: uniform, an environment map, or either behind a portal.
pub(super) fn light(ctx: &Context<'_>, record: &LightRecord, units: &mut Units) -> Result<Light, Error> {
    let p = &record.declared.params;
    let portal = portal(p)?;
    if p.contains("filename") {
        if p.contains("L") {
            return Err(p.error("infinite light: expected \"L\" or \"filename\", got both"));
        }
        return image(ctx, record, portal, units);
    }
    let emission = emission::of_light(ctx, p, "L", &record.declared.color_space, units)?;
    let emission = super::powered(p, "illuminance", emission, std::f64::consts::PI)?;
    Ok(match portal {
        None => Light::Infinite(UniformInfiniteLight { emission }),
        Some(portal) => behind(p, portal, Sky::Uniform(emission))?,
    })
}

/// The rectangle of `portal`, which stands in the world, whatever the light's transformation.
fn portal(p: &ParamSet) -> Result<Option<Portal>, Error> {
    let Some(corners) = p.point3s("portal")? else { return Ok(None) };
    let corners: [[f32; 3]; 4] = corners.try_into().map_err(|corners: Vec<_>| {
        refuse(p, "portal", "must be the 4 corners of a rectangle, in order around it", corners.len())
    })?;
    Portal::new(corners.map(Vec3::from)).map(Some).map_err(|e| at(p, e))
}

fn behind(p: &ParamSet, portal: Portal, sky: Sky) -> Result<Light, Error> {
    Ok(Light::Portal(Box::new(PortalLight::new(portal, sky).map_err(|e| at(p, e))?)))
}

/// An environment map.
fn image(
    ctx: &Context<'_>,
    record: &LightRecord,
    portal: Option<Portal>,
    units: &mut Units,
) -> Result<Light, Error> {
    let declared = &record.declared;
    let p = &declared.params;
    let text = p.string_opt("filename")?.ok_or_else(|| p.missing("string", "filename"))?;
    let path = ctx.file(p, "filename", text)?;
    let pixels = read_image(&path).map_err(|e| at(p, e))?;
    let texels = crate::scene::image::texels(&pixels).map_err(|e| at(p, e))?;
    if texels.width != texels.height {
        let got = format!("{} x {}", texels.width, texels.height);
        let hint = "environment maps are square, in the equal-area octahedral parameterisation; pbrt's imgtool makeequiarea converts from latitude-longitude";
        return Err(refuse(p, "filename", "must be a square image", got).hint(hint));
    }
    let space = color_space::name(&declared.color_space);
    let white = &color_space::find(&declared.color_space).illuminant;
    let mut scale = p.float64("scale", 1.0)?;
    if p.bool("absolute", false)? {
        units.absolute = true;
    } else {
        units.normalised = true;
        scale /= cie::y_integral(white);
    }
    let rgb = |i: usize| -> [f32; 3] {
        let at = |c: usize| texels.data[i * texels.channels + c.min(texels.channels - 1)].max(0.0);
        [at(0), at(1), at(2)]
    };
    if let Some(target) = p.float64_opt("illuminance")?.filter(|v| *v > 0.0) {
        scale *= target / illuminance(&texels, space, &rgb);
    }
    let table = upsample::RgbTable::get(space);
    let size = texels.width;
    let axes = axes(&declared.ctm.start);
    let colours: Vec<[f32; 3]> = match &portal {
        None => (0..size * size).map(rgb).collect(),
        Some(portal) => charted(texels.clone(), space, portal, axes),
    };
    let emission = |c: &[f32; 3]| {
        let scale = 2.0 * c[0].max(c[1]).max(c[2]);
        let sigmoid = table.coefficients(if scale > 0.0 { c.map(|v| v / scale) } else { [0.0; 3] });
        RgbEmission { sigmoid, scale }
    };
    let weights = luminances(&colours, space);
    if weights.iter().all(|w| *w == 0.0) {
        return Err(p.error("infinite light: the image is black"));
    }
    let mean = mean_emission(&colours, space, white, scale).map_err(|e| at(p, e))?;
    let white = white.scaled(scale as f32);
    let texels = colours.iter().map(emission).collect();
    if let Some(portal) = portal {
        return behind(p, portal, Sky::Image { size, texels, weights, white, mean });
    }
    let image = EnvironmentImage { size, texels, white, weights, mean };
    Ok(Light::Image(ImageInfiniteLight::new(image, axes).map_err(|e| at(p, e))?))
}

/// The map looked up over a portal's chart: bilinear, at the middle of each of as many texels, as in pbrt.
fn charted(
    texels: Texels,
    space: tyndall_spectral::SpaceName,
    portal: &Portal,
    axes: [Vec3; 3],
) -> Vec<[f32; 3]> {
    let n = texels.width;
    let map = ImageMap {
        texels: texels.into(),
        mapping: Mapping::default(),
        wrap: Wrap::Octahedral,
        lookup: Lookup::Bilinear,
        scale: 1.0,
        invert: false,
        rule: RgbRule { space, kind: RgbKind::Illuminant },
    };
    let colour = |i: usize| {
        let uv = [((i % n) as f32 + 0.5) / n as f32, ((i / n) as f32 + 0.5) / n as f32];
        let (d, _) = portal.direction(uv);
        let [u, v] = sphere_to_square(vec3(d.dot(axes[0]), d.dot(axes[1]), d.dot(axes[2])));
        // texture coordinates start at the lower left
        let at = TextureContext { p: Vec3::ZERO, n: Vec3::ZERO, uv: vec2(u, 1.0 - v) };
        map.vector(&at).map(|c| c.max(0.0))
    };
    (0..n * n).map(colour).collect()
}

/// Luminance with a small floor, so that no coloured texel is left out.
fn luminances(colours: &[[f32; 3]], space: tyndall_spectral::SpaceName) -> Vec<f32> {
    let row = tyndall_spectral::ColourSpace::get(space).xyz_from_rgb.0[1].map(|v| v as f32);
    colours
        .iter()
        .map(|c| {
            let y = row[0] * c[0] + row[1] * c[1] + row[2] * c[2];
            y.max(0.0) + 0.01 * (c[0] + c[1] + c[2])
        })
        .collect()
}

fn mean_emission(
    colours: &[[f32; 3]],
    space: tyndall_spectral::SpaceName,
    white: &Curve,
    scale: f64,
) -> Result<Emission, tyndall_spectral::SpectralError> {
    let sum = colours.iter().fold([0.0f64; 3], |s, c| [0, 1, 2].map(|k| s[k] + f64::from(c[k])));
    let mean = sum.map(|v| (v / colours.len() as f64) as f32);
    Ok(upsample::unbounded(space, mean)?.times(white).scaled(scale as f32).into())
}

/// Illuminance of the upper hemisphere on a horizontal plane, in units of the image.
fn illuminance(texels: &Texels, space: tyndall_spectral::SpaceName, rgb: &dyn Fn(usize) -> [f32; 3]) -> f64 {
    let row = tyndall_spectral::ColourSpace::get(space).xyz_from_rgb.0[1];
    let n = texels.width;
    let mut sum = 0.0;
    for i in 0..n * n {
        let uv = [((i % n) as f32 + 0.5) / n as f32, ((i / n) as f32 + 0.5) / n as f32];
        let z = tyndall_transport::light::square_to_sphere(uv).z;
        let c = rgb(i);
        let y: f64 = (0..3).map(|k| row[k] * f64::from(c[k])).sum();
        sum += y * f64::from(z.max(0.0));
    }
    sum * 4.0 * std::f64::consts::PI / (n * n) as f64
}

/// The images of the light's axes, made orthonormal: scale does not matter to directions.
fn axes(to_world: &tyndall_geometry::Transform) -> [Vec3; 3] {
    [vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0)].map(|a| to_world.vector(a).normalize())
}
