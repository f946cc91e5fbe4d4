//! Paths of neighbouring pixels go on from each other's second scattering (Bekaert, Sbert & Halton 2002, *Accelerating
//! path tracing by re-using paths*).
//!
//! Path k scatters at `x_k`, then at `y_k`, where light of all further orders is worked out once. Every `x_i` of the group
//! is joined to every `y_k` by a ray; with the balance heuristic over the points that could have sent a path there,
//!
//! ```text
//! L_i = sum_k beta_i F(x_i, y_k) S(y_k),    S(y_k) = sum over light c of  value_c / mean_l( r_c,l sum_m p_l(y_k | x_m) )
//! ```
//!
//! per lane, with `l` running over the path's wavelengths as heroes. `F` holds what scatters, the geometry and the
//! transmittance; `p_l(y | x)` is the density of `y`, per volume or area, of a path that scatters at `x` and is led by lane
//! l; zero where that path would have no throughput left, for then it ends. The denominator does not depend on the pixel, so
//! that a path simply starts anew at `y_k` with the density `sum_m p_l(y_k | x_m)`, and what it brings is dealt out in
//! proportion to `beta_i F(x_i, y_k)`. Where `y_k` does not scatter alike for all, what goes on to `wi` has the density
//! `sum_m p_l(y_k | x_m) p_l(wi | x_m)` and is dealt out by `beta_i F(x_i, y_k) f(wi | x_i)`.
//!
//! The paths of a group share their wavelengths and their time. Distances to `x_i` are led by a lane that is drawn for
//! itself (`pilot` in `volpath`), so that where the points lie does not depend on the hero of what follows;
//! then the weights sum to one for every hero.
//!
//! Pixels of a square have errors in common. Where cells have several pixels, these are dealt anew to groups for each sample,
//! one pixel of each cell to each group at random: neighbours have errors of their own and a picture has grain, not blotches.

mod choose;
mod company;
mod depart;
mod end;
mod group;
mod join;
mod level;
mod worth;

pub use level::Level;

use crate::{
    pixel::{Lanes, PixelPass},
    settings::Settings,
};
use tyndall_base::sobol::Sharers;
use tyndall_film::PixelBounds;
use tyndall_transport::{Scene, media::Medium};

/// Films of this many pixels along both sides have cells of 2 x 2 pixels where 4 x 4 share. On smaller ones, where
/// neighbours see more different things, a cell is one pixel.
const FINE: u32 = 256;
/// The part of the light that was scattered more than once from which sharing pays, and from which many share: measured,
/// less than this is lost in the noise of what is scattered once, and the links cost more than they bring.
const SOME: f32 = 0.12;
const MANY: f32 = 0.35;
/// The part of a shared point that is its own path's, at most, for links through media that vary to pay; and the mean square
/// by which coarse lengths are wrong there.
const OWN: f32 = 0.3;
const WRONG: f32 = 0.01;
/// Most paths that are shared.
pub(crate) const MOST: usize = 64;

/// Room for `number` who may share: on the heap, for a new array would be filled with whole empty members.
fn nobody<T>(number: usize) -> Vec<Option<T>> {
    let mut room = Vec::with_capacity(number);
    room.resize_with(number, || None);
    room
}

/// How pixels are grouped: a square has `cells` x `cells` cells, each of `cell` x `cell` pixels. Paths of one pixel of each
/// cell are shared. The pixels of a cell never share, so that neighbours have errors of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grouping {
    /// Cells of a square along each side, 4 or 8.
    pub cells: u32,
    /// Side of a cell \[pixels\], 1 or 2.
    pub cell: u32,
}

impl Grouping {
    /// For a film of `resolution` pixels, with `many` who share or few.
    fn new(resolution: [u32; 2], many: bool) -> Self {
        let fine = resolution[0].min(resolution[1]) >= FINE;
        match many {
            true => Self { cells: 8, cell: 1 },
            false => Self { cells: 4, cell: if fine { 2 } else { 1 } },
        }
    }

    /// Side of a square \[pixels\].
    pub fn side(&self) -> u32 {
        self.cells * self.cell
    }

    /// The square of an image that holds the point `at` of the unit square.
    fn square(&self, at: [f32; 2], resolution: [u32; 2]) -> PixelBounds {
        let side = self.side();
        let corner = |k: usize| (at[k] * resolution[k] as f32) as u32 / side * side;
        let (x0, y0) = (corner(0), corner(1));
        let end = |from: u32, k: usize| (from + side).min(resolution[k]);
        PixelBounds { x0, y0, x1: end(x0, 0), y1: end(y0, 1) }
    }

    /// Paths of a group.
    #[inline(always)]
    pub(crate) fn members(&self) -> usize {
        (self.cells * self.cells) as usize
    }

    /// How many share a net.
    #[inline(always)]
    pub(crate) fn sharers(&self) -> Sharers {
        if self.cells == 8 { Sharers::SixtyFour } else { Sharers::Sixteen }
    }
}

impl PixelPass {
    /// Whether paths of neighbouring pixels are shared.
    pub fn shares_paths(&self) -> bool {
        self.grouping.is_some() && self.may_share_paths()
    }

    /// Whether they can be.
    fn may_share_paths(&self) -> bool {
        // the single wavelength of a path would be that of the whole square
        let several = self.lanes != Lanes::One;
        several
            && self.is_led_by_hero()
            && self.layers.is_empty()
            && allowed(&self.settings)
            && possible(&self.scene)
    }

    /// Side of the squares of pixels that have errors in common, for [`tyndall_film::FilmSpec::square`]; 1 for none.
    pub fn shared_side(&self) -> u32 {
        match &self.grouping {
            Some(grouping) if self.may_share_paths() => grouping.side(),
            _ => 1,
        }
    }
}

/// Densities of flights must be known in closed form, and must not depend on the path before.
fn allowed(s: &Settings) -> bool {
    s.reuse
        && s.exact_transmittance
        && s.survival
        && !s.regularize
        && s.roulette_depth >= 1
        && s.max_depth >= 2
}

/// So must those of passing between two points.
fn possible(scene: &Scene) -> bool {
    let known = |m: &Medium| match m {
        Medium::Heterogeneous(m) => m.is_measurable(),
        Medium::Homogeneous(_) | Medium::Painted(_) => true,
    };
    !scene.has_alpha && scene.media.iter().all(known)
}
