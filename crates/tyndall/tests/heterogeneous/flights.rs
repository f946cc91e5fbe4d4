//! Free flights by null collisions against their density `sigma_t(t) exp(-int sigma_t)`, wavelength by wavelength.

use super::common::{Bands, Run, scene};
use super::media::{self, EXTINCTION};
use tyndall::integrators::observer::{Event, PathObserver, Vertex};
use tyndall_spectral::Spectrum;
use tyndall_testkit::chi2_1d;

const BANDS: Bands = Bands::new(4);
/// Voxels from z = 0 to 1.
const COLUMN: [f64; 4] = [0.5, 2.0, 0.0, 1.25];
const DRAWS: usize = 40_000;

/// Height of the first scattering.
#[derive(Default)]
struct First(Option<f64>);

impl PathObserver<1> for First {
    const WANTS_VERTICES: bool = true;

    fn contribution(&mut self, _: u32, _: &Spectrum<1>) {}

    fn vertex(&mut self, v: &Vertex<1>) {
        if v.event == Event::Medium && v.depth == 0 {
            self.0.get_or_insert(f64::from(v.p.z));
        }
    }
}

/// Density of the column at the depth `t` below its top: straight lines between the middles of voxels.
fn density(t: f64) -> f64 {
    let x = (4.0 * (1.0 - t) - 0.5).clamp(0.0, 3.0);
    let i = (x as usize).min(2);
    COLUMN[i] + (x - i as f64) * (COLUMN[i + 1] - COLUMN[i])
}

/// Its integral from the top, a straight line between thousandths.
fn passed() -> impl Fn(f64) -> f64 {
    let mut sums = vec![0.0];
    for i in 0..1000 {
        // Simpson's rule: exact for straight lines
        let at = |k: f64| density(1e-3 * (f64::from(i) + k));
        sums.push(sums[i as usize] + 1e-3 / 6.0 * (at(0.0) + 4.0 * at(0.5) + at(1.0)));
    }
    move |t: f64| {
        let i = ((1e3 * t) as usize).min(999);
        sums[i] + (1e3 * t - i as f64) * (sums[i + 1] - sums[i])
    }
}

#[test]
fn flights_follow_their_density() {
    let parameters = format!(
        " \"integer nz\" 4{}{}{} \"string edge\" \"clamp\"",
        media::numbers("density", &COLUMN),
        BANDS.interpolation(),
        BANDS.step("sigma_s", &EXTINCTION[..4]) + &BANDS.step("sigma_a", &[0.0; 4])
    );
    let camera = scene::camera(&BANDS, [0.5, 0.5, 5.0], [0.5; 3], 1e-4);
    let medium = media::medium("uniformgrid", &parameters);
    let text = scene::independent(&format!("{camera}WorldBegin\n{}{medium}{}", media::sky(), media::cube()));
    let passed = passed();
    let volpath = Run { max_depth: 0, ..Run::new(BANDS, 1).opow() };
    let analog = volpath.clone().analog();
    for (name, run) in [("volpath", volpath), ("analog", analog)] {
        let pass = run.plan(&text).pass;
        for (band, sigma) in EXTINCTION[..4].iter().enumerate() {
            let mut sample = 0;
            let draw = |_: &mut _| loop {
                let mut first = First::default();
                let (w, _) = pass.watch::<1>(0, 0, sample, &mut first);
                sample += 1;
                if ((w.hero() - 400.0) / Bands::WIDTH) as usize == band {
                    break first.0.map(|z| 1.0 - z);
                }
            };
            let pdf = |t: f64| sigma * density(t) * (-sigma * passed(t)).exp();
            chi2_1d(draw, pdf, [0.0, 1.0], DRAWS, 1).assert_ok(&format!("{name}, band {band}"), 8);
        }
    }
}
