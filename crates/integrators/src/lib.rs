//! Integrators: volpath, analog.
