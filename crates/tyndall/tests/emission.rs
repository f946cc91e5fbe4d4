//! Glowing media that do not scatter: closed form, without noise.

mod common;

use common::{Bands, Run, scene, table::Table};

/// A slab of source radiance `le`, everything else black.
fn glowing(mu: f64, bands: &Bands, table: &Table, le: &[f64]) -> String {
    let glow = bands.emission("Le", "Lescale", le);
    let more = format!("{glow}{}", scene::asymmetry(bands, &table.column("g")));
    let medium = scene::medium(bands, "m", &table.column("tau"), &table.column("albedo"), &more);
    format!(
        "{}WorldBegin\n{medium}{}",
        scene::parallel_camera(bands, -mu),
        scene::slab("m", scene::INTERFACE)
    )
}

/// Without scattering the emission of a segment is known in closed form, and nothing varies.
#[test]
fn pure_absorber_is_exact() {
    let bands = Bands::new(8);
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
