//! The backend of this machine: worker threads that take units from a queue; patches are merged on the caller's thread.

use std::any::Any;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;

use tyndall_film::{Patch, WorkUnit};

use crate::EngineError;
use crate::backend::{Backend, Cancel, Deliver, Units, Work};

/// Stack of a worker: paths recurse little, but scenes are not ours.
const STACK: usize = 8 << 20;

/// Threads of this process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Threads(usize);

impl Threads {
    /// A fixed number of threads, at least one.
    pub fn new(threads: usize) -> Self {
        Self(threads.max(1))
    }

    /// As many as the machine allows this process, its affinity and control group included.
    pub fn available() -> Self {
        Self::new(thread::available_parallelism().map_or(1, usize::from))
    }
}

type Delivery = Result<Patch, EngineError>;

impl Backend for Threads {
    fn run(
        &self,
        work: Work<'_>,
        units: &mut Units<'_>,
        deliver: &mut Deliver<'_>,
    ) -> Result<(), EngineError> {
        let stop = Cancel::default();
        let queue = Mutex::new(units);
        // patches wait here while the caller is busy, so that memory stays bounded
        let (send, receive) = sync_channel(2 * self.0);
        let (recycle, spare) = channel();
        let spare = Mutex::new(spare);
        let (queue, stop, spare) = (&queue, &stop, &spare);
        // the receiver goes in: when a thread cannot be started, those that wait to send must not wait for ever
        thread::scope(move |scope| {
            for k in 0..self.0 {
                let send = send.clone();
                let name = format!("tyndall-{k}");
                let body = move || worker(work, queue, stop, spare, &send);
                let spawned = thread::Builder::new().name(name).stack_size(STACK).spawn_scoped(scope, body);
                if let Err(source) = spawned {
                    stop.cancel();
                    return Err(EngineError::Job {
                        what: format!("cannot start thread {k}: {source}"),
                        hint: "give --threads a smaller number",
                    });
                }
            }
            drop(send);
            merge(&receive, &recycle, stop, deliver)
        })
    }

    fn width(&self) -> usize {
        self.0
    }
}

/// Takes units until there are none or a stop is asked; every unit taken is sent.
fn worker(
    work: Work<'_>,
    queue: &Mutex<&mut Units<'_>>,
    stop: &Cancel,
    spare: &Mutex<Receiver<Patch>>,
    send: &SyncSender<Delivery>,
) {
    while !stop.is_cancelled() && !work.cancel.is_cancelled() {
        let Some(unit) = lock(queue).next() else { return };
        let recycled = lock(spare).try_recv().ok();
        if send.send(render(work, unit, recycled)).is_err() {
            return;
        }
    }
}

/// Renders one unit; a panic becomes an error that says where it happened.
fn render(work: Work<'_>, unit: WorkUnit, recycled: Option<Patch>) -> Delivery {
    let mut patch = match recycled {
        Some(mut patch) => {
            patch.reset(unit.clone());
            patch
        }
        None => Patch::new(work.film, unit.clone()),
    };
    let rendered = catch_unwind(AssertUnwindSafe(|| work.pass.render(&unit, work.guide, &mut patch)));
    match rendered {
        Ok(()) => Ok(patch),
        Err(panic) => Err(EngineError::Worker { at: patch.last(), unit, message: message(&*panic) }),
    }
}

fn merge(
    receive: &Receiver<Delivery>,
    recycle: &Sender<Patch>,
    stop: &Cancel,
    deliver: &mut Deliver<'_>,
) -> Result<(), EngineError> {
    let mut first_error = None;
    let mut broken = false;
    for delivery in receive {
        match delivery {
            Ok(_) if broken => {}
            Ok(patch) => {
                broken = deliver(&patch) == ControlFlow::Break(());
                let _ = recycle.send(patch);
            }
            Err(error) => first_error = first_error.or(Some(error)),
        }
        if broken || first_error.is_some() {
            stop.cancel();
        }
    }
    first_error.map_or(Ok(()), Err)
}

fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|s| (*s).to_string());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "unknown panic".into())
}

/// A worker's panic is caught before it can poison a lock in the middle of a change.
fn lock<T: ?Sized>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
