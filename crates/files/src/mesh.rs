//! Meshes and the formats that they are read from.

mod ply;

pub use ply::{PlyMesh, decode_ply, read_ply};
