//! Rectangles that bound the exit pupil as seen from points of the film.

use super::{Aperture, Lens};

/// Intervals of the distance from the film's centre.
const BINS: usize = 64;
/// Points of the grid along the rectangle's longer side.
const GRID: i32 = 96;
/// Points of the film per interval.
const POINTS: usize = 3;

/// `[x0, x1, y]`: the pupil lies in x0..x1 and -y..y.
type Rectangle = [f64; 3];

/// Bounds of the pupil on the plane of the last element, for points of the film's x axis. Lens and bounds have an axis of
/// rotation, and so the other points' follow; a stop without that symmetry is bounded by its greatest radius.
#[derive(Clone, Debug)]
pub struct ExitPupil {
    bounds: Vec<Option<Rectangle>>,
}

impl ExitPupil {
    /// Searches the pupil for a film of `diagonal` \[m\].
    pub fn new(lens: &Lens, aperture: &Aperture, diagonal: f64) -> Self {
        let reach = aperture.reach();
        let lens = lens.opened(reach);
        let bins = (0..BINS).map(|bin| {
            let at = |k: usize| {
                let share = (bin as f64 + k as f64 / (POINTS - 1) as f64) / BINS as f64;
                seen_from(&lens, 0.5 * diagonal * share)
            };
            (0..POINTS).filter_map(at).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1]), a[2].max(b[2])])
        });
        Self { bounds: bins.collect() }
    }

    /// True when no point of the film sees the scene.
    pub fn is_closed(&self) -> bool {
        self.bounds.iter().all(Option::is_none)
    }

    /// A point of the rectangle and its area \[m^2\]; `share` is the film point's distance from the centre over the
    /// greatest.
    pub fn sample(&self, share: f64, u: [f64; 2]) -> Option<([f64; 2], f64)> {
        let bin = ((share * BINS as f64) as usize).min(BINS - 1);
        let [x0, x1, y] = self.bounds[bin]?;
        let p = [x0 + u[0] * (x1 - x0), y * (2.0 * u[1] - 1.0)];
        Some((p, (x1 - x0) * 2.0 * y))
    }
}

/// Bounds of what gets through from (x, 0), one grid step wider on all sides. Half the plane will do, by symmetry.
fn seen_from(lens: &Lens, x: f64) -> Option<Rectangle> {
    // a curved last element is met beyond its rim's plane: pbrt's factor
    let half = 1.5 * lens.rear_aperture();
    let step = 2.0 * half / f64::from(GRID);
    let mut found: Option<Rectangle> = None;
    for j in 0..=GRID / 2 {
        for i in 0..=GRID {
            let p = [f64::from(i) * step - half, f64::from(j) * step];
            let [x0, x1, y] = found.unwrap_or([f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY]);
            if p[0] > x0 && p[0] < x1 && p[1] <= y {
                continue;
            }
            let d = [p[0] - x, p[1], lens.rear()];
            if lens.to_scene([x, 0.0, 0.0], d, &Aperture::Disk).is_some() {
                found = Some([x0.min(p[0]), x1.max(p[0]), y.max(p[1])]);
            }
        }
    }
    found.map(|[x0, x1, y]| [x0 - step, x1 + step, y + step])
}
