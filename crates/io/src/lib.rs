//! Readers: pbrt-v4 scenes into a renderable scene, PLY meshes.
