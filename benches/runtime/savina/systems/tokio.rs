//! The threads of tokio, for the systems whose actors are its tasks.

use std::mem;
use std::thread::{self, JoinHandle};
use tokio::runtime::{Builder, Handle, Runtime};
use tokio::sync::oneshot;

/// A runtime on threads of its own: with one, tokio's single-threaded flavour, which is the quicker one then; with
/// more, its work-stealing one.
pub(super) enum Workers {
    One { handle: Handle, stop: oneshot::Sender<()>, thread: JoinHandle<()> },
    Many(Runtime),
}

impl Workers {
    pub(super) fn start(threads: usize) -> Self {
        if threads > 1 {
            let runtime = Builder::new_multi_thread().worker_threads(threads).build();
            return Self::Many(runtime.expect("the system has threads left"));
        }
        let runtime = Builder::new_current_thread().build().expect("it needs nothing of the system");
        let (stop, stopped) = oneshot::channel();
        let handle = runtime.handle().clone();
        let thread = thread::Builder::new().name("tokio".into()).spawn(move || {
            // An error is a stop as well: nobody holds the other end any more.
            let _ = runtime.block_on(stopped);
        });
        Self::One { handle, stop, thread: thread.expect("the system has a thread left") }
    }

    pub(super) fn handle(&self) -> &Handle {
        match self {
            Self::One { handle, .. } => handle,
            Self::Many(runtime) => runtime.handle(),
        }
    }

    /// Ends the runtime and drops its tasks.
    pub(super) fn stop(self) {
        match self {
            Self::One { stop, thread, .. } => {
                stop.send(()).expect("it waits for this");
                thread.join().expect("panics of tasks stay in them");
            }
            Self::Many(runtime) => drop(runtime),
        }
    }

    /// Leaves the runtime to itself: a task in it may never end.
    pub(super) fn abandon(self) {
        mem::forget(self);
    }
}
