//! Figure 6: the error of N fixed wavelengths against 80, and what it is made of.
//!
//! From spectra whose noise is common to all wavelengths ([`super::sweep`]) the systematic error of any set follows: with
//! `d` the difference of two quadratures at a pixel in linear sRGB, and `d_1, d_2` from independent halves of the
//! samples, `mean(d_1 d_2)` has the mean square of the systematic error as its expectation, and
//! `mean((d_1 - d_2)^2) / 4` is the mean square of the noise.

use super::{
    scenes::RANGE,
    shots::Taken,
    sweep::{self, HALVES, Sweep},
};
use crate::Error;
use tyndall_spectral::{
    Curve, cie,
    colour::{ColourSpace, SpaceName},
    strategy::{FixedSet, Rule},
};

/// The paper's numbers of wavelengths; the last is the reference.
pub const SIZES: [u32; 5] = [5, 10, 20, 40, 80];
/// Pixels brighter than this, in units of white, are the lamp and do not count.
const LAMP: f64 = 2.0;

/// The error of one set.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// `D65` or `F11`.
    pub lamp: &'static str,
    /// With fog or without.
    pub fog: bool,
    /// Where the wavelengths lie.
    pub rule: Rule,
    /// How many.
    pub n: u32,
    /// Root mean square of the systematic error against 80 wavelengths of the rule, white = 1.
    pub against_80: f64,
    /// The same against 1 nm.
    pub against_1nm: f64,
    /// Root mean square of the noise in the former.
    pub noise: f64,
}

/// Weights with which a transfer spectrum becomes linear sRGB.
struct Quadrature(Vec<(f64, [f64; 3])>);

impl Quadrature {
    fn new(set: &FixedSet, lamp: &Curve) -> Result<Self, Error> {
        let own = if set.lambda().len() == 4 && is_meyer(set) { Some(set.responses()?) } else { None };
        let bars = own.as_ref().unwrap_or_else(|| cie::matching_functions());
        let to_rgb = ColourSpace::get(SpaceName::Srgb).rgb_from_xyz;
        let weight = f64::from(set.weight());
        let terms = set.lambda().iter().map(|&l| {
            let light = weight * f64::from(lamp.eval(l));
            let xyz = bars.each_ref().map(|bar| light * f64::from(bar.eval(l)));
            (f64::from(l), to_rgb.apply(xyz))
        });
        Ok(Self(terms.collect()))
    }

    /// The sum over whole nanometres, the ends counted half.
    fn fine(lamp: &Curve) -> Self {
        let to_rgb = ColourSpace::get(SpaceName::Srgb).rgb_from_xyz;
        let terms = (0..sweep::NODES).map(|i| {
            let l = RANGE.min + i as f32;
            let end = if i == 0 || i == sweep::NODES - 1 { 0.5 } else { 1.0 };
            let light = end * f64::from(lamp.eval(l));
            let xyz = cie::matching_functions().each_ref().map(|bar| light * f64::from(bar.eval(l)));
            (f64::from(l), to_rgb.apply(xyz))
        });
        Self(terms.collect())
    }

    fn rgb(&self, transfer: &[f32]) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (lambda, rgb) in &self.0 {
            let v = sweep::at(transfer, *lambda);
            (0..3).for_each(|c| sum[c] += v * rgb[c]);
        }
        sum
    }

    /// Image per half.
    fn image(&self, sweep: &Sweep) -> Vec<Vec<[f64; 3]>> {
        (0..HALVES).map(|h| (0..sweep.pixels()).map(|p| self.rgb(sweep.spectrum(h, p))).collect()).collect()
    }
}

fn is_meyer(set: &FixedSet) -> bool {
    FixedSet::new(set.range(), 4, Rule::Meyer).is_ok_and(|m| m.lambda() == set.lambda())
}

/// Luminance of linear sRGB.
pub fn luminance(rgb: &[f64; 3]) -> f64 {
    let y = ColourSpace::get(SpaceName::Srgb).xyz_from_rgb.0[1];
    (0..3).map(|c| y[c] * rgb[c]).sum()
}

/// The luminance that counts as white: the 99th percentile of an image.
pub fn white(image: &[[f64; 3]]) -> f64 {
    let mut y: Vec<f64> = image.iter().map(luminance).collect();
    y.sort_by(f64::total_cmp);
    y.get(y.len() * 99 / 100).copied().filter(|w| *w > 0.0).unwrap_or(1.0)
}

/// Mean square of the systematic part of `a - b` and of its noise, in units of white.
fn compare(a: &[Vec<[f64; 3]>], b: &[Vec<[f64; 3]>], white: f64) -> (f64, f64) {
    let (mut systematic, mut noise, mut count) = (0.0, 0.0, 0.0);
    for p in 0..a[0].len() {
        if luminance(&b[0][p]) > LAMP * white {
            continue;
        }
        for c in 0..3 {
            let d = |h: usize| (a[h][p][c] - b[h][p][c]) / white;
            systematic += d(0) * d(1);
            noise += (d(0) - d(1)) * (d(0) - d(1)) / 4.0;
            count += 1.0;
        }
    }
    (systematic / count, noise / count)
}

/// All sets for one lamp and scene, Meyer's four among them.
pub fn points(sweep: &Sweep, lamp: (&'static str, &Curve), fog: bool) -> Result<Vec<Point>, Error> {
    let fine = Quadrature::fine(lamp.1).image(sweep);
    let white = white(&fine[0]);
    let image = |n: u32, rule| -> Result<_, Error> {
        Ok(Quadrature::new(&FixedSet::new(RANGE, n as usize, rule)?, lamp.1)?.image(sweep))
    };
    let mut points = Vec::new();
    for rule in [Rule::Midpoint, Rule::Endpoints] {
        let reference = image(80, rule)?;
        let sets = SIZES.iter().map(|&n| (n, rule));
        let meyer = (rule == Rule::Midpoint).then_some((4, Rule::Meyer));
        for (n, rule) in sets.chain(meyer) {
            let set = image(n, rule)?;
            let (square, noise) = compare(&set, &reference, white);
            let (square_fine, _) = compare(&set, &fine, white);
            let root = |v: f64| v.max(0.0).sqrt();
            points.push(Point {
                lamp: lamp.0,
                fog,
                rule,
                n,
                against_80: root(square),
                against_1nm: root(square_fine),
                noise: root(noise),
            });
        }
    }
    Ok(points)
}

/// What the paper's procedure measures: the error of a render against that of 80 wavelengths, noise of both included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rendered {
    /// Wavelengths.
    pub n: u32,
    /// Where they lie.
    pub rule: Rule,
    /// Root mean square difference, white = 1.
    pub total: f64,
    /// What noise alone would make of it, from the standard errors.
    pub noise: f64,
}

/// Compares the renders of one rule with the last of them.
pub fn rendered(shots: &[Taken], rule: Rule) -> Vec<Rendered> {
    let Some(last) = shots.last() else { return Vec::new() };
    let white = white(&last.rgb);
    let one = |t: &Taken| {
        let (mut total, mut noise, mut count) = (0.0, 0.0, 0.0);
        for p in (0..last.rgb.len()).filter(|&p| luminance(&last.rgb[p]) <= LAMP * white) {
            for c in 0..3 {
                let d = (t.rgb[p][c] - last.rgb[p][c]) / white;
                total += d * d;
                noise +=
                    (t.error[p][c] * t.error[p][c] + last.error[p][c] * last.error[p][c]) / (white * white);
                count += 1.0;
            }
        }
        let n = t.shot.spectral.set().map_or(0, |s| s.0);
        // the last against itself has no difference, and no noise
        let noise = if n == 80 { 0.0f64 } else { noise };
        Rendered { n, rule, total: (total / count).sqrt(), noise: (noise / count).sqrt() }
    };
    shots.iter().map(one).collect()
}

/// Root mean square of the standard errors of a render, white = 1: the whole error of a strategy without bias.
pub fn noise(t: &Taken) -> f64 {
    let white = white(&t.rgb);
    let counted = (0..t.rgb.len()).filter(|&p| luminance(&t.rgb[p]) <= LAMP * white);
    let squares: Vec<f64> = counted.flat_map(|p| t.error[p].map(|e| (e / white) * (e / white))).collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_spectral::{Outside, illuminant::illuminant};

    /// Quadratures of a flat transfer are those of the lamp; Meyer's four come close.
    #[test]
    fn quadratures_of_the_lamp() {
        let lamp = illuminant("D65", Outside::Hold).unwrap();
        let flat = vec![1.0; sweep::NODES];
        let fine = Quadrature::fine(&lamp).rgb(&flat);
        for (n, rule, bound) in
            [(80, Rule::Midpoint, 1e-3), (80, Rule::Endpoints, 0.02), (4, Rule::Meyer, 0.15)]
        {
            let set = FixedSet::new(RANGE, n, rule).unwrap();
            let got = Quadrature::new(&set, &lamp).unwrap().rgb(&flat);
            for (g, f) in got.iter().zip(fine) {
                assert!((g / f - 1.0).abs() < bound, "{n} {rule:?}: {got:?} {fine:?}");
            }
        }
    }

    #[test]
    fn white_is_bright_but_not_the_brightest() {
        let image: Vec<[f64; 3]> = (0..1000).map(|i| [f64::from(i) / 1000.0; 3]).collect();
        assert!((white(&image) - 0.99).abs() < 1e-3);
    }
}
