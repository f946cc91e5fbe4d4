//! One path alone, its vertices printed.

use clap::Args;

use crate::args::value::Pixel;

/// One path alone. All three options go together.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "One path alone")]
pub struct ReplayArgs {
    /// The pixel of the path
    #[arg(long, value_name = "X,Y", value_parser = Pixel::parse, requires = "trace")]
    pub pixel: Option<Pixel>,
    /// Which of the pixel's samples, from 0
    #[arg(long, value_name = "K", requires = "trace")]
    pub sample: Option<u32>,
    /// Print vertices, wavelengths and weights of this path instead of rendering
    #[arg(long, requires_all = ["pixel", "sample"])]
    pub trace: bool,
}

impl ReplayArgs {
    /// Pixel and sample of the path, if one is asked for.
    pub fn path(&self) -> Option<(Pixel, u32)> {
        self.pixel.zip(self.sample)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::render;
    use super::*;

    #[test]
    fn all_or_nothing() {
        let path = render("--pixel 3,4 --sample 7 --trace").expect("valid").replay.path();
        assert_eq!(path, Some((Pixel { x: 3, y: 4 }, 7)));
        assert_eq!(render("").expect("valid").replay.path(), None);
        assert!(render("--trace").is_err());
        assert!(render("--pixel 3,4").is_err());
        assert!(render("--pixel 3,4 --trace").is_err());
    }
}
