//! The handle of a thread, through which other threads control it.

use crate::batch::LetterContent;
use crate::register::{LAST, Object, RUN, WORKER, WorkerId};
use crate::shared::{Counters, ThreadShared};
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

/// A remote control for a thread: cheap to clone, usable from any thread, never blocking.
///
/// Each request is a message to the thread (thesis §2.2.3.3), so it is processed in order with all
/// other messages of the same sender. Requests to a stopped thread do nothing.
///
/// Objects of a thread need not be [`Send`]; what is sent is a closure that makes the object
/// there. A closure that panics is reported like an object that panics. Whatever has no method
/// here, such as registering an object that is restarted after a panic, is done with
/// [`run`](Self::run).
#[derive(Clone)]
pub struct ThreadHandle {
    pub(crate) shared: Arc<ThreadShared>,
}

impl ThreadHandle {
    /// Returns the name given at the start. It is also the name of the OS thread, of which Linux
    /// shows 15 bytes.
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

    /// Adds the worker that `make` returns, after the others; see [`Context::register_worker`].
    pub fn register_worker<W: Worker>(&self, make: impl ContextFn<W>) -> WorkerId {
        let id = self.shared.new_id() | WORKER;
        self.insert(id, |thread| Object::worker(make(thread)));
        WorkerId(id)
    }

    /// Adds the worker that `make` returns, after all others; see
    /// [`Context::register_last_worker`].
    pub fn register_last_worker<W: Worker>(&self, make: impl ContextFn<W>) -> WorkerId {
        let id = self.shared.new_id() | LAST;
        self.insert(id, |thread| Object::worker(make(thread)));
        WorkerId(id)
    }

    /// Adds the receiver that `make` returns. The address is valid at once: messages sent to it
    /// after this call arrive after the receiver was made.
    pub fn register_receiver<R: Receiver>(&self, make: impl ContextFn<R>) -> Address<R::Message> {
        let address = self.reserve_address();
        self.register_receiver_at(&address, make);
        address
    }

    /// Adds the receiver that `make` returns at a reserved address, or replaces the receiver
    /// registered there.
    ///
    /// # Panics
    /// When the address belongs to another thread.
    pub fn register_receiver_at<R: Receiver>(&self, address: &Address<R::Message>, make: impl ContextFn<R>) {
        self.insert(address.receiver_in(&self.shared), |thread| Object::receiver(make(thread)));
    }

    /// Returns an address without a receiver, for objects that need each other's address. Messages
    /// that arrive before a receiver is registered there are undeliverable.
    pub fn reserve_address<M: Send + 'static>(&self) -> Address<M> {
        Address::new(&self.shared, self.shared.new_id())
    }

    /// Removes and drops a worker, in its thread.
    pub fn unregister_worker(&self, id: WorkerId) {
        self.remove(id.0);
    }

    /// Removes and drops a receiver, in its thread. Messages queued after this call are
    /// undeliverable.
    ///
    /// # Panics
    /// When the address belongs to another thread.
    pub fn unregister_receiver<M: Send + 'static>(&self, address: &Address<M>) {
        self.remove(address.receiver_in(&self.shared));
    }

    /// Ends the thread after all messages queued so far: they are delivered, later ones are not.
    /// Interrupts a sleep or pause. [`Thread::wait_for`](crate::Thread::wait_for) waits for it.
    pub fn remote_stop(&self) {
        self.shared.stopping.store(true, Ordering::SeqCst);
        // Fails only when the thread has stopped already.
        let _ = self.ask("stop", Context::stop);
        self.shared.mailbox.0.wake_now();
    }

    /// Makes the thread sleep for `duration`, after all messages queued so far; see
    /// [`Context::sleep`].
    pub fn remote_sleep(&self, duration: Duration) {
        // Fails only when the thread has stopped, and then there is nothing to put to sleep.
        let _ = self.ask("sleep", move |thread| thread.sleep(duration));
    }

    /// Suspends the thread as soon as the call that is running there returns, before it delivers
    /// any queued message. Messages are queued until [`resume`](Self::resume).
    pub fn pause(&self) {
        self.shared.paused.store(true, Ordering::SeqCst);
    }

    /// Ends a pause. One call ends any number of pauses.
    pub fn resume(&self) {
        mutant!(self.silent_resume());
        self.shared.paused.store(false, Ordering::SeqCst);
        self.shared.mailbox.0.wake_now();
    }

    /// Returns whether the loop has ended and every object of the thread has been dropped.
    pub fn is_stopped(&self) -> bool {
        self.shared.finished.load(Ordering::SeqCst)
    }

    /// Returns the number of messages queued for the next iteration.
    pub fn queue_len(&self) -> usize {
        self.shared.mailbox.0.len()
    }

    /// Returns the statistics of the thread since its start.
    pub fn counters(&self) -> Counters {
        self.shared.tallies.0.read()
    }

    /// Calls `observer`, in that thread, with every panic there; see [`Context::observe`].
    pub fn observe(&self, observer: impl FnMut(&Fault) + Send + 'static) {
        self.command(move |thread| thread.observe(observer));
    }

    /// Makes the thread spin for up to `limit` before it sleeps; see [`Context::set_spin`].
    pub fn set_spin(&self, limit: Duration) {
        self.command(move |thread| thread.set_spin(limit));
    }

    /// Starts a trace that keeps the newest `capacity` records; 0 ends it.
    pub fn set_trace(&self, capacity: usize) {
        self.command(move |thread| thread.set_trace(capacity));
    }

    /// Requests the records of the trace, which are sent to `to` as a message.
    pub fn request_trace(&self, to: &Address<TraceSnapshot>) {
        let to = to.clone();
        // Fails only when the receiver's thread has stopped.
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

    /// Sends a command to the thread. A stopped thread ignores it.
    fn command(&self, call: impl ContextFn) {
        let _ = self.ask("run", call);
    }

    fn ask(&self, name: &'static str, call: impl ContextFn) -> Result<(), ThreadCommand> {
        let row = self.shared.mailbox.0.row::<ThreadCommand>();
        self.shared.send(0, row, ThreadCommand { name, call: Box::new(call) })
    }
}

/// A letter to the thread itself: changes of the register, the observer or the trace, sleep, stop.
struct ThreadCommand {
    name: &'static str,
    call: Box<dyn FnOnce(&mut Context) + Send>,
}

impl LetterContent for ThreadCommand {
    fn name(&self) -> &'static str {
        self.name
    }

    fn deliver(self, _: u32, _: Stamped, thread: &mut Context) {
        thread.call_as(RUN, &"run".into(), |thread| thread.catch_and_report("run", "run", self.call));
    }

    fn discard(self) -> usize {
        0
    }
}

impl PartialEq for ThreadHandle {
    /// Returns whether both are handles of the same thread.
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
