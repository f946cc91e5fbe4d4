//! `Film` and `PixelFilter`.

use super::{
    collect::Declared,
    color_space,
    context::{Context, at, refuse},
    sensor,
};
use tyndall_film::{Channels, FilmError, PixelBounds, PixelFilter, Sensor};
use tyndall_pbrt::{Error, ParamSet};
use tyndall_spectral::{SpaceName, cie, colour, illuminant};

/// What the film records.
#[derive(Clone, Debug)]
pub struct FilmDescription {
    /// Size of the whole image.
    pub resolution: [u32; 2],
    /// The part to render.
    pub bounds: PixelBounds,
    /// The file named in the scene, if any.
    pub filename: Option<String>,
    /// Colour space of R, G and B.
    pub space: SpaceName,
    /// Imaging ratio: exposure time times ISO over 100.
    pub imaging_ratio: f64,
    /// A measured sensor; `None` is the eye.
    pub sensor: Option<String>,
    /// White balance temperature \[K\], if any.
    pub white_balance: Option<f64>,
    /// Edges of spectral bands \[nm\]; empty for an RGB film.
    pub band_edges: Vec<f32>,
    /// The film wants depth, normals and albedo beside the image.
    pub gbuffer: bool,
    /// Pictures for the eye (PNG) shall be denoised.
    pub denoise: bool,
}

impl FilmDescription {
    /// The response curves: RGB and, if there are any, bands.
    pub fn channels(&self) -> Result<Channels, FilmError> {
        self.channels_of(Sensor::cie1931(self.imaging_ratio))
    }

    /// The same with another sensor.
    pub fn channels_of(&self, mut sensor: Sensor) -> Result<Channels, FilmError> {
        let space = tyndall_spectral::ColourSpace::get(self.space);
        if let Some(name) = &self.sensor {
            // pbrt's white balance of a measured sensor, where the scene gives none
            let kelvin = self.white_balance.unwrap_or(6500.0);
            let unknown = || FilmError::Channels { what: format!("no sensor is named {name}") };
            sensor = sensor::sensor(name, kelvin, space, self.imaging_ratio).ok_or_else(unknown)?;
        } else if let Some(kelvin) = self.white_balance {
            let light =
                illuminant::daylight(kelvin).map_err(|e| FilmError::Channels { what: e.to_string() })?;
            let from = colour::chromaticity(cie::xyz(&light));
            sensor = sensor.balanced(&colour::white_balance(from, colour::chromaticity(space.white)).0);
        }
        let rgb = Channels::rgb(&sensor, &space.rgb_from_xyz.0)?;
        if self.band_edges.is_empty() { Ok(rgb) } else { rgb.with_bands(&self.band_edges) }
    }
}

const KNOWN: [&str; 17] = [
    "xresolution",
    "yresolution",
    "cropwindow",
    "pixelbounds",
    "diagonal",
    "filename",
    "savefp16",
    "sensor",
    "iso",
    "whitebalance",
    "maxcomponentvalue",
    "nbuckets",
    "lambdamin",
    "lambdamax",
    "exposuretime",
    "coordinatesystem",
    "denoise",
];

/// The film of the scene; `exposure` is the shutter's open time \[s\].
pub fn film(ctx: &Context<'_>, declared: &Declared, exposure: f64) -> Result<FilmDescription, Error> {
    let p = &declared.params;
    let resolution = resolution(p)?;
    let white_balance = Some(p.float64("whitebalance", 0.0)?).filter(|k| *k != 0.0);
    if let Some(kelvin) = white_balance.filter(|k| !(4000.0..=25000.0).contains(k)) {
        return Err(refuse(p, "whitebalance", "must be 0 (none) or 4000 to 25000 K", kelvin));
    }
    let named = p.string("sensor", "cie1931")?;
    let chosen = Some(named).filter(|name| name != "cie1931");
    if let Some(name) = chosen.as_ref().filter(|name| !sensor::names().any(|n| n == **name)) {
        let all: Vec<_> = sensor::names().collect();
        let hint = tyndall_pbrt::did_you_mean(name, all.iter().copied())
            .unwrap_or_else(|| format!("known are cie1931, {}", all.join(", ")));
        return Err(refuse(p, "sensor", "must be a known sensor", format!("\"{name}\"")).hint(hint));
    }
    p.ignore("savefp16", "images are written in 32 bits");
    if p.contains("maxcomponentvalue") {
        p.ignore("maxcomponentvalue", "samples are never clipped in silence");
        p.warn_at(
            "maxcomponentvalue",
            "maxcomponentvalue: ignored, samples are never clipped in silence",
            ctx.warnings,
        );
    }
    let band_edges = match declared.name.as_str() {
        "rgb" => Vec::new(),
        "gbuffer" => {
            if p.string("coordinatesystem", "camera")? != "world" {
                p.ignore("coordinatesystem", "normals are in the scene's coordinates");
            }
            Vec::new()
        }
        "spectral" => bands(p, ctx)?,
        other => {
            return Err(p
                .error(format!("film \"{other}\" is not known"))
                .hint("known are rgb, spectral and gbuffer"));
        }
    };
    let description = FilmDescription {
        resolution,
        bounds: bounds(p, resolution)?,
        filename: p.string_opt("filename")?.map(|t| t.as_str().to_owned()),
        space: color_space::name(&declared.color_space),
        imaging_ratio: Sensor::imaging_ratio(exposure, p.float64("iso", 100.0)?),
        sensor: chosen,
        white_balance,
        band_edges,
        gbuffer: declared.name.as_str() == "gbuffer",
        denoise: p.bool("denoise", false)?,
    };
    description.channels().map_err(|e| at(p, e))?;
    ctx.finish(p, &KNOWN);
    Ok(description)
}

/// Resolution alone, for the camera.
pub fn resolution(p: &ParamSet) -> Result<[u32; 2], Error> {
    let one = |name, default| {
        let n = p.integer(name, default)?;
        if (1..=1 << 20).contains(&n) {
            return Ok(n as u32);
        }
        Err(refuse(p, name, "must be between 1 and 1048576 pixels", n))
    };
    Ok([one("xresolution", 1280)?, one("yresolution", 720)?])
}

fn bands(p: &ParamSet, ctx: &Context<'_>) -> Result<Vec<f32>, Error> {
    let count = p.integer("nbuckets", 16)?;
    if !(1..=4096).contains(&count) {
        return Err(refuse(p, "nbuckets", "must be between 1 and 4096", count));
    }
    let (low, high) = (p.float("lambdamin", ctx.range.min)?, p.float("lambdamax", ctx.range.max)?);
    if !(low < high && low > 0.0) {
        return Err(refuse(p, "lambdamax", "must be greater than \"lambdamin\"", high));
    }
    let edge = |i: i32| low + (high - low) * (i as f32 / count as f32);
    Ok((0..=count).map(edge).collect())
}

/// `pixelbounds` or `cropwindow`, rounded as pbrt does.
fn bounds(p: &ParamSet, [w, h]: [u32; 2]) -> Result<PixelBounds, Error> {
    let whole = PixelBounds::new(0, 0, w, h);
    if let Some(crop) = p.floats("cropwindow")? {
        let [x0, x1, y0, y1] = *crop else {
            return Err(refuse(p, "cropwindow", "must be 4 numbers", crop.len()));
        };
        if !(x0 < x1 && y0 < y1 && x0 >= 0.0 && y0 >= 0.0 && x1 <= 1.0 && y1 <= 1.0) {
            let got = format!("{x0} {x1} {y0} {y1}");
            return Err(refuse(p, "cropwindow", "must be x0 x1 y0 y1 within 0 and 1, ascending", got));
        }
        return Ok(crop_bounds([x0, x1, y0, y1], [w, h]));
    }
    let Some(given) = p.integers("pixelbounds")? else { return Ok(whole) };
    let [x0, x1, y0, y1] = *given else {
        return Err(refuse(p, "pixelbounds", "must be 4 integers", given.len()));
    };
    if !(0 <= x0 && x0 < x1 && x1 as u32 <= w && 0 <= y0 && y0 < y1 && y1 as u32 <= h) {
        let got = format!("{x0} {x1} {y0} {y1}");
        return Err(refuse(
            p,
            "pixelbounds",
            &format!("must be x0 x1 y0 y1 within {w} x {h}, ascending"),
            got,
        ));
    }
    Ok(PixelBounds::new(x0 as u32, y0 as u32, x1 as u32, y1 as u32))
}

/// The pixels of a window in fractions `[x0, x1, y0, y1]`.
pub fn crop_bounds([x0, x1, y0, y1]: [f32; 4], [w, h]: [u32; 2]) -> PixelBounds {
    let at = |f: f32, n: u32| (f * n as f32).ceil() as u32;
    PixelBounds::new(at(x0, w), at(y0, h), at(x1, w), at(y1, h))
}

/// The filter of the scene; pbrt's default is the Gaussian.
pub fn filter(ctx: &Context<'_>, declared: Option<&Declared>) -> Result<PixelFilter, Error> {
    let Some(declared) = declared else { return Ok(PixelFilter::default()) };
    let p = &declared.params;
    let radius = |default: f32| Ok::<_, Error>([p.float("xradius", default)?, p.float("yradius", default)?]);
    let made = match declared.name.as_str() {
        "box" => PixelFilter::boxed(radius(0.5)?),
        "triangle" => PixelFilter::triangle(radius(2.0)?),
        "gaussian" => PixelFilter::gaussian(radius(1.5)?, p.float("sigma", 0.5)?),
        "mitchell" => PixelFilter::mitchell(radius(2.0)?, p.float("B", 1.0 / 3.0)?, p.float("C", 1.0 / 3.0)?),
        "sinc" => PixelFilter::sinc(radius(4.0)?, p.float("tau", 3.0)?),
        other => {
            let hint = "box, triangle, gaussian, mitchell or sinc";
            return Err(p.error(format!("pixel filter \"{other}\" is unknown")).hint(hint));
        }
    };
    ctx.finish(p, &["xradius", "yradius", "sigma", "B", "C", "tau"]);
    made.map_err(|e| at(p, e))
}
