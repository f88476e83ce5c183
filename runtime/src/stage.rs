//! Deterministic single-step scheduler for tests: the test controls iterations, clock and message
//! order.

use crate::clock::ThreadClock;
use crate::shared::ThreadShared;
use crate::{Context, Next, ThreadHandle};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A test scheduler: threads without OS threads, and one clock for all of them, which the test
/// advances.
///
/// Everything runs in the caller's thread, in the order of the caller's calls, so a test built on it
/// is deterministic. The loop is the same as in every other thread.
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
#[doc(alias = "mock")]
#[doc(alias = "test scheduler")]
#[doc(alias = "virtual time")]
pub struct Stage {
    clock: ThreadClock,
    threads: Vec<Context>,
}

/// A queued message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PendingMessage {
    /// The receiver's name; empty when there is none, and for commands to the thread itself.
    pub to: Arc<str>,
    /// The type of the message; `run`, `sleep` or `stop` for commands to the thread itself.
    pub message: &'static str,
}

impl Default for Stage {
    fn default() -> Self {
        Self::new()
    }
}

impl Stage {
    /// Returns an empty stage. Its clock starts at the current time.
    pub fn new() -> Self {
        Self { clock: ThreadClock::manual(), threads: Vec::new() }
    }

    /// Adds a thread. It runs only when the stage iterates it.
    pub fn start(&mut self, name: &str) -> ThreadHandle {
        let thread = Context::new(ThreadShared::new(name, self.clock.clone(), Box::new(|| {})));
        let handle = thread.handle().clone();
        self.threads.push(thread);
        handle
    }

    /// Returns the time of the stage's clock.
    pub fn now(&self) -> Instant {
        self.clock.now()
    }

    /// Advances the clock. Calls no object: run what is due with [`settle`](Self::settle).
    pub fn advance(&mut self, by: Duration) {
        self.clock.advance(by);
    }

    /// Runs one iteration of `thread`.
    ///
    /// # Panics
    /// When `thread` is not on this stage. The same holds for all methods that take a thread.
    pub fn iterate(&mut self, thread: &ThreadHandle) -> Next {
        self.context(thread).iterate()
    }

    /// Returns the context of `thread`, for registering objects directly.
    pub fn context(&mut self, thread: &ThreadHandle) -> &mut Context {
        let found = self.threads.iter_mut().find(|one| one.handle() == thread);
        found.unwrap_or_else(|| panic!("thread {:?} is not on this stage", thread.name()))
    }

    /// Returns the queued messages of `thread`, in the order in which they would be delivered.
    pub fn waiting(&mut self, thread: &ThreadHandle) -> Vec<PendingMessage> {
        let context = self.context(thread);
        context.fetch_messages();
        let describe = |(to, message)| {
            let to = context.objects.get(&to).map(|slot| slot.label().name).unwrap_or_default();
            PendingMessage { to, message }
        };
        context.batch.describe().map(describe).collect()
    }

    /// Delivers the message at `index` of [`waiting`](Self::waiting) before all others, and calls
    /// no worker. Returns `false` when there is none. Messages of different senders may arrive in any
    /// order, so a test may try each; on a real thread those of one sender keep their order.
    pub fn deliver(&mut self, thread: &ThreadHandle, index: usize) -> bool {
        let context = self.context(thread);
        context.fetch_messages();
        let mut batch = std::mem::take(&mut context.batch);
        let found = batch.deliver_at(index, context);
        context.batch = batch;
        found
    }

    /// Iterates all threads in turn, in the order of their start, until nothing is due at the current
    /// time, or for `limit` rounds. Returns whether nothing is due any more.
    pub fn settle(&mut self, limit: usize) -> bool {
        for _ in 0..limit {
            let mut busy = false;
            for thread in &mut self.threads {
                let next = thread.iterate();
                busy |= next == Next::Now || matches!(next, Next::At(when) if when <= self.clock.now());
            }
            // A later thread may have sent a message to one that was already iterated in this round.
            let mut mail = self.threads.iter_mut();
            if !busy && !mail.any(|thread| thread.handle.queue_len() > 0 && !thread.halted()) {
                return true;
            }
        }
        false
    }
}
