//! Pixels of a file as texels.

use tyndall_files::image::Pixels;
use tyndall_transport::texture::Texels;

/// RGB where the file has it, else its first channel.
pub fn texels(pixels: &Pixels) -> Result<Texels, String> {
    let (width, height) = (pixels.width(), pixels.height());
    if pixels.non_finite() > 0 {
        return Err(format!("the image has {} values that are not finite", pixels.non_finite()));
    }
    if let Some([r, g, b]) = pixels.rgb() {
        let data = (0..width * height).flat_map(|i| [r[i], g[i], b[i]]).collect();
        return Ok(Texels { width, height, channels: 3, data });
    }
    let first = pixels.channels().first().ok_or("the image has no channels")?;
    Ok(Texels { width, height, channels: 1, data: first.data.clone() })
}
