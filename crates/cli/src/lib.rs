//! What the program `tyndall` is made of: arguments, commands, progress, log, signals.
//!
//! The program itself is `main.rs`, which reads like a recipe.

pub mod args;
pub mod commands;
pub mod exit;
pub mod log;
pub mod progress;
pub mod signal;
