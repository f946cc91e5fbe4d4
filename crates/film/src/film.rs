//! The film: the sum of all patches.

use std::sync::Arc;

use crate::planes::Planes;
use crate::{Diagnostics, FilmError, FilmSpec, Patch};

/// Sums over the whole window of a job. Equal sets of samples give equal films, whatever the order.
#[derive(Clone, Debug)]
pub struct Film {
    spec: Arc<FilmSpec>,
    pub(crate) planes: Planes,
    pub(crate) diagnostics: Diagnostics,
}

impl Film {
    /// An empty film. [`FilmSpec::check_size`] tells the memory it takes.
    ///
    /// # Errors
    /// When the description is not valid, or the system refuses the memory.
    pub fn new(spec: &Arc<FilmSpec>) -> Result<Self, FilmError> {
        spec.validate()?;
        let planes = Planes::new(spec, spec.bounds)?;
        Ok(Self { spec: spec.clone(), planes, diagnostics: Diagnostics::default() })
    }

    /// What the film holds.
    pub fn spec(&self) -> &Arc<FilmSpec> {
        &self.spec
    }

    /// Samples that were dropped or clamped.
    pub fn diagnostics(&self) -> &Diagnostics {
        &self.diagnostics
    }

    /// Number of samples held, over all pixels.
    pub fn samples(&self) -> u64 {
        self.planes.counts.iter().map(|&n| u64::from(n)).sum()
    }

    /// Adds a patch.
    ///
    /// # Errors
    /// When the patch is for another film.
    pub fn merge(&mut self, patch: &Patch) -> Result<(), FilmError> {
        self.same_kind(patch.spec())?;
        let (inner, outer) = (patch.planes.bounds, self.planes.bounds);
        if !outer.encloses(&inner) {
            return Err(FilmError::Outside { patch: inner, film: outer });
        }
        self.add(&patch.planes, &patch.diagnostics);
        Ok(())
    }

    /// Adds another film of the same job (a shard).
    ///
    /// # Errors
    /// When the other film is of another kind.
    pub fn merge_film(&mut self, other: &Film) -> Result<(), FilmError> {
        self.same_kind(&other.spec)?;
        self.add(&other.planes, &other.diagnostics);
        Ok(())
    }

    /// Empties the film, keeping its memory.
    pub fn clear(&mut self) {
        self.planes.reset(self.planes.bounds);
        self.diagnostics.clear();
    }

    /// True when both films hold the same bits.
    pub fn same_bits(&self, other: &Film) -> bool {
        self.spec == other.spec && self.planes == other.planes && self.diagnostics == other.diagnostics
    }

    /// The film's sums as named planes of little-endian bytes, for files.
    pub fn planes(&self) -> [(&'static str, &[u8]); 6] {
        let p = &self.planes;
        [
            ("sums", bytemuck::cast_slice(&p.sums)),
            ("squares", bytemuck::cast_slice(&p.squares)),
            ("cross", bytemuck::cast_slice(&p.cross)),
            ("counts", bytemuck::cast_slice(&p.counts)),
            ("weights", bytemuck::cast_slice(&p.weights)),
            ("largest", bytemuck::cast_slice(&p.largest)),
        ]
    }

    /// The same planes to be filled by a reader.
    pub fn planes_mut(&mut self) -> [(&'static str, &mut [u8]); 6] {
        let p = &mut self.planes;
        [
            ("sums", bytemuck::cast_slice_mut(&mut p.sums)),
            ("squares", bytemuck::cast_slice_mut(&mut p.squares)),
            ("cross", bytemuck::cast_slice_mut(&mut p.cross)),
            ("counts", bytemuck::cast_slice_mut(&mut p.counts)),
            ("weights", bytemuck::cast_slice_mut(&mut p.weights)),
            ("largest", bytemuck::cast_slice_mut(&mut p.largest)),
        ]
    }

    /// Replaces the counts of dropped and clamped samples by those of a file.
    pub fn set_diagnostics(&mut self, diagnostics: Diagnostics) {
        self.diagnostics = diagnostics;
    }

    fn add(&mut self, planes: &Planes, diagnostics: &Diagnostics) {
        self.diagnostics.merge(diagnostics);
        self.diagnostics.overflows += self.planes.merge(planes);
    }

    fn same_kind(&self, other: &Arc<FilmSpec>) -> Result<(), FilmError> {
        if Arc::ptr_eq(&self.spec, other) {
            return Ok(());
        }
        match self.spec.difference(other) {
            Some(what) => Err(FilmError::Mismatch { what }),
            None => Ok(()),
        }
    }
}
