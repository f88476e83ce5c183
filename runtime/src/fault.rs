//! Panics of objects: how they are reported, and whether the object is restarted.

use std::any::Any;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A panic in a worker, a receiver, or a closure that was sent to a thread.
///
/// The thread continues. Only the message being received is lost.
#[derive(Clone, Debug)]
pub struct Fault {
    /// The thread's name.
    pub thread: Arc<str>,
    /// The object's name.
    pub object: Arc<str>,
    /// The type of the message being received; `"update"` for a worker; otherwise what was being
    /// done with the object: `"make"`, `"drop"` or `"run"`.
    pub call: &'static str,
    /// The text of the panic, see [`panic_text`].
    pub reason: String,
    /// Whether the object was removed or restarted.
    pub outcome: Outcome,
}

/// Removal or restart of an object that panicked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It was dropped and is no longer registered.
    Removed,
    /// It was dropped, and its factory made a new one at the same position.
    Restarted,
    /// It panicked more than [`RESTARTS`] times within [`RESTART_WINDOW`], or its factory panicked,
    /// and it was removed for good.
    GivenUp,
}

/// Number of times that an object is restarted within [`RESTART_WINDOW`].
pub const RESTARTS: usize = 3;
/// Time after which a panic no longer counts against [`RESTARTS`].
pub const RESTART_WINDOW: Duration = Duration::from_secs(10);

/// Adds a panic at `now` to the recent `failures` of a restartable object. Returns whether the object
/// may be restarted.
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
