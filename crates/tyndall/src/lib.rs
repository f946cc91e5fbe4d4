//! Tyndall as a library: load a scene, render it, write the result.
