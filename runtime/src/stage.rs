//! Threads on a test's strings: iterations, clock and message order are stepped by hand.

use crate::clock::Clock;
use crate::mailbox::Content;
use crate::shared::Shared;
use crate::thread::Captured;
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
    threads: Vec<Captured>,
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
        let shared = Shared::new(name, self.clock.clone(), Box::new(|| {}));
        let thread = Captured::new(shared);
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
        self.captured(thread).iterate()
    }

    /// The inside of `thread`, for registering objects directly.
    pub fn context(&mut self, thread: &ThreadHandle) -> &mut Context {
        self.captured(thread).context()
    }

    /// What waits for `thread`, in the order in which it would be delivered.
    pub fn waiting(&mut self, thread: &ThreadHandle) -> Vec<Waiting> {
        let context = self.context(thread);
        context.fetch_messages();
        let describe = |content: &Content| {
            let (to, message) = match content {
                Content::Message { to, type_name, .. } => (to, *type_name),
                Content::Latest { to, slot } => (to, slot.type_name()),
                Content::Run(_) => (&0, "run"),
                Content::Sleep(_) => (&0, "sleep"),
                Content::Stop => (&0, "stop"),
            };
            let to = context.receivers.get(to).map(|slot| Arc::clone(&slot.name)).unwrap_or_default();
            Waiting { to, message }
        };
        context.batch.iter().map(|envelope| describe(&envelope.content)).collect()
    }

    /// Delivers the message at `index` of [`waiting`](Self::waiting) before all others, and calls
    /// no worker; `false` when there is none. Messages of different senders may come in any order,
    /// so a test may try any; those of one sender keep theirs on a real thread.
    pub fn deliver(&mut self, thread: &ThreadHandle, index: usize) -> bool {
        let context = self.context(thread);
        context.fetch_messages();
        let envelope = context.batch.remove(index);
        envelope.map(|envelope| context.resolve_message(envelope)).is_some()
    }

    /// Iterates all threads in turn, in the order in which they were started, until nothing is due
    /// before the clock is turned, or for `limit` rounds. `true`: nothing is due.
    pub fn settle(&mut self, limit: usize) -> bool {
        for _ in 0..limit {
            let mut busy = false;
            for thread in &mut self.threads {
                busy |= match thread.iterate() {
                    Next::Now => true,
                    Next::At(when) => when <= self.clock.now(),
                    // Somebody may have sent to one that had its turn in this round.
                    Next::OnMessage | Next::Stopped => false,
                };
            }
            if !busy && !self.threads.iter_mut().any(has_mail) {
                return true;
            }
        }
        false
    }

    fn captured(&mut self, thread: &ThreadHandle) -> &mut Captured {
        let found = self.threads.iter_mut().find(|one| one.handle() == thread);
        found.unwrap_or_else(|| panic!("thread {:?} is not on this stage", thread.name()))
    }
}

/// Would an iteration deliver something?
fn has_mail(thread: &mut Captured) -> bool {
    thread.handle().queue_len() > 0 && !thread.context().halted()
}
