//! Pictures inside a page.

use super::escape;
use base64::{Engine as _, engine::general_purpose::STANDARD};

/// A PNG file's bytes as an image element; `alt` says what is to be seen.
pub fn png_image(png: &[u8], alt: &str) -> String {
    format!("<img alt=\"{}\" src=\"data:image/png;base64,{}\">", escape(alt), STANDARD.encode(png))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_inside() {
        assert_eq!(
            png_image(b"\x89PNG", "a \"b\""),
            "<img alt=\"a &quot;b&quot;\" src=\"data:image/png;base64,iVBORw==\">"
        );
    }
}
