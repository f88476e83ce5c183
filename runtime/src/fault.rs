//! When a call panics: what is reported, and whether the object gets another chance.

use std::any::Any;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A panic in a worker, a receiver, or a closure that was sent to a thread.
///
/// The thread lives on; of the messages only the one being received is lost.
#[derive(Clone, Debug)]
pub struct Fault {
    /// The thread's name.
    pub thread: Arc<str>,
    /// The object's name.
    pub object: Arc<str>,
    /// The type of the message being received; `"update"` for a worker, else what was being done
    /// with the object (`"make"`, `"drop"`, `"run"`).
    pub call: &'static str,
    /// The text of the panic.
    pub reason: String,
    /// What became of the object.
    pub outcome: Outcome,
}

/// What became of an object that panicked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It is dropped and no longer registered.
    Removed,
    /// It was dropped, and its factory made a new one in the same place.
    Restarted,
    /// It panicked more than [`RESTARTS`] times within [`RESTART_WINDOW`] (or its factory did) and
    /// is removed for good.
    GivenUp,
}

/// How many restarts an object gets within [`RESTART_WINDOW`].
pub const RESTARTS: usize = 3;
/// See [`RESTARTS`].
pub const RESTART_WINDOW: Duration = Duration::from_secs(10);

/// Counts a panic at `now` among those of one restartable object that still count: may the object be
/// made anew?
pub(crate) fn allow_restart(failures: &mut Vec<Instant>, now: Instant) -> bool {
    failures.retain(|then| now.saturating_duration_since(*then) < RESTART_WINDOW);
    failures.push(now);
    failures.len() <= RESTARTS
}

/// Returns the text of a panic from the payload that `catch_unwind` or a join returns: the message
/// that was given to `panic!`, or a fixed text when the payload is no string.
///
/// ```
/// # use dragonfly_runtime::panic_text;
/// let caught = std::panic::catch_unwind(|| std::panic::resume_unwind(Box::new("no such bone")));
/// assert_eq!(panic_text(&*caught.unwrap_err()), "no such bone");
/// ```
pub fn panic_text(payload: &(dyn Any + Send)) -> &str {
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("a panic without a text")
}
