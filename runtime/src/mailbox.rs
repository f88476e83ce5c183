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
use crate::{Context, address::Permit, register::Data, trace::Stamp};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What is stored until the thread's next iteration: a message of the thesis (§3.2.6.4), that is whom
/// it is for and data of any type; or one that the thread itself understands.
pub(crate) struct Envelope {
    /// The receiver's number; 0 for the thread itself.
    pub(crate) to: u32,
    /// The type of the message, or what is asked of the thread.
    pub(crate) name: &'static str,
    pub(crate) content: Content,
    /// Who sent it and when; only when the thread that gets it is traced.
    pub(crate) stamp: Option<Box<Stamp>>,
}

pub(crate) enum Content {
    /// A message, and its room in a bounded address, given back when it leaves the queue.
    Message(Data, Option<Permit>),
    /// Takes whatever is newest when its turn comes, if that has not been taken yet.
    Latest(Box<dyn FnOnce() -> Option<Data> + Send>),
    /// For the thread itself: registers, observers, traces, sleep and stop.
    Run(Box<dyn FnOnce(&mut Context) + Send>),
}

const AWAKE: u8 = 0;
const ASLEEP: u8 = 1;
const CLOSED: u8 = 2;

/// The queue of one thread. Any thread may [`send`](Self::send); everything else is the owner's.
pub(crate) struct Mailbox {
    queue: Queue<Envelope>,
    /// The owner changes it by swaps, not stores: they take their place behind what a sender
    /// changed, and see it.
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
        if state == CLOSED && !planted("late_send") {
            // It closed between the first look and the push: nobody else will empty the queue.
            return Ok(self.discard());
        }
        let woken = || self.state.compare_exchange(ASLEEP, AWAKE, Ordering::SeqCst, Ordering::SeqCst);
        if state == ASLEEP && woken().is_ok() {
            self.wake_now(); // Of many senders only the first pays for it.
        }
        Ok(0)
    }

    /// Ends any sleep, also one that no message ends (paused, or told to sleep).
    pub(crate) fn wake_now(&self) {
        (self.wake)();
    }

    /// The owner is up: senders need not wake it.
    pub(crate) fn stay_awake(&self) {
        self.state.swap(AWAKE, Ordering::SeqCst);
    }

    /// The owner wants to sleep until a message comes. `false`: one is here already.
    pub(crate) fn fall_asleep(&self) -> bool {
        self.state.swap(ASLEEP, Ordering::SeqCst);
        if self.queue.len() > 0 && !planted("unchecked_sleep") {
            self.stay_awake();
            return false;
        }
        true
    }

    /// Takes everything stored so far, oldest first.
    pub(crate) fn drain(&self) -> impl Iterator<Item = Envelope> {
        self.queue.drain()
    }

    /// Refuses what comes from now on, and throws away what is there: how many messages.
    pub(crate) fn close(&self) -> usize {
        let early = planted("sweep_before_close").then(|| self.discard());
        self.state.swap(CLOSED, Ordering::SeqCst);
        early.unwrap_or_else(|| self.discard())
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

    fn discard(&self) -> usize {
        self.drain().map(Envelope::discard).sum()
    }
}

impl Envelope {
    /// Drops it undelivered: how many messages of the program (not of the runtime) that was.
    /// One that panics when it is dropped is dropped all the same.
    pub(crate) fn discard(self) -> usize {
        let discard = || match self.content {
            Content::Message(..) => 1,
            Content::Latest(take) => usize::from(take().is_some()),
            Content::Run(_) => 0,
        };
        catch_unwind(AssertUnwindSafe(discard)).unwrap_or(1)
    }
}
