//! Typed addresses of receivers, to which other threads send messages without blocking.

use crate::batch::{Envelope, LetterContent};
use crate::shared::ThreadShared;
use crate::sync::atomic::{AtomicUsize, Ordering};
use crate::sync::{BriefLock, mutant};
use std::fmt;
use std::sync::Arc;

/// The address of a receiver in some thread (thesis §3.2.6.4: target thread and receiver).
///
/// Messages sent by one thread to one thread arrive in the order of sending, whichever receivers
/// they are for. There are three flavors; all clones of an address share its bounds:
///
/// | created by | when messages arrive faster than they are delivered |
/// |---|---|
/// | registering a receiver | all are queued, without a limit |
/// | [`latest`](Self::latest) | the newest replaces the queued one |
/// | [`bounded`](Self::bounded) | the sender gets [`SendError::Full`] |
///
/// Use `latest` for messages that a newer one makes obsolete (pointer moves, sizes, scrubbing),
/// `bounded` where a fast producer needs back-pressure, and the plain address for edits and
/// requests.
#[doc(alias = "channel")]
#[doc(alias = "sender")]
#[doc(alias = "actor reference")]
pub struct Address<M>(Arc<Route<M>>);

/// Target and bounds of an address, shared by all its clones.
struct Route<M> {
    thread: Arc<ThreadShared>,
    receiver: u32,
    /// Number of the mailbox row that stores this flavor's letters.
    row: u32,
    flavor: Flavor<M>,
}

enum Flavor<M> {
    Plain,
    /// The queued message, if there is one.
    Latest(BriefLock<Option<M>>),
    Bounded {
        limit: usize,
        weight: fn(&M) -> usize,
        waiting: AtomicUsize,
    },
}

/// A message sent to a plain address.
struct PlainLetter<M>(M);
/// A queue position for the message that a `latest` address holds when it is delivered.
struct LatestLetter<M>(Arc<Route<M>>);
/// A message sent to a bounded address, its weight, and the address that counts it.
struct BoundedLetter<M>(M, usize, Arc<Route<M>>);

impl<M: Send + 'static> Address<M> {
    pub(crate) fn new(thread: &Arc<ThreadShared>, receiver: u32) -> Self {
        Self::with::<PlainLetter<M>>(thread, receiver, Flavor::Plain)
    }

    fn with<C: LetterContent>(thread: &Arc<ThreadShared>, receiver: u32, flavor: Flavor<M>) -> Self {
        let (thread, row) = (Arc::clone(thread), thread.mailbox.0.row::<C>());
        Self(Arc::new(Route { thread, receiver, row, flavor }))
    }

    /// Queues `message` for the receiver's next iteration and returns at once.
    ///
    /// `Ok` does not mean delivered: the receiver may have been removed, or the thread may stop
    /// with the message still queued. The thread counts both ([`Counters`](crate::Counters)).
    ///
    /// # Errors
    /// Returns the message when the thread has stopped, or when this address is bounded and full.
    pub fn send(&self, message: M) -> Result<(), SendError<M>> {
        let stopped = |content: PlainLetter<M>| SendError::Stopped(content.0);
        match &self.0.flavor {
            Flavor::Plain => self.put(PlainLetter(message)).map_err(stopped),
            Flavor::Latest(waiting) => self.replace(waiting, message),
            Flavor::Bounded { .. } => {
                let Some(weight) = self.0.admit(&message) else {
                    self.0.thread.tallies.0.refused.add(1);
                    return Err(SendError::Full(message));
                };
                let letter = BoundedLetter(message, weight, Arc::clone(&self.0));
                let back = self.put(letter).err().and_then(Envelope::open);
                back.map_or(Ok(()), |message| Err(SendError::Stopped(message)))
            }
        }
    }

    /// Returns an address of the same receiver at which only the newest message is queued.
    ///
    /// It is delivered at the queue position of the first message that it replaced, so it may
    /// overtake messages that were sent to other addresses in between.
    #[must_use]
    pub fn latest(&self) -> Self {
        Self::with::<LatestLetter<M>>(&self.0.thread, self.0.receiver, Flavor::Latest(BriefLock::new(None)))
    }

    /// Returns an address of the same receiver at which at most `limit` messages are queued.
    #[must_use]
    pub fn bounded(&self, limit: usize) -> Self {
        self.bounded_by(limit, |_| 1)
    }

    /// Returns an address of the same receiver at which at most `limit` total weight is queued.
    /// `weight` returns the weight of a message, for example its bytes. A message heavier than
    /// `limit` is never accepted.
    #[must_use]
    pub fn bounded_by(&self, limit: usize, weight: fn(&M) -> usize) -> Self {
        let bounded = Flavor::Bounded { limit, weight, waiting: AtomicUsize::new(0) };
        Self::with::<BoundedLetter<M>>(&self.0.thread, self.0.receiver, bounded)
    }

    /// Returns how much is queued at this address: the number of messages, or their total weight.
    /// Always 0 for a plain address, which does not count; see [`queue_len`](Self::queue_len).
    pub fn waiting(&self) -> usize {
        match &self.0.flavor {
            Flavor::Plain => 0,
            Flavor::Latest(waiting) => waiting.with(|waiting| usize::from(waiting.is_some())),
            Flavor::Bounded { waiting, .. } => waiting.load(Ordering::Relaxed),
        }
    }

    /// Returns the number of messages queued in the receiver's thread, for all its receivers.
    pub fn queue_len(&self) -> usize {
        self.0.thread.mailbox.0.len()
    }

    /// Returns whether the thread has stopped, so that every send fails.
    pub fn is_stopped(&self) -> bool {
        self.0.thread.mailbox.0.is_closed()
    }

    /// Returns the shared part of the receiver's thread.
    pub(crate) fn thread(&self) -> &Arc<ThreadShared> {
        &self.0.thread
    }

    /// Returns the number of the receiver in `thread`. Panics when the address belongs to another
    /// thread, which is a bug of the caller.
    pub(crate) fn receiver_in(&self, thread: &Arc<ThreadShared>) -> u32 {
        let (own, other) = (&self.0.thread.name, &thread.name);
        assert!(
            Arc::ptr_eq(&self.0.thread, thread),
            "the address belongs to thread {own:?}, not to {other:?}"
        );
        self.0.receiver
    }

    fn put<C: LetterContent>(&self, content: C) -> Result<(), C> {
        self.0.thread.send(self.0.receiver, self.0.row, content)
    }

    /// Stores `message` as the newest one of a `latest` address. If none was stored, also queues a
    /// letter, whose delivery will take the stored message; otherwise such a letter is queued
    /// already.
    fn replace(&self, waiting: &BriefLock<Option<M>>, message: M) -> Result<(), SendError<M>> {
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

    /// Queues the letter of a `latest` address. If the thread has stopped in the meantime, fails
    /// with the stored message, which another sender may have replaced by a newer one.
    pub(crate) fn announce(&self) -> Result<(), SendError<M>> {
        let back = self.put(LatestLetter(Arc::clone(&self.0))).err().and_then(Envelope::open);
        back.map_or(Ok(()), |newest| Err(SendError::Stopped(newest)))
    }
}

impl<M> Route<M> {
    /// Reserves room for the message and returns its weight; `None` when there is no room.
    fn admit(&self, message: &M) -> Option<usize> {
        let Flavor::Bounded { limit, weight, waiting } = &self.flavor else { return Some(0) };
        let weight = weight(message);
        let fits = |now: usize| now.checked_add(weight).filter(|after| after <= limit);
        waiting.fetch_update(Ordering::Relaxed, Ordering::Relaxed, fits).ok()?;
        Some(weight)
    }

    fn release(&self, weight: usize) {
        if let Flavor::Bounded { waiting, .. } = &self.flavor {
            waiting.fetch_sub(weight, Ordering::Relaxed);
        }
    }
}

impl<M: Send + 'static> Envelope for PlainLetter<M> {
    type Message = M;

    fn open(self) -> Option<M> {
        Some(self.0)
    }
}

impl<M: Send + 'static> Envelope for LatestLetter<M> {
    type Message = M;

    /// Takes the stored message. Returns `None` when it was returned to its sender because the
    /// thread had stopped.
    fn open(self) -> Option<M> {
        let Flavor::Latest(waiting) = &self.0.flavor else { return None };
        waiting.with(Option::take)
    }
}

impl<M: Send + 'static> Envelope for BoundedLetter<M> {
    type Message = M;

    /// Returns the message, and frees the room that it took up at its bounded address.
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

/// The reason why a message was not accepted, with the message.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum SendError<M> {
    /// The thread has stopped and will never deliver a message again.
    Stopped(M),
    /// The bounded address is full; the same send may succeed later.
    Full(M),
}

impl<M> SendError<M> {
    /// Returns the message that was not sent.
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

// Not derived, because messages need not be `Debug`.
impl<M> fmt::Debug for SendError<M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "SendError({self})")
    }
}

impl<M> std::error::Error for SendError<M> {}
