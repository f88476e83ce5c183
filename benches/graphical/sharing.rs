//! The interface of the methods to share a document, and the list of methods.

use super::document::{NumberedEdit, SharedDocument};
use super::frame::{FrameWork, PoseAnswer, PoseQuestion};
use super::ledger::Ledger;
use super::{locks, messages, swap, triple};
use dragonfly_runtime::{Captured, Context, ThreadHandle};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The main thread's side: edits, and reads a little.
pub trait Sharing {
    /// Makes the edit, or sends it. `begins` is whether it is the first of a gesture: a method may replace queued
    /// edits of the same gesture.
    fn edit(&mut self, edit: NumberedEdit, begins: bool);

    /// Asks a question and waits for the answer.
    fn ask(&mut self, question: PoseQuestion, main: &mut Captured) -> TimedAnswer;

    /// Returns the document after all edits so far.
    fn document(&mut self, main: &mut Captured) -> SharedDocument;

    /// Returns the number of queued edits after `posted` were posted.
    fn backlog(&self, _posted: u64, _ledger: &Ledger) -> u64 {
        0
    }
}

/// The graphics thread's side; created and used there.
pub trait Viewing {
    /// Draws a frame from one consistent view.
    fn frame(&mut self, frame: &mut FrameWork);

    /// Called when a frame is due. Returns whether it can start. If not, this is called again when a message arrives,
    /// or at the wake-up that this call has requested.
    fn is_ready(&mut self, _thread: &mut Context) -> bool {
        true
    }

    /// Returns the edit that a frame that starts now must at least show. Called once in each iteration.
    fn promise(&mut self, ledger: &Ledger) -> u64 {
        ledger.completed()
    }
}

/// An answer, and its cost.
pub struct TimedAnswer {
    /// The answer.
    pub answer: PoseAnswer,
    /// Time for which the main thread was blocked.
    pub blocked: Duration,
}

impl TimedAnswer {
    /// Returns an answer that is available when the call that asks returns.
    pub fn at_once(ask: impl FnOnce() -> PoseAnswer) -> Self {
        let begin = Instant::now();
        let answer = ask();
        Self { answer, blocked: begin.elapsed() }
    }
}

/// The input of a method.
pub struct SharingStart<'a> {
    /// The document to share; the first edit copies shared data.
    pub document: SharedDocument,
    /// The graphics thread.
    pub graphics: &'a ThreadHandle,
    /// The main thread, which is the caller's.
    pub main: &'a mut Captured,
    /// The measurement data.
    pub ledger: &'a Arc<Ledger>,
}

/// Creates the graphics thread's side, in that thread.
pub type MakeViewing = Box<dyn FnOnce(&mut Context) -> Box<dyn Viewing> + Send>;

/// Both sides of a method: that of the main thread and that of the graphics thread.
pub struct SharingParts {
    /// The side that stays in the main thread.
    pub sharing: Box<dyn Sharing>,
    /// The side for the graphics thread.
    pub viewing: MakeViewing,
}

/// A method to share a document between threads.
#[derive(Clone, Copy)]
pub struct SharingMethod {
    /// Name in the tables.
    pub name: &'static str,
    /// Starts the method.
    pub start: fn(SharingStart) -> SharingParts,
    /// Whether it is among the few methods that are compared in every case.
    pub in_every_case: bool,
}

impl SharingMethod {
    /// Returns a method that is compared only in the case `drag`, with all others.
    pub const fn new(name: &'static str, start: fn(SharingStart) -> SharingParts) -> Self {
        Self { name, start, in_every_case: false }
    }

    const fn in_every_case(self) -> Self {
        Self { in_every_case: true, ..self }
    }
}

type StdMutex<T> = std::sync::Mutex<T>;
type StdRwLock<T> = std::sync::RwLock<T>;
type PlMutex<T> = parking_lot::Mutex<T>;
type PlRwLock<T> = parking_lot::RwLock<T>;

/// All methods.
pub const METHODS: &[SharingMethod] = &[
    SharingMethod::new("messages", messages::plain).in_every_case(),
    SharingMethod::new("messages, newest", messages::newest).in_every_case(),
    SharingMethod::new("messages, on demand", messages::on_demand).in_every_case(),
    SharingMethod::new("messages, batched", messages::batched).in_every_case(),
    SharingMethod::new("messages, relayed", messages::relayed),
    SharingMethod::new("messages, read", messages::read),
    SharingMethod::new("messages, merged", messages::merged),
    SharingMethod::new("messages, spinning", messages::spinning),
    SharingMethod::new("mutex, frame", locks::held_for_frame::<StdMutex<_>>).in_every_case(),
    SharingMethod::new("mutex, poses", locks::sampled::<StdMutex<_>>).in_every_case(),
    SharingMethod::new("mutex, clone", locks::cloned::<StdMutex<_>>),
    SharingMethod::new("mutex, cow", locks::copied_on_write::<StdMutex<_>>).in_every_case(),
    SharingMethod::new("mutex a take", locks::lock_per_take::<StdMutex<_>>),
    SharingMethod::new("parking, frame", locks::held_for_frame::<PlMutex<_>>),
    SharingMethod::new("parking, poses", locks::sampled::<PlMutex<_>>),
    SharingMethod::new("parking, cow", locks::copied_on_write::<PlMutex<_>>),
    SharingMethod::new("rwlock, frame", locks::held_for_frame::<StdRwLock<_>>),
    SharingMethod::new("rwlock, poses", locks::sampled::<StdRwLock<_>>),
    SharingMethod::new("parking rw, frame", locks::held_for_frame::<PlRwLock<_>>),
    SharingMethod::new("parking rw, poses", locks::sampled::<PlRwLock<_>>),
    SharingMethod::new("arcswap, cow", swap::start).in_every_case(),
    SharingMethod::new("triple buffer", triple::start).in_every_case(),
];
