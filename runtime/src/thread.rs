//! A thread's owner: an OS thread of its own, or one that is driven from outside.

use crate::clock::Clock;
use crate::shared::Shared;
use crate::sync::{Held, mutant, park, thread};
use crate::{Context, Next, ThreadHandle};
use std::cell::Cell;
use std::io;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How long dropping a [`Thread`] waits for it to end.
pub const DROP_DEADLINE: Duration = Duration::from_secs(2);

/// An OS thread that runs the loop: asleep until a message comes, a deadline passes, or for as
/// long as a worker asks to go on.
///
/// Dropping it stops the thread behind its queued messages and waits for that, for at most
/// [`DROP_DEADLINE`]; a thread that is stuck in a call is then left to itself and reported.
pub struct Thread {
    handle: ThreadHandle,
    os_thread: Option<thread::JoinHandle<()>>,
}

impl Thread {
    /// Starts an OS thread called `name`.
    ///
    /// # Errors
    /// When the system gives no thread.
    ///
    /// # Panics
    /// When `name` contains a zero byte.
    pub fn start(name: &str) -> io::Result<Self> {
        // The mailbox must know whom to wake, and the loop needs the mailbox: so the thread is
        // started first, and waits until its mailbox is laid in the cradle.
        let cradle = Arc::new(Held::new(None));
        let theirs = Arc::clone(&cradle);
        let os_thread = thread::Builder::new().name(name.to_owned()).spawn(move || thread_proc(&theirs))?;
        let sleeper = os_thread.thread().clone();
        let wake = Box::new(move || sleeper.unpark());
        let shared = Shared::new(name, Clock::Real, wake);
        cradle.with(|cradle| *cradle = Some(Arc::clone(&shared)));
        os_thread.thread().unpark();
        Ok(Self { handle: ThreadHandle { shared }, os_thread: Some(os_thread) })
    }

    /// Makes a thread of the caller's: there is no OS thread, the caller's loop calls
    /// [`Captured::iterate`]. For the main thread, whose loop belongs to the window system.
    ///
    /// `wake` is called from sending threads when a message comes after `iterate` said it would
    /// wait, and on [`resume`](ThreadHandle::resume) and
    /// [`remote_stop`](ThreadHandle::remote_stop). It must be quick and make the caller's loop
    /// call `iterate` soon; once too often does no harm.
    pub fn capture(name: &str, wake: impl Fn() + Send + Sync + 'static) -> Captured {
        Captured { context: Context::new(Shared::new(name, Clock::Real, Box::new(wake))) }
    }

    /// Its remote control.
    pub fn handle(&self) -> &ThreadHandle {
        &self.handle
    }

    /// Waits until all of `threads` have stopped and dropped their objects.
    ///
    /// It only waits: stop them before. A thread that waits for itself waits in vain.
    ///
    /// # Errors
    /// The names of those that still run at `deadline`.
    pub fn wait_for(threads: &[ThreadHandle], deadline: Instant) -> Result<(), Vec<String>> {
        mutant!(Self::unchecked_wait(threads, deadline));
        let names = || -> Vec<String> {
            let running = threads.iter().filter(|one| !one.is_stopped());
            running.map(|one| one.name().to_owned()).collect()
        };
        // First said, then looked: a thread that finishes in between either sees who waits or is
        // seen as finished.
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
            return; // It owns itself; the stop is in its queue.
        }
        let waited = Self::wait_for(std::slice::from_ref(&self.handle), Instant::now() + DROP_DEADLINE);
        if waited.is_err() {
            tracing::error!(thread = self.handle.name(), "does not stop; left to itself");
            return;
        }
        if os_thread.join().is_err() {
            tracing::error!(thread = self.handle.name(), "its loop panicked");
        }
    }
}

/// The loop of a thread of its own (thesis §3.2.6.1).
fn thread_proc(cradle: &Held<Option<Arc<Shared>>>) {
    let shared = loop {
        match cradle.with(Option::take) {
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
        // Who was told to sleep or to pause is awake in this sense, and looks for nothing.
        if !context.spin.is_zero() && mailbox.is_asleep() {
            mailbox
                .look(patience(deadline.map_or(context.spin, |deadline| left(deadline).min(context.spin))));
            if !mailbox.is_asleep() {
                continue;
            }
        }
        // A wake-up that nobody meant, which the system allows itself, is slept through.
        park(deadline);
        while !due() && mailbox.is_asleep() {
            park(deadline);
        }
    }
}

/// Looks on for as long as `limit`. In between whoever waits for this core has a turn, soon: it
/// may be the one that is waited for.
fn patience(limit: Duration) -> impl Fn() -> bool {
    const LOOKS: u32 = 16;
    let (begin, looks) = (Instant::now(), Cell::new(0));
    move || {
        looks.set(looks.get() + 1);
        std::hint::spin_loop();
        if looks.get() % LOOKS != 0 {
            return true;
        }
        thread::yield_now();
        begin.elapsed() < limit
    }
}

/// A thread that is driven from outside: the same loop, one [`iterate`](Self::iterate) at a time.
///
/// Dropping it ends it at once: what is queued is not delivered, its objects are dropped.
pub struct Captured {
    context: Context,
}

impl Captured {
    /// Its remote control.
    pub fn handle(&self) -> &ThreadHandle {
        self.context.handle()
    }

    /// One iteration: delivers, calls the workers, and says when to call this again.
    ///
    /// With winit: `Now` is `ControlFlow::Poll`, `At` is `WaitUntil`, `OnMessage` is `Wait`,
    /// `Stopped` leaves the event loop. Calling it earlier than asked does no harm.
    pub fn iterate(&mut self) -> Next {
        self.context.iterate()
    }

    /// The inside of the thread, for registering objects directly. Call [`iterate`](Self::iterate)
    /// afterwards, so that what was asked for here is taken into account.
    pub fn context(&mut self) -> &mut Context {
        &mut self.context
    }
}
