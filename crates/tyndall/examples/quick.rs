use std::{path::Path, time::Instant};
use tyndall::{Options, Source, plan};
use tyndall_film::{Film, Guide, Pass, Patch, WorkUnit};
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let mut o = Options { spp: a.get(2).map(|s| s.parse().unwrap()), ..Options::default() };
    if let Some(i) = a.get(3) {
        if i != "-" {
            o.integrator = Some(i.clone());
        }
    }
    if let Some(i) = a.get(4) {
        if i != "-" {
            o.seed = Some(i.parse().unwrap());
        }
    }
    if let Some(i) = a.get(5) {
        let n: u32 = i.parse().unwrap();
        o.spectral = tyndall::Spectral::Hero { wavelengths: n };
    }
    let mut p = plan(Source::File(Path::new(&a[1])), &o).unwrap_or_else(|e| panic!("{e}"));
    for kv in a.iter().skip(6) {
        let (k, v) = kv.split_once('=').unwrap();
        match k {
            "eq" => {
                p.pass.settings.equiangular = match v {
                    "off" => tyndall_integrators::Equiangular::Off,
                    "always" => tyndall_integrators::Equiangular::Always,
                    _ => tyndall_integrators::Equiangular::Auto,
                }
            }
            "nee" => p.pass.settings.light_sampling = v == "1",
            "exact" => p.pass.settings.exact_transmittance = v == "1",
            "surv" => p.pass.settings.survival = v == "1",
            "rrd" => p.pass.settings.roulette_depth = v.parse().unwrap(),
            "rrt" => p.pass.settings.roulette_threshold = v.parse().unwrap(),
            "eqd" => p.pass.settings.equiangular_depth = v.parse().unwrap(),
            "ind" => {
                if v == "1" {
                    p.pass.settings.sampler = tyndall_transport::sampler::SamplerKind::Independent
                }
            }
            "portable" => p.pass.portable = v == "1",
            _ => panic!(),
        }
    }
    let spec = p.job.film.clone();
    let mut film = Film::new(&spec).unwrap();
    let t = Instant::now();
    let unit = WorkUnit { window: spec.bounds, samples: 0..p.job.spp, round: 0 };
    let mut patch = Patch::new(&spec, unit.clone());
    p.pass.render(&unit, &Guide::default(), &mut patch);
    film.merge(&patch).unwrap();
    let s = t.elapsed().as_secs_f64();
    let d = film.develop();
    let m: Vec<f64> =
        d.mean.iter().map(|c| c.iter().map(|&v| v as f64).sum::<f64>() / c.len() as f64).collect();
    println!(
        "{:?} {:.3}s {:.0} samples/s nonfinite {}",
        m,
        s,
        film.samples() as f64 / s,
        film.diagnostics().non_finite
    );
    if let Ok(out) = std::env::var("RAW") {
        let mut b = Vec::new();
        for c in &d.mean[..3] {
            for v in c {
                b.extend(v.to_le_bytes());
            }
        }
        std::fs::write(out, b).unwrap();
    }
}
