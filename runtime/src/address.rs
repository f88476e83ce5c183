//! Where to send a message: typed, cheap to clone, never waiting.

use crate::mailbox::Content;
use crate::object::short_type_name;
use crate::register::Data;
use crate::shared::Shared;
use crate::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use crate::sync::{Queue, planted};
use std::fmt;
use std::sync::Arc;

/// The address of a receiver in some thread (thesis §3.2.6.4: target thread and receiver).
///
/// Messages sent by one thread to one thread arrive in the order of sending, whichever receivers
/// they are for. There are three flavours; all clones of one share its bounds:
///
/// | made by | when messages come faster than they are taken |
/// |---|---|
/// | registering a receiver | all wait, in any number |
/// | [`latest`](Self::latest) | the newest takes the place of the one that waits |
/// | [`bounded`](Self::bounded) | the sender gets [`SendError::Full`] |
///
/// Use `latest` for what a newer one makes pointless (pointer moves, sizes, scrubbing), `bounded`
/// where a fast producer must learn that it is too fast, the plain one for edits and requests.
pub struct Address<M> {
    pub(crate) thread: Arc<Shared>,
    pub(crate) receiver: u32,
    flavour: Flavour<M>,
}

enum Flavour<M> {
    Plain,
    Latest(Arc<Slot<M>>),
    Bounded(Arc<Bound<M>>),
}

impl<M: Send + 'static> Address<M> {
    pub(crate) fn new(thread: Arc<Shared>, receiver: u32) -> Self {
        Self { thread, receiver, flavour: Flavour::Plain }
    }

    /// Stores `message` for the receiver's next iteration and goes on at once.
    ///
    /// `Ok` does not mean delivered: the receiver may have been removed, or the thread may stop
    /// with the message still queued. Both are counted there ([`Counters`](crate::Counters)).
    ///
    /// # Errors
    /// Gives the message back when the thread has stopped, or when this address is bounded and
    /// full.
    pub fn send(&self, message: M) -> Result<(), SendError<M>> {
        match &self.flavour {
            Flavour::Plain => self.post(message, None),
            Flavour::Latest(slot) => self.replace(slot, message),
            Flavour::Bounded(bound) => match bound.admit(&message) {
                Some(permit) => self.post(message, Some(permit)),
                None => {
                    self.thread.tallies.refused.add(1);
                    Err(SendError::Full(message))
                }
            },
        }
    }

    /// An address of the same receiver at which at most one message waits: the newest.
    ///
    /// It is delivered in the place of the first one it stands for, so it may overtake messages
    /// that were sent to other addresses in between.
    #[must_use]
    pub fn latest(&self) -> Self {
        let slot = Slot {
            thread: Arc::clone(&self.thread),
            waiting: Queue::new(),
            announced: AtomicBool::new(false),
        };
        self.with(Flavour::Latest(Arc::new(slot)))
    }

    /// An address of the same receiver at which at most `limit` messages wait.
    #[must_use]
    pub fn bounded(&self, limit: usize) -> Self {
        self.bounded_by(limit, |_| 1)
    }

    /// An address of the same receiver at which messages of at most `limit` in all wait, each
    /// weighing what `weight` says: bytes, say. One that outweighs the limit alone never passes.
    #[must_use]
    pub fn bounded_by(&self, limit: usize, weight: fn(&M) -> usize) -> Self {
        let waiting = Arc::new(AtomicUsize::new(0));
        self.with(Flavour::Bounded(Arc::new(Bound { limit, weight, waiting })))
    }

    /// How much waits at this address: messages, or their weight. 0 for a plain one, which does
    /// not count; see [`queue_len`](Self::queue_len).
    pub fn waiting(&self) -> usize {
        match &self.flavour {
            Flavour::Plain => 0,
            Flavour::Latest(slot) => slot.waiting.len().min(1),
            Flavour::Bounded(bound) => bound.waiting.load(Ordering::Relaxed),
        }
    }

    /// How many messages its thread has stored for the next iteration, for all receivers.
    pub fn queue_len(&self) -> usize {
        self.thread.mailbox.len()
    }

    /// Has the thread stopped, so that every send fails?
    pub fn is_stopped(&self) -> bool {
        self.thread.mailbox.is_closed()
    }

    /// A caller's mistake, not a thing that happens: addresses are not mixed up by chance.
    pub(crate) fn check_thread(&self, thread: &Arc<Shared>) {
        let (own, other) = (&self.thread.name, &thread.name);
        assert!(Arc::ptr_eq(&self.thread, thread), "the address belongs to thread {own:?}, not to {other:?}");
    }

    fn with(&self, flavour: Flavour<M>) -> Self {
        Self { thread: Arc::clone(&self.thread), receiver: self.receiver, flavour }
    }

    fn post(&self, message: M, permit: Option<Permit>) -> Result<(), SendError<M>> {
        self.put(Content::Message(Box::new(message), permit)).map_err(|content| {
            let Content::Message(data, _) = content else {
                unreachable!("what comes back is what was sent");
            };
            let message = data.downcast().expect("the type it had above");
            SendError::Stopped(*message)
        })
    }

    fn put(&self, content: Content) -> Result<(), Content> {
        self.thread.send(self.receiver, short_type_name::<M>(), content)
    }

    fn replace(&self, slot: &Arc<Slot<M>>, message: M) -> Result<(), SendError<M>> {
        if self.is_stopped() {
            return Err(SendError::Stopped(message));
        }
        let old: Vec<M> = slot.waiting.drain().collect();
        slot.waiting.push(message);
        self.thread.tallies.replaced.add(old.len());
        if slot.announced.swap(true, Ordering::SeqCst) {
            return Ok(()); // A place in the queue is held already; the newest will be taken there.
        }
        let theirs = Arc::clone(slot);
        let take = move || theirs.take_newest().map(|message| Box::new(message) as Data);
        match self.put(Content::Latest(Box::new(take))) {
            Ok(()) => Ok(()),
            // When it is not there, a newer one replaced it, and that one's sender will be told.
            Err(_) => slot.take_newest().map_or(Ok(()), |newest| Err(SendError::Stopped(newest))),
        }
    }
}

impl<M> Clone for Address<M> {
    fn clone(&self) -> Self {
        Self {
            thread: Arc::clone(&self.thread),
            receiver: self.receiver,
            flavour: match &self.flavour {
                Flavour::Plain => Flavour::Plain,
                Flavour::Latest(slot) => Flavour::Latest(Arc::clone(slot)),
                Flavour::Bounded(bound) => Flavour::Bounded(Arc::clone(bound)),
            },
        }
    }
}

impl<M> fmt::Debug for Address<M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Address({}/{})", self.thread.name, self.receiver)
    }
}

/// Why a message was not accepted. The message can be recovered.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum SendError<M> {
    /// The thread has stopped; nothing will ever be delivered there again.
    Stopped(M),
    /// The bounded address is full; the same send may pass later.
    Full(M),
}

impl<M> SendError<M> {
    /// The message that was not sent.
    pub fn into_inner(self) -> M {
        match self {
            Self::Stopped(message) | Self::Full(message) => message,
        }
    }
}

impl<M> fmt::Display for SendError<M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Stopped(_) => "the thread has stopped",
            Self::Full(_) => "the address is full",
        })
    }
}

// By hand, because messages need not be `Debug`.
impl<M> fmt::Debug for SendError<M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "SendError({self})")
    }
}

impl<M> std::error::Error for SendError<M> {}

/// Where the newest message of a conflating address waits, and whether a place in the thread's
/// queue is held for it. A queue rather than a lock around an option, so that there is one kind
/// of thing that threads share.
struct Slot<M> {
    thread: Arc<Shared>,
    waiting: Queue<M>,
    announced: AtomicBool,
}

impl<M> Slot<M> {
    /// First the announcement is taken back, then the message: whoever puts one in between
    /// announces it anew. The other way round its message would wait for ever.
    fn take_newest(&self) -> Option<M> {
        let early = planted("announced_too_long").then(|| self.waiting.drain());
        self.announced.swap(false, Ordering::SeqCst);
        let mut waiting: Vec<M> = early.unwrap_or_else(|| self.waiting.drain()).collect();
        // Two senders at once may both have found it empty; then two are here.
        let newest = waiting.pop();
        self.thread.tallies.replaced.add(waiting.len());
        newest
    }
}

struct Bound<M> {
    limit: usize,
    weight: fn(&M) -> usize,
    waiting: Arc<AtomicUsize>,
}

impl<M> Bound<M> {
    fn admit(&self, message: &M) -> Option<Permit> {
        let weight = (self.weight)(message);
        let fits = |waiting: usize| {
            let after = waiting.checked_add(weight)?;
            (after <= self.limit).then_some(after)
        };
        self.waiting.fetch_update(Ordering::Relaxed, Ordering::Relaxed, fits).ok()?;
        let waiting = Arc::clone(&self.waiting);
        Some(Permit { waiting, weight })
    }
}

/// Room taken in a bounded address; dropping it gives the room back.
pub(crate) struct Permit {
    waiting: Arc<AtomicUsize>,
    weight: usize,
}

impl Drop for Permit {
    fn drop(&mut self) {
        self.waiting.fetch_sub(self.weight, Ordering::Relaxed);
    }
}
