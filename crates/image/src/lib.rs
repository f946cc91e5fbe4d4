//! Image files: EXR (RGB and spectral), PNG, PFM and textures.
