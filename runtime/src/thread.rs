//! The owner of a thread: with an OS thread of its own, or driven by the caller's loop.

use crate::clock::ThreadClock;
use crate::shared::ThreadShared;
use crate::sync::{BriefLock, mutant, park, thread};
use crate::{Context, Next, ThreadHandle};
use std::cell::Cell;
use std::io;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Longest time that dropping a [`Thread`] waits for it to end.
pub const DROP_DEADLINE: Duration = Duration::from_secs(2);

/// An OS thread that runs the loop. It sleeps until a message arrives or a deadline passes, unless a
/// worker requests another iteration.
///
/// Dropping it stops the thread after its queued messages and waits for that, for at most
/// [`DROP_DEADLINE`]; a thread that is stuck in a call is then left running and logged.
#[doc(alias = "event loop")]
#[doc(alias = "actor system")]
#[doc(alias = "executor")]
pub struct Thread {
    handle: ThreadHandle,
    os_thread: Option<thread::JoinHandle<()>>,
}

impl Thread {
    /// Starts an OS thread called `name`.
    ///
    /// # Errors
    /// When the system cannot create a thread.
    ///
    /// # Panics
    /// When `name` contains a zero byte.
    pub fn start(name: &str) -> io::Result<Self> {
        // The mailbox needs the OS thread in order to wake it, and the loop needs the mailbox: so the
        // OS thread is started first and waits for its mailbox.
        let handoff = Arc::new(BriefLock::new(None));
        let theirs = Arc::clone(&handoff);
        let os_thread = thread::Builder::new().name(name.to_owned()).spawn(move || thread_proc(&theirs))?;
        let sleeper = os_thread.thread().clone();
        let wake = Box::new(move || sleeper.unpark());
        let shared = ThreadShared::new(name, ThreadClock::Real, wake);
        handoff.with(|handoff| *handoff = Some(Arc::clone(&shared)));
        os_thread.thread().unpark();
        Ok(Self { handle: ThreadHandle { shared }, os_thread: Some(os_thread) })
    }

    /// Makes a runtime thread of the calling OS thread, whose loop calls [`Captured::iterate`]. For
    /// the main thread, whose loop belongs to the window system.
    ///
    /// `wake` is called from sending threads when a message arrives between two calls of `iterate`
    /// while the thread waits for messages, and by [`resume`](ThreadHandle::resume) and
    /// [`remote_stop`](ThreadHandle::remote_stop). It must be fast and make the caller's loop call
    /// `iterate` soon; an unnecessary call does no harm.
    pub fn capture(name: &str, wake: impl Fn() + Send + Sync + 'static) -> Captured {
        Captured { context: Context::new(ThreadShared::new(name, ThreadClock::Real, Box::new(wake))) }
    }

    /// Returns the handle of the thread, for other threads.
    pub fn handle(&self) -> &ThreadHandle {
        &self.handle
    }

    /// Blocks until all of `threads` have stopped and dropped their objects.
    ///
    /// It does not stop them: call [`remote_stop`](ThreadHandle::remote_stop) before. A thread that
    /// waits for itself waits until `deadline`.
    ///
    /// # Errors
    /// The names of the threads that are still running at `deadline`.
    pub fn wait_for(threads: &[ThreadHandle], deadline: Instant) -> Result<(), Vec<String>> {
        mutant!(Self::unchecked_wait(threads, deadline));
        let names = || -> Vec<String> {
            let running = threads.iter().filter(|one| !one.is_stopped());
            running.map(|one| one.name().to_owned()).collect()
        };
        // Registered first, checked second: a thread that finishes in between either finds this waiter
        // or is found finished.
        threads.iter().for_each(|one| one.shared.waiters.with(|waiters| waiters.push(thread::current())));
        let mut running = names();
        while !running.is_empty() {
            if Instant::now() >= deadline {
                return Err(running);
            }
            park(Some(deadline));
            running = names();
        }
        Ok(())
    }
}

impl Drop for Thread {
    fn drop(&mut self) {
        let Some(os_thread) = self.os_thread.take() else {
            return;
        };
        self.handle.remote_stop();
        if os_thread.thread().id() == thread::current().id() {
            return; // Dropped in the thread itself, which ends when it reaches the queued stop.
        }
        let waited = Self::wait_for(std::slice::from_ref(&self.handle), Instant::now() + DROP_DEADLINE);
        if waited.is_err() {
            tracing::error!(thread = self.handle.name(), "does not stop; left running");
            return;
        }
        if os_thread.join().is_err() {
            tracing::error!(thread = self.handle.name(), "its loop panicked");
        }
    }
}

/// The loop of an OS thread (thesis §3.2.6.1).
fn thread_proc(handoff: &BriefLock<Option<Arc<ThreadShared>>>) {
    let shared = loop {
        match handoff.with(Option::take) {
            Some(shared) => break shared,
            None => park(None),
        }
    };
    let mut context = Context::new(shared);
    tracing::debug!(thread = context.handle().name(), "started");
    loop {
        let deadline = match context.iterate() {
            Next::Now => continue,
            Next::At(deadline) => Some(deadline),
            Next::OnMessage => None,
            Next::Stopped => return,
        };
        let left = |deadline: Instant| deadline.saturating_duration_since(Instant::now());
        let due = || deadline.is_some_and(|deadline| left(deadline).is_zero());
        let mailbox = &context.shared().mailbox.0;
        // A thread that sleeps or pauses on request is not marked as asleep, and does not spin.
        if !context.spin.is_zero() && mailbox.is_asleep() {
            mailbox
                .spin(patience(deadline.map_or(context.spin, |deadline| left(deadline).min(context.spin))));
            if !mailbox.is_asleep() {
                continue;
            }
        }
        // A spurious wake-up by the system is ignored.
        park(deadline);
        while !due() && mailbox.is_asleep() {
            park(deadline);
        }
    }
}

/// Returns a condition that holds for `limit`. Every 16th check yields the core to another thread,
/// which may be the one whose message is awaited.
fn patience(limit: Duration) -> impl Fn() -> bool {
    const CHECKS: u32 = 16;
    let (begin, checks) = (Instant::now(), Cell::new(0));
    move || {
        checks.set(checks.get() + 1);
        std::hint::spin_loop();
        if checks.get() % CHECKS != 0 {
            return true;
        }
        thread::yield_now();
        begin.elapsed() < limit
    }
}

/// A thread that is driven by the caller's loop, one [`iterate`](Self::iterate) at a time.
///
/// Dropping it ends it at once: queued messages are not delivered, its objects are dropped.
pub struct Captured {
    context: Context,
}

impl Captured {
    /// Returns the handle of the thread, for other threads.
    pub fn handle(&self) -> &ThreadHandle {
        self.context.handle()
    }

    /// Runs one iteration: delivers messages and calls the workers. Returns when to call this again.
    ///
    /// With winit: `Now` is `ControlFlow::Poll`, `At` is `WaitUntil`, `OnMessage` is `Wait`,
    /// `Stopped` leaves the event loop. An earlier call does no harm.
    pub fn iterate(&mut self) -> Next {
        self.context.iterate()
    }

    /// Returns the context of the thread, for registering objects directly. Call
    /// [`iterate`](Self::iterate) afterwards, so that alarms and stops requested here take effect.
    pub fn context(&mut self) -> &mut Context {
        &mut self.context
    }
}
