//! The wavelengths that one path carries.

/// Marks a slot that carries the continuum, not a spectral line.
pub const CONTINUUM: u16 = u16::MAX;

/// `N` wavelengths with the density each was drawn with; slot 0 is the hero, all slots are exchangeable.
///
/// The estimate of an integral over wavelength is the mean over slots of `value / pdf`. A slot on a spectral line
/// (`line[k] != CONTINUUM`) holds in `pdf` the *probability* of the line (no unit), and a light's value there is the
/// line's power instead of its power per nm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wavelengths<const N: usize> {
    /// Wavelength \[nm\].
    pub lambda: [f32; N],
    /// Density \[1/nm\], or probability for a slot on a line.
    pub pdf: [f32; N],
    /// Index of the spectral line in the job's list of lines, or [`CONTINUUM`].
    pub line: [u16; N],
}

impl<const N: usize> Wavelengths<N> {
    /// Wavelengths on the continuum \[nm\] with their densities \[1/nm\].
    pub fn continuum(lambda: [f32; N], pdf: [f32; N]) -> Self {
        Self { lambda, pdf, line: [CONTINUUM; N] }
    }

    /// The hero's wavelength \[nm\].
    #[inline(always)]
    pub fn hero(&self) -> f32 {
        self.lambda[0]
    }

    /// True when slot `k` carries a spectral line.
    #[inline(always)]
    pub fn on_line(&self, k: usize) -> bool {
        self.line[k] != CONTINUUM
    }
}
