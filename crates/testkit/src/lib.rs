//! Statistical tests for samplers, estimators and images.
#![forbid(unsafe_code)]
