//! Threads on a test's strings: iterations, clock and message order are stepped by hand.

use crate::clock::Clock;
use crate::shared::Shared;
use crate::{Context, Next, ThreadHandle};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A stage: threads without OS threads, and one clock for all that stands still until turned.
///
/// Everything runs in the caller, in the order the caller says, so a test built on it always goes
/// the same way. The loop is that of every other thread.
///
/// ```
/// # use dragonfly_runtime::{Context, Next, Receiver, Stage};
/// # use std::time::Duration;
/// struct Bell(u32);
/// impl Receiver for Bell {
///     type Message = u32;
///     fn receive(&mut self, times: u32, thread: &mut Context) {
///         self.0 += times;
///         thread.wake_at(thread.now() + Duration::from_secs(1));
///     }
/// }
///
/// let mut stage = Stage::new();
/// let tower = stage.start("tower");
/// let bell = stage.context(&tower).register_receiver(Bell(0));
/// bell.send(3).unwrap();
/// let Next::At(when) = stage.iterate(&tower) else { panic!("it asked to be woken") };
/// assert_eq!(when, stage.now() + Duration::from_secs(1));
/// stage.advance(Duration::from_secs(1));
/// assert_eq!(stage.iterate(&tower), Next::OnMessage);
/// ```
pub struct Stage {
    clock: Clock,
    threads: Vec<Context>,
}

/// A message that waits for delivery.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Waiting {
    /// The receiver's name; empty when there is none, and for messages to the thread itself.
    pub to: Arc<str>,
    /// The type of the message; `run`, `sleep` or `stop` for those to the thread itself.
    pub message: &'static str,
}

impl Default for Stage {
    fn default() -> Self {
        Self::new()
    }
}

impl Stage {
    /// An empty stage. Its clock starts at the present time.
    pub fn new() -> Self {
        Self { clock: Clock::manual(), threads: Vec::new() }
    }

    /// Puts a thread on the stage. It does nothing until told to.
    pub fn start(&mut self, name: &str) -> ThreadHandle {
        let thread = Context::new(Shared::new(name, self.clock.clone(), Box::new(|| {})));
        let handle = thread.handle().clone();
        self.threads.push(thread);
        handle
    }

    /// The time on the stage.
    pub fn now(&self) -> Instant {
        self.clock.now()
    }

    /// Turns the clock forward. Nobody is called: see what is due with [`settle`](Self::settle).
    pub fn advance(&mut self, by: Duration) {
        self.clock.advance(by);
    }

    /// One iteration of `thread`.
    ///
    /// # Panics
    /// Like all methods that name a thread, when it is not on this stage.
    pub fn iterate(&mut self, thread: &ThreadHandle) -> Next {
        self.context(thread).iterate()
    }

    /// The inside of `thread`, for registering objects directly.
    pub fn context(&mut self, thread: &ThreadHandle) -> &mut Context {
        let found = self.threads.iter_mut().find(|one| one.handle() == thread);
        found.unwrap_or_else(|| panic!("thread {:?} is not on this stage", thread.name()))
    }

    /// What waits for `thread`, in the order in which it would be delivered.
    pub fn waiting(&mut self, thread: &ThreadHandle) -> Vec<Waiting> {
        let context = self.context(thread);
        context.fetch_messages();
        let describe = |(to, message)| {
            let to = context.objects.get(&to).map(|slot| slot.label().name).unwrap_or_default();
            Waiting { to, message }
        };
        context.batch.describe().map(describe).collect()
    }

    /// Delivers the message at `index` of [`waiting`](Self::waiting) before all others, and calls
    /// no worker; `false` when there is none. Messages of different senders may come in any order,
    /// so a test may try any; those of one sender keep theirs on a real thread.
    pub fn deliver(&mut self, thread: &ThreadHandle, index: usize) -> bool {
        let context = self.context(thread);
        context.fetch_messages();
        let mut batch = std::mem::take(&mut context.batch);
        let found = batch.deliver_at(index, context);
        context.batch = batch;
        found
    }

    /// Iterates all threads in turn, in the order in which they were started, until nothing is due
    /// before the clock is turned, or for `limit` rounds. `true`: nothing is due.
    pub fn settle(&mut self, limit: usize) -> bool {
        for _ in 0..limit {
            let mut busy = false;
            for thread in &mut self.threads {
                let next = thread.iterate();
                busy |= next == Next::Now || matches!(next, Next::At(when) if when <= self.clock.now());
            }
            // Somebody may have sent to one that had its turn in this round.
            let mut mail = self.threads.iter_mut();
            if !busy && !mail.any(|thread| thread.handle.queue_len() > 0 && !thread.halted()) {
                return true;
            }
        }
        false
    }
}
