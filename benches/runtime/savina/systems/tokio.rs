//! The tokio runtimes for the systems whose actors are tokio tasks.

use super::super::run::{Finish, Run};
use std::mem;
use std::thread::{self, JoinHandle};
use tokio::runtime::{Builder, Handle, Runtime};
use tokio::sync::oneshot;

/// A runtime with threads of its own: single-threaded for one thread, which is faster then; work-stealing for more.
enum TokioThreads {
    One { handle: Handle, stop: oneshot::Sender<()>, thread: JoinHandle<()> },
    Many(Runtime),
}

impl TokioThreads {
    fn start(threads: usize) -> Self {
        if threads > 1 {
            let runtime = Builder::new_multi_thread().worker_threads(threads).build();
            return Self::Many(runtime.expect("the system has threads left"));
        }
        let runtime = Builder::new_current_thread().build().expect("it needs nothing of the system");
        let (stop, stopped) = oneshot::channel();
        let handle = runtime.handle().clone();
        let thread = thread::Builder::new().name("tokio".into()).spawn(move || {
            // An error is a stop too: the other end was dropped.
            let _ = runtime.block_on(stopped);
        });
        Self::One { handle, stop, thread: thread.expect("the system has a thread left") }
    }

    fn handle(&self) -> &Handle {
        match self {
            Self::One { handle, .. } => handle,
            Self::Many(runtime) => runtime.handle(),
        }
    }

    /// Ends the runtime and drops its tasks.
    fn stop(self) {
        match self {
            Self::One { stop, thread, .. } => {
                stop.send(()).expect("it waits for this");
                thread.join().expect("panics of tasks stay in them");
            }
            Self::Many(runtime) => drop(runtime),
        }
    }

    /// Leaves the runtime running: one of its tasks may never end.
    fn abandon(self) {
        mem::forget(self);
    }
}

/// Calls `start` to create the first actors on `threads` threads, and waits for the end of the run.
pub(super) fn play(threads: usize, start: impl FnOnce(Run)) -> Result<Finish, String> {
    let workers = TokioThreads::start(threads);
    let inside = workers.handle().enter();
    let (run, verdict) = Run::begin();
    start(run);
    let finish = verdict.wait();
    drop(inside);
    if finish.is_err() {
        workers.abandon();
        return finish;
    }
    workers.stop();
    if verdict.is_clean() { finish } else { Err("an actor panicked behind the end".into()) }
}
