//! The one loop of all threads (thesis §2.2.3.3 and §3.2.6.1).
//!
//! An iteration: (1) deliver every message stored since the last one, in order; (2) call the
//! workers, in order, until one returns `false`. Then say when the next iteration is due.

use crate::Context;
use crate::fault::{Fault, Outcome, allow_restart, panic_text};
use crate::object::short_type_name;
use crate::register::{LAST, Label, Object, Slot, WORKER};
use crate::sync::atomic::Ordering;
use crate::sync::mutant;
use crate::trace::{self, End, Event, Record, Stamped};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::thread;
use std::time::Instant;

/// When a thread's next iteration is due.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Next {
    /// At once: messages are stored, or somebody asked for it.
    Now,
    /// At this moment, or before it when a message comes.
    At(Instant),
    /// When a message comes.
    OnMessage,
    /// Never: the thread has stopped and its objects are dropped.
    Stopped,
}

impl Context {
    pub(crate) fn iterate(&mut self) -> Next {
        if self.ended {
            return Next::Stopped;
        }
        if let Some(next) = self.suspended() {
            self.shared().mailbox.0.stay_awake(); // What comes need not wake it.
            return next;
        }
        self.again = false;
        if !self.alarms.is_empty() {
            let now = self.now(); // A look at the clock costs as much as a message.
            self.alarms.retain(|(_, when)| *when > now);
        }
        self.shared().tallies.0.iterations.add_own(1);
        self.dispatch_messages();
        self.update_workers();
        self.next()
    }

    /// Delivers every message stored since the last iteration. What the deliveries themselves send
    /// to this thread is for the next one.
    fn dispatch_messages(&mut self) {
        self.fetch_messages();
        // Out of the context meanwhile, which the deliveries need whole.
        let mut batch = std::mem::take(&mut self.batch);
        let letters = batch.len();
        batch.deliver(self);
        batch.shrink(letters);
        self.batch = batch;
    }

    /// Takes over what is stored, behind what an earlier iteration left undelivered.
    pub(crate) fn fetch_messages(&mut self) {
        self.handle.shared.mailbox.0.empty_into(&mut self.batch);
    }

    /// Hands a message to its receiver, if that is still there.
    pub(crate) fn resolve_message<M: Send + 'static>(&mut self, to: u32, message: M, stamp: Stamped) {
        let mut message = Some(message);
        let end = self.call(to, &mut message, |label, begin, end| Event::Message {
            from: stamp.as_ref().map(|stamp| Arc::clone(&stamp.from)).unwrap_or_default(),
            to: label.name,
            message: short_type_name::<M>(),
            waited: stamp.map(|stamp| begin.saturating_duration_since(stamp.sent)),
            end,
        });
        let tallies = &self.shared().tallies;
        if end != End::Undeliverable {
            return tallies.0.delivered.add_own(1);
        }
        tallies.0.undeliverable.add_own(1);
        let (thread, name) = (&self.shared().name, short_type_name::<M>());
        tracing::debug!(%thread, receiver = to, message = name, "undeliverable");
    }

    /// Calls the workers in order. Those registered meanwhile wait for the next iteration.
    fn update_workers(&mut self) {
        let newcomers = self.shared().next_id();
        let mut from = WORKER;
        while !self.halted() {
            let mut ahead = self.objects.range(from..).map(|(id, _)| *id);
            let Some(id) = ahead.find(|id| id & !(WORKER | LAST) < newcomers) else {
                return;
            };
            let event = |label: Label, _, end| Event::Worker { name: label.name, end };
            // What a panicking worker should have done is not done: as if it had said so.
            if self.call(id, &mut (), event) != End::Done(true) {
                return;
            }
            from = id + 1;
        }
    }

    /// Calls an object, with the register free for changes meanwhile, and traces that as `event`.
    fn call(
        &mut self,
        id: u32,
        message: &mut dyn Any,
        event: impl FnOnce(Label, Instant, End) -> Event,
    ) -> End {
        let begin = self.trace.is_some().then(|| self.now());
        let object = self.objects.get_mut(&id).and_then(|slot| slot.object.take());
        let label = begin.and(object.as_ref()).map(|object| object.label.clone());
        let end = object.map_or(End::Undeliverable, |object| self.call_object(id, object, message));
        if let (Some(trace), Some(begin)) = (&mut self.trace, begin) {
            let took = self.handle.shared.clock.now().saturating_duration_since(begin);
            let iteration = self.handle.shared.tallies.0.iterations.get();
            let event = event(label.unwrap_or_default(), begin, end);
            trace.add(Record { iteration, at: begin, took, event });
        }
        end
    }

    fn call_object(&mut self, id: u32, mut object: Object, message: &mut dyn Any) -> End {
        let Object { label, call } = &mut object;
        let answer = self.shown(id, &label.name, |thread| thread.guarded(|thread| call(message, thread)));
        let end = answer.as_ref().map_or(End::Panicked, |answer| End::Done(*answer));
        if let (Ok(_), Some(Slot { object: place @ None, .. })) = (&answer, self.objects.get_mut(&id)) {
            *place = Some(object);
            return end;
        }
        // It panicked, or was unregistered or replaced by its own call.
        let Object { label, call } = object;
        self.contain(&label.name, "drop", |_| drop(call));
        if let Err(payload) = answer {
            let outcome = self.after_panic(id);
            self.report(&label.name, label.call, &*payload, outcome);
        }
        end
    }

    /// Removes the object that panicked, or makes it anew when it has a factory.
    fn after_panic(&mut self, id: u32) -> Outcome {
        let now = self.now();
        let slot = self.objects.get_mut(&id);
        let Some(slot) = slot.filter(|slot| slot.object.is_none()) else {
            return Outcome::Removed; // It had removed itself before.
        };
        let allowed = allow_restart(&mut slot.failures, now);
        let factory = slot.factory.take();
        let outcome = if factory.is_some() { Outcome::GivenUp } else { Outcome::Removed };
        if let Some(mut factory) = factory.filter(|_| allowed) {
            let made = self.guarded(|thread| factory(thread));
            if let (Ok(object), Some(slot)) = (made, self.objects.get_mut(&id)) {
                slot.object = Some(object);
                slot.factory = Some(factory);
                self.shared().tallies.0.restarts.add_own(1);
                return Outcome::Restarted;
            }
        }
        self.remove(id);
        outcome
    }

    fn report(&mut self, object: &str, call: &'static str, payload: &(dyn Any + Send), outcome: Outcome) {
        self.shared().tallies.0.panics.add_own(1);
        let thread = Arc::clone(&self.shared().name);
        let object = object.into();
        let reason = panic_text(payload).to_owned();
        tracing::error!(%thread, %object, call, reason, ?outcome, "panic");
        let fault = Fault { thread, object, call, reason, outcome };
        if let Some(mut observer) = self.observer.take() {
            // One that panics itself is not asked again.
            if catch_unwind(AssertUnwindSafe(|| observer(&fault))).is_ok() {
                self.observer = Some(observer);
            }
        }
    }

    /// Runs `call`; a panic ends here. What it had in hand is dropped or made anew by the caller,
    /// so no half-changed state is seen again.
    fn guarded<A>(&mut self, call: impl FnOnce(&mut Self) -> A) -> thread::Result<A> {
        catch_unwind(AssertUnwindSafe(|| call(self)))
    }

    /// Runs `job`; a panic is reported as one in `what` was done with `object`.
    pub(crate) fn contain(&mut self, object: &str, what: &'static str, job: impl FnOnce(&mut Self)) {
        if let Err(payload) = self.guarded(job) {
            self.report(object, what, &*payload, Outcome::Removed);
        }
    }

    pub(crate) fn drop_slot(&mut self, slot: Slot) {
        let Label { name, .. } = slot.label();
        self.contain(&name, "drop", |_| drop(slot));
    }

    /// Runs `call`, which must not panic, while the watchdog sees what is running, and what is sent
    /// bears its name.
    pub(crate) fn shown<A>(&mut self, id: u32, name: &Arc<str>, call: impl FnOnce(&mut Self) -> A) -> A {
        let sender = trace::sender(&self.shared().name, name);
        let outer = sender.map(|sender| trace::send_as(Some(sender)));
        self.shared().show_running(id);
        let answer = call(self);
        self.shared().show_running(0);
        outer.map(trace::send_as);
        answer
    }

    /// When the next iteration is due; sleeps (in the mailbox's sense) or finishes.
    fn next(&mut self) -> Next {
        if self.stopped {
            self.finish();
            return Next::Stopped;
        }
        if let Some(next) = self.suspended() {
            return next;
        }
        if self.again || self.batch.len() > 0 || !self.shared().mailbox.0.fall_asleep() {
            return Next::Now;
        }
        let first = self.alarms.iter().map(|(_, when)| *when).min();
        first.map_or(Next::OnMessage, Next::At)
    }

    /// Told to sleep or to pause, and until when. A stop in the queue overrules both.
    fn suspended(&mut self) -> Option<Next> {
        mutant!(self.stuck_in_pause());
        if self.shared().stopping.load(Ordering::SeqCst) {
            self.sleep_until = None;
            return None;
        }
        if self.shared().paused.load(Ordering::SeqCst) {
            return Some(Next::OnMessage);
        }
        let until = self.sleep_until?;
        if self.now() < until {
            return Some(Next::At(until));
        }
        self.sleep_until = None;
        None
    }

    pub(crate) fn halted(&mut self) -> bool {
        self.stopped || self.suspended().is_some()
    }

    /// Ends the thread: refuses messages, then drops all objects in reverse order of registration,
    /// workers first, so that users are dropped before what they use; then cancels the thread's
    /// jobs and waits for them; then wakes the threads that wait for this one.
    pub(crate) fn finish(&mut self) {
        if std::mem::replace(&mut self.ended, true) {
            return;
        }
        mutant!(self.finished_too_early());
        self.drop_everything();
        self.shared().finish();
    }

    /// All of [`finish`](Self::finish) before the wake-up.
    pub(crate) fn drop_everything(&mut self) {
        let mut left = std::mem::take(&mut self.batch);
        left.append(&mut self.shared().mailbox.0.close());
        let left = left.discard();
        self.shared().tallies.0.undelivered.add_own(left);
        while let Some((_, slot)) = self.objects.pop_last() {
            self.drop_slot(slot);
        }
        let shared = self.shared();
        shared.jobs.finish(&shared.name);
        self.trace = None;
        tracing::debug!(thread = %self.shared().name, left, "stopped");
    }
}

impl Drop for Context {
    /// However the loop ended, nobody may wait for this thread in vain.
    fn drop(&mut self) {
        self.finish();
    }
}
