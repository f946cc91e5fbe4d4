//! What can be wrong with geometry handed to this crate.

use std::fmt;

/// Why a transform, a shape or an acceleration structure was refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GeometryError {
    /// The matrix cannot be inverted.
    #[error("transform: expected an invertible 4x4 matrix, got determinant {determinant:e}")]
    SingularTransform {
        /// The determinant found.
        determinant: f64,
    },
    /// A coordinate is infinite, NaN or beyond the range that the traversal is safe for.
    #[error("{place}: expected finite coordinates below {limit:e}, got {value}", limit = crate::shape::COORDINATE_LIMIT)]
    BadCoordinate {
        /// Which shape and vertex.
        place: Place,
        /// The offending value.
        value: f32,
    },
    /// A mesh index points past the vertices.
    #[error("{place}: expected vertex indices below {count}, got {index}")]
    IndexOutOfRange {
        /// Which shape and face.
        place: Place,
        /// The offending index.
        index: u32,
        /// How many vertices there are.
        count: usize,
    },
    /// An optional per-vertex array has another length than the positions.
    #[error("{array}: expected one entry per vertex ({expected}), got {got}")]
    LengthMismatch {
        /// Which array: `N`, `uv` or `S`.
        array: &'static str,
        /// Number of vertices.
        expected: usize,
        /// Number of entries.
        got: usize,
    },
    /// A scalar parameter outside its range.
    #[error("{parameter}: expected {expected}, got {got}")]
    BadParameter {
        /// The parameter's name in pbrt's words.
        parameter: &'static str,
        /// What is allowed.
        expected: &'static str,
        /// What was given.
        got: f64,
    },
    /// An object lists a shape group, or an instance names an object, that does not exist.
    #[error("{what}: expected an index below {count}, got {index}")]
    NoSuch {
        /// What refers to what.
        what: &'static str,
        /// The index given.
        index: u32,
        /// How many there are.
        count: usize,
    },
    /// Triangles round a vertex do not form one fan, so the mesh has no surface there.
    #[error(
        "vertex {vertex}: expected triangles that form one fan round it (a manifold mesh), got several or overlapping ones"
    )]
    NotManifold {
        /// Index of the vertex.
        vertex: usize,
    },
    /// More primitives than the node format can address.
    #[error("acceleration structure: expected at most {limit} primitive blocks, got {got}")]
    TooManyPrimitives {
        /// The limit of the format.
        limit: usize,
        /// What was needed.
        got: usize,
    },
}

/// Where in the input something was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Index of the shape group where that is known.
    pub group: Option<u32>,
    /// What is counted: "vertex", "triangle", "patch".
    pub element: &'static str,
    /// Its index.
    pub index: usize,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(group) = self.group {
            write!(f, "shape {group}, ")?;
        }
        write!(f, "{} {}", self.element, self.index)
    }
}
