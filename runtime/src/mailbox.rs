//! The one place where threads meet: a queue, and who must be woken when something is put in it.
//!
//! Three states. The sender looks at the state *after* its push, the owner looks at the queue
//! *after* it changed the state; so at least one of the two sees the other, and no message is
//! left lying in a thread that sleeps or has closed:
//!
//! ```text
//! sender                      owner, before it sleeps      owner, when it closes
//! push                        state = ASLEEP               state = CLOSED
//! state ASLEEP? -> wake it    queue empty? else go on      throw away what is queued
//! state CLOSED? -> throw away what is queued
//! ```
//!
//! Cost of a send to a thread that is awake: one allocation for the message's box, two atomic
//! loads, one short lock.

use crate::sync::atomic::{AtomicU8, Ordering};
use crate::sync::{Queue, planted};
use crate::{Context, address::Permit, trace::Stamp};
use std::any::Any;
use std::collections::VecDeque;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::time::Duration;

/// What is stored until the thread's next iteration.
pub(crate) struct Envelope {
    pub(crate) content: Content,
    /// Who sent it and when; only when the thread that gets it is traced.
    pub(crate) stamp: Option<Box<Stamp>>,
}

/// A message of the thesis (§3.2.6.4): whom it is for, and data of any type; or one that the
/// thread itself understands.
pub(crate) enum Content {
    /// For the receiver of that number.
    Message {
        to: u32,
        type_name: &'static str,
        data: Box<dyn Any + Send>,
        /// Room in a bounded address, given back when the message leaves the queue.
        permit: Option<Permit>,
    },
    /// For the receiver of that number: whatever is newest when its turn comes.
    Latest { to: u32, slot: Arc<dyn Latest> },
    /// For the thread itself: registers, observers, traces.
    Run(Box<dyn FnOnce(&mut Context) + Send>),
    /// For the thread itself: sleep this long.
    Sleep(Duration),
    /// For the thread itself: stop; nothing behind this is delivered.
    Stop,
}

/// Where the newest message of a conflating address waits.
pub(crate) trait Latest: Send + Sync {
    /// Takes the newest message out, if it has not been taken yet.
    fn take(&self) -> Option<Box<dyn Any + Send>>;
    fn type_name(&self) -> &'static str;
}

const AWAKE: u8 = 0;
const ASLEEP: u8 = 1;
const CLOSED: u8 = 2;

/// The queue of one thread. Any thread may [`send`](Self::send); everything else is the owner's.
pub(crate) struct Mailbox {
    queue: Queue<Envelope>,
    state: AtomicU8,
    wake: Box<dyn Fn() + Send + Sync>,
}

impl Mailbox {
    /// `wake` must end the owner's sleep; it is called from sending threads.
    pub(crate) fn new(wake: Box<dyn Fn() + Send + Sync>) -> Self {
        Self { queue: Queue::new(), state: AtomicU8::new(AWAKE), wake }
    }

    /// Stores `envelope`, or gives it back when the mailbox is closed.
    ///
    /// Never waits. One that is accepted at the very moment of closing may be thrown away like one
    /// that stood behind the stop; the number thrown away here is the second part of the answer.
    pub(crate) fn send(&self, envelope: Envelope) -> Result<usize, Envelope> {
        if self.is_closed() {
            return Err(envelope);
        }
        let early = planted("lost_notify").then(|| self.state.load(Ordering::SeqCst));
        self.queue.push(envelope);
        let state = early.unwrap_or_else(|| self.state.load(Ordering::SeqCst));
        match state {
            ASLEEP => self.wake_if_asleep(),
            // It closed between the first look and the push: nobody else will empty the queue.
            CLOSED if !planted("late_send") => return Ok(self.discard()),
            _ => {}
        }
        Ok(0)
    }

    /// Wakes the owner if it said it would sleep; of many senders only the first pays for it.
    fn wake_if_asleep(&self) {
        let first = self.state.compare_exchange(ASLEEP, AWAKE, Ordering::SeqCst, Ordering::SeqCst);
        if first.is_ok() {
            (self.wake)();
        }
    }

    /// Ends any sleep, also one that no message ends (paused, or told to sleep).
    pub(crate) fn wake_now(&self) {
        (self.wake)();
    }

    /// The owner is up: senders need not wake it.
    pub(crate) fn stay_awake(&self) {
        self.enter(AWAKE);
    }

    /// The owner wants to sleep until a message comes. `false`: one is here already.
    pub(crate) fn fall_asleep(&self) -> bool {
        self.enter(ASLEEP);
        if self.queue.len() > 0 && !planted("unchecked_sleep") {
            self.stay_awake();
            return false;
        }
        true
    }

    /// Takes everything stored so far, oldest first.
    pub(crate) fn drain(&self, into: &mut VecDeque<Envelope>) {
        self.queue.drain(into);
        if planted("reversed_batch") {
            into.make_contiguous().reverse();
        }
    }

    /// Refuses what comes from now on, and throws away what is there: how many messages.
    pub(crate) fn close(&self) -> usize {
        if planted("sweep_before_close") {
            let count = self.discard();
            self.enter(CLOSED);
            return count;
        }
        self.enter(CLOSED);
        self.discard()
    }

    /// Has nothing happened since [`fall_asleep`](Self::fall_asleep)?
    pub(crate) fn is_asleep(&self) -> bool {
        self.state.load(Ordering::SeqCst) == ASLEEP
    }

    pub(crate) fn is_closed(&self) -> bool {
        self.state.load(Ordering::SeqCst) == CLOSED
    }

    pub(crate) fn len(&self) -> usize {
        self.queue.len()
    }

    /// A swap, not a store: it takes its place behind what a sender changed, and sees it.
    fn enter(&self, state: u8) {
        self.state.swap(state, Ordering::SeqCst);
    }

    fn discard(&self) -> usize {
        let mut left = VecDeque::new();
        self.queue.drain(&mut left);
        left.into_iter().map(Envelope::discard).sum()
    }
}

impl Envelope {
    /// Drops it undelivered: how many messages of the program (not of the runtime) that was.
    /// One that panics when it is dropped is dropped all the same.
    pub(crate) fn discard(self) -> usize {
        let discard = || match self.content {
            Content::Message { .. } => 1,
            Content::Latest { slot, .. } => usize::from(slot.take().is_some()),
            Content::Run(_) | Content::Sleep(_) | Content::Stop => 0,
        };
        catch_unwind(AssertUnwindSafe(discard)).unwrap_or(1)
    }
}
