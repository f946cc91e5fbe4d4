//! Known answers.

use super::common::{Run, judge::Family, scene};
use super::media::{self, BANDS, EXTINCTION};

/// What neither absorbs nor emits cannot be seen in a uniform sky.
#[test]
fn chromatic_furnace() {
    let mut family = Family::default();
    for (name, medium) in media::conservative() {
        let text = format!("{}WorldBegin\n{}{medium}{}", media::camera(), media::sky(), media::cube());
        family.bands(&format!("{name}, hero"), &Run::new(BANDS, 512).bands(&text), &[1.0; 8]);
        family.bands(&format!("{name}, opow"), &Run::new(BANDS, 256).opow().bands(&text), &[1.0; 8]);
        family.bands(&format!("{name}, analog"), &Run::new(BANDS, 256).analog().bands(&text), &[1.0; 8]);
    }
    family.assert(0.05);
}

/// Sky through a column of absorbing voxels: the line integral of straight lines between their centres.
#[test]
fn beer_lambert_through_a_column() {
    let column = [0.5, 2.0, 0.0, 1.25];
    let inner: f64 = column.windows(2).map(|v| 0.5 * (v[0] + v[1])).sum();
    let ends = column[0] + column[3];
    // over the outer half voxels: the value itself, or a straight line down to half of it
    let cases = [("clamp", 0.5 * ends), ("fade", 0.5 * 0.75 * ends)];
    let mut family = Family::default();
    for (edge, outer) in cases {
        let length = (inner + outer) / 4.0;
        let expected = EXTINCTION.map(|s| (-s * length).exp());
        let parameters = format!(
            " \"integer nz\" 4{}{} \"string edge\" \"{edge}\"",
            media::numbers("density", &column),
            media::spectra(&[0.0; 8], 1.0)
        );
        let medium = media::medium("uniformgrid", &parameters);
        let camera = scene::camera(&BANDS, [0.5, 0.5, 5.0], [0.5; 3], 1e-4);
        let text = format!("{camera}WorldBegin\n{}{medium}{}", media::sky(), media::cube());
        let runs = [
            ("hero", Run::new(BANDS, 2048)),
            ("hero 4", Run::new(BANDS, 2048).hero(4)),
            ("opow", Run::new(BANDS, 2048).opow()),
            ("analog", Run::new(BANDS, 2048).analog()),
        ];
        for (name, run) in runs {
            family.bands(&format!("{edge}, {name}"), &run.bands(&text), &expected);
        }
    }
    family.assert(0.15);
}

/// The same on shadow rays: a white plane behind the column, lit through it by the sun.
#[test]
fn beer_lambert_on_shadow_rays() {
    let column = [0.5, 2.0, 0.0, 1.25];
    let length = column.iter().sum::<f64>() / 4.0;
    let expected = EXTINCTION.map(|s| 3.0 / std::f64::consts::PI * (-s * length).exp());
    let sun = "LightSource \"distant\" \"bool absolute\" true \"spectrum L\" [300 3 900 3] \"point3 from\" [0 0 1] \
               \"point3 to\" [0 0 0]\n";
    let density = media::numbers("density", &column);
    let parameters =
        format!(" \"integer nz\" 4{density}{} \"string edge\" \"clamp\"", media::spectra(&[0.0; 8], 1.0));
    let medium = media::medium("uniformgrid", &parameters);
    let white = "Material \"diffuse\" \"spectrum reflectance\" [300 1 900 1]\n";
    let camera = scene::camera(&BANDS, [0.5, 0.5, -0.2], [0.5, 0.5, -0.5], 1e-4);
    let text = format!("{camera}WorldBegin\n{sun}{medium}{}{white}{}", media::cube(), scene::plane(-0.5));
    let mut family = Family::default();
    for (name, set) in
        [("residual", ""), ("ratio", "residualratio=false"), ("delta", "exacttransmittance=false")]
    {
        let text = with_integrator(&text, set);
        for (lanes, run) in [("8", Run::new(BANDS, 2048)), ("opow", Run::new(BANDS, 2048).opow())] {
            let got = Run { max_depth: 1, ..run }.bands(&text);
            family.bands(&format!("{name}, {lanes}"), &got, &expected);
        }
    }
    family.assert(0.1);
}

/// An isothermal medium in black walls of its temperature: everything has the radiance of the walls.
#[test]
fn isothermal_enclosure() {
    let le = [1.0, 2.0, 0.5, 1.0, 3.0, 0.7, 1.0, 0.3];
    let glow = format!(" \"bool absolute\" true{}", BANDS.step("Le", &le));
    let medium = media::uniform(&media::ALBEDO, &glow);
    let camera = "LookAt 0.6 0.55 0.3  1 0.4 0.8  0 1 0\nCamera \"perspective\" \"float fov\" 60\n";
    let text = format!(
        "{medium}MediumInterface \"\" \"m\"\n{camera}{}WorldBegin\nMediumInterface \"m\" \"\"\n{}\
         AreaLightSource \"diffuse\" \"bool absolute\" true \"bool twosided\" true{}{}\n{}",
        scene::film(&BANDS),
        scene::BLACK,
        BANDS.interpolation(),
        BANDS.step("L", &le),
        scene::cuboid([0.0; 3], [1.0; 3])
    );
    let mut family = Family::default();
    family.bands("hero", &Run::new(BANDS, 512).bands(&text), &le);
    family.bands("opow", &Run::new(BANDS, 512).opow().bands(&text), &le);
    family.bands("analog", &Run::new(BANDS, 512).analog().bands(&text), &le);
    family.assert(0.1);
}

/// A black body of one temperature that absorbs: `B(T) (1 - exp(-tau))`, Planck's law in absolute units.
#[test]
fn grid_of_temperatures() {
    let parameters = format!(
        " \"integer nz\" 2 \"float density\" [1 1] \"float temperature\" [1700 1700] \"float temperatureoffset\" 200 \
         \"float temperaturescale\" 2 \"float Lescale\" 0.5 \"bool absolute\" true \"string edge\" \"clamp\"{}",
        media::spectra(&[0.0; 8], 1.0)
    );
    let camera = scene::camera(&BANDS, [0.5, 0.5, 5.0], [0.5; 3], 1e-4);
    let text = format!("{camera}WorldBegin\n{}{}", media::medium("uniformgrid", &parameters), media::cube());
    let edges = BANDS.edges();
    let planck = |i: usize| {
        let at = |k: usize| f64::from(edges[i]) + (k as f64 + 0.5) / 64.0 * 16.0;
        (0..64).map(|k| tyndall_spectral::curve::planck(3000.0, at(k))).sum::<f64>() / 64.0
    };
    let expected: Vec<f64> = (0..8).map(|i| 0.5 * planck(i) * (1.0 - (-EXTINCTION[i]).exp())).collect();
    let mut family = Family::default();
    family.bands("hero", &Run::new(BANDS, 2048).bands(&text), &expected);
    family.bands("analog", &Run::new(BANDS, 2048).analog().bands(&text), &expected);
    family.assert(0.1);
}

/// The scene with a parameter `NAME=VALUE` of the integrator.
pub fn with_integrator(text: &str, set: &str) -> String {
    let Some((name, value)) = set.split_once('=') else { return text.into() };
    media::with_parameters(text, &format!("\"bool {name}\" {value}"))
}
