//! The one loop of all threads (thesis §2.2.3.3 and §3.2.6.1).
//!
//! An iteration: (1) deliver every message stored since the last one, in order; (2) call the
//! workers, in order, until one returns `false`. Then say when the next iteration is due.

use crate::Context;
use crate::fault::{Fault, Outcome, allow_restart, reason};
use crate::mailbox::{Content, Envelope};
use crate::register::{Call, Data, LAST, Label, RUN, Slot, WORKER};
use crate::sync::atomic::Ordering;
use crate::sync::planted;
use crate::trace::{self, End, Event, Record};
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
        if self.shared().mailbox.is_closed() {
            return Next::Stopped;
        }
        self.shared().mailbox.stay_awake();
        if let Some(next) = self.suspended() {
            return next;
        }
        self.again = false;
        let now = self.now();
        self.alarms.retain(|(_, when)| *when > now);
        self.shared().tallies.iterations.add(1);
        self.dispatch_messages();
        self.update_workers();
        self.next()
    }

    /// Delivers every message stored since the last iteration. What the deliveries themselves send
    /// to this thread is for the next one.
    fn dispatch_messages(&mut self) {
        self.fetch_messages();
        while !self.halted()
            && let Some(envelope) = self.batch.pop_front()
        {
            // Calls are guarded themselves; this is for messages that panic when they are dropped.
            self.contain("message", "drop", |thread| thread.resolve_message(envelope));
        }
        // A flood must not hold its memory for ever.
        if self.batch.is_empty() && self.batch.capacity() > 4096 {
            self.batch = Default::default();
        }
    }

    /// Takes over what is stored, behind what an earlier iteration left undelivered.
    pub(crate) fn fetch_messages(&mut self) {
        self.batch.extend(self.handle.shared.mailbox.drain());
        if planted("reversed_batch") {
            self.batch.make_contiguous().reverse();
        }
    }

    pub(crate) fn resolve_message(&mut self, envelope: Envelope) {
        let Envelope { to, name: message, content, stamp } = envelope;
        let data = match content {
            Content::Message(data, _permit) => Some(data),
            Content::Latest(take) => take(),
            Content::Run(job) => {
                self.shown(RUN, "run", |thread| thread.contain("run", "run", job));
                None
            }
        };
        if data.is_none() {
            return; // It was for the thread itself, or its newest message was taken already.
        }
        let tallies = &self.shared().tallies;
        if self.objects.contains_key(&to) {
            tallies.delivered.add(1);
        } else {
            tallies.undeliverable.add(1);
            tracing::debug!(thread = %self.shared().name, receiver = to, message, "undeliverable");
        }
        self.call(to, data, |label, begin, end| Event::Message {
            from: stamp.as_ref().map(|stamp| Arc::clone(&stamp.from)).unwrap_or_default(),
            to: label.name,
            message,
            waited: stamp.map(|stamp| begin.saturating_duration_since(stamp.sent)),
            end,
        });
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
            // What a panicking worker should have done is not done: as if it had said so.
            if self.call(id, None, |label, _, end| Event::Worker { name: label.name, end }) != End::Done(true)
            {
                return;
            }
            from = id + 1;
        }
    }

    /// Calls an object, with the register free for changes meanwhile, and traces that as `event`.
    fn call(&mut self, id: u32, data: Option<Data>, event: impl FnOnce(Label, Instant, End) -> Event) -> End {
        let begin = self.trace.is_some().then(|| self.now());
        let slot = self.objects.get_mut(&id);
        let found = slot.and_then(|slot| Some((slot.call.take()?, slot.label.clone())));
        let (label, end) = match found {
            Some((object, label)) => (label.clone(), self.call_object(id, &label, object, data)),
            None => (Label::default(), End::Undeliverable),
        };
        if let (Some(trace), Some(begin)) = (&mut self.trace, begin) {
            let took = self.handle.shared.clock.now().saturating_duration_since(begin);
            let iteration = self.handle.shared.tallies.iterations.get();
            trace.add(Record { iteration, at: begin, took, event: event(label, begin, end) });
        }
        end
    }

    fn call_object(&mut self, id: u32, label: &Label, mut object: Call, data: Option<Data>) -> End {
        let call = |thread: &mut Self| thread.guarded(|thread| object(data, thread));
        match self.shown(id, &label.name, call) {
            Ok(answer) => {
                match self.objects.get_mut(&id) {
                    Some(slot) if slot.call.is_none() => slot.call = Some(object),
                    _ => self.contain(&label.name, "drop", |_| drop(object)), // Unregistered or replaced by its call.
                }
                End::Done(answer)
            }
            Err(payload) => {
                self.contain(&label.name, "drop", |_| drop(object));
                let outcome = self.after_panic(id);
                self.report(&label.name, label.call, &*payload, outcome);
                End::Panicked
            }
        }
    }

    /// Removes the object that panicked, or makes it anew when it has a factory.
    fn after_panic(&mut self, id: u32) -> Outcome {
        let now = self.now();
        let slot = self.objects.get_mut(&id);
        let Some(slot) = slot.filter(|slot| slot.call.is_none()) else {
            return Outcome::Removed; // It had removed itself before.
        };
        let allowed = allow_restart(&mut slot.failures, now);
        let factory = slot.factory.take();
        let outcome = if factory.is_some() { Outcome::GivenUp } else { Outcome::Removed };
        if let Some(mut factory) = factory.filter(|_| allowed) {
            let made = self.guarded(|thread| factory(thread));
            if let (Ok(object), Some(slot)) = (made, self.objects.get_mut(&id)) {
                slot.call = Some(object.call);
                slot.factory = Some(factory);
                self.shared().tallies.restarts.add(1);
                return Outcome::Restarted;
            }
        }
        self.remove(id);
        outcome
    }

    fn report(&mut self, object: &str, call: &'static str, payload: &(dyn Any + Send), outcome: Outcome) {
        self.shared().tallies.panics.add(1);
        let thread = Arc::clone(&self.shared().name);
        let object = object.into();
        let reason = reason(payload);
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
    fn contain(&mut self, object: &str, what: &'static str, job: impl FnOnce(&mut Self)) {
        if let Err(payload) = self.guarded(job) {
            self.report(object, what, &*payload, Outcome::Removed);
        }
    }

    pub(crate) fn drop_slot(&mut self, slot: Slot) {
        let name = Arc::clone(&slot.label.name);
        self.contain(&name, "drop", |_| drop(slot));
    }

    /// Runs `call`, which must not panic, while the watchdog sees what is running, and what is sent
    /// bears its name.
    fn shown<A>(&mut self, id: u32, name: &str, call: impl FnOnce(&mut Self) -> A) -> A {
        let outer = trace::send_as(trace::sender(&self.shared().name, name));
        self.shared().show_running(id);
        let answer = call(self);
        self.shared().show_running(0);
        trace::send_as(outer);
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
        if self.again || !self.batch.is_empty() || !self.shared().mailbox.fall_asleep() {
            return Next::Now;
        }
        let first = self.alarms.iter().map(|(_, when)| *when).min();
        first.map_or(Next::OnMessage, Next::At)
    }

    /// Told to sleep or to pause, and until when. A stop in the queue overrules both.
    fn suspended(&mut self) -> Option<Next> {
        if self.shared().stopping.load(Ordering::SeqCst) && !planted("stuck_in_pause") {
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

    /// Ends the thread: refuses messages, then drops all objects, users before what they use,
    /// which is in reverse order of registration, and workers first; then tells who waits.
    pub(crate) fn finish(&mut self) {
        if self.shared().mailbox.is_closed() {
            return;
        }
        if planted("finished_too_early") {
            self.shared().finish();
        }
        let mut left = self.shared().mailbox.close();
        left += std::mem::take(&mut self.batch).into_iter().map(Envelope::discard).sum::<usize>();
        self.shared().tallies.undelivered.add(left);
        while let Some((_, slot)) = self.objects.pop_last() {
            self.drop_slot(slot);
        }
        self.trace = None;
        tracing::debug!(thread = %self.shared().name, left, "stopped");
        self.shared().finish();
    }
}

impl Drop for Context {
    /// However the loop ended, nobody may wait for this thread in vain.
    fn drop(&mut self) {
        self.finish();
    }
}
