//! What lies ahead of a path: boundaries without a material up to the next surface, found by one query.

use tyndall_geometry::{Hit, Notes, Ray};
use tyndall_transport::Scene;

/// What lies ahead on a ray, of which the path may have passed some.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ahead {
    /// The ray that was asked about; distances are along it.
    pub ray: Ray,
    /// The surface, or whatever else the path has to stop at.
    pub met: Option<Hit>,
    /// Boundaries before it, in order, and how many of them the path has passed.
    boundaries: [Hit; Notes::MOST],
    len: u32,
    passed: u32,
    /// How far the path has come.
    pub at: f32,
}

impl Ahead {
    /// Asks about `ray`. Boundaries are passed by where their order is certain; else the nearest of them is what is met, and
    /// `certain` becomes false: a path has no use for further questions of this kind.
    #[inline(always)]
    pub fn of(scene: &Scene, ray: &Ray, certain: &mut bool) -> Self {
        let none = Hit { t: 0.0, shape: 0, prim: 0, instance: 0, u: 0.0, v: 0.0 };
        let mut ahead =
            Self { ray: *ray, met: None, boundaries: [none; Notes::MOST], len: 0, passed: 0, at: 0.0 };
        if !*certain {
            ahead.met = scene.intersect(ray);
            return ahead;
        }
        let (met, mut notes) = scene.intersect_noting(ray);
        ahead.met = met;
        if notes.is_empty() {
            return ahead;
        }
        match notes.in_order_before(met.as_ref().map_or(f32::INFINITY, |h| h.t)) {
            Some(hits) => {
                ahead.boundaries[..hits.len()].copy_from_slice(hits);
                ahead.len = hits.len() as u32;
            }
            None => {
                *certain = false;
                ahead.met = scene.intersect(ray);
            }
        }
        ahead
    }

    /// The next boundary, if one comes first.
    #[inline(always)]
    pub fn boundary(&self) -> Option<Hit> {
        if self.passed < self.len { Some(self.boundaries[self.passed as usize % Notes::MOST]) } else { None }
    }

    /// Distance from where the path is to what comes next.
    #[inline(always)]
    pub fn distance(&self) -> f32 {
        match self.boundary().or(self.met) {
            Some(hit) => hit.t - self.at,
            None => f32::INFINITY,
        }
    }

    /// The path passes the boundary at `hit`.
    #[inline(always)]
    pub fn pass(&mut self, hit: &Hit) {
        self.at = hit.t;
        self.passed += 1;
    }
}
