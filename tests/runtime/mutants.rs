//! Faulty versions of the runtime's functions, compiled into it in builds with `--cfg loom` or `--cfg shuttle` only.
//!
//! A model that cannot fail proves nothing. `.ci/models` sets `PLANTED` to the name of each function here in turn: the
//! runtime then runs it in place of the one that calls it in `mutant!`, and a model must fail.
//!
//! Most of them check something under one lock and act on it under another, so that a second thread can act in
//! between.

use crate::batch::{Batch, Letter, LetterContent};
use crate::mailbox::{ASLEEP, AWAKE, CLOSED, Mailbox, MailboxContent};
use crate::shared::ThreadShared;
use crate::sync::atomic::Ordering;
use crate::sync::{BriefLock, park, thread};
use crate::{Address, Context, Next, SendError, Thread, ThreadHandle};
use std::time::Instant;

impl Mailbox {
    /// For [`send`](Self::send): reads whether the owner must be woken before it stores the message. An owner that
    /// falls asleep in between is not woken.
    pub(crate) fn lost_notify<C: LetterContent>(&self, row: u32, letter: Letter<C>) -> Result<(), C> {
        let early = self.state();
        self.stored.with(|stored| {
            if self.state() == CLOSED {
                return Err(letter.content);
            }
            stored.batch.push(row, letter);
            if early != AWAKE {
                self.state.store(AWAKE, Ordering::SeqCst);
            }
            Ok(())
        })?;
        if early == ASLEEP {
            self.wake_now();
        }
        Ok(())
    }

    /// For [`send`](Self::send): stores a message in a mailbox that was closed in between.
    pub(crate) fn late_send<C: LetterContent>(&self, row: u32, letter: Letter<C>) -> Result<(), C> {
        let early = self.state();
        if early == CLOSED {
            return Err(letter.content);
        }
        self.stored.with(|stored| {
            stored.batch.push(row, letter);
            if early != AWAKE {
                self.state.store(AWAKE, Ordering::SeqCst);
            }
        });
        if early == ASLEEP {
            self.wake_now();
        }
        Ok(())
    }

    /// For [`fall_asleep`](Self::fall_asleep): sleeps although a message came in between.
    pub(crate) fn unchecked_sleep(&self) -> bool {
        let empty = self.stored.with(|stored| stored.batch.len() == 0);
        self.stored.with(|_| {
            if empty {
                self.state.store(ASLEEP, Ordering::SeqCst);
            }
        });
        empty
    }

    /// For [`close`](Self::close): misses a message that was stored in between.
    pub(crate) fn sweep_before_close(&self) -> Batch {
        let take = |stored: &mut MailboxContent| std::mem::take(&mut stored.batch);
        let left = self.stored.with(take);
        self.stored.with(|_| self.state.store(CLOSED, Ordering::SeqCst));
        left
    }
}

impl<M: Send + 'static> Address<M> {
    /// For `replace`: treats a message that was delivered in between as still queued, so the new one is never
    /// delivered.
    pub(crate) fn announced_too_long(
        &self,
        waiting: &BriefLock<Option<M>>,
        message: M,
    ) -> Result<(), SendError<M>> {
        let queued = waiting.with(|waiting| waiting.is_some());
        waiting.with(|waiting| *waiting = Some(message));
        if queued {
            self.thread().tallies.0.replaced.add(1);
            return Ok(());
        }
        self.announce()
    }
}

impl Batch {
    /// For [`deliver`](Self::deliver): delivers the newest message first.
    pub(crate) fn reversed_batch(&mut self, thread: &mut Context) {
        while self.len() > 0 && self.deliver_at(self.len() - 1, thread) {}
    }
}

impl ThreadHandle {
    /// For [`resume`](Self::resume): does not wake the thread.
    pub(crate) fn silent_resume(&self) {
        self.shared.paused.store(false, Ordering::SeqCst);
    }
}

impl Context {
    /// For `suspended`: a stop does not end a pause.
    pub(crate) fn stuck_in_pause(&mut self) -> Option<Next> {
        self.shared().paused.load(Ordering::SeqCst).then_some(Next::OnMessage)
    }

    /// For [`finish`](Self::finish): wakes the waiting threads before the objects are dropped.
    pub(crate) fn finished_too_early(&mut self) {
        self.shared().finish();
        self.drop_everything();
    }
}

impl ThreadShared {
    /// For [`finish`](Self::finish): what the thread wrote may not be visible yet to the threads that it wakes.
    pub(crate) fn relaxed_finish(&self) {
        self.finished.store(true, Ordering::Relaxed);
        self.waiters.with(std::mem::take).into_iter().for_each(|waiter| waiter.unpark());
    }
}

impl Thread {
    /// For [`wait_for`](Self::wait_for): checks whether the threads have stopped before it asks them to wake it.
    pub(crate) fn unchecked_wait(threads: &[ThreadHandle], deadline: Instant) -> Result<(), Vec<String>> {
        let mut running: Vec<_> = threads.iter().filter(|one| !one.is_stopped()).collect();
        threads.iter().for_each(|one| one.shared.waiters.with(|waiters| waiters.push(thread::current())));
        while !running.is_empty() {
            park(Some(deadline));
            running.retain(|one| !one.is_stopped());
        }
        Ok(())
    }
}
