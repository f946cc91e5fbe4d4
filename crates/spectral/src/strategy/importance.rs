//! Densities that follow what the film will see.
//!
//! With film responses `r_k` (colour matching functions, bands) and the emission `S` of all lights,
//! `p(lambda) ~ 0.9 sqrt(sum_k (r_k S / integral of r_k S)^2) + 0.1 uniform`, the norm being the density that minimises the
//! summed relative variances of the channels for a scene without colour of its own. Lines take part with their power
//! in place of power per nm, and get probabilities.
//!
//! Relative variance of X, Y, Z, mean over the 24 ColorChecker patches, 1 / 8 wavelengths, by quadrature: uniform
//! 3.16 / 0.008 (D65), 7.96 / 0.61 (F11); 1/cosh^2 of pbrt-v4 1.93 / 0.002, 5.32 / 0.41; [`Density::visible`] 1.05 / 0.005,
//! 3.21 / 0.12; [`Density::light`] 1.04 / 0.006, 1.11 / 0.009.

use super::density::{Density, Weights, cell_count};
use crate::cie;
use crate::curve::Curve;
use crate::emission::{Emission, Line};
use crate::error::{SpectralError, require};
use crate::range::LambdaRange;

/// Share of the uniform density, so that no wavelength that the film sees is starved.
pub const UNIFORM_SHARE: f64 = 0.1;
/// Points per cell at which curves are averaged: lamps' spectra can be narrow.
const POINTS: usize = 4;

impl Density {
    /// The norm of the CIE 1931 colour matching functions, and 10 % uniform.
    pub fn visible(range: LambdaRange) -> Result<Self, SpectralError> {
        Self::light(range, cie::matching_functions(), &[(1.0, &Curve::ONE.into())])
    }

    /// Follows `responses` (the film's channels) times the weighted sum of `sources`, and 10 % uniform. Lines of the
    /// sources inside `range` become lines of the density, by ascending wavelength.
    pub fn light(
        range: LambdaRange,
        responses: &[Curve],
        sources: &[(f32, &Emission)],
    ) -> Result<Self, SpectralError> {
        let lines = gather_lines(range, sources)?;
        let emission =
            |l: f32| sources.iter().map(|(w, s)| f64::from(w * s.continuum().eval(l))).sum::<f64>();
        let cells = cell_count(range);
        let mut norm = vec![0.0f64; cells + lines.len()];
        for response in responses {
            let product = |l: f32| f64::from(response.eval(l)).max(0.0);
            let mut seen: Vec<f64> = (0..cells)
                .map(|i| cell_points(range, cells, i).map(|l| product(l) * emission(l)).sum::<f64>())
                .map(|sum| sum / POINTS as f64 * f64::from(range.width()) / cells as f64)
                .collect();
            seen.extend(lines.iter().map(|l| product(l.lambda) * f64::from(l.power)));
            let total: f64 = seen.iter().sum();
            require(total.is_finite(), "light that the film sees", "finite values on its range", total)?;
            if total > 0.0 {
                norm.iter_mut().zip(&seen).for_each(|(n, s)| *n += (s / total) * (s / total));
            }
        }
        norm.iter_mut().for_each(|n| *n = n.sqrt());
        let total: f64 = norm.iter().sum();
        if total <= 0.0 {
            return Err(SpectralError::NoPower("the light that the film can see", range.min, range.max));
        }
        norm.iter_mut().for_each(|n| *n *= (1.0 - UNIFORM_SHARE) / total);
        add_floor(&mut norm, cells, UNIFORM_SHARE);
        Ok(with_lines(range, norm, cells, &lines))
    }

    /// Uniform over `range`, with the probability `share` given to lines in equal parts. Lines outside are left out.
    pub fn uniform_with_lines(range: LambdaRange, lines: &[Line], share: f64) -> Result<Self, SpectralError> {
        require(share > 0.0 && share < 1.0, "probability of the lines", "between 0 and 1", share)?;
        let lamp = Emission::new(Curve::ZERO, lines)?;
        let lines = gather_lines(range, &[(1.0, &lamp)])?;
        if lines.is_empty() {
            return Ok(Self::uniform(range));
        }
        let cells = cell_count(range);
        let mut masses = vec![(1.0 - share) / cells as f64; cells];
        masses.extend(lines.iter().map(|_| share / lines.len() as f64));
        Ok(with_lines(range, masses, cells, &lines))
    }
}

/// Wavelengths at which cell `i` is looked at.
fn cell_points(range: LambdaRange, cells: usize, i: usize) -> impl Iterator<Item = f32> {
    let nm = f64::from(range.width()) / (cells * POINTS) as f64;
    (0..POINTS).map(move |j| (f64::from(range.min) + ((i * POINTS + j) as f64 + 0.5) * nm) as f32)
}

/// All lines inside `range`, weighted powers of equal wavelengths added.
fn gather_lines(range: LambdaRange, sources: &[(f32, &Emission)]) -> Result<Vec<Line>, SpectralError> {
    let weighted = |(w, s): &(f32, &Emission)| s.scaled(*w).lines().to_vec();
    let all: Vec<Line> = sources.iter().flat_map(weighted).filter(|l| range.contains(l.lambda)).collect();
    Ok(Emission::new(Curve::ZERO, &all)?.lines().iter().copied().filter(|l| l.power > 0.0).collect())
}

/// Half of `share` to the cells and half to the lines, all of it to the cells when there are no lines.
fn add_floor(masses: &mut [f64], cells: usize, share: f64) {
    let (continuum, lines) = masses.split_at_mut(cells);
    let to_lines = if lines.is_empty() { 0.0 } else { 0.5 * share };
    continuum.iter_mut().for_each(|m| *m += (share - to_lines) / cells as f64);
    let per_line = to_lines / lines.len().max(1) as f64;
    lines.iter_mut().for_each(|m| *m += per_line);
}

fn with_lines(range: LambdaRange, mut masses: Vec<f64>, cells: usize, lines: &[Line]) -> Density {
    let probabilities = masses.split_off(cells);
    let lines = lines.iter().map(|l| l.lambda).zip(probabilities).collect();
    Weights { range, cells: masses, lines }.into()
}
