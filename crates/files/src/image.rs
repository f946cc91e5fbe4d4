//! Images: a plain container of named float planes, and the formats that it is read from and written to.
//!
//! | format | read | write |
//! |---|---|---|
//! | OpenEXR (RGB(A), Y, spectral, any channels; f16, f32, u32) | [`read_exr`] | [`write_exr`] (f32, ZIP) |
//! | PNG | [`read_image`] | [`write_png`] (8 or 16 bits, sRGB) |
//! | PFM | [`read_pfm`] | [`write_pfm`] |
//! | Radiance HDR, JPEG, TGA, BMP, QOI | [`read_image`] | - |

mod encoding;
mod exr_attributes;
mod exr_chunk;
mod exr_read;
mod exr_write;
mod guard;
mod ldr;
mod meta;
mod pfm;
mod pixels;
mod png_text;
mod png_write;
mod read;
mod spectral_layout;
mod spectral_names;

pub use encoding::Encoding;
pub use exr_read::{ExrInfo, decode_exr, probe_exr, read_exr};
pub use exr_write::{ExrCompression, ExrOptions, encode_exr, write_exr};
pub use meta::MetaValue;
pub use pfm::{decode_pfm, encode_pfm, read_pfm, write_pfm};
pub use pixels::{Channel, Pixels, Window};
pub use png_text::read_png_texts;
pub use png_write::{BitDepth, PngOptions, PngReport, encode_png, write_png};
pub use read::{read_encoded, read_image};
pub use spectral_layout::{SpectralLayout, SpectralUnit, band_edges_nm};
pub use spectral_names::{
    SpectralChannel, SpectralKind, format_spectrum, parse_spectrum, spectral_channel_name, spectral_channels,
};
