//! The seam between the engine and those who render units.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use tyndall_film::{FilmSpec, Guide, Pass, Patch, WorkUnit};

use crate::EngineError;

/// A request to stop, shared between threads. Units under way are finished and delivered.
#[derive(Clone, Debug, Default)]
pub struct Cancel(Arc<AtomicBool>);

impl Cancel {
    /// Asks to stop.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// True once asked to stop.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Units to render, taken one by one.
pub type Units<'u> = dyn Iterator<Item = WorkUnit> + Send + 'u;

/// Receives finished patches, on the caller's thread.
pub type Deliver<'d> = dyn FnMut(&Patch) -> ControlFlow<()> + 'd;

/// What units are rendered with.
#[derive(Clone, Copy)]
pub struct Work<'w> {
    /// Renders a unit.
    pub pass: &'w dyn Pass,
    /// The film that patches are for.
    pub film: &'w Arc<FilmSpec>,
    /// Frozen while the units run.
    pub guide: &'w Guide,
    /// Asks to stop.
    pub cancel: &'w Cancel,
}

/// Renders units somewhere and delivers their patches in any order.
///
/// Every unit taken is delivered exactly once, also after a request to stop; none is taken after it, or after `deliver`
/// breaks.
pub trait Backend {
    /// Renders the units.
    ///
    /// # Errors
    /// When a unit fails; patches delivered before stay valid.
    fn run(
        &self,
        work: Work<'_>,
        units: &mut Units<'_>,
        deliver: &mut Deliver<'_>,
    ) -> Result<(), EngineError>;

    /// Number of units under way at once, for the record.
    fn width(&self) -> usize;
}
