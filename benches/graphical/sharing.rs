//! What every way of sharing a document must be able to do, and the list of ways.

use super::document::{NumberedEdit, SharedDocument};
use super::frame::{FrameWork, PoseAnswer, PoseQuestion};
use super::ledger::Ledger;
use super::{locks, messages, swap, triple};
use dragonfly_runtime::{Captured, Context, ThreadHandle};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The main thread's side: edits, and reads a little.
pub trait Sharing {
    /// Makes the edit, or has it made. `begins`: it is the first of a gesture; those of one gesture replace each other.
    fn edit(&mut self, edit: NumberedEdit, begins: bool);

    /// Asks, and comes back with the answer.
    fn ask(&mut self, question: PoseQuestion, main: &mut Captured) -> TimedAnswer;

    /// The document as all edits so far have left it.
    fn document(&mut self, main: &mut Captured) -> SharedDocument;

    /// Edits that wait to be made when `posted` were posted.
    fn backlog(&self, _posted: u64, _ledger: &Ledger) -> u64 {
        0
    }
}

/// The graphics thread's side; made and kept there.
pub trait Viewing {
    /// Draws a frame from one consistent view.
    fn frame(&mut self, frame: &mut FrameWork);

    /// Called when a frame is due: may it begin? If not, the thread is asked again when a message comes, or when
    /// the answer itself had it woken.
    fn is_ready(&mut self, _thread: &mut Context) -> bool {
        true
    }

    /// The edit that a frame must show that begins now: this or a newer one. Asked once in each iteration.
    fn promise(&mut self, ledger: &Ledger) -> u64 {
        ledger.completed()
    }
}

/// An answer, and what it cost.
pub struct TimedAnswer {
    /// The answer.
    pub answer: PoseAnswer,
    /// How long the main thread could do nothing else.
    pub blocked: Duration,
}

impl TimedAnswer {
    /// An answer that is there when the call that asked for it returns.
    pub fn at_once(ask: impl FnOnce() -> PoseAnswer) -> Self {
        let begin = Instant::now();
        let answer = ask();
        Self { answer, blocked: begin.elapsed() }
    }
}

/// What a way of sharing starts from.
pub struct SharingStart<'a> {
    /// What is shared; the first to edit copies what others have.
    pub document: SharedDocument,
    /// The graphics thread.
    pub graphics: &'a ThreadHandle,
    /// The main thread, which is the caller's.
    pub main: &'a mut Captured,
    /// What is told to the measurement.
    pub ledger: &'a Arc<Ledger>,
}

/// Makes the graphics thread's side, in that thread.
pub type MakeViewing = Box<dyn FnOnce(&mut Context) -> Box<dyn Viewing> + Send>;

/// Both sides.
pub struct SharingParts {
    /// Stays in the main thread.
    pub sharing: Box<dyn Sharing>,
    /// Goes to the graphics thread.
    pub viewing: MakeViewing,
}

/// One way to share a document between threads.
#[derive(Clone, Copy)]
pub struct SharingMethod {
    /// As it is called in the tables.
    pub name: &'static str,
    /// Starts it.
    pub start: fn(SharingStart) -> SharingParts,
    /// Is it among the few that are compared in every case?
    pub telling: bool,
}

impl SharingMethod {
    /// One that is compared in the core case only.
    pub const fn new(name: &'static str, start: fn(SharingStart) -> SharingParts) -> Self {
        Self { name, start, telling: false }
    }

    const fn telling(self) -> Self {
        Self { telling: true, ..self }
    }
}

type StdMutex<T> = std::sync::Mutex<T>;
type StdRwLock<T> = std::sync::RwLock<T>;
type PlMutex<T> = parking_lot::Mutex<T>;
type PlRwLock<T> = parking_lot::RwLock<T>;

/// All ways.
pub const METHODS: &[SharingMethod] = &[
    SharingMethod::new("messages", messages::plain).telling(),
    SharingMethod::new("messages, newest", messages::newest).telling(),
    SharingMethod::new("messages, on demand", messages::on_demand).telling(),
    SharingMethod::new("messages, batched", messages::batched).telling(),
    SharingMethod::new("messages, relayed", messages::relayed),
    SharingMethod::new("messages, read", messages::read),
    SharingMethod::new("messages, merged", messages::merged),
    SharingMethod::new("messages, spinning", messages::spinning),
    SharingMethod::new("mutex, frame", locks::held::<StdMutex<_>>).telling(),
    SharingMethod::new("mutex, poses", locks::sampled::<StdMutex<_>>).telling(),
    SharingMethod::new("mutex, clone", locks::cloned::<StdMutex<_>>),
    SharingMethod::new("mutex, cow", locks::copied_on_write::<StdMutex<_>>).telling(),
    SharingMethod::new("mutex a take", locks::a_take::<StdMutex<_>>),
    SharingMethod::new("parking, frame", locks::held::<PlMutex<_>>),
    SharingMethod::new("parking, poses", locks::sampled::<PlMutex<_>>),
    SharingMethod::new("parking, cow", locks::copied_on_write::<PlMutex<_>>),
    SharingMethod::new("rwlock, frame", locks::held::<StdRwLock<_>>),
    SharingMethod::new("rwlock, poses", locks::sampled::<StdRwLock<_>>),
    SharingMethod::new("parking rw, frame", locks::held::<PlRwLock<_>>),
    SharingMethod::new("parking rw, poses", locks::sampled::<PlRwLock<_>>),
    SharingMethod::new("arcswap, cow", swap::start).telling(),
    SharingMethod::new("triple buffer", triple::start).telling(),
];
