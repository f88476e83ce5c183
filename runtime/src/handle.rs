//! A thread, as other threads see it.

use crate::batch::Content;
use crate::register::{LAST, Object, RUN, WORKER, WorkerId};
use crate::shared::{Counters, Shared};
use crate::sync::atomic::Ordering;
use crate::sync::mutant;
use crate::trace::Stamped;
use crate::{Address, Context, Fault, Receiver, SendError, TraceSnapshot, Worker};
use std::fmt;
use std::sync::Arc;
use std::time::Duration;

/// A closure that can be sent to a thread and runs in that thread's loop. Implemented for every
/// closure of this signature. Work that takes long belongs in a [`Job`](crate::Job).
pub trait ContextFn<T = ()>: FnOnce(&mut Context) -> T + Send + 'static {}

impl<T, F: FnOnce(&mut Context) -> T + Send + 'static> ContextFn<T> for F {}

/// A thread's remote control: cheap to clone, usable anywhere, never waiting.
///
/// What it asks for is a message to the thread (thesis §2.2.3.3), so it happens in order with all
/// other messages of the same sender. Asking a stopped thread does nothing.
///
/// Objects of a thread need not be [`Send`]; what is sent is a closure that makes the object
/// there. A closure that panics is reported like an object that does. Whatever has no method here,
/// such as registering an object that is made anew when it panics, is done with [`run`](Self::run).
#[derive(Clone)]
pub struct ThreadHandle {
    pub(crate) shared: Arc<Shared>,
}

impl ThreadHandle {
    /// The name given at the start; also that of the OS thread, of which Linux shows 15 bytes.
    pub fn name(&self) -> &str {
        &self.shared.name
    }

    /// Runs `call` in the thread, between two of its messages.
    ///
    /// # Errors
    /// When the thread has stopped; `call` is dropped.
    pub fn run(&self, call: impl ContextFn) -> Result<(), SendError<()>> {
        self.ask("run", call).map_err(|_| SendError::Stopped(()))
    }

    /// Adds the worker that `make` makes behind the others; see [`Context::register_worker`].
    pub fn register_worker<W: Worker>(&self, make: impl ContextFn<W>) -> WorkerId {
        let id = self.shared.new_id() | WORKER;
        self.insert(id, |thread| Object::worker(make(thread)));
        WorkerId(id)
    }

    /// Adds the worker that `make` makes behind all; see [`Context::register_last_worker`].
    pub fn register_last_worker<W: Worker>(&self, make: impl ContextFn<W>) -> WorkerId {
        let id = self.shared.new_id() | LAST;
        self.insert(id, |thread| Object::worker(make(thread)));
        WorkerId(id)
    }

    /// Adds the receiver that `make` makes. The address is good at once: what is sent to it after
    /// this call arrives after the receiver was made.
    pub fn register_receiver<R: Receiver>(&self, make: impl ContextFn<R>) -> Address<R::Message> {
        let address = self.reserve_address();
        self.register_receiver_at(&address, make);
        address
    }

    /// Adds the receiver that `make` makes at an address reserved before, or puts it in the place
    /// of the one that is there.
    ///
    /// # Panics
    /// When the address belongs to another thread.
    pub fn register_receiver_at<R: Receiver>(&self, address: &Address<R::Message>, make: impl ContextFn<R>) {
        self.insert(address.receiver_in(&self.shared), |thread| Object::receiver(make(thread)));
    }

    /// An address at which nobody is registered yet, for objects that need each other's address.
    /// What arrives before a receiver is registered there is undeliverable.
    pub fn reserve_address<M: Send + 'static>(&self) -> Address<M> {
        Address::new(&self.shared, self.shared.new_id())
    }

    /// Removes and drops a worker, in its thread.
    pub fn unregister_worker(&self, id: WorkerId) {
        self.remove(id.0);
    }

    /// Removes and drops a receiver, in its thread. What is queued behind this is undeliverable.
    ///
    /// # Panics
    /// When the address belongs to another thread.
    pub fn unregister_receiver<M: Send + 'static>(&self, address: &Address<M>) {
        self.remove(address.receiver_in(&self.shared));
    }

    /// Ends the thread behind all messages queued so far: they are delivered, later ones are not.
    /// Ends a sleep or pause early. [`Thread::wait_for`](crate::Thread::wait_for) waits for it.
    pub fn remote_stop(&self) {
        self.shared.stopping.store(true, Ordering::SeqCst);
        // Nothing to do when it has stopped already.
        let _ = self.ask("stop", Context::stop);
        self.shared.mailbox.0.wake_now();
    }

    /// Lets the thread sleep for `duration`, behind all messages queued so far; see
    /// [`Context::sleep`].
    pub fn remote_sleep(&self, duration: Duration) {
        // A stopped thread sleeps well enough.
        let _ = self.ask("sleep", move |thread| thread.sleep(duration));
    }

    /// Lets the thread rest as soon as the call that is running there returns: it does not wait in
    /// the queue. Messages are stored until [`resume`](Self::resume).
    pub fn pause(&self) {
        self.shared.paused.store(true, Ordering::SeqCst);
    }

    /// Ends a pause. Pauses do not add up.
    pub fn resume(&self) {
        mutant!(self.silent_resume());
        self.shared.paused.store(false, Ordering::SeqCst);
        self.shared.mailbox.0.wake_now();
    }

    /// Has the loop ended, with every object of the thread dropped?
    pub fn is_stopped(&self) -> bool {
        self.shared.finished.load(Ordering::SeqCst)
    }

    /// How many messages are stored for the next iteration.
    pub fn queue_len(&self) -> usize {
        self.shared.mailbox.0.len()
    }

    /// What happened in the thread so far.
    pub fn counters(&self) -> Counters {
        self.shared.tallies.0.read()
    }

    /// Tells `observer`, in that thread, of every panic there; see [`Context::observe`].
    pub fn observe(&self, observer: impl FnMut(&Fault) + Send + 'static) {
        self.command(move |thread| thread.observe(observer));
    }

    /// Lets the thread look for messages for `limit` before it sleeps; see [`Context::set_spin`].
    pub fn set_spin(&self, limit: Duration) {
        self.command(move |thread| thread.set_spin(limit));
    }

    /// Traces the thread, keeping the newest `capacity` records; 0 ends the trace.
    pub fn set_trace(&self, capacity: usize) {
        self.command(move |thread| thread.set_trace(capacity));
    }

    /// Asks for the records of the trace; they come as a message, like any answer.
    pub fn request_trace(&self, to: &Address<TraceSnapshot>) {
        let to = to.clone();
        // Who has stopped does not want them any more.
        self.command(move |thread| _ = to.send(thread.trace()));
    }

    fn insert(&self, id: u32, make: impl ContextFn<Object>) {
        self.command(move |thread| {
            let object = make(thread);
            thread.insert(id, object, None);
        });
    }

    fn remove(&self, id: u32) {
        self.command(move |thread| _ = thread.remove(id));
    }

    /// A message that the thread itself understands. A stopped thread has no use for it.
    fn command(&self, call: impl ContextFn) {
        let _ = self.ask("run", call);
    }

    fn ask(&self, name: &'static str, call: impl ContextFn) -> Result<(), Asked> {
        let row = self.shared.mailbox.0.row::<Asked>();
        self.shared.send(0, row, Asked { name, call: Box::new(call) })
    }
}

/// A letter to the thread itself: registers, observers, traces, sleep and stop.
struct Asked {
    name: &'static str,
    call: Box<dyn FnOnce(&mut Context) + Send>,
}

impl Content for Asked {
    fn name(&self) -> &'static str {
        self.name
    }

    fn deliver(self, _: u32, _: Stamped, thread: &mut Context) {
        thread.shown(RUN, &"run".into(), |thread| thread.contain("run", "run", self.call));
    }

    fn discard(self) -> usize {
        0
    }
}

impl PartialEq for ThreadHandle {
    /// Do both stand for the same thread?
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.shared, &other.shared)
    }
}

impl Eq for ThreadHandle {}

impl fmt::Debug for ThreadHandle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "ThreadHandle({})", self.name())
    }
}
