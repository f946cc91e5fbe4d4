//! Plane albedo and transmittance of slabs against adding-doubling and closed forms, one row of a table per band.

mod common;

use common::{Bands, Run, judge::Family, scene, table::Table};

const FLUX: &str = include_str!("../data/tests/slab_flux.csv");

/// The rows of `table` as the bands of one medium.
fn medium_of(bands: &Bands, table: &Table, phase: &str) -> String {
    let more = match phase {
        "hg" => scene::asymmetry(bands, &table.column("g")),
        other => format!(" \"string phase\" \"{other}\""),
    };
    scene::medium(bands, "m", &table.column("tau"), &table.column("albedo"), &more)
}

fn rows(phase: &str, mu: &str) -> (Bands, Table) {
    let table = Table::parse(FLUX).only("phase", phase).only("mu0", mu);
    (Bands { count: table.len() }, table)
}

fn check(phase: &str, family: &mut Family, run: impl Fn(Bands) -> Run, name: &str) {
    let slab = scene::slab("m", scene::INTERFACE);
    for mu in ["1.0", "0.5", "0.1"] {
        let (bands, table) = rows(phase, mu);
        let medium = medium_of(&bands, &table, phase);
        let cos = mu.parse().expect("a cosine");
        let r = run(bands).bands(&scene::reflectance(cos, &medium, &slab));
        family.bands(&format!("{phase}, {name}, R({mu})"), &r, &table.column("R"));
        let t = run(bands).bands(&scene::transmittance(cos, &medium, &slab));
        family.bands(&format!("{phase}, {name}, T({mu})"), &t, &table.column("T_total"));
    }
}

#[test]
fn isotropic() {
    let mut family = Family::default();
    check("isotropic", &mut family, |b| Run::new(b, 4096), "hero 8");
    check("isotropic", &mut family, |b| Run::new(b, 2048).hero(4), "hero 4");
    check("isotropic", &mut family, |b| Run::new(b, 2048).opow(), "opow");
    check("isotropic", &mut family, |b| Run::new(b, 2048).fixed_set(), "fixed set");
    check("isotropic", &mut family, |b| Run::new(b, 2048).analog(), "analog");
    family.assert(0.15);
}

#[test]
fn henyey_greenstein() {
    let mut family = Family::default();
    check("hg", &mut family, |b| Run::new(b, 4096), "hero 8");
    check("hg", &mut family, |b| Run::new(b, 2048).opow(), "opow");
    check("hg", &mut family, |b| Run::new(b, 2048).analog(), "analog");
    family.assert(0.15);
}

#[test]
fn rayleigh() {
    let mut family = Family::default();
    check("rayleigh", &mut family, |b| Run::new(b, 4096), "hero 8");
    check("rayleigh", &mut family, |b| Run::new(b, 2048).opow(), "opow");
    check("rayleigh", &mut family, |b| Run::new(b, 4096).analog(), "analog");
    family.assert(0.1);
}

/// 8000 wide, 1 thick, a black plane 0.001 under it: offsets of rays that grow with the scene step over the plane.
#[test]
fn wide_and_thin_over_a_black_plane() {
    let mut family = Family::default();
    for phase in ["isotropic", "rayleigh"] {
        for mu in ["1.0", "0.5", "0.1"] {
            let (bands, table) = rows(phase, mu);
            let medium = medium_of(&bands, &table, phase);
            let shape = scene::cuboid([-4000.0, -4000.0, -1.0], [4000.0, 4000.0, 0.0]);
            let slab = format!(
                "AttributeBegin\nMediumInterface \"m\" \"\"\n{}\n{shape}AttributeEnd\n",
                scene::INTERFACE
            );
            let cos = mu.parse().expect("a cosine");
            let text =
                scene::reflectance(cos, &medium, &slab).replace(&scene::plane(-1.5), &scene::plane(-1.001));
            family.bands(
                &format!("{phase}, R({mu})"),
                &Run::new(bands, 2048).bands(&text),
                &table.column("R"),
            );
        }
    }
    family.assert(0.1);
}

/// Chandrasekhar's H functions: 60 mean free paths are as good as infinitely many at albedos up to 0.9.
#[test]
fn semi_infinite() {
    let table = Table::parse(include_str!("../data/tests/semi_infinite_isotropic_albedo.csv"));
    let bands = Bands { count: table.len() };
    let depth = vec![60.0; table.len()];
    let medium = scene::medium(&bands, "m", &depth, &table.column("albedo"), "");
    let slab = scene::slab("m", scene::INTERFACE);
    let mut family = Family::default();
    for mu in ["1.0", "0.7", "0.3", "0.1"] {
        let text = scene::reflectance(mu.parse().expect("a cosine"), &medium, &slab);
        let expected = table.column(&format!("plane_albedo_mu0_{mu}"));
        family.bands(&format!("hero, {mu}"), &Run::new(bands, 2048).bands(&text), &expected);
        family.bands(&format!("analog, {mu}"), &Run::new(bands, 2048).analog().bands(&text), &expected);
    }
    family.assert(0.1);
}

/// Smooth boundaries whose index differs from band to band.
#[test]
fn fresnel_boundaries() {
    let all = Table::parse(include_str!("../data/tests/slab_fresnel.csv"));
    let mut family = Family::default();
    for mu in ["1.0", "0.5"] {
        let table = all.only("mu0_external", mu);
        let bands = Bands { count: table.len() };
        let medium = medium_of(&bands, &table, "hg");
        let glass =
            format!("Material \"dielectric\"{}{}", scene::STEP, bands.step("eta", &table.column("n_rel")));
        let slab = scene::slab("m", &glass);
        let cos = mu.parse().expect("a cosine");
        let (r, t) = (scene::reflectance(cos, &medium, &slab), scene::transmittance(cos, &medium, &slab));
        for (name, run) in [("hero", Run::new(bands, 2048)), ("analog", Run::new(bands, 2048).analog())] {
            family.bands(&format!("{name}, R({mu})"), &run.bands(&r), &table.column("R_total_incl_specular"));
            family.bands(&format!("{name}, T({mu})"), &run.bands(&t), &table.column("T_total"));
        }
    }
    family.assert(0.2);
}

/// A reflecting ground under the slab.
#[test]
fn over_a_lambertian_ground() {
    let all = Table::parse(include_str!("../data/tests/slab_over_lambertian_ground.csv"));
    let mut family = Family::default();
    for phase in ["isotropic", "hg"] {
        let table = all.only("phase", phase);
        let bands = Bands { count: table.len() };
        let medium = medium_of(&bands, &table, phase);
        let rho = bands.step("reflectance", &table.column("ground_reflectance"));
        let ground = format!("Material \"diffuse\"{}{rho}\n", scene::STEP);
        let text = scene::reflectance(0.6, &medium, &scene::slab("m", scene::INTERFACE))
            .replace(scene::BLACK, &ground);
        family.bands(&format!("{phase}, hero"), &Run::new(bands, 2048).bands(&text), &table.column("R_top"));
        family.bands(
            &format!("{phase}, opow"),
            &Run::new(bands, 2048).opow().bands(&text),
            &table.column("R_top"),
        );
        let analog = Run::new(bands, 2048).analog().bands(&text);
        family.bands(&format!("{phase}, analog"), &analog, &table.column("R_top"));
    }
    family.assert(0.1);
}
