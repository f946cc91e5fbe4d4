//! Single scattering in closed form: slabs in sunlight (Chandrasekhar) and the airlight of a point light.

mod common;

use common::{Bands, Run, judge::Family, scene, table::Table};
use std::f64::consts::PI;

/// Sunlight of unit perpendicular irradiance travelling along `(sin, 0, -cos)`.
fn sun(mu0: f64) -> String {
    let sin = (1.0 - mu0 * mu0).sqrt();
    format!(
        "LightSource \"distant\" \"bool absolute\" true \"spectrum L\" [300 1 900 1] \"point3 from\" [{} 0 {mu0}] \
         \"point3 to\" [0 0 0]\n",
        -sin
    )
}

/// Henyey-Greenstein with `cos` the cosine of the scattering angle \[1/sr\].
fn henyey_greenstein(g: f64, cos: f64) -> f64 {
    (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * cos).powf(1.5))
}

/// Cases SS1 and SS3 (tau 1, albedo 0.8, isotropic, mu0 0.5, mu 0.7) as the first band, and seven more.
#[test]
fn slab_in_sunlight() {
    let bands = Bands { count: 8 };
    let tau: [f64; 8] = [1.0, 0.2, 3.0, 0.5, 2.0, 0.1, 1.5, 0.8];
    let albedo = [0.8, 1.0, 0.5, 0.9, 0.3, 0.95, 0.7, 0.6];
    let g = [0.0, 0.5, -0.4, 0.8, 0.0, -0.7, 0.3, 0.6];
    let (mu0, mu) = (0.5f64, 0.7f64);
    let sines = (1.0 - mu0 * mu0).sqrt() * (1.0 - mu * mu).sqrt();
    let phase = |g: f64, cos: f64| henyey_greenstein(g, cos);
    let reflected: Vec<f64> = (0..8)
        .map(|i| {
            albedo[i] * phase(g[i], sines - mu * mu0) * mu0 / (mu0 + mu)
                * -(-tau[i] * (1.0 / mu0 + 1.0 / mu)).exp_m1()
        })
        .collect();
    let transmitted: Vec<f64> = (0..8)
        .map(|i| {
            let beams = (-tau[i] / mu).exp() - (-tau[i] / mu0).exp();
            albedo[i] * phase(g[i], sines + mu * mu0) * mu0 / (mu - mu0) * beams
        })
        .collect();
    // the published values of the two cases
    assert!((reflected[0] - 0.025665505413833074).abs() < 1e-12);
    assert!((transmitted[0] - 0.016602367764955935).abs() < 1e-12);

    let medium = scene::medium(&bands, "m", &tau, &albedo, &scene::asymmetry(&bands, &g));
    let slab = scene::slab("m", scene::INTERFACE);
    let sin = (1.0 - mu * mu).sqrt();
    let mut family = Family::default();
    for (name, height, expected) in [("SS1", 1.0, &reflected), ("SS3", -1.0, &transmitted)] {
        // the light that reaches the camera travels towards +x
        let camera = scene::camera([5.0 * sin, 0.0, 5.0 * mu * height], [0.0; 3], 0.01);
        let text = format!("{camera}WorldBegin\n{}{medium}{slab}", sun(mu0));
        let run = || Run { max_depth: 1, ..Run::new(bands, 2048) };
        family.bands(&format!("{name}, hero"), &run().bands(&text), expected);
        family.bands(&format!("{name}, opow"), &run().opow().bands(&text), expected);
    }
    family.assert(0.05);
}

/// A point light beside the line of sight: the integral by adaptive quadrature, with and without equiangular samples.
#[test]
fn airlight_of_a_point_light() {
    let all = Table::parse(include_str!("../data/tests/airlight_point_light_single_scattering.csv"));
    let mut family = Family::default();
    for (h, z) in [("0.1", "4.0"), ("1.0", "4.0"), ("1.0", "20.0")] {
        let table = all.only("h", h).only("z_surface", z);
        let bands = Bands { count: table.len() };
        let more = scene::asymmetry(&bands, &table.column("g"));
        let medium = scene::medium(&bands, "m", &table.column("sigma_t"), &table.column("albedo"), &more);
        let expected = table.column("L_single_scatter_I=1W/sr");
        for equiangular in ["auto", "always", "off"] {
            let window = "\"float screenwindow\" [-0.0001 0.0001 -0.0001 0.0001]";
            let film = scene::film()
                .replace("\"volpath\"", &format!("\"volpath\" \"string equiangular\" \"{equiangular}\""));
            let text = format!(
                "{medium}MediumInterface \"\" \"m\"\nLookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\" {window}\n{film}\
                 WorldBegin\nMediumInterface \"m\" \"m\"\n\
                 LightSource \"point\" \"bool absolute\" true \"spectrum I\" [300 1 900 1] \"point3 from\" [{h} 0 3]\n{}{}",
                scene::BLACK,
                scene::plane(z.parse().expect("a depth"))
            );
            // without equiangular samples the vertices near the light are rare and heavy
            let spp = if equiangular == "off" { 16384 } else { 2048 };
            let run = Run { max_depth: 1, ..Run::new(bands, spp) };
            if equiangular == "off" && h == "0.1" {
                continue;
            }
            family.bands(&format!("h {h}, z {z}, {equiangular}"), &run.bands(&text), &expected);
        }
    }
    family.assert(0.1);
}
