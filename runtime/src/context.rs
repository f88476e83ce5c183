//! What a worker or receiver can ask of the thread it lives in.

use crate::batch::Batch;
use crate::handle::ThreadHandle;
use crate::register::{Factory, LAST, Label, Object, RUN, Register, Slot, WORKER, WorkerId};
use crate::shared::Shared;
use crate::trace::Trace;
use crate::{Address, Fault, Receiver, Timer, TraceSnapshot, Worker};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The inside of a thread: its loop's state and its registers.
///
/// Every call in the thread gets it as `&mut Context`. Changes of the registers take place at
/// once: a message that waits for a removed receiver is undeliverable, a removed worker is not called
/// any more. A worker that comes while workers are being called has its first turn in the next
/// iteration, so an iteration always ends.
pub struct Context {
    pub(crate) handle: ThreadHandle,
    pub(crate) objects: Register,
    /// Taken from the mailbox, not yet delivered; rests here while the thread sleeps or pauses.
    pub(crate) batch: Batch,
    pub(crate) again: bool,
    pub(crate) stopped: bool,
    pub(crate) ended: bool,
    pub(crate) sleep_until: Option<Instant>,
    pub(crate) spin: Duration,
    /// One for each object at most. Few, so a list is quicker than a map, and keeps its memory.
    pub(crate) alarms: Vec<(u32, Instant)>,
    pub(crate) observer: Option<Observer>,
    pub(crate) trace: Option<Trace>,
    /// Does a watchdog want to know what the objects are called?
    watched: bool,
}

/// Who is told of panics.
type Observer = Box<dyn FnMut(&Fault)>;

impl Context {
    pub(crate) fn new(shared: Arc<Shared>) -> Self {
        Self {
            handle: ThreadHandle { shared },
            objects: Register::new(),
            batch: Batch::default(),
            again: false,
            stopped: false,
            ended: false,
            sleep_until: None,
            spin: Duration::ZERO,
            alarms: Vec::new(),
            observer: None,
            trace: None,
            watched: false,
        }
    }

    /// This thread, as others see it. Sending to it is for the next iteration.
    pub fn handle(&self) -> &ThreadHandle {
        &self.handle
    }

    /// The time now, by this thread's clock; in a test that is turned by hand.
    pub fn now(&self) -> Instant {
        self.shared().clock.now()
    }

    /// A timer that starts now and goes by this thread's clock.
    pub fn timer(&self) -> Timer {
        Timer::with_clock(self.shared().clock.clone())
    }

    /// Adds `worker` behind the others, but before those that stay last.
    pub fn register_worker(&mut self, worker: impl Worker) -> WorkerId {
        let id = self.shared().new_id() | WORKER;
        self.insert(id, Object::worker(worker), None);
        WorkerId(id)
    }

    /// Adds `worker` behind all others, those that come later included; among several of these,
    /// registration order counts.
    pub fn register_last_worker(&mut self, worker: impl Worker) -> WorkerId {
        let id = self.shared().new_id() | LAST;
        self.insert(id, Object::worker(worker), None);
        WorkerId(id)
    }

    /// Adds the worker that `make` makes, and has it made anew, in the same place, when it panics:
    /// at most [`RESTARTS`](crate::RESTARTS) times in [`RESTART_WINDOW`](crate::RESTART_WINDOW).
    pub fn register_restartable_worker<W: Worker>(
        &mut self,
        mut make: impl FnMut(&mut Context) -> W + 'static,
    ) -> WorkerId {
        let id = self.shared().new_id() | WORKER;
        self.insert_made(id, move |thread| Object::worker(make(thread)));
        WorkerId(id)
    }

    /// Adds `receiver`.
    pub fn register_receiver<R: Receiver>(&mut self, receiver: R) -> Address<R::Message> {
        let address = self.handle.reserve_address();
        self.register_receiver_at(&address, receiver);
        address
    }

    /// Adds `receiver` at an address that was reserved before, or puts it in the place of the one
    /// that is there.
    ///
    /// # Panics
    /// When the address belongs to another thread.
    pub fn register_receiver_at<R: Receiver>(&mut self, address: &Address<R::Message>, receiver: R) {
        self.insert(address.receiver_in(self.shared()), Object::receiver(receiver), None);
    }

    /// Adds the receiver that `make` makes at an address that was reserved before, and has it made
    /// anew when it panics: at most [`RESTARTS`](crate::RESTARTS) times in
    /// [`RESTART_WINDOW`](crate::RESTART_WINDOW). Only the message that it panicked with is lost.
    ///
    /// # Panics
    /// When the address belongs to another thread.
    pub fn register_restartable_receiver_at<R: Receiver>(
        &mut self,
        address: &Address<R::Message>,
        mut make: impl FnMut(&mut Context) -> R + 'static,
    ) {
        self.insert_made(address.receiver_in(self.shared()), move |thread| Object::receiver(make(thread)));
    }

    /// Removes and drops a worker; `false` when there is none of that number.
    /// A worker that removes itself is dropped when its call returns.
    pub fn unregister_worker(&mut self, id: WorkerId) -> bool {
        self.remove(id.0)
    }

    /// Removes and drops a receiver; `false` when there is none at that address. What is queued
    /// for it is undeliverable.
    ///
    /// # Panics
    /// When the address belongs to another thread.
    pub fn unregister_receiver<M: Send + 'static>(&mut self, address: &Address<M>) -> bool {
        self.remove(address.receiver_in(self.shared()))
    }

    /// Ends the thread when the running call returns: nothing more is delivered or called. See
    /// [`remote_stop`](ThreadHandle::remote_stop) for the other way, behind all queued messages.
    pub fn stop(&mut self) {
        self.stopped = true;
    }

    /// Lets the thread sleep from when the running call returns, which ends the iteration; messages
    /// it has not delivered come first in the next one. Messages do not wake it, they are stored; a
    /// [`remote_stop`](ThreadHandle::remote_stop) does.
    pub fn sleep(&mut self, duration: Duration) {
        self.sleep_until = self.now().checked_add(duration);
    }

    /// Like [`sleep`](Self::sleep), until somebody calls [`resume`](ThreadHandle::resume).
    pub fn pause(&mut self) {
        self.handle.pause();
    }

    /// Asks for another iteration without waiting for a message. Holds for the next one only, so
    /// who wants to run continuously asks in every call.
    pub fn iterate_again(&mut self) {
        self.again = true;
    }

    /// Asks for an iteration at `when` at the latest. Each object has one such alarm: a later call
    /// replaces it, it is gone when it has rung, and when the object is removed. Outside of an object's
    /// call, in a closure that makes or runs something, it is the one alarm of the thread itself.
    pub fn wake_at(&mut self, when: Instant) {
        let owner = match self.shared().running() as u32 {
            0 => RUN,
            id => id,
        };
        self.alarms.retain(|(id, _)| *id != owner);
        self.alarms.push((owner, when));
    }

    /// From now on the thread looks for messages for `limit` before it sleeps, which saves the
    /// system's wake-up: a message is there in well under a microsecond instead of five to fifty.
    /// For the length of a gesture, with a limit of a few milliseconds; it costs a core's time.
    /// Who else needs the core gets it. Zero, as at the start, is the end of it. A captured thread
    /// sleeps in its owner's loop, and so is not concerned.
    pub fn set_spin(&mut self, limit: Duration) {
        self.spin = limit;
    }

    /// Tells `observer` of every panic in this thread from now on, in place of any earlier one.
    /// Panics are reported to `tracing` at level ERROR in any case.
    pub fn observe(&mut self, observer: impl FnMut(&Fault) + 'static) {
        self.observer = Some(Box::new(observer));
    }

    /// Keeps the newest `capacity` records of what happens from now on; 0 ends the trace.
    pub fn set_trace(&mut self, capacity: usize) {
        self.trace = (capacity > 0).then(|| Trace::new(capacity));
        let traced = &self.shared().traced;
        traced.store(capacity > 0, std::sync::atomic::Ordering::Relaxed);
    }

    /// The records of the trace; empty when it is off.
    pub fn trace(&self) -> TraceSnapshot {
        let records = self.trace.iter().flat_map(|trace| &trace.records).cloned().collect();
        TraceSnapshot { thread: Arc::clone(&self.shared().name), taken: self.now(), records }
    }

    pub(crate) fn shared(&self) -> &Arc<Shared> {
        &self.handle.shared
    }

    /// Puts an object in its place in the register; one that was there is dropped.
    pub(crate) fn insert(&mut self, id: u32, object: Object, factory: Option<Factory>) {
        self.show_label(id, Some(object.label.clone()));
        let slot = Slot { object: Some(object), factory, failures: Vec::new() };
        if let Some(old) = self.objects.insert(id, slot) {
            self.drop_slot(old);
        }
    }

    /// Puts the object that `factory` makes in its place, with the factory beside it.
    pub(crate) fn insert_made(&mut self, id: u32, mut factory: impl FnMut(&mut Self) -> Object + 'static) {
        let first = factory(self);
        self.insert(id, first, Some(Box::new(factory)));
    }

    /// Removes and drops an object, and what is kept of it elsewhere; `false` when there is none.
    pub(crate) fn remove(&mut self, id: u32) -> bool {
        let Some(slot) = self.objects.remove(&id) else {
            return false;
        };
        self.alarms.retain(|(owner, _)| *owner != id);
        self.show_label(id, None);
        self.drop_slot(slot);
        true
    }

    /// From now on others see what the objects of this thread are called.
    pub(crate) fn show_labels(&mut self) {
        self.watched = true;
        for (id, slot) in &self.objects {
            self.show_label(*id, Some(slot.label()));
        }
        self.show_label(RUN, Some(Label { name: "run".into(), call: "run" }));
    }

    fn show_label(&self, id: u32, label: Option<Label>) {
        if self.watched {
            self.shared().labels.with(|labels| match label {
                Some(label) => labels.insert(id, label),
                None => labels.remove(&id),
            });
        }
    }
}
