//! The one loop of all threads (thesis §2.2.3.3 and §3.2.6.1).
//!
//! An iteration: (1) deliver every message stored since the last one, in order; (2) call the
//! workers, in order, until one returns `false`. Then say when the next iteration is due.

use crate::fault::{Fault, Outcome, reason};
use crate::mailbox::{Content, Envelope};
use crate::object::AnyReceiver;
use crate::register::{Kind, LAST, RUN, Slot};
use crate::sync::atomic::Ordering;
use crate::sync::planted;
use crate::trace::{End, Event, Sending, Stamp};
use crate::{Context, Worker};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
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
        if self.finished {
            return Next::Stopped;
        }
        self.shared().mailbox.stay_awake();
        if let Some(next) = self.suspended() {
            return next;
        }
        self.again = false;
        self.silence_due_alarms();
        self.shared().tallies.iterations.add(1);
        if let Some(trace) = &mut self.trace {
            trace.iteration += 1;
        }
        self.dispatch_messages();
        self.update_workers();
        self.next()
    }

    /// Delivers every message stored since the last iteration. What the deliveries themselves send
    /// to this thread is for the next one.
    fn dispatch_messages(&mut self) {
        self.fetch_messages();
        while !self.halted() {
            let Some(envelope) = self.batch.pop_front() else {
                break;
            };
            // Calls are guarded themselves; this is for messages that panic when they are dropped.
            if let Err(payload) = self.guarded(|thread| thread.resolve_message(envelope)) {
                self.report("message", "drop", &*payload, Outcome::Removed);
            }
        }
        // A flood must not hold its memory for ever.
        if self.batch.is_empty() && self.batch.capacity() > 4096 {
            self.batch = Default::default();
        }
    }

    /// Takes over what is stored, behind what an earlier iteration left undelivered.
    pub(crate) fn fetch_messages(&mut self) {
        self.handle.shared().mailbox.drain(&mut self.batch);
    }

    pub(crate) fn resolve_message(&mut self, envelope: Envelope) {
        match envelope.content {
            Content::Message { to, type_name, data, permit } => {
                drop(permit);
                self.deliver(to, type_name, data, envelope.stamp);
            }
            Content::Latest { to, slot } => {
                if let Some(data) = slot.take() {
                    self.deliver(to, slot.type_name(), data, envelope.stamp);
                }
            }
            Content::Run(job) => {
                let _sending = Sending::enter(&self.shared().name, "run");
                self.show_running(RUN);
                if let Err(payload) = self.guarded(|thread| job(thread)) {
                    self.report("run", "run", &*payload, Outcome::Removed);
                }
                self.show_running(0);
            }
            Content::Sleep(duration) => self.sleep(duration),
            Content::Stop => self.stop(),
        }
    }

    fn deliver(
        &mut self,
        to: u32,
        type_name: &'static str,
        data: Box<dyn Any + Send>,
        stamp: Option<Box<Stamp>>,
    ) {
        let tallies = &self.shared().tallies;
        if self.receivers.contains_key(&to) {
            tallies.delivered.add(1);
        } else {
            tallies.undeliverable.add(1);
            let thread = &self.shared().name;
            tracing::debug!(%thread, receiver = to, message = type_name, "undeliverable");
        }
        self.call::<dyn AnyReceiver>(
            to,
            type_name,
            |receiver, thread| {
                receiver.receive_any(data, thread);
                true
            },
            |to, begin, end| Event::Message {
                from: stamp.as_ref().map(|stamp| Arc::clone(&stamp.from)).unwrap_or_default(),
                to,
                message: type_name,
                waited: stamp.map(|stamp| begin.saturating_duration_since(stamp.sent)),
                end,
            },
        );
    }

    /// Calls the workers in order. Those registered meanwhile wait for the next iteration.
    fn update_workers(&mut self) {
        let newcomers = self.shared().next_id();
        let mut from = 0;
        while !self.halted() {
            let mut ahead = self.workers.range(from..).map(|(id, _)| *id);
            let Some(id) = ahead.find(|id| id & !LAST < newcomers) else {
                return;
            };
            let update = |worker: &mut dyn Worker, thread: &mut Context| worker.update(thread);
            let end =
                self.call::<dyn Worker>(id, "update", update, |name, _, end| Event::Worker { name, end });
            // What a panicking worker should have done is not done: as if it had said so.
            if end != End::Done(true) {
                return;
            }
            from = id + 1;
        }
    }

    /// Calls an object, with the register free for changes meanwhile, and traces that as `event`.
    fn call<T: Kind + ?Sized>(
        &mut self,
        id: u32,
        what: &'static str,
        call: impl FnOnce(&mut T, &mut Context) -> bool,
        event: impl FnOnce(Arc<str>, Instant, End) -> Event,
    ) -> End {
        let begin = self.trace.is_some().then(|| self.now());
        let slot = T::register(self).get_mut(&id);
        let object = slot.and_then(|slot| Some((slot.object.take()?, Arc::clone(&slot.name))));
        let (name, end) = match object {
            Some((object, name)) => (Arc::clone(&name), self.call_object(id, what, call, object, &name)),
            None => (Arc::default(), End::Undeliverable),
        };
        let now = begin.map(|_| self.now());
        if let (Some(trace), Some(begin), Some(now)) = (&mut self.trace, begin, now) {
            trace.add(begin, now.saturating_duration_since(begin), event(name, begin, end));
        }
        end
    }

    fn call_object<T: Kind + ?Sized>(
        &mut self,
        id: u32,
        what: &'static str,
        call: impl FnOnce(&mut T, &mut Context) -> bool,
        mut object: Box<T>,
        name: &str,
    ) -> End {
        let sending = Sending::enter(&self.shared().name, name);
        self.running = id;
        self.show_running(id);
        let answer = self.guarded(|thread| call(&mut object, thread));
        self.show_running(0);
        self.running = 0;
        drop(sending);
        match answer {
            Ok(answer) => {
                match T::register(self).get_mut(&id) {
                    Some(slot) if slot.object.is_none() => slot.object = Some(object),
                    _ => self.drop_guarded(name, object), // Unregistered or replaced by its call.
                }
                End::Done(answer)
            }
            Err(payload) => {
                self.drop_guarded(name, object);
                let outcome = self.after_panic::<T>(id);
                self.report(name, what, &*payload, outcome);
                End::Panicked
            }
        }
    }

    /// Removes the object that panicked, or makes it anew when it has a factory.
    fn after_panic<T: Kind + ?Sized>(&mut self, id: u32) -> Outcome {
        let now = self.now();
        let slot = T::register(self).get_mut(&id);
        let Some(slot) = slot.filter(|slot| slot.object.is_none()) else {
            return Outcome::Removed; // It had removed itself before.
        };
        let allowed = slot.failures.allow_restart(now);
        let factory = slot.factory.take();
        let outcome = if factory.is_some() { Outcome::GivenUp } else { Outcome::Removed };
        if let Some(mut factory) = factory.filter(|_| allowed) {
            let made = self.guarded(|thread| factory(thread));
            if let (Ok(object), Some(slot)) = (made, T::register(self).get_mut(&id)) {
                slot.object = Some(object);
                slot.factory = Some(factory);
                self.shared().tallies.restarts.add(1);
                return Outcome::Restarted;
            }
        }
        T::register(self).remove(&id);
        self.forget(id);
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
    fn guarded<A>(&mut self, call: impl FnOnce(&mut Self) -> A) -> Result<A, Box<dyn Any + Send>> {
        catch_unwind(AssertUnwindSafe(|| call(self)))
    }

    fn drop_guarded<T>(&mut self, name: &str, object: T) {
        if let Err(payload) = self.guarded(|_| drop(object)) {
            self.report(name, "drop", &*payload, Outcome::Removed);
        }
    }

    pub(crate) fn drop_slot<T: ?Sized>(&mut self, slot: Option<Slot<T>>) {
        if let Some(slot) = slot {
            let name = Arc::clone(&slot.name);
            self.drop_guarded(&name, slot);
        }
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

    fn silence_due_alarms(&mut self) {
        if !self.alarms.is_empty() {
            let now = self.now();
            self.alarms.retain(|(_, when)| *when > now);
        }
    }

    /// Ends the thread: refuses messages, then drops all objects, users before what they use,
    /// which is in reverse order of registration, and workers first; then tells who waits.
    pub(crate) fn finish(&mut self) {
        if std::mem::replace(&mut self.finished, true) {
            return;
        }
        if planted("finished_too_early") {
            self.shared().finish();
        }
        let mut left = self.shared().mailbox.close();
        left += std::mem::take(&mut self.batch).into_iter().map(Envelope::discard).sum::<usize>();
        self.shared().tallies.undelivered.add(left);
        while let Some((_, slot)) = self.workers.pop_last() {
            self.drop_slot(Some(slot));
        }
        while let Some((_, slot)) = self.receivers.pop_last() {
            self.drop_slot(Some(slot));
        }
        self.trace = None;
        tracing::debug!(thread = %self.shared().name, left, "stopped");
        self.shared().finish();
    }

    /// Lets the watchdog see which object is running, and that it is another call than before.
    fn show_running(&mut self, id: u32) {
        self.calls = self.calls.wrapping_add(1);
        let call = u64::from(self.calls) << 32 | u64::from(id);
        let running = &self.shared().running;
        running.store(call, std::sync::atomic::Ordering::Relaxed);
    }
}

impl Drop for Context {
    /// However the loop ended, nobody may wait for this thread in vain.
    fn drop(&mut self) {
        self.finish();
    }
}
