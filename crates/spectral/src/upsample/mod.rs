//! Smooth spectra from RGB, as pbrt-v4 makes them.
//!
//! - *albedo* (values in \[0, 1\]): the sigmoid whose product with the colour space's white has this RGB;
//! - *unbounded*: `2 m` times the albedo of `rgb / (2 m)`, `m` the greatest component;
//! - *illuminant*: the unbounded spectrum times the white's spectrum (Y = 1).
//!
//! Grey is a constant. Source: Jakob, Hanika, "A low-dimensional function space for efficient spectral upsampling",
//! Computer Graphics Forum 38(2), 2019. Values here are solved for exactly; [`RgbTable`] holds the paper's table, whose
//! interpolation pbrt-v4 uses everywhere, for textures. Extinction coefficients should come from spectra: what RGB does
//! not fix (the colour after a long way) is made up here.

mod solve;
mod table;

use std::sync::OnceLock;

pub use table::RgbTable;

use crate::colour::{ColourSpace, SpaceName};
use crate::curve::{Curve, SigmoidPolynomial};
use crate::error::{SpectralError, require};
use solve::{Effort, Quadrature};

/// The sigmoid of an RGB reflectance in \[0, 1\].
pub fn albedo(space: SpaceName, rgb: [f32; 3]) -> Result<Curve, SpectralError> {
    for c in rgb {
        require((0.0..=1.0).contains(&c), "RGB reflectance", "components from 0 to 1", f64::from(c))?;
    }
    Ok(Curve::Sigmoid(coefficients(space, rgb)))
}

/// The scaled sigmoid of any RGB >= 0.
pub fn unbounded(space: SpaceName, rgb: [f32; 3]) -> Result<Curve, SpectralError> {
    for c in rgb {
        require(c >= 0.0 && c.is_finite(), "RGB value", "finite components >= 0", f64::from(c))?;
    }
    let scale = 2.0 * rgb[0].max(rgb[1]).max(rgb[2]);
    if scale == 0.0 {
        return Ok(Curve::ZERO);
    }
    Ok(Curve::ScaledSigmoid(scale, coefficients(space, rgb.map(|c| c / scale))))
}

/// The scaled sigmoid times the white of the colour space, for RGB lights.
pub fn illuminant(space: SpaceName, rgb: [f32; 3]) -> Result<Curve, SpectralError> {
    Ok(unbounded(space, rgb)?.times(&ColourSpace::get(space).illuminant))
}

/// Coefficients for RGB in \[0, 1\], solved with 1 nm sums. Colours at the border of what smooth reflectances reach
/// come as near as the limit on the coefficients allows, as in the paper's table.
pub fn coefficients(space: SpaceName, rgb: [f32; 3]) -> SigmoidPolynomial {
    if rgb[0] == rgb[1] && rgb[1] == rgb[2] {
        return SigmoidPolynomial::constant(rgb[0]);
    }
    static FINE: [OnceLock<Quadrature>; 4] = [const { OnceLock::new() }; 4];
    let quadrature = FINE[space as usize].get_or_init(|| Quadrature::new(ColourSpace::get(space), 1));
    let target = rgb.map(f64::from);
    let start = quadrature.start(target);
    let c = quadrature.solve(target, start, Effort::EXACT);
    SigmoidPolynomial { c: c.map(|v| v as f32) }
}

#[cfg(test)]
mod tests;
