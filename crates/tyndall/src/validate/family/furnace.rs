//! Furnaces: what neither absorbs nor emits cannot be seen in uniform light, and what is in equilibrium glows alike.

use super::{Family, Tolerance};
use crate::validate::{
    bands::{Bands, Dialect},
    case::Case,
    scene,
};

pub(super) const FAMILY: Family = Family {
    name: "furnace",
    title: "Furnaces: conservative balls, behind glass, inside glass, Lambertian box, isothermal enclosure",
    source: "invariance of uniform radiance; L = Le / (1 - rho); Kirchhoff",
    tolerance: Tolerance::Relative(2e-3),
    cases,
};

const N: usize = 8;
const G: [f64; N] = [-0.9, 0.95, 0.0, 0.5, -0.3, 0.85, 0.2, -0.6];
const LE: [f64; N] = [1.0, 2.0, 0.5, 1.0, 3.0, 0.7, 1.0, 0.3];

fn cases(dialect: Dialect) -> Vec<Case> {
    let bands = Bands::of(N, dialect);
    let mut out = balls(&bands);
    out.push(inside_glass(&bands));
    out.extend(boxes(&bands));
    out.push(isothermal(&bands));
    out
}

/// sigma_s = 5 (550 nm / lambda)^4.
fn rayleigh_law(bands: &Bands) -> Vec<f64> {
    bands.edges().windows(2).map(|e| 5.0 * (550.0 / (0.5 * f64::from(e[0] + e[1]))).powi(4)).collect()
}

/// Conservative spheres in a sky of radiance 1, bare and behind dispersive glass.
fn balls(bands: &Bands) -> Vec<Case> {
    let eta: Vec<f64> = (0..N).map(|i| 1.31 + 0.03 * i as f64).collect();
    let boundaries =
        [("ball", scene::INTERFACE.to_owned(), 1.0), ("glass ball", scene::glass(bands, &eta), 0.2)];
    let mut out = Vec::new();
    for phase in ["henyey-greenstein", "isotropic", "rayleigh"] {
        let function = match phase {
            "henyey-greenstein" => scene::asymmetry(bands, &G),
            other => scene::phase(bands, other, &[]),
        };
        for (name, boundary, density) in &boundaries {
            let sigma: Vec<f64> = rayleigh_law(bands).iter().map(|s| density * s).collect();
            let camera = scene::camera(bands, [0.0, 0.0, 5.0], [0.0; 3], 0.9);
            let medium = scene::medium(bands, "m", &sigma, &[1.0; N], &function);
            let (sky, ball) = (scene::sky(bands.dialect), scene::ball("m", boundary));
            let text = format!("{camera}WorldBegin\n{sky}{medium}{ball}");
            out.push(Case::new(format!("{name} {phase}"), *bands, text, vec![1.0; N]));
        }
    }
    out
}

/// Inside glass the radiance of the sky is n^2.
fn inside_glass(bands: &Bands) -> Case {
    let eta = [1.33, 1.2, 1.5, 1.4, 1.25, 1.7, 1.1, 1.6];
    // at most 0.5 off the axis: no ray is trapped by total reflection
    let camera = scene::camera(bands, [0.0; 3], [0.0, 0.1, -1.0], 0.35);
    let (sky, glass) = (scene::sky(bands.dialect), scene::glass(bands, &eta));
    let text = format!("{camera}WorldBegin\n{sky}{glass}\nShape \"sphere\"\n");
    let labels = eta.iter().map(|n| format!("n {n}")).collect();
    Case::new("camera inside glass", *bands, text, eta.map(|n| n * n).into()).labels(labels)
}

/// A closed box with walls that emit and reflect, filled with `medium` if there is one.
fn enclosure(bands: &Bands, rho: &[f64], medium: &str) -> String {
    let camera = "LookAt 0.3 0.2 0.1  1 0.4 -0.2  0 1 0\nCamera \"perspective\" \"float fov\" 60\n";
    let inside = if medium.is_empty() { "" } else { "m" };
    format!(
        "{medium}MediumInterface \"\" \"{inside}\"\n{camera}{}WorldBegin\nMediumInterface \"{inside}\" \"\"\n\
         {}AreaLightSource \"diffuse\" \"bool twosided\" true{}\n{}",
        scene::film(bands),
        scene::diffuse(bands, rho),
        bands.emission("L", "scale", &LE),
        scene::cuboid([-1.0; 3], [1.0; 3])
    )
}

/// L = Le / (1 - rho); a conservative medium does not show.
fn boxes(bands: &Bands) -> [Case; 2] {
    let rho = [0.5, 0.1, 0.7, 0.5, 0.3, 0.6, 0.2, 0.8];
    let expected: Vec<f64> = LE.iter().zip(rho).map(|(l, r)| l / (1.0 - r)).collect();
    let sigma: Vec<f64> = rayleigh_law(bands).iter().map(|s| 0.1 * s).collect();
    let fog = scene::medium(bands, "m", &sigma, &[1.0; N], &scene::asymmetry(bands, &G));
    let labels: Vec<String> = (0..N).map(|i| format!("Le {}, rho {}", LE[i], rho[i])).collect();
    let case = |name: &str, medium: &str| {
        Case::new(name, *bands, enclosure(bands, &rho, medium), expected.clone()).labels(labels.clone())
    };
    [case("Lambertian box", ""), case("Lambertian box with fog", &fog)]
}

/// Walls, medium and all at one temperature: everything has the radiance of the black walls.
fn isothermal(bands: &Bands) -> Case {
    let tau: Vec<f64> = (0..N).map(|i| 0.3 + 0.7 * (i * 3 % N) as f64).collect();
    let albedo: Vec<f64> = (0..N).map(|i| 0.1 + 0.12 * (i * 5 % N) as f64).collect();
    let glow = bands.emission("Le", "Lescale", &LE) + &scene::asymmetry(bands, &G);
    let medium = scene::medium(bands, "m", &tau, &albedo, &glow);
    Case::new("isothermal enclosure", *bands, enclosure(bands, &[0.0; N], &medium), LE.into())
}
