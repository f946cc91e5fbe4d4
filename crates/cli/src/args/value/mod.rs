//! Values on the command line. Each kind has its own syntax, and an error that says what was expected.

mod address;
mod aov;
mod bands;
mod crop;
mod duration;
mod image_file;
mod number;
mod orders;
mod overrides;
mod pixel;
mod region;
mod resolution;
mod shard;
mod target;
mod white;

pub use address::{DEFAULT_PORT, ServerAddress};
pub use aov::Aov;
pub use bands::{Bands, Interval, Range};
pub use crop::Crop;
pub use duration::Duration;
pub use image_file::{FileKind, ImageFile};
pub use number::{finite, fraction, positive};
pub use orders::{Order, Orders};
pub use overrides::Override;
pub use pixel::Pixel;
pub use region::Region;
pub use resolution::Resolution;
pub use shard::Shard;
pub use target::Target;
pub use white::WhitePoint;

/// A value that cannot be read, in words for the user.
pub type Refusal = String;
