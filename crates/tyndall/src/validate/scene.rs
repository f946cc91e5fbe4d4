//! Pieces of scene texts.

use super::bands::{Bands, Dialect};

/// Black surfaces follow.
pub const BLACK: &str = "Material \"diffuse\" \"spectrum reflectance\" [300 0 900 0]\n";
/// A boundary that does not bend light.
pub const INTERFACE: &str = "Material \"interface\"";
/// Lateral half-width of a slab of thickness 1.
const WIDE: f64 = 2000.0;
/// The sampler of all scenes, up to its number of samples.
const SAMPLER: &str = "Sampler \"zsobol\" \"integer pixelsamples\" ";
/// Number of scatterings that stands for no limit.
const UNLIMITED: u32 = 1_000_000;

/// Infinite light of radiance 1.
pub fn sky(dialect: Dialect) -> String {
    format!("LightSource \"infinite\"{} \"spectrum L\" [300 1 900 1]\n", absolute(dialect))
}

/// Values of lights as they are given. Constant spectra of value 1 are the same in both dialects.
pub fn absolute(dialect: Dialect) -> &'static str {
    if dialect == Dialect::Own { " \"bool absolute\" true" } else { "" }
}

/// Sunlight of unit perpendicular irradiance travelling along `(sin, 0, -mu0)`.
pub fn sun(dialect: Dialect, mu0: f64) -> String {
    let sin = (1.0 - mu0 * mu0).sqrt();
    format!(
        "LightSource \"distant\"{} \"spectrum L\" [300 1 900 1] \"point3 from\" [{} 0 {mu0}] \"point3 to\" [0 0 0]\n",
        absolute(dialect),
        -sin
    )
}

/// Camera with parallel rays from `eye` to `target`, a square of half-width `half`.
pub fn camera(bands: &Bands, eye: [f64; 3], target: [f64; 3], half: f64) -> String {
    let window = format!("[{} {half} {} {half}]", -half, -half);
    let text = |v: [f64; 3]| format!("{} {} {}", v[0], v[1], v[2]);
    let look = format!("LookAt {}  {}  0 1 0", text(eye), text(target));
    format!("{look}\nCamera \"orthographic\" \"float screenwindow\" {window}\n{}", film(bands))
}

/// The same along `(sin, 0, cos)` through the origin from 5 away: `cos` < 0 looks down.
pub fn parallel_camera(bands: &Bands, cos: f64) -> String {
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    camera(bands, [-5.0 * sin, 0.0, -5.0 * cos], [0.0; 3], 0.01)
}

/// Film with a bucket a band, 4 x 4 pixels, box filter, sampler and integrator without a limit of depth.
pub fn film(bands: &Bands) -> String {
    let range = bands.range();
    format!(
        "Film \"spectral\" \"integer nbuckets\" {} \"float lambdamin\" {} \"float lambdamax\" {} \"integer xresolution\" 4 \
         \"integer yresolution\" 4\nPixelFilter \"box\"\n{SAMPLER}4096\n{}\n",
        bands.count,
        range.min,
        range.max,
        integrator(UNLIMITED)
    )
}

fn integrator(depth: u32) -> String {
    format!("Integrator \"volpath\" \"integer maxdepth\" {depth}")
}

/// The scene with independent random numbers.
pub fn independent(text: &str) -> String {
    text.replace(SAMPLER, &SAMPLER.replace("zsobol", "independent"))
}

/// The scene with `depth` as the most scatterings of a path.
pub fn limited(text: &str, depth: u32) -> String {
    text.replace(&integrator(UNLIMITED), &integrator(depth))
}

/// A medium by its extinction per unit of length and albedo, band by band, plus further parameters.
pub fn medium(bands: &Bands, name: &str, tau: &[f64], albedo: &[f64], more: &str) -> String {
    let spectra = coefficients(bands, tau, albedo);
    format!("MakeNamedMedium \"{name}\" \"string type\" \"homogeneous\"{spectra}{more}\n")
}

/// The same as a grid of `densities`, x fastest, that fills a box between two corners to its faces.
pub fn grid(bands: &Bands, tau: &[f64], albedo: &[f64], voxels: &Voxels<'_>, more: &str) -> String {
    let spectra = coefficients(bands, tau, albedo);
    let Voxels { counts: [nx, ny, nz], densities, low, high } = voxels;
    let text = |v: &[f64]| v.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    format!(
        "MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" \"integer nx\" {nx} \"integer ny\" {ny} \"integer nz\" {nz} \
         \"float density\" [{}] \"point3 p0\" [{}] \"point3 p1\" [{}] \"string edge\" \"clamp\"{spectra}{more}\n",
        text(densities),
        text(low),
        text(high)
    )
}

/// A grid of densities.
#[derive(Clone, Copy, Debug)]
pub struct Voxels<'d> {
    /// Along x, y and z.
    pub counts: [usize; 3],
    /// One a voxel.
    pub densities: &'d [f64],
    /// Lower corner of the box.
    pub low: [f64; 3],
    /// Upper corner.
    pub high: [f64; 3],
}

/// Coefficients by extinction and albedo.
fn coefficients(bands: &Bands, tau: &[f64], albedo: &[f64]) -> String {
    let sigma_a: Vec<f64> = tau.iter().zip(albedo).map(|(t, w)| t * (1.0 - w)).collect();
    let sigma_s: Vec<f64> = tau.iter().zip(albedo).map(|(t, w)| t * w).collect();
    let (a, s) = (bands.step("sigma_a", &sigma_a), bands.step("sigma_s", &sigma_s));
    format!("{}{a}{s}", bands.interpolation())
}

/// Henyey-Greenstein's g band by band (the directive needs [`Bands::interpolation`]); one number where all bands agree.
pub fn asymmetry(bands: &Bands, g: &[f64]) -> String {
    if g.iter().all(|v| *v == g[0]) {
        return format!(" \"float g\" {}", g[0]);
    }
    format!(" \"string phase\" \"henyey-greenstein\"{}", bands.step("g", g))
}

/// The phase function that a table calls `phase`.
pub fn phase(bands: &Bands, phase: &str, g: &[f64]) -> String {
    match phase {
        "hg" => asymmetry(bands, g),
        "isotropic" => " \"float g\" 0".into(),
        other => format!(" \"string phase\" \"{other}\""),
    }
}

/// A smooth boundary with an index band by band.
pub fn glass(bands: &Bands, eta: &[f64]) -> String {
    format!("Material \"dielectric\"{}{}", bands.interpolation(), bands.step("eta", eta))
}

/// A diffuse surface with a reflectance band by band.
pub fn diffuse(bands: &Bands, reflectance: &[f64]) -> String {
    format!("Material \"diffuse\"{}{}\n", bands.interpolation(), bands.step("reflectance", reflectance))
}

/// A closed box between two corners, normals outwards.
pub fn cuboid(low: [f64; 3], high: [f64; 3]) -> String {
    let corner = |i: [usize; 3]| {
        let at = |k: usize| if i[k] == 0 { low[k] } else { high[k] };
        format!("{} {} {} ", at(0), at(1), at(2))
    };
    let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
    let points: String = corners.map(corner).concat();
    format!(
        "Shape \"trianglemesh\" \"integer indices\" [0 2 1 0 3 2  4 5 6 4 6 7  0 1 5 0 5 4  3 7 6 3 6 2  \
         0 4 7 0 7 3  1 2 6 1 6 5] \"point3 P\" [{points}]\n"
    )
}

/// Densities of a slab whose optical thickness is that of density 1 all over: straight lines between the middles of four
/// layers, one of them empty, and constant beyond the outermost middles.
pub const UNEVEN: [f64; 4] = [0.5, 2.0, 0.0, 1.5];

/// The medium of [`slab`] with the densities [`UNEVEN`] from the bottom to the top.
pub fn uneven(bands: &Bands, tau: &[f64], albedo: &[f64], more: &str) -> String {
    let (low, high) = ([-WIDE, -WIDE, -1.0], [WIDE, WIDE, 0.0]);
    grid(bands, tau, albedo, &Voxels { counts: [1, 1, 4], densities: &UNEVEN, low, high }, more)
}

/// A wide box of medium from z = -1 to 0 with this boundary.
pub fn slab(medium: &str, material: &str) -> String {
    layer(medium, material, [-1.0, 0.0], WIDE)
}

/// A box of medium, `half` wide, between two heights.
pub fn layer(medium: &str, material: &str, [low, high]: [f64; 2], half: f64) -> String {
    let shape = cuboid([-half, -half, low], [half, half, high]);
    format!("AttributeBegin\nMediumInterface \"{medium}\" \"\"\n{material}\n{shape}AttributeEnd\n")
}

/// The slab as two boxes of one medium each, side by side in front of the camera. A hair of a millionth lies between
/// them, so that no ray meets two faces at once.
pub fn halves(left: &str, right: &str) -> String {
    let half = |name: &str, from: f64, to: f64| {
        let shape = cuboid([from, -WIDE, -1.0], [to, WIDE, 0.0]);
        format!("AttributeBegin\nMediumInterface \"{name}\" \"\"\n{INTERFACE}\n{shape}AttributeEnd\n")
    };
    half(left, -WIDE, -1e-6) + &half(right, 0.0, WIDE)
}

/// Wide layers without boundaries that bend light: from each height down there is this medium. Neighbours share one plane,
/// since of two that coincide a ray may miss one.
pub fn layers(downwards: &[(f64, &str)]) -> String {
    let above = [""].into_iter().chain(downwards.iter().map(|l| l.1));
    let face = |((height, below), above): (&(f64, &str), &str)| {
        let plane = plane(*height);
        format!("AttributeBegin\nMediumInterface \"{below}\" \"{above}\"\n{INTERFACE}\n{plane}AttributeEnd\n")
    };
    downwards.iter().zip(above).map(face).collect()
}

/// A horizontal plane with its normal upwards, much wider than the slab.
pub fn plane(z: f64) -> String {
    let w = 100.0 * WIDE;
    format!(
        "Shape \"bilinearmesh\" \"point3 P\" [{} {} {z}  {w} {} {z}  {} {w} {z}  {w} {w} {z}]\n",
        -w, -w, -w, -w
    )
}

/// Slab seen from above at the cosine `mu`, lit by a uniform sky from above only: the mean radiance is its plane
/// albedo by reciprocity.
pub fn reflectance(bands: &Bands, mu: f64, media: &str, slabs: &str) -> String {
    seen_from_above(bands, mu, media, slabs, -1.5)
}

/// The same lit from below only: the mean radiance is the total transmittance.
pub fn transmittance(bands: &Bands, mu: f64, media: &str, slabs: &str) -> String {
    seen_from_above(bands, mu, media, slabs, 6.0)
}

/// Slab seen from above with a black plane at the height `black`.
pub fn seen_from_above(bands: &Bands, mu: f64, media: &str, slabs: &str, black: f64) -> String {
    over_ground(bands, mu, media, slabs, &format!("{BLACK}{}", plane(black)))
}

/// Slab under a uniform sky over any ground, seen from above.
pub fn over_ground(bands: &Bands, mu: f64, media: &str, slabs: &str, ground: &str) -> String {
    let (camera, sky) = (parallel_camera(bands, -mu), sky(bands.dialect));
    format!("{camera}WorldBegin\n{sky}{media}{slabs}{ground}")
}

/// A sphere of radius 1 around the origin filled with `medium`.
pub fn ball(medium: &str, material: &str) -> String {
    format!("AttributeBegin\nMediumInterface \"{medium}\" \"\"\n{material}\nShape \"sphere\"\nAttributeEnd\n")
}
