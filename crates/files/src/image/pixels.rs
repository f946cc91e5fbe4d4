//! The image container: named f32 planes, a data window in a display window, attributes.

use super::MetaValue;
use crate::{FileError, Result};
use std::collections::BTreeMap;

/// A rectangle of pixels: x to the right, y down, `x0, y0` its first pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// First column.
    pub x0: i32,
    /// First row.
    pub y0: i32,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

impl Window {
    /// The window of an uncropped image.
    pub const fn of_size(width: usize, height: usize) -> Self {
        Window { x0: 0, y0: 0, width, height }
    }

    /// Number of pixels.
    pub const fn area(&self) -> usize {
        self.width * self.height
    }
}

/// One plane of an image: `data[y * width + x]`, row 0 on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its name, for example `R` or `S0.550,000000nm`.
    pub name: String,
    /// Its samples, row by row.
    pub data: Vec<f32>,
}

/// An image of named float planes.
#[derive(Clone, Debug, PartialEq)]
pub struct Pixels {
    window: Window,
    display: Window,
    channels: Vec<Channel>,
    /// Attributes by name.
    pub meta: BTreeMap<String, MetaValue>,
}

impl Pixels {
    /// An image without channels whose data fill the display window.
    pub fn new(width: usize, height: usize) -> Self {
        Self::cropped(Window::of_size(width, height), Window::of_size(width, height))
    }

    /// An image without channels whose data fill `window`, a part of `display` (a crop).
    pub fn cropped(window: Window, display: Window) -> Self {
        Pixels { window, display, channels: Vec::new(), meta: BTreeMap::new() }
    }

    /// An image of three planes `R`, `G`, `B`, from interleaved triples.
    ///
    /// # Errors
    /// [`FileError::BadImage`] unless there are `width * height` triples.
    pub fn from_rgb(width: usize, height: usize, rgb: &[[f32; 3]]) -> Result<Self> {
        let mut pixels = Self::new(width, height);
        for (c, name) in ["R", "G", "B"].into_iter().enumerate() {
            pixels.push(name, rgb.iter().map(|p| p[c]).collect())?;
        }
        Ok(pixels)
    }

    /// Adds a channel.
    ///
    /// # Errors
    /// [`FileError::BadImage`] when the number of samples is not that of the data window, or the name is
    /// empty or taken.
    pub fn push(&mut self, name: impl Into<String>, data: Vec<f32>) -> Result<()> {
        let name = name.into();
        if data.len() != self.window.area() {
            return Err(FileError::bad_image(
                format!("{} samples ({} x {})", self.window.area(), self.window.width, self.window.height),
                format!("{} in channel `{name}`", data.len()),
                "every channel covers the whole data window",
            ));
        }
        if name.is_empty() || self.channel(&name).is_some() {
            return Err(FileError::bad_image(
                "channel names that are not empty and differ",
                format!("`{name}` again"),
                "give every channel its own name",
            ));
        }
        self.channels.push(Channel { name, data });
        Ok(())
    }

    /// Adds an attribute, or replaces the one of that name.
    pub fn set(&mut self, name: impl Into<String>, value: impl Into<MetaValue>) {
        self.meta.insert(name.into(), value.into());
    }

    /// Columns of the data window.
    pub fn width(&self) -> usize {
        self.window.width
    }

    /// Rows of the data window.
    pub fn height(&self) -> usize {
        self.window.height
    }

    /// Where the data lie.
    pub fn window(&self) -> Window {
        self.window
    }

    /// The full frame.
    pub fn display(&self) -> Window {
        self.display
    }

    /// All channels, in the order in which they were added or read.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// The samples of a channel.
    pub fn channel(&self, name: &str) -> Option<&[f32]> {
        self.channels.iter().find(|c| c.name == name).map(|c| c.data.as_slice())
    }

    /// The samples of a channel, to be changed.
    pub fn channel_mut(&mut self, name: &str) -> Option<&mut [f32]> {
        self.channels.iter_mut().find(|c| c.name == name).map(|c| c.data.as_mut_slice())
    }

    /// The planes R, G, B; for an image with only a `Y` (grey) plane that plane three times.
    pub fn rgb(&self) -> Option<[&[f32]; 3]> {
        match (self.channel("R"), self.channel("G"), self.channel("B")) {
            (Some(r), Some(g), Some(b)) => Some([r, g, b]),
            _ => self.channel("Y").map(|y| [y; 3]),
        }
    }

    /// Number of samples that are infinite or not a number.
    pub fn non_finite(&self) -> usize {
        self.channels.iter().flat_map(|c| &c.data).filter(|v| !v.is_finite()).count()
    }
}
