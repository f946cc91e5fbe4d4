//! The numbers one path draws, a pure function of (seed, pixel, sample, dimension).
//!
//! The first dimensions are padded two-dimensional Owen-scrambled Sobol points (Burley 2020, *Practical hash-based
//! Owen scrambling*), because they decide most of the variance; beyond them a counter-based hash serves, whose
//! length has no bound. Every pair of dimensions has its own scramble, so the order of draws within a pair is fixed.

use tyndall_base::{Vec2, hash, rng::Pcg32, sobol, vec::vec2};

/// Which points the first dimensions come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SamplerKind {
    /// Owen-scrambled Sobol points first, hash beyond.
    #[default]
    OwenSobol,
    /// Independent uniform numbers in every dimension.
    Independent,
}

/// Dimensions that a path reserves at each vertex; a vertex that draws fewer leaves the rest unused.
pub const DIMENSIONS_PER_VERTEX: u32 = 16;
/// Dimensions before the first vertex: film 2, wavelength and first distance 2, lens 2, time 1, first segment's light.
pub const CAMERA_DIMENSIONS: u32 = 16;
/// Dimensions served by Sobol points; beyond about four vertices stratification buys nothing.
const SOBOL_DIMENSIONS: u32 = CAMERA_DIMENSIONS + 4 * DIMENSIONS_PER_VERTEX;

/// The stream of one path.
#[derive(Clone, Debug)]
pub struct PathSampler {
    kind: SamplerKind,
    /// Hash of (seed, pixel, replicate): the key of all that does not come from a net.
    key: u32,
    /// The key of every scramble: the same, or that of the pixels which share a net.
    scramble: u32,
    /// Position within the replicate's net.
    index: u32,
    /// The same, prepared for the net.
    point: sobol::SobolIndex,
    dimension: u32,
    /// Streams handed out so far.
    streams: u32,
}

/// Tells the nets of groups of paths from those of pixels.
const GROUP: u32 = 0x6a09_e667;
/// And those that pixels share.
const SHARED: u32 = 0xbb67_ae85;

impl PathSampler {
    /// The stream of sample `sample` of pixel (`px`, `py`).
    ///
    /// Samples are dealt to `replicates` nets (sample `i` belongs to replicate `i mod replicates`), each with its own
    /// scramble, so that the replicates' means are independent.
    pub fn new(kind: SamplerKind, seed: u64, px: u32, py: u32, sample: u32, replicates: u32) -> Self {
        let replicates = replicates.max(1);
        let key = hash::hash4(seed as u32, (seed >> 32) as u32 ^ (sample % replicates), px, py);
        let index = sample / replicates;
        let point = sobol::SobolIndex::new(index);
        Self { kind, key, scramble: key, index, point, dimension: 0, streams: 0 }
    }

    /// The same stream, but with the points of a net that several pixels share, of which this one is number `k` and
    /// (`px`, `py`) the first. What falls unevenly in one pixel is made up for in the others.
    pub fn within(
        mut self,
        (k, sharers): (u32, sobol::Sharers),
        seed: u64,
        (px, py): (u32, u32),
        sample: u32,
        replicates: u32,
    ) -> Self {
        let all = Self::new(self.kind, seed ^ (u64::from(SHARED) << 32), px, py, sample, replicates);
        self.scramble = all.key;
        self.point = sobol::SobolIndex::shared(self.index, k, sharers);
        self
    }

    /// The stream that the paths number `sample` of all pixels of a group share; a pixel, (`px`, `py`), names the group.
    pub fn of_group(kind: SamplerKind, seed: u64, px: u32, py: u32, sample: u32, replicates: u32) -> Self {
        Self::new(kind, seed ^ (u64::from(GROUP) << 32), px, py, sample, replicates)
    }

    /// Moves to `dimension`.
    #[inline(always)]
    pub fn seek(&mut self, dimension: u32) {
        self.dimension = dimension;
    }

    /// Moves to the first dimension of path vertex `vertex` (0 is the first vertex after the camera).
    #[inline(always)]
    pub fn seek_vertex(&mut self, vertex: u32) {
        self.dimension = CAMERA_DIMENSIONS.saturating_add(vertex.saturating_mul(DIMENSIONS_PER_VERTEX));
    }

    /// A generator of its own for an estimator that needs a number of numbers nobody knows, such as tracking through a
    /// medium: a function of the path and of how many were asked for before.
    #[inline]
    pub fn stream(&mut self) -> Pcg32 {
        self.streams += 1;
        Pcg32::from_key(hash::hash3_u64(self.key, self.index, self.streams))
    }

    #[inline(always)]
    fn stratified(&self) -> bool {
        self.kind == SamplerKind::OwenSobol && self.dimension < SOBOL_DIMENSIONS
    }

    /// One number of \[0, 1).
    #[inline(always)]
    pub fn next_1d(&mut self) -> f32 {
        let u = if self.stratified() {
            self.point.d1(hash::hash2(self.scramble, self.dimension))
        } else {
            hash::to_unit_f32(hash::hash2(hash::hash2(self.key, self.dimension), self.index))
        };
        self.dimension += 1;
        u
    }

    /// Two numbers of \[0, 1), jointly stratified in the first dimensions.
    #[inline(always)]
    pub fn next_2d(&mut self) -> Vec2 {
        let u = if self.stratified() {
            self.point.d2(hash::hash2(self.scramble, self.dimension))
        } else {
            let a = hash::hash2(hash::hash2(self.key, self.dimension), self.index);
            [hash::to_unit_f32(a), hash::to_unit_f32(hash::hash2(a, !self.index))]
        };
        self.dimension += 2;
        vec2(u[0], u[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_are_pure_functions_of_their_key() {
        let draw = |seed, x, sample| {
            let mut s = PathSampler::new(SamplerKind::OwenSobol, seed, x, 7, sample, 8);
            (0..200).map(|_| s.next_1d()).collect::<Vec<_>>()
        };
        assert_eq!(draw(1, 3, 5), draw(1, 3, 5));
        assert_ne!(draw(1, 3, 5), draw(2, 3, 5));
        assert_ne!(draw(1, 3, 5), draw(1, 4, 5));
        assert_ne!(draw(1, 3, 5), draw(1, 3, 13));
    }

    #[test]
    fn each_replicate_is_a_net() {
        // 8 replicates of 16 samples: the first dimension of each replicate has one point per sixteenth.
        for replicate in 0..8 {
            let mut seen = [false; 16];
            for i in 0..16 {
                let mut s = PathSampler::new(SamplerKind::OwenSobol, 9, 1, 2, i * 8 + replicate, 8);
                seen[(s.next_1d() * 16.0) as usize] = true;
            }
            assert!(seen.iter().all(|&b| b), "replicate {replicate} misses a stratum");
        }
    }

    #[test]
    fn pixels_that_share_a_net_fill_it_together() {
        // 16 pixels of 8 samples in each of 2 replicates: 128 strata, one point each
        for replicate in 0..2 {
            let mut seen = [false; 128];
            for (k, i) in (0..16).flat_map(|k| (0..8).map(move |i| (k, i))) {
                let (sample, pixel) = (2 * i + replicate, (40 + k % 4, 20 + k / 4));
                let own = PathSampler::new(SamplerKind::OwenSobol, 9, pixel.0, pixel.1, sample, 2);
                let mut s = own.clone().within((k, sobol::Sharers::Sixteen), 9, (40, 20), sample, 2);
                seen[(s.next_1d() * 128.0) as usize] = true;
                // beyond the net each pixel has numbers of its own
                let mut own = own;
                own.seek_vertex(40);
                s.seek_vertex(40);
                assert_eq!(own.next_2d(), s.next_2d());
            }
            assert!(seen.iter().all(|&b| b), "replicate {replicate} misses a stratum");
        }
    }

    #[test]
    fn numbers_beyond_the_net_are_uniform() {
        let mut w = tyndall_testkit::Welford::default();
        for i in 0..20_000 {
            let mut s = PathSampler::new(SamplerKind::OwenSobol, 11, 5, 6, i, 1);
            s.seek_vertex(40);
            w.add(f64::from(s.next_2d().y));
        }
        // standard error of a uniform mean over 20,000 numbers is 0.00204
        assert!((w.mean() - 0.5).abs() < 4.0 * 0.00204, "{}", w.mean());
    }
}
