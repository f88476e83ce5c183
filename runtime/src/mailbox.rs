//! The queue of a thread, shared by its senders: the letters, and whether the owner must be woken.
//!
//! Letters and state change together, under one short lock:
//!
//! ```text
//! sender                          owner, before it sleeps      owner, when it closes
//! closed? -> return the message   letters? -> do not sleep     state = CLOSED
//! store the letter                state = ASLEEP               take all letters
//! asleep? -> state = AWAKE, and
//! wake it, outside the lock
//! ```
//!
//! Cost of a send to a thread that is awake: one short lock and the move of the message; no
//! allocation, once the queue has grown to its usual length. The owner takes all letters at once by
//! swapping them for an empty batch, whose memory the senders fill next.

use crate::batch::{Batch, Letter, LetterContent};
use crate::sync::atomic::{AtomicU8, Ordering};
use crate::sync::{BriefLock, mutant};
use std::any::TypeId;

pub(crate) const AWAKE: u8 = 0;
pub(crate) const ASLEEP: u8 = 1;
pub(crate) const CLOSED: u8 = 2;
/// The owner spins and reads the state: idle as if asleep, but it need not be woken.
const SPINNING: u8 = 3;

/// The queue of one thread. Any thread may [`send`](Self::send); only the owner calls the other
/// methods that change it.
#[doc(alias = "channel")]
pub(crate) struct Mailbox {
    pub(crate) stored: BriefLock<MailboxContent>,
    /// Changed under the lock only. Read without it where a slightly outdated value is sufficient.
    pub(crate) state: AtomicU8,
    wake: Box<dyn Fn() + Send + Sync>,
}

#[derive(Default)]
pub(crate) struct MailboxContent {
    pub(crate) batch: Batch,
    /// The content types of the batch's rows, by row number.
    rows: Vec<TypeId>,
}

impl Mailbox {
    /// Creates an empty mailbox. `wake` must end the owner's sleep; it is called from sending
    /// threads.
    pub(crate) fn new(wake: Box<dyn Fn() + Send + Sync>) -> Self {
        Self { stored: BriefLock::new(MailboxContent::default()), state: AtomicU8::new(AWAKE), wake }
    }

    /// Returns the number of the row for letters of type `C`. There are few types, so a list is
    /// searched.
    pub(crate) fn row<C: LetterContent>(&self) -> u32 {
        let own = TypeId::of::<C>();
        self.stored.with(|stored| {
            let known = stored.rows.iter().position(|row| *row == own);
            known.unwrap_or_else(|| {
                stored.rows.push(own);
                stored.rows.len() - 1
            }) as u32
        })
    }

    /// Stores `letter`, or returns its content when the mailbox is closed. Blocks for no longer than
    /// another sender needs to move a message.
    pub(crate) fn send<C: LetterContent>(&self, row: u32, letter: Letter<C>) -> Result<(), C> {
        mutant!(self.lost_notify(row, letter));
        mutant!(self.late_send(row, letter));
        let state = self.stored.with(|stored| {
            let state = self.state();
            if state == CLOSED {
                return Err(letter.content);
            }
            stored.batch.push(row, letter);
            if state != AWAKE {
                self.state.store(AWAKE, Ordering::SeqCst);
            }
            Ok(state)
        })?;
        if state == ASLEEP {
            self.wake_now(); // Only the first of several senders pays for the wake-up.
        }
        Ok(())
    }

    /// Wakes the owner, also from a sleep or pause that messages do not end.
    pub(crate) fn wake_now(&self) {
        (self.wake)();
    }

    /// Called by the owner when it is running: senders need not wake it. A wake-up that a sender has
    /// just caused does no harm.
    pub(crate) fn set_awake(&self) {
        if self.is_asleep() {
            self.state.store(AWAKE, Ordering::SeqCst);
        }
    }

    /// Called by the owner before it sleeps. Returns `false` when it must not sleep, because a letter
    /// is queued.
    pub(crate) fn fall_asleep(&self) -> bool {
        mutant!(self.unchecked_sleep());
        self.stored.with(|stored| {
            let empty = stored.batch.len() == 0;
            if empty {
                self.state.store(ASLEEP, Ordering::SeqCst);
            }
            empty
        })
    }

    /// Called by the owner after [`fall_asleep`](Self::fall_asleep): spins until a letter arrives or
    /// `patient` returns `false`.
    pub(crate) fn spin(&self, patient: impl Fn() -> bool) {
        let change = |from, to| {
            self.stored.with(|_| {
                if self.state() == from {
                    self.state.store(to, Ordering::SeqCst);
                }
            })
        };
        change(ASLEEP, SPINNING);
        while self.state() == SPINNING && patient() {}
        change(SPINNING, ASLEEP);
    }

    /// Called by the owner when it is running: appends all queued letters to `batch`.
    pub(crate) fn empty_into(&self, batch: &mut Batch) {
        self.stored.with(|stored| {
            self.set_awake();
            batch.append(&mut stored.batch);
        });
    }

    /// Closes the mailbox, so that every later send fails, and returns the letters queued so far.
    pub(crate) fn close(&self) -> Batch {
        mutant!(self.sweep_before_close());
        self.stored.with(|stored| {
            self.state.store(CLOSED, Ordering::SeqCst);
            std::mem::take(&mut stored.batch)
        })
    }

    /// Returns whether no letter has arrived since [`fall_asleep`](Self::fall_asleep).
    pub(crate) fn is_asleep(&self) -> bool {
        self.state() == ASLEEP
    }

    pub(crate) fn is_closed(&self) -> bool {
        self.state() == CLOSED
    }

    pub(crate) fn len(&self) -> usize {
        self.stored.with(|stored| stored.batch.len())
    }

    pub(crate) fn state(&self) -> u8 {
        self.state.load(Ordering::SeqCst)
    }
}
