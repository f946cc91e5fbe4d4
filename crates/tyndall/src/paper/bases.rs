//! Representations of spectra by few numbers, over recorded paths: Peercy's linear basis and the piecewise polynomials of
//! Raso and Fournier, beside as many point samples.
//!
//! Light is followed from the lamp to the eye. After every transmittance, albedo and reflectance the product is projected
//! on the basis again, by least squares over whole nanometres: a basis of few functions is not closed under
//! `exp(-sigma d)`. Point samples are closed under products; what they lose is lost in the last sum alone.
//!
//! M. S. Peercy, "Linear color representations for full spectral rendering", SIGGRAPH 1993: characteristic vectors of the
//! spectra of a scene, here of the lamp, its products with each reflectance, and with two of them. M. G. Raso, A. Fournier,
//! "A piecewise polynomial approach to shading using spectral distributions", Graphics Interface 1991: cubic pieces, here
//! of equal width.

use super::{
    Paper,
    scenes::{self, RANGE, Scene, path},
};
use crate::{Error, Options, Plan, Source, Spectral, plan};
use tyndall_base::{Vec3, math::f64 as math};
use tyndall_geometry::Ray;
use tyndall_integrators::observer::{Event, PathObserver, Vertex};
use tyndall_spectral::{
    Curve, Spectrum, Wavelengths, cie,
    colour::delta_e_2000,
    colour::lab,
    strategy::{FixedSet, Rule},
};
use tyndall_transport::MediumId;

/// Numbers of coefficients: multiples of the four of a cubic.
pub const COUNTS: [usize; 4] = [4, 8, 12, 16];
/// Values at whole nanometres.
const NODES: usize = 401;
/// What the study of one path costs against a path of one wavelength, as timed.
const COST: f64 = 5000.0;
/// Coefficients of one cubic.
const CUBIC: usize = 4;

type Values = Vec<f64>;

/// The error of a representation.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// `Peercy`, `Raso and Fournier` or `point samples`.
    pub method: &'static str,
    /// The lamp.
    pub lamp: &'static str,
    /// Coefficients.
    pub count: usize,
    /// Root mean square over paths of the error of X, Y, Z relative to the path's.
    pub per_path: f64,
    /// Colour difference of the light of all paths together (CIEDE2000).
    pub delta_e: f64,
}

/// Factors of a path's contribution, from the lamp to the eye.
type Factors = Vec<Values>;

/// Cost of the study over so many paths, in paths of one wavelength.
pub(super) fn cost(paths: usize) -> f64 {
    COST * paths as f64
}

fn lambda(i: usize) -> f32 {
    RANGE.min + i as f32
}

fn values(curve: &Curve) -> Values {
    (0..NODES).map(|i| f64::from(curve.eval(lambda(i)))).collect()
}

/// What the recorder keeps of a vertex.
#[derive(Clone, Copy)]
struct Kept {
    event: Event,
    p: Vec3,
    n: Vec3,
    distance: f32,
    medium: MediumId,
}

/// Keeps vertices, and how many there were when light was met.
#[derive(Default)]
struct Recorder {
    vertices: Vec<Kept>,
    lit: Option<usize>,
}

impl PathObserver<1> for Recorder {
    fn contribution(&mut self, _order: u32, value: &Spectrum<1>) {
        if value[0] > 0.0 && self.lit.is_none() {
            self.lit = Some(self.vertices.len());
        }
    }

    fn vertex(&mut self, v: &Vertex<1>) {
        let (event, p, n, distance, medium) = (v.event, v.p, v.n, v.distance, v.medium);
        self.vertices.push(Kept { event, p, n, distance, medium });
    }

    const WANTS_VERTICES: bool = true;
}

/// Paths of the fog scene that end on the lamp by chance, as factors per nanometre without the lamp's.
fn record(paper: &Paper<'_>, count: usize) -> Result<Vec<Factors>, Error> {
    let options = Options {
        spectral: Spectral::Opow { set: None },
        range: RANGE,
        integrator: Some("wang-chern".into()),
        resolution: Some([64; 2]),
        max_depth: Some(32),
        ..Options::default()
    };
    let plan = plan(Source::File(&path(&paper.scenes, Scene::Fog)), &options)?;
    let mut paths = Vec::new();
    for k in 0..4096 * 64u32 {
        if paths.len() == count {
            break;
        }
        let mut seen = Recorder::default();
        plan.pass.watch::<1>(k % 64, k / 64 % 64, k / 4096, &mut seen);
        // the lamp itself is told after the light it sends, paths that see it directly have no factor but fog
        if let Some(lit) = seen.lit.filter(|&lit| lit > 0) {
            paths.push(factors(&plan, &seen.vertices[..=lit.min(seen.vertices.len() - 1)]));
        }
    }
    Ok(paths)
}

/// The last vertex is the lamp: only the way to it counts.
fn factors(plan: &Plan, vertices: &[Kept]) -> Factors {
    let mut all = Factors::new();
    for (i, v) in vertices.iter().enumerate() {
        if let Some(m) = plan.pass.scene.medium(v.medium) {
            let sigma_t = |l| m.homogeneous(&one(l)).map_or(0.0, |m| m.sigma_t()[0]);
            let t = (0..NODES).map(|k| math::exp(-f64::from(sigma_t(lambda(k)) * v.distance)));
            all.push(t.collect());
        }
        if i + 1 < vertices.len() {
            all.extend(event(plan, v));
        }
    }
    all.reverse();
    all
}

fn one(lambda: f32) -> Wavelengths<1> {
    Wavelengths::continuum([lambda], [1.0])
}

/// Scattering coefficient or reflectance at a vertex.
fn event(plan: &Plan, v: &Kept) -> Option<Values> {
    let scene = &plan.pass.scene;
    match v.event {
        Event::Medium => {
            let m = scene.medium(v.medium)?;
            (0..NODES).map(|k| Some(f64::from(m.homogeneous(&one(lambda(k)))?.sigma_s[0]))).collect()
        }
        Event::Surface => {
            // the surface again, from just above it
            let ray = Ray::new(v.p + v.n * 1e-3, -v.n);
            let hit = scene.intersect(&ray)?;
            let isect = scene.interaction(&ray, &hit);
            let material = scene.materials.get(isect.binding.material.index())?;
            Some((0..NODES).map(|k| f64::from(material.albedo(&isect.surface, &one(lambda(k)))[0])).collect())
        }
        _ => None,
    }
}

/// Orthonormal functions by Gram and Schmidt; dependent ones are left out.
fn orthonormal(functions: &[Values]) -> Vec<Values> {
    let mut basis: Vec<Values> = Vec::new();
    for f in functions {
        let mut f = f.clone();
        let before = dot(&f, &f);
        // twice is enough
        for _ in 0..2 {
            for b in &basis {
                let c = dot(&f, b);
                f.iter_mut().zip(b).for_each(|(f, b)| *f -= c * b);
            }
        }
        let norm = dot(&f, &f);
        if norm > 1e-16 * before {
            let scale = 1.0 / norm.sqrt();
            basis.push(f.iter().map(|v| v * scale).collect());
        }
    }
    basis
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn product(a: &[f64], b: &[f64]) -> Values {
    a.iter().zip(b).map(|(a, b)| a * b).collect()
}

/// Peercy's basis: the characteristic vectors of the spectra that the scene without fog makes of the lamp, by the power
/// method on what is left of them.
fn characteristic(lamp: &Values, count: usize) -> Vec<Values> {
    let walls =
        ["cornell-white.spd", "cornell-green.spd", "cornell-red.spd"].map(|n| values(&scenes::spectrum(n)));
    let mut spectra = vec![lamp.clone()];
    for a in &walls {
        let once = product(lamp, a);
        spectra.extend(walls.iter().map(|b| product(&once, b)));
        // a third bounce gives enough independent spectra for 16 vectors
        spectra.extend(walls.iter().flat_map(|b| {
            let twice = product(&once, b);
            walls.iter().map(move |c| product(&twice, c)).collect::<Vec<_>>()
        }));
        spectra.push(once);
    }
    let mut left: Vec<Values> = spectra.clone();
    let mut basis = Vec::new();
    for _ in 0..count {
        let mut v = left.iter().max_by(|a, b| dot(a, a).total_cmp(&dot(b, b))).cloned().unwrap_or_default();
        for _ in 0..50 {
            let mut next = vec![0.0; NODES];
            for s in &left {
                let c = dot(s, &v);
                next.iter_mut().zip(s).for_each(|(n, s)| *n += c * s);
            }
            let norm = dot(&next, &next).sqrt();
            if norm <= 0.0 {
                break;
            }
            v = next.iter().map(|n| n / norm).collect();
        }
        for s in &mut left {
            let c = dot(s, &v);
            s.iter_mut().zip(&v).for_each(|(s, v)| *s -= c * v);
        }
        basis.push(v);
    }
    orthonormal(&basis)
}

/// Cubics on pieces of equal width.
fn cubics(count: usize) -> Vec<Values> {
    let pieces = count / CUBIC;
    let mut all = Vec::new();
    for piece in 0..pieces {
        let inside = |i: usize| i * pieces / NODES == piece;
        for power in 0..CUBIC {
            let x = |i: usize| 2.0 * (i as f64 * pieces as f64 / NODES as f64 - piece as f64) - 1.0;
            let value = |i| if inside(i) { (0..power).fold(1.0, |v, _| v * x(i)) } else { 0.0 };
            all.push((0..NODES).map(value).collect());
        }
    }
    orthonormal(&all)
}

fn project(basis: &[Values], f: &[f64]) -> Values {
    let mut out = vec![0.0; f.len()];
    for b in basis {
        let c = dot(f, b);
        out.iter_mut().zip(b).for_each(|(o, b)| *o += c * b);
    }
    out
}

fn xyz(spectrum: &[f64]) -> [f64; 3] {
    cie::matching_functions().each_ref().map(|bar| dot(spectrum, &values(bar)))
}

/// A path's light in a basis: projected after every factor.
fn reprojected(basis: &[Values], lamp: &Values, path: &Factors) -> [f64; 3] {
    let start = project(basis, lamp);
    xyz(&path.iter().fold(start, |light, f| project(basis, &product(&light, f))))
}

/// The same at points.
fn sampled(set: &FixedSet, lamp: &Values, path: &Factors) -> [f64; 3] {
    let at = |f: &Values, l: f32| {
        let x = f64::from(l - RANGE.min);
        let i = (x as usize).min(NODES - 2);
        f[i] + (x - i as f64) * (f[i + 1] - f[i])
    };
    let mut sum = [0.0; 3];
    for &l in set.lambda() {
        let light = path.iter().fold(at(lamp, l), |v, f| v * at(f, l)) * f64::from(set.weight());
        for (s, bar) in sum.iter_mut().zip(cie::matching_functions()) {
            *s += light * f64::from(bar.eval(l));
        }
    }
    sum
}

/// The study for lamps of these spectra.
pub(super) fn study(
    paper: &mut Paper<'_>,
    lamps: &[(&'static str, Curve)],
    paths: usize,
) -> Result<Vec<Row>, Error> {
    let paths = record(paper, paths)?;
    let mut rows = Vec::new();
    for (name, lamp) in lamps {
        let lamp = values(lamp);
        let exact: Vec<[f64; 3]> =
            paths.iter().map(|p| xyz(&p.iter().fold(lamp.clone(), |light, f| product(&light, f)))).collect();
        let white = xyz(&lamp);
        for count in COUNTS {
            let set = FixedSet::new(RANGE, count, Rule::Midpoint)?;
            let (peercy, raso) = (characteristic(&lamp, count), cubics(count));
            let mut row = |method, light: &dyn Fn(&Factors) -> [f64; 3]| {
                let got: Vec<[f64; 3]> = paths.iter().map(light).collect();
                rows.push(judge(method, name, count, &got, &exact, white));
            };
            row("Peercy", &|p| reprojected(&peercy, &lamp, p));
            row("Raso and Fournier", &|p| reprojected(&raso, &lamp, p));
            row("point samples", &|p| sampled(&set, &lamp, p));
            paper.tell(count as f64 / 16.0, None);
        }
    }
    Ok(rows)
}

fn judge(
    method: &'static str,
    lamp: &'static str,
    count: usize,
    got: &[[f64; 3]],
    exact: &[[f64; 3]],
    white: [f64; 3],
) -> Row {
    let relative = |(g, e): (&[f64; 3], &[f64; 3])| {
        let difference: f64 = (0..3).map(|c| (g[c] - e[c]) * (g[c] - e[c])).sum();
        difference / dot(e, e)
    };
    let squares: f64 = got.iter().zip(exact).map(relative).sum();
    // all paths together as a surface half as bright as white
    let sum = |all: &[[f64; 3]]| all.iter().fold([0.0; 3], |s, v| [s[0] + v[0], s[1] + v[1], s[2] + v[2]]);
    let (got, all) = (sum(got), sum(exact));
    let scale = 0.5 * white[1] / all[1];
    let shown = |v: [f64; 3]| lab(v.map(|v| v * scale), white);
    let delta_e = delta_e_2000(shown(got), shown(all));
    Row { method, lamp, count, per_path: (squares / exact.len() as f64).sqrt(), delta_e }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bases_are_orthonormal_and_hold_what_they_should() {
        let lamp = values(&scenes::lamp());
        for basis in [characteristic(&lamp, 8), cubics(8)] {
            assert_eq!(basis.len(), 8);
            for (i, a) in basis.iter().enumerate() {
                for (j, b) in basis.iter().enumerate() {
                    assert!((dot(a, b) - f64::from(u8::from(i == j))).abs() < 1e-9);
                }
            }
        }
        // a spectrum that the first basis was made for, and a polynomial for the second
        let lit = product(&lamp, &values(&scenes::spectrum("cornell-white.spd")));
        let rest = |basis: &[Values], f: &Values| {
            let p = project(basis, f);
            f.iter().zip(&p).map(|(a, b)| (a - b) * (a - b)).sum::<f64>() / dot(f, f)
        };
        assert!(rest(&characteristic(&lamp, 8), &lit) < 1e-5);
        let cubic: Values = (0..NODES).map(|i| 1.0 + (i as f64 / 400.0) * (i as f64 / 400.0)).collect();
        assert!(rest(&cubics(4), &cubic) < 1e-12);
    }

    #[test]
    fn more_coefficients_do_better_on_a_smooth_path() {
        let lamp = values(&scenes::lamp());
        let fog = values(&scenes::spectrum("fog-sigma-s.spd"));
        let path: Factors =
            vec![fog.iter().map(|s| math::exp(-s)).collect(), values(&scenes::spectrum("cornell-red.spd"))];
        let exact = xyz(&product(&product(&lamp, &path[0]), &path[1]));
        let error = |got: [f64; 3]| (0..3).map(|c| (got[c] / exact[c] - 1.0).abs()).fold(0.0, f64::max);
        let raso = |n| error(reprojected(&cubics(n), &lamp, &path));
        assert!(raso(16) < raso(4) && raso(16) < 0.02, "{} {}", raso(4), raso(16));
        let set = FixedSet::new(RANGE, 16, Rule::Midpoint).unwrap();
        assert!(error(sampled(&set, &lamp, &path)) < 0.02);
    }
}
