//! The number of wavelengths on a path does not move the mean, and the instruction set does not move a bit.

mod common;

use common::{Bands, Run, develop, judge::Family, scene};
use tyndall_film::ErrorMode;
use tyndall_geometry::Dispatch;
use tyndall_integrators::isa::Isa;

const BANDS: Bands = Bands::new(16);

/// Coloured fog around a dispersive glass ball over a coloured floor, a small lamp, a point light and a dim sky.
fn everything() -> String {
    let of = |a: usize, low: f64, high: f64| -> Vec<f64> {
        (0..16).map(|i| low + (high - low) * ((i * a) % 16) as f64 / 15.0).collect()
    };
    let fog = scene::medium(
        &BANDS,
        "fog",
        &of(5, 0.05, 0.6),
        &of(7, 0.3, 1.0),
        &scene::asymmetry(&BANDS, &of(3, -0.5, 0.8)),
    );
    let glass = scene::glass(&BANDS, &of(9, 1.3, 1.7));
    let floor = scene::diffuse(&BANDS, &of(11, 0.05, 0.9));
    let lamp = format!(
        "AttributeBegin\nAreaLightSource \"diffuse\" \"bool absolute\" true \"bool twosided\" true{}{}\nTranslate 0 1.5 1\n\
         Shape \"disk\" \"float radius\" 0.4\nAttributeEnd\n",
        BANDS.interpolation(),
        BANDS.step("L", &of(13, 1.0, 6.0))
    );
    let point = "LightSource \"point\" \"bool absolute\" true \"spectrum I\" [300 2 900 1] \"point3 from\" [1.5 0.5 0.5]\n";
    let sky = "LightSource \"infinite\" \"bool absolute\" true \"spectrum L\" [300 0.3 900 0.1]\n";
    let fog_box = scene::cuboid([-3.0, -3.0, -0.99], [3.0, 3.0, 2.0]);
    format!(
        "{}WorldBegin\n{fog}{sky}{point}{floor}{}AttributeBegin\nMediumInterface \"fog\" \"\"\n{}\n{fog_box}AttributeEnd\n{lamp}\
         {glass}\nTranslate 0 0 -0.4\nScale 0.5 0.5 0.5\nMediumInterface \"\" \"fog\"\nShape \"sphere\"\n",
        scene::camera(&BANDS, [2.0, -4.0, 4.0], [0.0; 3], 1.5),
        scene::plane(-1.0),
        scene::INTERFACE
    )
}

#[test]
fn the_mean_does_not_depend_on_the_number_of_lanes() {
    let run = |spp: u32, seed: u64| Run { max_depth: 6, ..Run::new(BANDS, spp).seed(seed) };
    let text = everything();
    let one = run(65536, 1).hero(1).bands(&text);
    let four = run(16384, 2).hero(4).bands(&text);
    let eight = run(8192, 3).bands(&text);
    let sixteen = run(4096, 4).hero(16).bands(&text);
    let mut family = Family::default();
    family.equal("1 and 4", &one, &four);
    family.equal("4 and 8", &four, &eight);
    family.equal("8 and 16", &eight, &sixteen);
    family.assert(0.1);
}

#[test]
fn every_instruction_set_gives_the_same_bits() {
    let text = everything();
    let base = || Run { errors: ErrorMode::Conservative, ..Run::new(BANDS, 256) };
    for run in [base().hero(1), base().hero(4), base(), base().hero(16), base().opow(), base().fixed_set()] {
        let (plain, others) = (with(&run, Dispatch::Portable).plan(&text), sets());
        let expected = develop(&plain);
        for set in others {
            let plan = with(&run, set).plan(&text);
            assert_eq!(Some(plan.pass.isa), Isa::choose(set));
            assert_eq!(develop(&plan), expected, "{set:?} {:?}", run.spectral);
        }
    }
    let lit_by_area = text.lines().filter(|l| !l.contains("\"point\"")).collect::<Vec<_>>().join("\n");
    let analog = base().analog();
    let expected = with(&analog, Dispatch::Portable).develop(&lit_by_area);
    for set in sets() {
        assert_eq!(with(&analog, set).develop(&lit_by_area), expected, "{set:?}");
    }
}

fn with(run: &Run, dispatch: Dispatch) -> Run {
    Run { dispatch, ..run.clone() }
}

/// The instruction sets that this processor has, beside the portable one; those that it has not are told.
fn sets() -> Vec<Dispatch> {
    let (have, lack): (Vec<_>, Vec<_>) =
        [Dispatch::Detect, Dispatch::Avx2, Dispatch::Avx512].into_iter().partition(|d| d.is_available());
    lack.iter().for_each(|d| println!("{d:?}: this processor does not have it, nothing was compared"));
    have
}
