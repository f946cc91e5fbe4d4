//! Beer-Lambert: `exp(-sigma_a d)` in every band, on camera rays and on shadow rays, for every spectral strategy.

mod common;

use common::{Bands, Run, judge::Family, scene};
use tyndall::WavelengthPdf;

const BANDS: Bands = Bands { count: 16 };

fn depths() -> Vec<f64> {
    (0..16).map(|i| 0.02 + 0.2 * f64::from(i * 7 % 16)).collect()
}

fn transmittance(mu: f64) -> Vec<f64> {
    depths().iter().map(|tau| (-tau / mu).exp()).collect()
}

/// The sky seen through an absorbing slab.
fn absorber(mu: f64) -> String {
    let medium = scene::medium(&BANDS, "m", &depths(), &[0.0; 16], "");
    let slab = scene::slab("m", scene::INTERFACE);
    format!("{}WorldBegin\n{}{medium}{slab}", scene::parallel_camera(-mu), scene::SKY)
}

fn strategies(spp: u32) -> Vec<(&'static str, Run)> {
    let run = || Run::new(BANDS, spp);
    vec![
        ("hero 1", run().hero(1)),
        ("hero 4", run().hero(4)),
        ("hero 8", run()),
        ("hero 16", run().hero(16)),
        ("opow", run().opow()),
        ("fixed set", run().fixed_set()),
        ("density of the light", Run { pdf: WavelengthPdf::Light, ..run() }),
        ("density of the eye", Run { pdf: WavelengthPdf::Visible, ..run() }),
        ("analog", run().analog()),
    ]
}

#[test]
fn sky_through_an_absorber() {
    let mut family = Family::default();
    for mu in [1.0, 0.5] {
        for (name, run) in strategies(4096) {
            family.bands(&format!("{name}, mu {mu}"), &run.bands(&absorber(mu)), &transmittance(mu));
        }
    }
    family.assert(0.15);
}

/// A white plane under the slab, lit by the sun through it and seen from between the two: `E mu exp(-tau/mu) / pi`.
/// Shadow rays carry the transmittance in closed form and the samples fill the bands evenly, so nothing varies.
#[test]
fn sun_through_an_absorber_is_exact() {
    for mu in [1.0f64, 0.5] {
        let sun = format!(
            "LightSource \"distant\" \"bool absolute\" true \"spectrum L\" [300 3 900 3] \"point3 from\" [{} 0 {mu}] \
             \"point3 to\" [0 0 0]\n",
            (1.0 - mu * mu).sqrt()
        );
        let medium = scene::medium(&BANDS, "m", &depths(), &[0.0; 16], "");
        let white = "Material \"diffuse\" \"spectrum reflectance\" [300 1 900 1]\n";
        let camera = scene::camera([0.0, 0.0, -1.2], [0.0, 0.0, -1.5], 0.01);
        let slab = scene::slab("m", scene::INTERFACE);
        let text = format!("{camera}WorldBegin\n{sun}{medium}{slab}{white}{}", scene::plane(-1.5));
        for (name, run) in
            strategies(1024).into_iter().filter(|(n, _)| !n.contains("density") && *n != "analog")
        {
            let got = Run { max_depth: 1, ..run }.bands(&text);
            for (band, (g, t)) in got.iter().zip(transmittance(mu)).enumerate() {
                let expected = 3.0 * mu / std::f64::consts::PI * t;
                let error = (g.mean / expected - 1.0).abs();
                assert!(error < 3e-6, "{name}, mu {mu}, band {band}: {} against {expected}", g.mean);
                assert!(g.se < 1e-6 * expected, "{name}, mu {mu}, band {band}: error {}", g.se);
            }
        }
    }
}
