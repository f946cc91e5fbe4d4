//! A medium that varies in space and emits, as a light: points are drawn where it emits much.
//!
//! Emission along a ray is an integral over the distance `t`, so a point is drawn by volume and its density is counted per
//! solid angle and length. With `p_V` \[1/m^3\] the density of a point `y`, as seen from `x`:
//!
//! ```text
//! dV = t^2 dw dt,   p(w, t) = p_V(y) |y - x|^2   [1/(sr m)]
//! ```
//!
//! `p_V` is constant in each cell of a regular grid, in proportion to the mean over wavelength of what the cell emits,
//! `sigma_a le`, by some points in it. A cell that these miss is left to chance, which finds it in any case.

use crate::{TransportError, ids::MediumId, media::Heterogeneous};
use std::sync::Arc;
use tyndall_base::{Vec3, distribution::Alias, vec::vec3};
use tyndall_geometry::Bounds3;
use tyndall_spectral::{Emission, LambdaRange, Spectrum, Wavelengths};

/// Cells at most: beyond that they have more than a voxel.
const MOST_CELLS: usize = 1 << 17;
/// Points along an edge of a cell at which emission is looked up, at least and at most.
const POINTS: [usize; 2] = [2, 4];
/// Wavelengths at which it is looked up.
const PROBES: usize = 8;
/// Of these for the strongest lines of the spectrum, at most.
const LINE_PROBES: usize = 4;
/// Points are near what emits up to this many times its radius, from its middle: beyond that it covers at most 0.8 sr.
const NEAR: f32 = 2.0;

/// See the module.
#[derive(Clone, Debug)]
pub struct VolumeLight {
    medium: MediumId,
    matter: Arc<Heterogeneous>,
    spectrum: Emission,
    /// `integral of sigma_a le dV` over `spectrum` \[m^2\].
    cross_section: f64,
    cells: Grid,
    alias: Alias,
    /// Density of a point per volume of the world \[1/m^3\], by cell.
    density: Vec<f32>,
    bounds: Bounds3,
    everywhere: bool,
}

/// A point that emits.
#[derive(Clone, Copy, Debug)]
pub struct VolumePoint {
    /// The point \[m\].
    pub p: Vec3,
    /// Density per volume \[1/m^3\].
    pub pdf: f32,
}

/// Cells that fill a box of the medium's own space.
#[derive(Clone, Copy, Debug)]
struct Grid {
    lo: Vec3,
    edge: Vec3,
    dims: [usize; 3],
}

impl Grid {
    /// Cells of at least a voxel, `detail` long; also the voxels along an edge. `None` for boxes beyond measure.
    fn new(b: Bounds3, detail: f32) -> Option<(Self, usize)> {
        let extent = b.extent();
        let sides = [extent.x, extent.y, extent.z].map(f64::from);
        let detail = f64::from(detail);
        if !(detail > 0.0 && sides.iter().all(|e| *e > 0.0 && e.is_finite())) {
            return None;
        }
        let count = |edge: f64| sides.map(|e| (e / edge).ceil().max(1.0));
        let mut longest = detail;
        while count(longest).iter().product::<f64>() > MOST_CELLS as f64 {
            longest *= 1.25;
        }
        let dims = count(longest).map(|n| n as usize);
        let edge = vec3(extent.x / dims[0] as f32, extent.y / dims[1] as f32, extent.z / dims[2] as f32);
        Some((Self { lo: b.lo, edge, dims }, (longest / detail).ceil() as usize))
    }

    fn len(&self) -> usize {
        self.dims.iter().product()
    }

    /// Corner of a cell.
    #[inline(always)]
    fn corner(&self, cell: usize) -> Vec3 {
        let [nx, ny, _] = self.dims;
        let at = vec3((cell % nx) as f32, (cell / nx % ny) as f32, (cell / (nx * ny)) as f32);
        self.lo + self.edge.hadamard(at)
    }

    /// The cell of a point.
    #[inline(always)]
    fn cell(&self, p: Vec3) -> usize {
        let v = p - self.lo;
        let at = |x: f32, edge: f32, n: usize| ((x / edge).max(0.0) as usize).min(n - 1);
        let [nx, ny, nz] = self.dims;
        let (x, y, z) = (at(v.x, self.edge.x, nx), at(v.y, self.edge.y, ny), at(v.z, self.edge.z, nz));
        (z * ny + y) * nx + x
    }
}

impl VolumeLight {
    /// The light of medium `medium`; `None` where nothing is found to emit. `everywhere`: also for points near what emits.
    pub fn new(
        medium: MediumId,
        matter: &Arc<Heterogeneous>,
        everywhere: bool,
    ) -> Result<Option<Self>, TransportError> {
        let Some(spectrum) = matter.emission().cloned() else { return Ok(None) };
        let Some((cells, voxels)) = Grid::new(matter.grid_bounds(), matter.grid_detail()) else {
            return Ok(None);
        };
        let probes = probes(&spectrum, matter.range());
        let per_volume = |e: Spectrum<PROBES>| measure(&e, &probes, matter.range());
        let steps = voxels.clamp(POINTS[0], POINTS[1]);
        let weights: Vec<f64> = matter.with_emission(&probes, |emitted| {
            (0..cells.len())
                .map(|c| mean_over(cells.corner(c), cells.edge, steps, |p| per_volume(emitted(p))))
                .collect()
        });
        let total: f64 = weights.iter().sum();
        let unit = per_volume(spectrum.sample(&probes));
        if !(total > 0.0 && total.is_finite() && unit > 0.0) {
            return Ok(None);
        }
        let alias = Alias::new(&weights)
            .map_err(|e| TransportError::Unusable { what: "emission of a medium", why: e.to_string() })?;
        let sides = [cells.edge.x, cells.edge.y, cells.edge.z].map(f64::from);
        let cell_volume = sides.iter().product::<f64>() * matter.volume_scale();
        let density: Vec<f32> =
            (0..cells.len()).map(|c| (f64::from(alias.pmf(c)) / cell_volume) as f32).collect();
        let cross_section = total * cell_volume / unit;
        // boxes of the size of atoms or galaxies leave the range of f32: chance finds what they emit
        let in_range = |c: usize| density[c].is_normal() || (density[c] == 0.0 && weights[c] == 0.0);
        if !((0..cells.len()).all(in_range) && (cross_section as f32).is_normal()) {
            return Ok(None);
        }
        let emitting = (0..cells.len()).filter(|&c| weights[c] > 0.0);
        let corners = emitting.flat_map(|c| [cells.corner(c), cells.corner(c) + cells.edge]);
        let bounds = matter.to_world_bounds(Bounds3::from_points(corners));
        let matter = Arc::clone(matter);
        Ok(Some(Self { medium, matter, spectrum, cross_section, cells, alias, density, bounds, everywhere }))
    }

    /// The medium.
    pub fn medium(&self) -> MediumId {
        self.medium
    }

    /// What emits.
    #[inline(always)]
    pub fn matter(&self) -> &Heterogeneous {
        &self.matter
    }

    /// An emission of the kind found in the medium.
    pub fn spectrum(&self) -> &Emission {
        &self.spectrum
    }

    /// `integral of sigma_a le dV` over [`Self::spectrum`] \[m^2\]: the power is 4 pi times this times the spectrum.
    pub fn cross_section(&self) -> f64 {
        self.cross_section
    }

    /// The box of what emits, in the world.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    /// Whether points near [`Self::bounds`] are left to chance.
    pub fn is_hollow(&self) -> bool {
        !self.everywhere
    }

    /// Whether points are drawn for `x`: a function of `x` alone, so that all techniques agree on it.
    #[inline(always)]
    pub fn serves(&self, x: Vec3) -> bool {
        self.everywhere || !is_near(self.bounds, x)
    }

    /// Draws a point by four numbers of \[0, 1).
    #[inline]
    pub fn sample(&self, u: [f32; 4]) -> VolumePoint {
        let cell = self.alias.sample(u[0]);
        let p = self.cells.corner(cell) + self.cells.edge.hadamard(vec3(u[1], u[2], u[3]));
        VolumePoint { p: self.matter.world_of(p), pdf: self.density[cell] }
    }

    /// Density per volume of the world with which [`Self::sample`] draws the point `p` of the medium's own space.
    #[inline(always)]
    pub fn pdf_at(&self, p: Vec3) -> f32 {
        self.density[self.cells.cell(p)]
    }
}

/// Whether `x` is so near that what emits fills much of its sky, where chance does as well for less.
#[inline(always)]
pub(super) fn is_near(emitting: Bounds3, x: Vec3) -> bool {
    let radius2 = (emitting.extent() * 0.5).length_squared();
    (x - emitting.centre()).length_squared() <= NEAR * NEAR * radius2
}

/// Wavelengths over the range, the last of them on the strongest lines.
fn probes(spectrum: &Emission, range: LambdaRange) -> Wavelengths<PROBES> {
    let mut lines: Vec<_> = spectrum.lines().iter().filter(|l| range.contains(l.lambda)).collect();
    lines.sort_by(|a, b| b.power.total_cmp(&a.power));
    lines.truncate(LINE_PROBES);
    let first = PROBES - lines.len();
    let mut w = Wavelengths::continuum([range.min; PROBES], [1.0; PROBES]);
    for k in 0..PROBES {
        w.lambda[k] = range.min + range.width() * (k as f32 + 0.5) / first as f32;
        if k >= first {
            (w.lambda[k], w.line[k]) = (lines[k - first].lambda, k as u16);
        }
    }
    w
}

/// Integral over wavelength by the probes.
fn measure(e: &Spectrum<PROBES>, w: &Wavelengths<PROBES>, range: LambdaRange) -> f64 {
    let continuum = (0..PROBES).filter(|&k| !w.on_line(k)).count();
    let share = f64::from(range.width()) / continuum as f64;
    (0..PROBES).map(|k| f64::from(e[k]) * if w.on_line(k) { 1.0 } else { share }).sum()
}

/// Mean of `f` over a box by `steps^3` midpoints.
fn mean_over(lo: Vec3, edge: Vec3, steps: usize, f: impl Fn(Vec3) -> f64) -> f64 {
    let at = |i: usize| (i as f32 + 0.5) / steps as f32;
    let mut sum = 0.0;
    for z in 0..steps {
        for y in 0..steps {
            for x in 0..steps {
                sum += f(lo + edge.hadamard(vec3(at(x), at(y), at(z))));
            }
        }
    }
    sum / (steps * steps * steps) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::media::{Dense, Edge, Model, emission::Source, model::Separable};
    use tyndall_geometry::Transform;
    use tyndall_scatter::phase::PhaseFunction;
    use tyndall_spectral::{Curve, Line, Outside};
    use tyndall_testkit::{Rng, Welford};

    /// A grid with empty voxels in a box that is stretched and sheared; `le` per voxel over a spectrum.
    fn matter(le: Emission) -> Arc<Heterogeneous> {
        let dims = [5, 4, 3];
        let density: Vec<f32> =
            (0..60).map(|i| if i % 5 < 3 { 0.5 + 0.05 * (i % 11) as f32 } else { 0.0 }).collect();
        let scale: Vec<f32> = (0..60).map(|i| 1.0 + 0.1 * (i % 7) as f32).collect();
        let density = Dense::new(dims, &density, Edge::Clamp).expect("valid");
        let scale = Dense::new(dims, &scale, Edge::Fade);
        let source = Some(Source::Spectrum { le, scale: Some(scale.expect("valid")) });
        let model = Separable {
            density,
            sigma_a: Curve::linear(&[400.0, 700.0], &[0.5, 2.0], Outside::Hold).expect("valid"),
            sigma_s: Curve::ONE,
            source,
            phase: PhaseFunction::Isotropic,
        };
        #[rustfmt::skip]
        let place = Transform::from_columns([
            0.2, 0.0, 0.1, 0.0,
            0.05, 0.3, 0.0, 0.0,
            0.0, -0.1, 0.5, 0.0,
            3.0, -2.0, 1.0, 1.0,
        ]);
        let range = LambdaRange::new(400.0, 700.0).expect("valid");
        let made = Heterogeneous::new(Model::Dense(model), place.expect("valid"), 1.0, range);
        Arc::new(made.expect("valid"))
    }

    fn light(le: Emission) -> VolumeLight {
        let light = VolumeLight::new(MediumId(0), &matter(le), true).expect("valid");
        light.expect("it emits")
    }

    /// Points lie where the density says, and the mean of emission over density is the power in every lane.
    #[test]
    fn points_follow_their_density() {
        let light = light(Curve::ONE.into());
        let w = Wavelengths::<4>::continuum([430.0, 500.0, 600.0, 690.0], [1.0; 4]);
        // sigma_a at these; its mean over wavelength is 1.25
        let sigma_a = [0.65, 1.0, 1.5, 1.95];
        let mut rng = Rng::new(7);
        let mut power = [Welford::default(); 4];
        let mut strays = 0;
        for _ in 0..50_000 {
            let ([a, b], [c, d]) = (rng.f32x2(), rng.f32x2());
            let y = light.sample([a, b, c, d]);
            // a point on a face of its cell may be rounded into the next
            strays += u32::from(light.pdf_at(light.matter().to_grid(y.p)) != y.pdf);
            assert!(light.bounds().padded(Vec3::splat(1e-4)).contains(y.p));
            let Some([emitted, majorant]) = light.matter().glow_at(y.p, &w) else { continue };
            let there = light.matter().at(y.p, &w);
            assert_eq!(there.emitted, emitted);
            for k in 0..4 {
                assert!(majorant[k] >= there.sigma_a[k] + there.sigma_s[k]);
                power[k].add(f64::from(emitted[k] / y.pdf));
            }
        }
        assert!(strays < 10, "{strays}");
        // two points an axis know the power to some percent
        let grey = light.cross_section() / 1.25;
        for (k, sigma_a) in sigma_a.into_iter().enumerate() {
            let got = power[k].mean() / sigma_a;
            assert!((got / grey - 1.0).abs() < 0.05, "{got} {grey}");
            assert!((got / power[1].mean() - 1.0).abs() < 1e-4, "{got}");
        }
    }

    /// All points have a density, and the integral of it is 1.
    #[test]
    fn the_density_has_norm_one() {
        let light = light(Curve::ONE.into());
        let edge = light.cells.edge;
        let volume = f64::from(edge.x * edge.y * edge.z) * light.matter.volume_scale();
        let sum: f64 = light.density.iter().map(|d| f64::from(*d) * volume).sum();
        assert!((sum - 1.0).abs() < 1e-5, "{sum}");
        assert!(light.density.contains(&0.0), "a grid with empty cells");
    }

    /// Boxes without measure in f32 are no lights, and take no time.
    #[test]
    fn boxes_beyond_measure_are_left_to_chance() {
        let b = |x: f32| Bounds3::new(Vec3::ZERO, vec3(x, 1.0, 1.0));
        assert!(Grid::new(b(f32::INFINITY), 1.0).is_none() && Grid::new(b(f32::NAN), 1.0).is_none());
        assert!(Grid::new(b(0.0), 1.0).is_none() && Grid::new(b(1.0), 0.0).is_none());
        for (x, detail) in [(3e38, 1e-38), (1e30, 1.0), (400.0, 0.5), (1e-30, 1.0)] {
            let (grid, voxels) = Grid::new(b(x), detail).expect("finite");
            assert!((1..=MOST_CELLS).contains(&grid.len()) && voxels >= 1, "{x} {detail}: {grid:?}");
        }
    }

    /// A spectrum of lines alone has its power in them.
    #[test]
    fn lines_count() {
        let lines = [Line { lambda: 546.1, power: 2.0 }, Line { lambda: 435.8, power: 1.0 }];
        let light = light(Emission::new(Curve::ZERO, &lines).expect("valid"));
        assert!(light.cross_section() > 0.0);
        let dark = VolumeLight::new(MediumId(0), &matter(Curve::ZERO.into()), true).expect("valid");
        assert!(dark.is_none());
    }
}
