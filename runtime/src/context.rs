//! The context of a thread: what a worker or receiver can use while it is called.

use crate::batch::Batch;
use crate::handle::ThreadHandle;
use crate::register::{LAST, Label, Object, ObjectFactory, ObjectSlot, RUN, Register, WORKER, WorkerId};
use crate::shared::ThreadShared;
use crate::trace::Trace;
use crate::{Address, Fault, Receiver, Timer, TraceSnapshot, Worker};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The context of a thread: the state of its loop and the register of its objects.
///
/// Every call in the thread gets it as `&mut Context`. Changes of the register take effect at once:
/// a message queued for a removed receiver is undeliverable, and a removed worker is not called
/// again. A worker that is registered while workers are being called is first called in the next
/// iteration, so an iteration always ends.
pub struct Context {
    pub(crate) handle: ThreadHandle,
    pub(crate) objects: Register,
    /// Letters fetched from the mailbox and not yet delivered, also while the thread sleeps or pauses.
    pub(crate) batch: Batch,
    pub(crate) again: bool,
    pub(crate) stopped: bool,
    pub(crate) ended: bool,
    pub(crate) sleep_until: Option<Instant>,
    pub(crate) spin: Duration,
    /// Alarms by object, at most one each. They are few, so a list is faster than a map, and it keeps
    /// its memory.
    pub(crate) alarms: Vec<(u32, Instant)>,
    pub(crate) observer: Option<FaultObserver>,
    pub(crate) trace: Option<Trace>,
    /// Whether a watchdog needs the names of the objects.
    watched: bool,
}

/// Called with every panic in the thread.
type FaultObserver = Box<dyn FnMut(&Fault)>;

impl Context {
    pub(crate) fn new(shared: Arc<ThreadShared>) -> Self {
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

    /// Returns the handle of this thread. Messages sent to it are delivered in the next iteration.
    pub fn handle(&self) -> &ThreadHandle {
        &self.handle
    }

    /// Returns the current time of this thread's clock, which a test may advance itself.
    pub fn now(&self) -> Instant {
        self.shared().clock.now()
    }

    /// Returns a timer that starts now and uses this thread's clock.
    pub fn timer(&self) -> Timer {
        Timer::with_clock(self.shared().clock.clone())
    }

    /// Adds `worker` after all others except those registered to stay last.
    pub fn register_worker(&mut self, worker: impl Worker) -> WorkerId {
        let id = self.shared().new_id() | WORKER;
        self.insert(id, Object::worker(worker), None);
        WorkerId(id)
    }

    /// Adds `worker` after all others, including those registered later. Several such workers are
    /// called in the order of registration.
    pub fn register_last_worker(&mut self, worker: impl Worker) -> WorkerId {
        let id = self.shared().new_id() | LAST;
        self.insert(id, Object::worker(worker), None);
        WorkerId(id)
    }

    /// Adds the worker that `make` returns. When it panics, `make` is called again to replace it at
    /// the same position: at most [`RESTARTS`](crate::RESTARTS) times in [`RESTART_WINDOW`](crate::RESTART_WINDOW).
    pub fn register_restartable_worker<W: Worker>(
        &mut self,
        mut make: impl FnMut(&mut Context) -> W + 'static,
    ) -> WorkerId {
        let id = self.shared().new_id() | WORKER;
        self.insert_made(id, move |thread| Object::worker(make(thread)));
        WorkerId(id)
    }

    /// Adds `receiver` and returns its address.
    pub fn register_receiver<R: Receiver>(&mut self, receiver: R) -> Address<R::Message> {
        let address = self.handle.reserve_address();
        self.register_receiver_at(&address, receiver);
        address
    }

    /// Adds `receiver` at a reserved address, or replaces the receiver registered there.
    ///
    /// # Panics
    /// When the address belongs to another thread.
    pub fn register_receiver_at<R: Receiver>(&mut self, address: &Address<R::Message>, receiver: R) {
        self.insert(address.receiver_in(self.shared()), Object::receiver(receiver), None);
    }

    /// Adds the receiver that `make` returns at a reserved address. When it panics, `make` is called
    /// again to replace it: at most [`RESTARTS`](crate::RESTARTS) times in
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

    /// Removes and drops a worker. Returns `false` when there is no worker with that id.
    /// A worker that removes itself is dropped when its call returns.
    pub fn unregister_worker(&mut self, id: WorkerId) -> bool {
        self.remove(id.0)
    }

    /// Removes and drops a receiver. Returns `false` when there is none at that address. Messages
    /// queued for it are undeliverable.
    ///
    /// # Panics
    /// When the address belongs to another thread.
    pub fn unregister_receiver<M: Send + 'static>(&mut self, address: &Address<M>) -> bool {
        self.remove(address.receiver_in(self.shared()))
    }

    /// Ends the thread when the running call returns: no further message is delivered and no worker
    /// called. [`remote_stop`](ThreadHandle::remote_stop) ends it after all queued messages instead.
    pub fn stop(&mut self) {
        self.stopped = true;
    }

    /// Makes the thread sleep for `duration` as soon as the running call returns, which ends the
    /// iteration; messages not yet delivered are delivered first in the next one. Messages do not
    /// wake the thread, they are queued; a [`remote_stop`](ThreadHandle::remote_stop) does.
    pub fn sleep(&mut self, duration: Duration) {
        self.sleep_until = self.now().checked_add(duration);
    }

    /// Like [`sleep`](Self::sleep), but until [`resume`](ThreadHandle::resume) is called.
    pub fn pause(&mut self) {
        self.handle.pause();
    }

    /// Requests another iteration without waiting for a message. Valid for one iteration, so an
    /// object that must run continuously calls this in every call.
    pub fn iterate_again(&mut self) {
        self.again = true;
    }

    /// Requests an iteration at `when` at the latest. Each object has one such alarm: a later call
    /// replaces it, and it is removed when it is due and when the object is removed. Outside of an
    /// object's call, in a closure that was sent to the thread, it sets the alarm of the thread
    /// itself.
    pub fn wake_at(&mut self, when: Instant) {
        let owner = match self.shared().running() as u32 {
            0 => RUN,
            id => id,
        };
        self.alarms.retain(|(id, _)| *id != owner);
        self.alarms.push((owner, when));
    }

    /// Makes the thread spin for up to `limit` before it sleeps. That avoids the wake-up by the
    /// system: a message then arrives in well under a microsecond instead of 5 to 50.
    /// Meant for the length of a gesture, with a limit of a few milliseconds, because it uses a CPU
    /// core; other threads that need the core still get it. Zero, the default, turns it off. No
    /// effect on a captured thread, which sleeps in its owner's loop.
    pub fn set_spin(&mut self, limit: Duration) {
        self.spin = limit;
    }

    /// Calls `observer` with every panic in this thread from now on. Replaces an earlier observer.
    /// Panics are also logged with `tracing` at level ERROR.
    pub fn observe(&mut self, observer: impl FnMut(&Fault) + 'static) {
        self.observer = Some(Box::new(observer));
    }

    /// Starts a trace that keeps the newest `capacity` records; 0 ends it.
    pub fn set_trace(&mut self, capacity: usize) {
        self.trace = (capacity > 0).then(|| Trace::new(capacity));
        let traced = &self.shared().traced;
        traced.store(capacity > 0, std::sync::atomic::Ordering::Relaxed);
    }

    /// Returns the records of the trace; empty when it is off.
    pub fn trace(&self) -> TraceSnapshot {
        let records = self.trace.iter().flat_map(|trace| &trace.records).cloned().collect();
        TraceSnapshot { thread: Arc::clone(&self.shared().name), taken: self.now(), records }
    }

    pub(crate) fn shared(&self) -> &Arc<ThreadShared> {
        &self.handle.shared
    }

    /// Puts an object into the register and drops the one that it replaces, if any.
    pub(crate) fn insert(&mut self, id: u32, object: Object, factory: Option<ObjectFactory>) {
        self.publish_label(id, Some(object.label.clone()));
        let slot = ObjectSlot { object: Some(object), factory, failures: Vec::new() };
        if let Some(old) = self.objects.insert(id, slot) {
            self.drop_slot(old);
        }
    }

    /// Puts the object that `factory` returns into the register, together with the factory.
    pub(crate) fn insert_made(&mut self, id: u32, mut factory: impl FnMut(&mut Self) -> Object + 'static) {
        let first = factory(self);
        self.insert(id, first, Some(Box::new(factory)));
    }

    /// Removes and drops an object, its alarm and its label. Returns `false` when there is none.
    pub(crate) fn remove(&mut self, id: u32) -> bool {
        let Some(slot) = self.objects.remove(&id) else {
            return false;
        };
        self.alarms.retain(|(owner, _)| *owner != id);
        self.publish_label(id, None);
        self.drop_slot(slot);
        true
    }

    /// Shows the names of this thread's objects to other threads from now on.
    pub(crate) fn publish_labels(&mut self) {
        self.watched = true;
        for (id, slot) in &self.objects {
            self.publish_label(*id, Some(slot.label()));
        }
        self.publish_label(RUN, Some(Label { name: "run".into(), call: "run" }));
    }

    fn publish_label(&self, id: u32, label: Option<Label>) {
        if self.watched {
            self.shared().labels.with(|labels| match label {
                Some(label) => labels.insert(id, label),
                None => labels.remove(&id),
            });
        }
    }
}
