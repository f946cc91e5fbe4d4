//! The numbers of the page as CSV files beside it.

use super::{Results, colour, figure6, shots::Taken};
use crate::Error;
use std::{fmt::Write as _, fs, path::Path};
use tyndall_files::FileError;
use tyndall_spectral::strategy::Rule;

/// Paths per second of the paper's 64 machines together: 15.86e9 paths in 7892 minutes, and 0.99e9 in 462.
pub const PAPER_RATE: f64 = 35_759.0;

/// A rule's name on the command line.
pub fn rule(rule: Rule) -> &'static str {
    match rule {
        Rule::Midpoint => "midpoint",
        Rule::Endpoints => "endpoints",
        Rule::Meyer => "meyer",
    }
}

/// Paths per second of a render.
pub fn rate(t: &Taken) -> f64 {
    t.shot.paths() / t.seconds
}

/// Writes all tables into `folder`.
pub fn write(folder: &Path, r: &Results) -> Result<(), Error> {
    let put = |name: &str, text: String| {
        let path = folder.join(name);
        fs::write(&path, text).map_err(|e| Error::from(FileError::io(&path, "write", e)))
    };
    put("figure-5.csv", figure_5())?;
    put("figure-6-systematic.csv", systematic(&r.points))?;
    put("figure-6-rendered.csv", rendered(&r.rendered))?;
    put("times.csv", times(r))?;
    put("colour-differences.csv", differences(r))?;
    put("bases.csv", bases(r))
}

fn figure_5() -> String {
    let (s, a) = (super::scenes::spectrum("fog-sigma-s.spd"), super::scenes::spectrum("fog-sigma-a.spd"));
    let mut out = String::from("lambda_nm,sigma_s_per_m,sigma_a_per_m\n");
    for nm in (380u16..=780).step_by(5) {
        let l = f32::from(nm);
        let _ = writeln!(out, "{nm},{},{}", s.eval(l), a.eval(l));
    }
    out
}

fn systematic(points: &[figure6::Point]) -> String {
    let mut out = String::from("lamp,medium,rule,N,rms_against_80,rms_against_1nm,noise\n");
    for p in points {
        let medium = if p.fog { "fog" } else { "clear" };
        let rule = rule(p.rule);
        let _ = writeln!(
            out,
            "{},{medium},{rule},{},{:.3e},{:.3e},{:.1e}",
            p.lamp, p.n, p.against_80, p.against_1nm, p.noise
        );
    }
    out
}

/// The rendered points of both rules.
pub fn rendered_points(shots: &[Taken]) -> Vec<figure6::Rendered> {
    let of = |rule: Rule| -> Vec<Taken> {
        shots.iter().filter(|t| t.shot.spectral.set().is_some_and(|s| s.1 == rule)).cloned().collect()
    };
    [Rule::Midpoint, Rule::Endpoints].iter().flat_map(|&rule| figure6::rendered(&of(rule), rule)).collect()
}

fn rendered(shots: &[Taken]) -> String {
    let mut out = String::from("rule,N,rms_with_noise,rms_of_noise,rms_without_noise\n");
    for p in rendered_points(shots) {
        let rest = (p.total * p.total - p.noise * p.noise).max(0.0).sqrt();
        let _ = writeln!(out, "{},{},{:.3e},{:.3e},{rest:.3e}", rule(p.rule), p.n, p.total, p.noise);
    }
    out
}

fn times(r: &Results) -> String {
    let mut out = String::from("name,paths,seconds,paths_per_second,against_the_paper\n");
    for t in r.pictures.iter().chain(&r.references).chain(&r.rendered).chain(&r.heroes) {
        let rate = rate(t);
        let _ = writeln!(
            out,
            "{},{},{:.2},{rate:.0},{:.2}",
            t.shot.name,
            t.shot.paths(),
            t.seconds,
            rate / PAPER_RATE
        );
    }
    out
}

/// Colour differences of all pictures of the fog against the reference, the second reference first.
pub fn colour_differences(r: &Results) -> Vec<(String, colour::Difference)> {
    let [truth, twin] = &r.references;
    let fog = r.pictures.iter().filter(|t| t.shot.scene != super::Scene::Clear);
    let against = |t: &Taken| (t.shot.name.clone(), colour::difference(t, truth));
    std::iter::once(twin).chain(fog).map(against).collect()
}

fn differences(r: &Results) -> String {
    let mut out = String::from("name,mean,percentile_95,worst,mean_of_noise_alone\n");
    for (name, d) in colour_differences(r) {
        let _ = writeln!(out, "{name},{:.3},{:.3},{:.3},{:.3}", d.mean, d.high, d.worst, d.noise);
    }
    out
}

fn bases(r: &Results) -> String {
    let mut out = String::from("lamp,method,coefficients,rms_per_path,delta_e_2000\n");
    for b in &r.bases {
        let _ = writeln!(out, "{},{},{},{:.3e},{:.3}", b.lamp, b.method, b.count, b.per_path, b.delta_e);
    }
    out
}
