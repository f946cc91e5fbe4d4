//! Up to four response curves as one interleaved 1 nm table.

use tyndall_spectral::{Curve, LambdaRange};

/// Rows of four responses, one per whole nm; straight lines between, zero outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Dense {
    pub names: Vec<String>,
    /// Weights of the channels that make up Y.
    pub luminance: Vec<f32>,
    first: f32,
    rows: Vec<[f32; 4]>,
}

impl Dense {
    /// Channels `c = sum_j mix[c][j] curve_j`, sampled at whole nm over `range`.
    pub fn mixed(
        names: [&str; 3],
        luminance: [f32; 3],
        curves: &[Curve; 3],
        mix: &[[f64; 3]; 3],
        range: LambdaRange,
    ) -> Self {
        let first = range.min.floor();
        let row = |nm: f32| {
            let r = [0, 1, 2].map(|j| f64::from(curves[j].eval(nm)));
            let c = [0, 1, 2].map(|c| (mix[c][0] * r[0] + mix[c][1] * r[1] + mix[c][2] * r[2]) as f32);
            [c[0], c[1], c[2], 0.0]
        };
        let rows = (0..=(range.max.ceil() - first) as usize).map(|k| row(first + k as f32)).collect();
        Self { names: names.map(String::from).to_vec(), luminance: luminance.to_vec(), first, rows }
    }

    pub fn is_finite(&self) -> bool {
        self.rows.iter().flatten().chain(&self.luminance).all(|v| v.is_finite())
    }

    /// Responses at a wavelength \[nm\].
    #[inline(always)]
    pub fn at(&self, lambda: f32) -> [f32; 4] {
        let x = lambda - self.first;
        // the last row itself is inside, the rest of its nm is not
        if !(x >= 0.0 && x <= self.rows.len() as f32 - 1.0) {
            return [0.0; 4];
        }
        let i = x as usize;
        let (a, b) = (self.rows[i], self.rows[(i + 1).min(self.rows.len() - 1)]);
        let t = x - i as f32;
        let mut row = [0.0; 4];
        for c in 0..4 {
            row[c] = a[c] + t * (b[c] - a[c]);
        }
        row
    }
}
