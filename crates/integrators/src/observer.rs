//! Whoever watches a path: orders of scattering, first vertices, traces. `()` watches nothing and compiles away.

use tyndall_base::Vec3;
use tyndall_spectral::Spectrum;
use tyndall_transport::MediumId;

/// What happened at a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// Scattered in a medium.
    Medium,
    /// Scattered by a surface.
    Surface,
    /// Crossed a boundary without a material.
    Boundary,
    /// Left the scene.
    Escape,
    /// Ended by roulette, absorption or depth.
    End,
}

/// A vertex of a path.
#[derive(Clone, Copy, Debug)]
pub struct Vertex<const N: usize> {
    /// What happened.
    pub event: Event,
    /// Where \[m\].
    pub p: Vec3,
    /// Shading normal at a surface, else zero.
    pub n: Vec3,
    /// Distance from the previous vertex or boundary \[m\].
    pub distance: f32,
    /// Scatterings so far, this one included.
    pub depth: u32,
    /// Medium of the segment that ended here.
    pub medium: MediumId,
    /// Reflectance or single-scattering albedo, where known.
    pub albedo: Spectrum<N>,
    /// Throughput before the event.
    pub throughput: Spectrum<N>,
}

/// Receives what a path does.
pub trait PathObserver<const N: usize> {
    /// The path adds `value` to its pixel, light of `order` scatterings.
    fn contribution(&mut self, order: u32, value: &Spectrum<N>);
    /// The path has a new vertex. Built only when [`Self::WANTS_VERTICES`].
    fn vertex(&mut self, vertex: &Vertex<N>);
    /// Whether vertices are wanted at all.
    const WANTS_VERTICES: bool;
}

impl<const N: usize> PathObserver<N> for () {
    #[inline(always)]
    fn contribution(&mut self, _order: u32, _value: &Spectrum<N>) {}
    #[inline(always)]
    fn vertex(&mut self, _vertex: &Vertex<N>) {}
    const WANTS_VERTICES: bool = false;
}
