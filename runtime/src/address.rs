//! Where to send a message: typed, cheap to clone, never waiting.

use crate::batch::{Content, Wrapped};
use crate::shared::Shared;
use crate::sync::atomic::{AtomicUsize, Ordering};
use crate::sync::{Held, mutant};
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
pub struct Address<M>(Arc<Route<M>>);

/// The way to a receiver, shared by all clones of an address.
struct Route<M> {
    thread: Arc<Shared>,
    receiver: u32,
    /// Where in the thread's mailbox the letters of this flavour lie.
    row: u32,
    flavour: Flavour<M>,
}

enum Flavour<M> {
    Plain,
    /// The message that waits.
    Latest(Held<Option<M>>),
    Bounded {
        limit: usize,
        weight: fn(&M) -> usize,
        waiting: AtomicUsize,
    },
}

/// Letters of the three flavours.
struct Plain<M>(M);
struct Newest<M>(Arc<Route<M>>);
struct Weighed<M>(M, usize, Arc<Route<M>>);

impl<M: Send + 'static> Address<M> {
    pub(crate) fn new(thread: &Arc<Shared>, receiver: u32) -> Self {
        Self::with::<Plain<M>>(thread, receiver, Flavour::Plain)
    }

    fn with<C: Content>(thread: &Arc<Shared>, receiver: u32, flavour: Flavour<M>) -> Self {
        let (thread, row) = (Arc::clone(thread), thread.mailbox.0.row::<C>());
        Self(Arc::new(Route { thread, receiver, row, flavour }))
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
        let stopped = |content: Plain<M>| SendError::Stopped(content.0);
        match &self.0.flavour {
            Flavour::Plain => self.put(Plain(message)).map_err(stopped),
            Flavour::Latest(waiting) => self.replace(waiting, message),
            Flavour::Bounded { .. } => {
                let Some(weight) = self.0.admit(&message) else {
                    self.0.thread.tallies.0.refused.add(1);
                    return Err(SendError::Full(message));
                };
                let letter = Weighed(message, weight, Arc::clone(&self.0));
                let back = self.put(letter).err().and_then(Wrapped::open);
                back.map_or(Ok(()), |message| Err(SendError::Stopped(message)))
            }
        }
    }

    /// An address of the same receiver at which at most one message waits: the newest.
    ///
    /// It is delivered in the place of the first one it stands for, so it may overtake messages
    /// that were sent to other addresses in between.
    #[must_use]
    pub fn latest(&self) -> Self {
        Self::with::<Newest<M>>(&self.0.thread, self.0.receiver, Flavour::Latest(Held::new(None)))
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
        let bounded = Flavour::Bounded { limit, weight, waiting: AtomicUsize::new(0) };
        Self::with::<Weighed<M>>(&self.0.thread, self.0.receiver, bounded)
    }

    /// How much waits at this address: messages, or their weight. 0 for a plain one, which does
    /// not count; see [`queue_len`](Self::queue_len).
    pub fn waiting(&self) -> usize {
        match &self.0.flavour {
            Flavour::Plain => 0,
            Flavour::Latest(waiting) => waiting.with(|waiting| usize::from(waiting.is_some())),
            Flavour::Bounded { waiting, .. } => waiting.load(Ordering::Relaxed),
        }
    }

    /// How many messages its thread has stored for the next iteration, for all receivers.
    pub fn queue_len(&self) -> usize {
        self.0.thread.mailbox.0.len()
    }

    /// Has the thread stopped, so that every send fails?
    pub fn is_stopped(&self) -> bool {
        self.0.thread.mailbox.0.is_closed()
    }

    /// The thread of the receiver.
    pub(crate) fn thread(&self) -> &Arc<Shared> {
        &self.0.thread
    }

    /// A caller's mistake, not a thing that happens: addresses are not mixed up by chance.
    pub(crate) fn receiver_in(&self, thread: &Arc<Shared>) -> u32 {
        let (own, other) = (&self.0.thread.name, &thread.name);
        assert!(
            Arc::ptr_eq(&self.0.thread, thread),
            "the address belongs to thread {own:?}, not to {other:?}"
        );
        self.0.receiver
    }

    fn put<C: Content>(&self, content: C) -> Result<(), C> {
        self.0.thread.send(self.0.receiver, self.0.row, content)
    }

    /// Whoever finds nothing waiting holds a place in the thread's queue for it; whoever finds a
    /// message takes its place. When the turn of that place comes, nothing waits again.
    fn replace(&self, waiting: &Held<Option<M>>, message: M) -> Result<(), SendError<M>> {
        if self.is_stopped() {
            return Err(SendError::Stopped(message));
        }
        mutant!(self.announced_too_long(waiting, message));
        if waiting.with(|waiting| waiting.replace(message)).is_some() {
            self.0.thread.tallies.0.replaced.add(1);
            return Ok(());
        }
        self.announce()
    }

    /// Queues the letter that stands for the newest message. If the thread has stopped since, the
    /// message is given back; a newer one, if another sender replaced it.
    pub(crate) fn announce(&self) -> Result<(), SendError<M>> {
        let back = self.put(Newest(Arc::clone(&self.0))).err().and_then(Wrapped::open);
        back.map_or(Ok(()), |newest| Err(SendError::Stopped(newest)))
    }
}

impl<M> Route<M> {
    /// What the message weighs, when there is room for it; the room is taken then.
    fn admit(&self, message: &M) -> Option<usize> {
        let Flavour::Bounded { limit, weight, waiting } = &self.flavour else { return Some(0) };
        let weight = weight(message);
        let fits = |now: usize| now.checked_add(weight).filter(|after| after <= limit);
        waiting.fetch_update(Ordering::Relaxed, Ordering::Relaxed, fits).ok()?;
        Some(weight)
    }

    fn release(&self, weight: usize) {
        if let Flavour::Bounded { waiting, .. } = &self.flavour {
            waiting.fetch_sub(weight, Ordering::Relaxed);
        }
    }
}

impl<M: Send + 'static> Wrapped for Plain<M> {
    type Message = M;

    fn open(self) -> Option<M> {
        Some(self.0)
    }
}

impl<M: Send + 'static> Wrapped for Newest<M> {
    type Message = M;

    /// Nothing, when its sender was given it back at the very moment of the stop.
    fn open(self) -> Option<M> {
        let Flavour::Latest(waiting) = &self.0.flavour else { return None };
        waiting.with(Option::take)
    }
}

impl<M: Send + 'static> Wrapped for Weighed<M> {
    type Message = M;

    /// Its room in the address is free as soon as it has left the queue.
    fn open(self) -> Option<M> {
        self.2.release(self.1);
        Some(self.0)
    }
}

impl<M> Clone for Address<M> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<M> fmt::Debug for Address<M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Address({}/{})", self.0.thread.name, self.0.receiver)
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
