//! Threads, workers, receivers and typed messages.

#![forbid(unsafe_code)]

mod address;
mod clock;
mod context;
mod fault;
mod handle;
mod iteration;
mod mailbox;
mod object;
mod register;
mod shared;
mod stage;
#[cfg(not(any(loom, shuttle)))]
mod sync;
/// The model checkers' threads, for the models.
#[cfg(any(loom, shuttle))]
#[allow(missing_docs, unreachable_pub)]
pub mod sync;
mod thread;
mod trace;
mod watchdog;

pub use address::{Address, SendError};
pub use clock::Timer;
pub use context::Context;
pub use fault::{Fault, Outcome, RESTART_WINDOW, RESTARTS};
pub use handle::{Stopped, ThreadHandle};
pub use iteration::Next;
pub use object::{Receiver, Worker};
pub use register::WorkerId;
pub use shared::Counters;
pub use stage::{Stage, Waiting};
pub use thread::{Captured, DROP_DEADLINE, Thread};
pub use trace::{End, Event, Record, TraceSnapshot};
pub use watchdog::{STALL_LIMIT, Stall, Watchdog};
