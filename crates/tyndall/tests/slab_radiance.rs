//! Radiances of slabs in sunlight, all orders of scattering, against adding-doubling.

mod common;

use common::{Bands, Run, judge::Family, scene, table::Table};

const MU0: f64 = 0.6;

#[test]
fn reflected_and_transmitted() {
    let all = Table::parse(include_str!("../data/tests/slab_radiance.csv"));
    let sun = format!(
        "LightSource \"distant\" \"bool absolute\" true \"spectrum L\" [300 1 900 1] \"point3 from\" [{} 0 {MU0}] \
         \"point3 to\" [0 0 0]\n",
        -(1.0 - MU0 * MU0).sqrt()
    );
    let cases = [
        ("isotropic", "0.8", "0"),
        ("isotropic", "0.25", "0"),
        ("hg", "0.8", "90"),
        ("hg", "0.25", "0"),
        ("hg", "0.5", "180"),
        ("rayleigh", "0.8", "90"),
        ("rayleigh", "0.25", "0"),
        ("rayleigh", "0.5", "180"),
    ];
    let mut family = Family::default();
    for (phase, view, azimuth) in cases {
        let table = all.only("phase", phase).only("mu_view", view).only("dphi_deg", azimuth);
        let bands = Bands { count: table.len() };
        let more = match phase {
            "hg" => scene::asymmetry(&bands, &table.column("g")),
            other => format!(" \"string phase\" \"{other}\""),
        };
        let medium = scene::medium(&bands, "m", &table.column("tau"), &table.column("albedo"), &more);
        let mu: f64 = view.parse().expect("a cosine");
        let phi = azimuth.parse::<f64>().expect("an angle").to_radians();
        let sin = (1.0 - mu * mu).sqrt();
        for (side, height, column) in
            [("R", 1.0, "L_reflected_per_Eperp"), ("T", -1.0, "L_transmitted_diffuse_per_Eperp")]
        {
            let eye = [5.0 * sin * phi.cos(), 5.0 * sin * phi.sin(), 5.0 * mu * height];
            let camera = scene::camera(eye, [0.0; 3], 0.01);
            let text = format!("{camera}WorldBegin\n{sun}{medium}{}", scene::slab("m", scene::INTERFACE));
            let name = format!("{phase}, {side}, view {view}, azimuth {azimuth}");
            let expected = table.column(column);
            family.bands(&format!("{name}, hero"), &Run::new(bands, 1024).bands(&text), &expected);
            family.bands(&format!("{name}, opow"), &Run::new(bands, 1024).opow().bands(&text), &expected);
        }
    }
    family.assert(0.1);
}
