//! Scattering models: phase functions and BSDFs.
