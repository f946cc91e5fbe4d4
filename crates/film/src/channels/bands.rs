//! Bands: mean radiance per nm between edges.

use tyndall_spectral::{Spectrum, cie};

use crate::FilmError;

/// Adjoining bands of any widths.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bands {
    edges: Vec<f32>,
    inverse_width: Vec<f32>,
    /// Band that holds the start of each nm from the first edge on, for the search.
    start: Vec<u16>,
}

impl Bands {
    /// Marks a wavelength outside all bands.
    pub const NONE: u16 = u16::MAX;

    /// Bands between ascending edges \[nm\].
    ///
    /// # Errors
    /// When there are fewer than two edges, more than 4097, or they do not ascend within 1 to 1e6 nm.
    pub fn new(edges: &[f32]) -> Result<Self, FilmError> {
        let refuse = |what: String| Err(FilmError::Channels { what });
        if !(2..=4097).contains(&edges.len()) {
            return refuse(format!("expected 2 to 4097 band edges, got {}", edges.len()));
        }
        if let Some(w) = edges.windows(2).find(|w| w[0] >= w[1] || w[0].is_nan() || w[1].is_nan()) {
            return refuse(format!("band edges must ascend, got {} nm and then {} nm", w[0], w[1]));
        }
        let (first, last) = (edges[0], edges[edges.len() - 1]);
        if !(first >= 1.0 && last <= 1e6) {
            return refuse(format!("band edges must lie within 1 and 1e6 nm, got {first} to {last} nm"));
        }
        let band_at = |nm: f32| edges.partition_point(|&e| e <= nm).clamp(1, edges.len() - 1) as u16 - 1;
        Ok(Self {
            inverse_width: edges.windows(2).map(|w| 1.0 / (w[1] - w[0])).collect(),
            start: (0..=(last - first) as usize).map(|k| band_at(first + k as f32)).collect(),
            edges: edges.to_vec(),
        })
    }

    /// Weights of the bands that make up Y: the integral of y-bar over each band.
    pub(super) fn luminance(&self) -> Vec<f32> {
        let y = cie::y_bar();
        let integral = |a: f32, b: f32| {
            let n = ((b - a) * 4.0).ceil().max(1.0) as usize;
            let h = (b - a) / n as f32;
            (0..n).map(|i| f64::from(y.eval(a + (i as f32 + 0.5) * h)) * f64::from(h)).sum::<f64>() as f32
        };
        self.edges.windows(2).map(|e| integral(e[0], e[1])).collect()
    }

    /// Number of bands.
    pub fn len(&self) -> usize {
        self.inverse_width.len()
    }

    /// True without bands.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Edges \[nm\].
    pub fn edges(&self) -> &[f32] {
        &self.edges
    }

    /// The band of a wavelength: lower edge inside, upper edge outside but for the last, or [`Bands::NONE`].
    #[inline]
    pub(super) fn find(&self, lambda: f32) -> u16 {
        if self.edges.is_empty() || !(lambda >= self.edges[0] && lambda <= self.edges[self.len()]) {
            return Self::NONE;
        }
        let mut band = usize::from(self.start[((lambda - self.edges[0]) as usize).min(self.start.len() - 1)]);
        while band + 1 < self.len() && lambda >= self.edges[band + 1] {
            band += 1;
        }
        band as u16
    }

    #[inline]
    pub(super) fn respond<const N: usize>(
        &self,
        l: &Spectrum<N>,
        scale: &[f32; N],
        band: &[u16; N],
        out: &mut [f32],
    ) {
        if self.is_empty() {
            return;
        }
        out.fill(0.0);
        for k in 0..N {
            if let Some(o) = out.get_mut(usize::from(band[k])) {
                *o += l[k] * scale[k] * self.inverse_width[usize::from(band[k])];
            }
        }
    }
}
