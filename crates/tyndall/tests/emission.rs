//! Glowing media: Kirchhoff's law for slabs that also scatter.

mod common;

use common::{Bands, Run, judge::Family, scene, table::Table};

/// A slab of source radiance `le`, everything else black.
fn glowing(mu: f64, bands: &Bands, table: &Table, le: &[f64]) -> String {
    let glow = format!(" \"bool absolute\" true{}", bands.step("Le", le));
    let more = format!("{glow}{}", scene::asymmetry(bands, &table.column("g")));
    let medium = scene::medium(bands, "m", &table.column("tau"), &table.column("albedo"), &more);
    format!("{}WorldBegin\n{medium}{}", scene::parallel_camera(-mu), scene::slab("m", scene::INTERFACE))
}

#[test]
fn isothermal_slab() {
    let all = Table::parse(include_str!("../data/tests/isothermal_emitting_slab.csv"));
    let mut family = Family::default();
    for mu in ["1.0", "0.3"] {
        let table = all.only("mu_view", mu);
        let bands = Bands { count: table.len() };
        let le: Vec<f64> = (0..bands.count).map(|i| 0.5 + (i * 5 % 7) as f64).collect();
        let text = glowing(mu.parse().expect("a cosine"), &bands, &table, &le);
        let expected: Vec<f64> = table.column("L_over_B").iter().zip(&le).map(|(e, l)| e * l).collect();
        family.bands(&format!("hero, {mu}"), &Run::new(bands, 2048).bands(&text), &expected);
        family.bands(&format!("opow, {mu}"), &Run::new(bands, 2048).opow().bands(&text), &expected);
        family.bands(&format!("analog, {mu}"), &Run::new(bands, 4096).analog().bands(&text), &expected);
    }
    family.assert(0.2);
}

/// Without scattering the emission of a segment is known in closed form, and nothing varies.
#[test]
fn pure_absorber_is_exact() {
    let bands = Bands { count: 8 };
    let table =
        Table::parse("albedo,g,tau\n0,0,0.001\n0,0,0.01\n0,0,0.1\n0,0,0.5\n0,0,1\n0,0,2\n0,0,5\n0,0,12");
    let le = [1.0, 2.0, 0.5, 1.0, 3.0, 0.7, 1.0, 0.3];
    for mu in [1.0, 0.4] {
        for (name, run) in [("hero", Run::new(bands, 1024)), ("opow", Run::new(bands, 1024).opow())] {
            let got = run.bands(&glowing(mu, &bands, &table, &le));
            for ((g, tau), le) in got.iter().zip(table.column("tau")).zip(le) {
                let expected = le * -(-tau / mu).exp_m1();
                assert!(
                    (g.mean / expected - 1.0).abs() < 1e-5,
                    "{name}, tau {tau}: {} against {expected}",
                    g.mean
                );
                assert!(g.se < 1e-5 * expected, "{name}, tau {tau}: error {}", g.se);
            }
        }
    }
}
