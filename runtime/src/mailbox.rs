//! The one place where threads meet: what is stored, and who must be woken when something comes.
//!
//! Everything that must be seen together changes together, under one short lock:
//!
//! ```text
//! sender                          owner, before it sleeps      owner, when it closes
//! closed? -> give it back         something stored? -> go on   state = CLOSED
//! store it                        state = ASLEEP               throw away what is stored
//! asleep? -> state = AWAKE, and
//! wake it, outside the lock
//! ```
//!
//! Cost of a send to a thread that is awake: one short lock and the move of the message; no
//! allocation, once there is room for as many as wait at a time. The owner takes all that is
//! stored by changing places with an empty batch, whose room the senders fill next.

use crate::batch::{Batch, Content, Letter};
use crate::sync::atomic::{AtomicU8, Ordering};
use crate::sync::{Held, mutant};
use std::any::TypeId;

pub(crate) const AWAKE: u8 = 0;
pub(crate) const ASLEEP: u8 = 1;
pub(crate) const CLOSED: u8 = 2;
/// Does nothing but look at the state: as good as asleep, but need not be woken.
const LOOKING: u8 = 3;

/// The queue of one thread. Any thread may [`send`](Self::send); everything else is the owner's.
pub(crate) struct Mailbox {
    pub(crate) stored: Held<Stored>,
    /// Changed under the lock, and looked at from outside, where a moment ago is good enough.
    pub(crate) state: AtomicU8,
    wake: Box<dyn Fn() + Send + Sync>,
}

#[derive(Default)]
pub(crate) struct Stored {
    pub(crate) batch: Batch,
    /// The types of the batch's rows.
    rows: Vec<TypeId>,
}

impl Mailbox {
    /// `wake` must end the owner's sleep; it is called from sending threads.
    pub(crate) fn new(wake: Box<dyn Fn() + Send + Sync>) -> Self {
        Self { stored: Held::new(Stored::default()), state: AtomicU8::new(AWAKE), wake }
    }

    /// The number of the row in which such letters lie here: few types, so a short list.
    pub(crate) fn row<C: Content>(&self) -> u32 {
        let own = TypeId::of::<C>();
        self.stored.with(|stored| {
            let known = stored.rows.iter().position(|row| *row == own);
            known.unwrap_or_else(|| {
                stored.rows.push(own);
                stored.rows.len() - 1
            }) as u32
        })
    }

    /// Stores `letter`, or gives its content back when the mailbox is closed. Never waits for
    /// more than another's move of a message.
    pub(crate) fn send<C: Content>(&self, row: u32, letter: Letter<C>) -> Result<(), C> {
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
            self.wake_now(); // Of many senders only the first pays for it.
        }
        Ok(())
    }

    /// Ends any sleep, also one that no message ends (paused, or told to sleep).
    pub(crate) fn wake_now(&self) {
        (self.wake)();
    }

    /// The owner is up: senders need not wake it. One that does so meanwhile does no harm.
    pub(crate) fn stay_awake(&self) {
        if self.is_asleep() {
            self.state.store(AWAKE, Ordering::SeqCst);
        }
    }

    /// The owner wants to sleep until a message comes. `false`: one is here already.
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

    /// The owner has fallen asleep, but looks for messages as long as `patient` says, before it
    /// really sleeps.
    pub(crate) fn look(&self, patient: impl Fn() -> bool) {
        let change = |from, to| {
            self.stored.with(|_| {
                if self.state() == from {
                    self.state.store(to, Ordering::SeqCst);
                }
            })
        };
        change(ASLEEP, LOOKING);
        while self.state() == LOOKING && patient() {}
        change(LOOKING, ASLEEP);
    }

    /// The owner is up, and puts everything stored so far behind what is in `batch`.
    pub(crate) fn empty_into(&self, batch: &mut Batch) {
        self.stored.with(|stored| {
            self.stay_awake();
            batch.append(&mut stored.batch);
        });
    }

    /// Refuses what comes from now on: what was stored before.
    pub(crate) fn close(&self) -> Batch {
        mutant!(self.sweep_before_close());
        self.stored.with(|stored| {
            self.state.store(CLOSED, Ordering::SeqCst);
            std::mem::take(&mut stored.batch)
        })
    }

    /// Has nothing happened since [`fall_asleep`](Self::fall_asleep)?
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
