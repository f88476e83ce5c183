//! The one loop of all threads (thesis §2.2.3.3 and §3.2.6.1).
//!
//! An iteration: (1) deliver every message queued since the last one, in order; (2) call the
//! workers, in order, until one returns `false`; (3) return when the next iteration is due.

use crate::Context;
use crate::fault::{Fault, Outcome, allow_restart, panic_text};
use crate::object::short_type_name;
use crate::register::{LAST, Label, Object, ObjectSlot, WORKER};
use crate::sync::atomic::Ordering;
use crate::sync::mutant;
use crate::trace::{self, CallEnd, Stamped, TraceEvent, TraceRecord};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::thread;
use std::time::Instant;

/// When a thread's next iteration is due.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Next {
    /// At once: messages are queued, or another iteration was requested.
    Now,
    /// At this moment, or earlier when a message arrives.
    At(Instant),
    /// When a message arrives.
    OnMessage,
    /// Never: the thread has stopped, and its objects have been dropped.
    Stopped,
}

impl Context {
    pub(crate) fn iterate(&mut self) -> Next {
        if self.ended {
            return Next::Stopped;
        }
        if let Some(next) = self.suspended() {
            self.shared().mailbox.0.set_awake(); // The thread runs: new messages need not wake it.
            return next;
        }
        self.again = false;
        if !self.alarms.is_empty() {
            let now = self.now(); // Reading the clock costs as much as delivering a message.
            self.alarms.retain(|(_, when)| *when > now);
        }
        self.shared().tallies.0.iterations.add_own(1);
        self.dispatch_messages();
        self.update_workers();
        self.next()
    }

    /// Delivers every message queued since the last iteration. Messages that these deliveries send to
    /// this thread are delivered in the next one.
    fn dispatch_messages(&mut self) {
        self.fetch_messages();
        // Taken out of the context, which the deliveries borrow as a whole.
        let mut batch = std::mem::take(&mut self.batch);
        let letters = batch.len();
        batch.deliver(self);
        batch.shrink(letters);
        self.batch = batch;
    }

    /// Appends the queued letters to those that an earlier iteration left undelivered.
    pub(crate) fn fetch_messages(&mut self) {
        self.handle.shared.mailbox.0.empty_into(&mut self.batch);
    }

    /// Calls the receiver `to` with `message`, or counts the message as undeliverable if it is gone.
    pub(crate) fn resolve_message<M: Send + 'static>(&mut self, to: u32, message: M, stamp: Stamped) {
        let mut message = Some(message);
        let end = self.call(to, &mut message, |label, begin, end| TraceEvent::Message {
            from: stamp.as_ref().map(|stamp| Arc::clone(&stamp.from)).unwrap_or_default(),
            to: label.name,
            message: short_type_name::<M>(),
            waited: stamp.map(|stamp| begin.saturating_duration_since(stamp.sent)),
            end,
        });
        let tallies = &self.shared().tallies;
        if end != CallEnd::Undeliverable {
            return tallies.0.delivered.add_own(1);
        }
        tallies.0.undeliverable.add_own(1);
        let (thread, name) = (&self.shared().name, short_type_name::<M>());
        tracing::debug!(%thread, receiver = to, message = name, "undeliverable");
    }

    /// Calls the workers in order. Those registered during the calls are first called in the next
    /// iteration.
    fn update_workers(&mut self) {
        let newcomers = self.shared().next_id();
        let mut from = WORKER;
        while !self.halted() {
            let mut ahead = self.objects.range(from..).map(|(id, _)| *id);
            let Some(id) = ahead.find(|id| id & !(WORKER | LAST) < newcomers) else {
                return;
            };
            let event = |label: Label, _, end| TraceEvent::Worker { name: label.name, end };
            // A panic counts as `false`: the worker has not done its work.
            if self.call(id, &mut (), event) != CallEnd::Done(true) {
                return;
            }
            from = id + 1;
        }
    }

    /// Calls an object and traces the call as `event`. The call may change the register.
    fn call(
        &mut self,
        id: u32,
        message: &mut dyn Any,
        event: impl FnOnce(Label, Instant, CallEnd) -> TraceEvent,
    ) -> CallEnd {
        let begin = self.trace.is_some().then(|| self.now());
        let object = self.objects.get_mut(&id).and_then(|slot| slot.object.take());
        let label = begin.and(object.as_ref()).map(|object| object.label.clone());
        let end = object.map_or(CallEnd::Undeliverable, |object| self.call_object(id, object, message));
        if let (Some(trace), Some(begin)) = (&mut self.trace, begin) {
            let took = self.handle.shared.clock.now().saturating_duration_since(begin);
            let iteration = self.handle.shared.tallies.0.iterations.get();
            let event = event(label.unwrap_or_default(), begin, end);
            trace.add(TraceRecord { iteration, at: begin, took, event });
        }
        end
    }

    fn call_object(&mut self, id: u32, mut object: Object, message: &mut dyn Any) -> CallEnd {
        let Object { label, call } = &mut object;
        let answer = self.call_as(id, &label.name, |thread| thread.catch(|thread| call(message, thread)));
        let end = answer.as_ref().map_or(CallEnd::Panicked, |answer| CallEnd::Done(*answer));
        if let (Ok(_), Some(ObjectSlot { object: place @ None, .. })) = (&answer, self.objects.get_mut(&id)) {
            *place = Some(object);
            return end;
        }
        // The object panicked, or was unregistered or replaced by its own call.
        let Object { label, call } = object;
        self.catch_and_report(&label.name, "drop", |_| drop(call));
        if let Err(payload) = answer {
            let outcome = self.after_panic(id);
            self.report(&label.name, label.call, &*payload, outcome);
        }
        end
    }

    /// Removes the object that panicked, or restarts it when it has a factory.
    fn after_panic(&mut self, id: u32) -> Outcome {
        let now = self.now();
        let slot = self.objects.get_mut(&id);
        let Some(slot) = slot.filter(|slot| slot.object.is_none()) else {
            return Outcome::Removed; // It had removed itself before it panicked.
        };
        let allowed = allow_restart(&mut slot.failures, now);
        let factory = slot.factory.take();
        let outcome = if factory.is_some() { Outcome::GivenUp } else { Outcome::Removed };
        if let Some(mut factory) = factory.filter(|_| allowed) {
            let made = self.catch(|thread| factory(thread));
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
            // An observer that panics itself is removed.
            if catch_unwind(AssertUnwindSafe(|| observer(&fault))).is_ok() {
                self.observer = Some(observer);
            }
        }
    }

    /// Runs `call` and catches a panic. The caller must drop or restart the objects that `call`
    /// used, so that no half-changed state is used again.
    fn catch<A>(&mut self, call: impl FnOnce(&mut Self) -> A) -> thread::Result<A> {
        catch_unwind(AssertUnwindSafe(|| call(self)))
    }

    /// Runs `call`. Reports a panic in it as a [`Fault`] of `object`, with `what` as its
    /// [`call`](Fault::call), such as `"drop"`.
    pub(crate) fn catch_and_report(
        &mut self,
        object: &str,
        what: &'static str,
        call: impl FnOnce(&mut Self),
    ) {
        if let Err(payload) = self.catch(call) {
            self.report(object, what, &*payload, Outcome::Removed);
        }
    }

    pub(crate) fn drop_slot(&mut self, slot: ObjectSlot) {
        let Label { name, .. } = slot.label();
        self.catch_and_report(&name, "drop", |_| drop(slot));
    }

    /// Runs `call`, which must not panic, as the object `id`: the watchdog sees it running, and
    /// messages that it sends are traced with its `name`.
    pub(crate) fn call_as<A>(&mut self, id: u32, name: &Arc<str>, call: impl FnOnce(&mut Self) -> A) -> A {
        let sender = trace::sender(&self.shared().name, name);
        let outer = sender.map(|sender| trace::send_as(Some(sender)));
        self.shared().set_running(id);
        let answer = call(self);
        self.shared().set_running(0);
        outer.map(trace::send_as);
        answer
    }

    /// Returns when the next iteration is due. Marks the mailbox as asleep, or ends the thread.
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

    /// Returns until when the thread sleeps or pauses; `None` if it does neither. A queued stop
    /// interrupts both.
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

    /// Does everything that [`finish`](Self::finish) does before the wake-up.
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
    /// Ends the thread however the loop ended, so that waiting for it always returns.
    fn drop(&mut self) {
        self.finish();
    }
}
