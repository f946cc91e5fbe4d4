//! Media that vary in space, every kind of them, in several bands at once: known answers, and what must not matter.

#[path = "../common/mod.rs"]
mod common;
mod embers;
mod flights;
mod invariance;
mod known;
mod media;
mod painted;
mod shared;
mod skies;
mod sparse;
mod table;
