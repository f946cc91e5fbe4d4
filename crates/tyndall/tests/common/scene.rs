//! Pieces of scene texts.

use super::Bands;

/// Makes tables of a directive piecewise constant.
pub const STEP: &str = " \"string interpolation\" \"step\"";
/// Infinite light of radiance 1.
pub const SKY: &str =
    "LightSource \"infinite\" \"bool absolute\" true \"float scale\" 1 \"spectrum L\" [300 1 900 1]\n";
/// A black surface follows.
pub const BLACK: &str = "Material \"diffuse\" \"spectrum reflectance\" [300 0 900 0]\n";
/// Lateral half-width of a slab of thickness 1.
const WIDE: f64 = 2000.0;

/// Camera with parallel rays from `eye` to `target`, a square of half-width `half`.
pub fn camera(eye: [f64; 3], target: [f64; 3], half: f64) -> String {
    let window = format!("[{} {half} {} {half}]", -half, -half);
    let text = |v: [f64; 3]| format!("{} {} {}", v[0], v[1], v[2]);
    let look = format!("LookAt {}  {}  0 1 0", text(eye), text(target));
    format!("{look}\nCamera \"orthographic\" \"float screenwindow\" {window}\n{}", film())
}

/// The same along `(sin, 0, cos)` through the origin from 5 away: `cos` < 0 looks down.
pub fn parallel_camera(cos: f64) -> String {
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    camera([-5.0 * sin, 0.0, -5.0 * cos], [0.0; 3], 0.01)
}

/// Film, filter, sampler and integrator; sizes and depths come from the options.
pub fn film() -> String {
    "Film \"rgb\"\nPixelFilter \"box\"\nSampler \"zsobol\"\nIntegrator \"volpath\" \"integer maxdepth\" -1\n"
        .into()
}

/// A medium by its optical thickness per unit of length and albedo, band by band, plus further parameters.
pub fn medium(bands: &Bands, name: &str, tau: &[f64], albedo: &[f64], more: &str) -> String {
    let sigma_a: Vec<f64> = tau.iter().zip(albedo).map(|(t, w)| t * (1.0 - w)).collect();
    let sigma_s: Vec<f64> = tau.iter().zip(albedo).map(|(t, w)| t * w).collect();
    let (a, s) = (bands.step("sigma_a", &sigma_a), bands.step("sigma_s", &sigma_s));
    format!("MakeNamedMedium \"{name}\" \"string type\" \"homogeneous\"{STEP}{a}{s}{more}\n")
}

/// Henyey-Greenstein's g band by band; the directive needs [`STEP`].
pub fn asymmetry(bands: &Bands, g: &[f64]) -> String {
    format!(" \"string phase\" \"henyey-greenstein\"{}", bands.step("g", g))
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

/// A wide box of medium from z = -1 to 0 with the current or no material.
pub fn slab(medium: &str, material: &str) -> String {
    let shape = cuboid([-WIDE, -WIDE, -1.0], [WIDE, WIDE, 0.0]);
    format!("AttributeBegin\nMediumInterface \"{medium}\" \"\"\n{material}\n{shape}AttributeEnd\n")
}

/// A boundary that does not bend light.
pub const INTERFACE: &str = "Material \"interface\"";

/// A horizontal plane, much wider than the slab.
pub fn plane(z: f64) -> String {
    let w = 100.0 * WIDE;
    format!(
        "Shape \"bilinearmesh\" \"point3 P\" [{} {} {z}  {w} {} {z}  {} {w} {z}  {w} {w} {z}]\n",
        -w, -w, -w, -w
    )
}

/// Slab seen from above at the cosine `mu`, lit by a uniform sky from above only: the mean radiance is its plane
/// albedo by reciprocity.
pub fn reflectance(mu: f64, media: &str, slabs: &str) -> String {
    format!("{}WorldBegin\n{SKY}{media}{slabs}{BLACK}{}", parallel_camera(-mu), plane(-1.5))
}

/// The same lit from below only: the mean radiance is the total transmittance.
pub fn transmittance(mu: f64, media: &str, slabs: &str) -> String {
    format!("{}WorldBegin\n{SKY}{media}{slabs}{BLACK}{}", parallel_camera(-mu), plane(6.0))
}

/// A sphere of radius 1 around the origin filled with `medium`.
pub fn ball(medium: &str, material: &str) -> String {
    format!("AttributeBegin\nMediumInterface \"{medium}\" \"\"\n{material}\nShape \"sphere\"\nAttributeEnd\n")
}
