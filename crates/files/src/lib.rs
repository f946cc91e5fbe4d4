//! File formats: EXR (RGB and spectral), PNG, PFM and other textures, PLY meshes.
