//! The pbrt-v4 text format: bytes to directives with source spans.
