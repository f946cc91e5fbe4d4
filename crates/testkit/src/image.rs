use crate::distribution::student_two_sided;
use crate::family::{ALPHA, sidak};
use crate::moments::Welford;

/// One channel of an image: independent pixel estimates with their standard errors, row by row.
#[derive(Clone, Copy, Debug)]
pub struct ImageEstimate<'a> {
    /// Pixels in a row.
    pub width: usize,
    /// Pixel values.
    pub mean: &'a [f64],
    /// Standard error of each pixel; empty for an exact reference.
    pub se: &'a [f64],
    /// Degrees of freedom of each pixel's variance (infinite when it is known).
    pub dof: f64,
}

/// Two images compared block by block.
#[derive(Clone, Debug)]
#[must_use]
pub struct BlockTest {
    /// Student's t of each block, row by row.
    pub t: Vec<f64>,
    /// Two-sided p-value of each block.
    pub p: Vec<f64>,
    /// Blocks in a row.
    pub columns: usize,
}

impl BlockTest {
    /// The p-value of the whole comparison: that of the worst block, by Sidak's rule over the blocks.
    pub fn family_p(&self) -> f64 {
        let least = self.p.iter().copied().fold(1.0, f64::min);
        -f64::exp_m1(self.p.len() as f64 * f64::ln_1p(-least))
    }

    /// Column and row of the worst block.
    pub fn worst(&self) -> (usize, usize) {
        let worst = (0..self.p.len()).min_by(|&a, &b| self.p[a].total_cmp(&self.p[b])).unwrap_or(0);
        (worst % self.columns, worst / self.columns)
    }

    /// Panics when any block differs at [`ALPHA`], shared over the blocks and a family of `images`.
    #[track_caller]
    pub fn assert_ok(&self, name: &str, images: usize) {
        let ((x, y), p, level) = (self.worst(), self.family_p(), sidak(ALPHA, images));
        let t = self.t[y * self.columns + x];
        assert!(
            p > level,
            "{name}: block ({x}, {y}) has t = {t:.2}, p = {p:.3e} over all blocks <= {level:.1e}"
        );
    }
}

/// Compares two images on blocks of `size` x `size` pixels (the last row and column may be smaller).
///
/// `t = (a - b) / sqrt(se_a^2 + se_b^2)` of the block means, with the degrees of freedom of Welch & Satterthwaite over
/// the pixels. Pixels must be independent of each other: where they share paths, take [`block_test_replicates`], with blocks
/// of whole squares.
pub fn block_test(a: ImageEstimate<'_>, b: ImageEstimate<'_>, size: usize) -> BlockTest {
    assert!(a.width == b.width && a.mean.len() == b.mean.len(), "images of the same size");
    let (columns, blocks) = blocks(a.width, a.mean.len(), size);
    let results = blocks.iter().map(|pixels| {
        let difference: f64 = pixels.iter().map(|&i| a.mean[i] - b.mean[i]).sum();
        let variances = [a, b].into_iter().filter(|image| !image.se.is_empty());
        let terms =
            variances.flat_map(|image| pixels.iter().map(move |&i| (image.se[i] * image.se[i], image.dof)));
        let (variance, spread) = terms.fold((0.0, 0.0), |(v, s), (x, dof)| (v + x, s + x * x / dof));
        t_and_p(difference, variance, variance * variance / spread)
    });
    let (t, p) = results.unzip();
    BlockTest { t, p, columns }
}

/// Compares two sets of replicate images (independent runs of equal length) block by block, by Welch's t-test of the
/// replicates' block means: valid whatever the correlation between the pixels of one run.
pub fn block_test_replicates(a: &[&[f64]], b: &[&[f64]], width: usize, size: usize) -> BlockTest {
    let pixels = a.first().map_or(0, |image| image.len());
    assert!(a.len() > 1 && b.len() > 1, "at least two replicates each");
    assert!(a.iter().chain(b).all(|image| image.len() == pixels), "images of the same size");
    let (columns, blocks) = blocks(width, pixels, size);
    let results = blocks.iter().map(|block| {
        let mean = |image: &&[f64]| block.iter().map(|&i| image[i]).sum::<f64>() / block.len() as f64;
        let [a, b] = [a, b].map(|set| set.iter().map(mean).collect::<Welford>());
        let [va, vb] = [a, b].map(|w| w.variance() / w.n() as f64);
        let spread = va * va / (a.n() - 1) as f64 + vb * vb / (b.n() - 1) as f64;
        t_and_p(a.mean() - b.mean(), va + vb, (va + vb) * (va + vb) / spread)
    });
    let (t, p) = results.unzip();
    BlockTest { t, p, columns }
}

/// Student's t and its p-value. No variance demands equality; what is not finite fails.
fn t_and_p(difference: f64, variance: f64, dof: f64) -> (f64, f64) {
    let t = if difference == 0.0 { 0.0 } else { difference / variance.sqrt() };
    let p = match () {
        () if !t.is_finite() || variance.is_nan() => 0.0,
        () if t == 0.0 => 1.0,
        // beyond a million the law is normal, and known variances have infinitely many
        () => student_two_sided(t, dof.min(1e6)),
    };
    (t, p)
}

/// The number of blocks in a row, and each block's pixel indices.
fn blocks(width: usize, pixels: usize, size: usize) -> (usize, Vec<Vec<usize>>) {
    assert!(
        size > 0 && width > 0 && pixels.is_multiple_of(width),
        "expected whole rows of {width} pixels, got {pixels}"
    );
    let (columns, rows) = (width.div_ceil(size), (pixels / width).div_ceil(size));
    let mut blocks = vec![Vec::new(); columns * rows];
    for i in 0..pixels {
        blocks[(i / width / size) * columns + (i % width) / size].push(i);
    }
    (columns, blocks)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Rng, distribution::normal_quantile, ks_test};

    const WIDTH: usize = 40;
    const PIXELS: usize = WIDTH * 20;

    fn noise(rng: &mut Rng) -> f64 {
        normal_quantile(rng.f64().max(1e-16))
    }

    fn estimate<'a>(mean: &'a [f64], se: &'a [f64]) -> ImageEstimate<'a> {
        ImageEstimate { width: WIDTH, mean, se, dof: 31.0 }
    }

    /// Means and standard errors of `n` normal samples a pixel.
    fn render(seed: u64, n: usize) -> (Vec<f64>, Vec<f64>) {
        let mut rng = Rng::new(seed);
        let pixel = |i: usize| {
            let w: Welford = (0..n).map(|_| i as f64 + noise(&mut rng)).collect();
            (w.mean(), w.se())
        };
        (0..PIXELS).map(pixel).unzip()
    }

    #[test]
    fn equal_scenes_pass_and_a_shifted_block_is_found() {
        let ((a, se_a), (mut b, se_b)) = (render(1, 32), render(2, 32));
        let test = block_test(estimate(&a, &se_a), estimate(&b, &se_b), 8);
        assert_eq!((test.columns, test.t.len()), (5, 15));
        test.assert_ok("same scene", 1);
        // one standard error in each pixel of the block at (3, 1)
        for i in (0..PIXELS).filter(|i| (24..32).contains(&(i % WIDTH)) && (8..16).contains(&(i / WIDTH))) {
            b[i] += se_b[i];
        }
        let test = block_test(estimate(&a, &se_a), estimate(&b, &se_b), 8);
        assert_eq!(test.worst(), (3, 1));
        assert!(test.family_p() < 1e-4);
    }

    #[test]
    fn replicates_see_through_correlated_pixels() {
        // all pixels of a run share one error: pixelwise tests would cry wolf
        let run = |seed: u64| {
            let mut rng = Rng::new(seed);
            let common = noise(&mut rng);
            (0..PIXELS).map(|i| i as f64 + common + 0.1 * noise(&mut rng)).collect::<Vec<f64>>()
        };
        let p = |first: u64| {
            let images: Vec<Vec<f64>> = (first..first + 16).map(run).collect();
            let views: Vec<&[f64]> = images.iter().map(Vec::as_slice).collect();
            block_test_replicates(&views[..8], &views[8..], WIDTH, 8).p[7]
        };
        ks_test((0..200).map(|i| p(100 + 16 * i)), |x| x).assert_ok("p-values of replicates", 1);
    }

    #[test]
    fn exact_references_and_not_a_number() {
        let (mean, se) = render(3, 64);
        let truth: Vec<f64> = (0..PIXELS).map(|i| i as f64).collect();
        let reference = ImageEstimate { width: WIDTH, mean: &truth, se: &[], dof: f64::INFINITY };
        let ours = ImageEstimate { width: WIDTH, mean: &mean, se: &se, dof: 63.0 };
        block_test(ours, reference, 8).assert_ok("against the truth", 1);
        assert_eq!(block_test(reference, reference, 8).family_p(), 1.0);
        let mut broken = mean.clone();
        broken[0] = f64::NAN;
        assert_eq!(block_test(ImageEstimate { mean: &broken, ..ours }, reference, 8).family_p(), 0.0);
    }
}
