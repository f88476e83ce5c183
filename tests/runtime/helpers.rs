//! Objects and threads that these tests share.

use dragonfly_runtime::{Context, Receiver, Worker};
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// Time limit of every wait. Sufficient on any machine: a test that waits this long has failed.
pub(crate) const LIMIT: Duration = Duration::from_secs(20);

/// Returns the moment [`LIMIT`] from now.
pub(crate) fn deadline() -> Instant {
    Instant::now() + LIMIT
}

/// A log of events, in order. Clones share it.
#[derive(Clone, Default)]
pub(crate) struct Log(Rc<RefCell<Vec<String>>>);

impl Log {
    pub(crate) fn add(&self, line: impl Into<String>) {
        self.0.borrow_mut().push(line.into());
    }

    /// Returns the entries since the last call, separated by spaces.
    pub(crate) fn take(&self) -> String {
        self.0.take().join(" ")
    }
}

/// A worker whose `update` is a closure.
pub(crate) struct FnWorker<F>(F);

pub(crate) fn fn_worker<F: FnMut(&mut Context) -> bool>(act: F) -> FnWorker<F> {
    FnWorker(act)
}

impl<F: FnMut(&mut Context) -> bool + 'static> Worker for FnWorker<F> {
    fn update(&mut self, thread: &mut Context) -> bool {
        (self.0)(thread)
    }
}

/// A receiver whose `receive` is a closure.
pub(crate) struct FnReceiver<M, F>(F, std::marker::PhantomData<fn(M)>);

pub(crate) fn fn_receiver<M, F: FnMut(M, &mut Context)>(act: F) -> FnReceiver<M, F> {
    FnReceiver(act, std::marker::PhantomData)
}

impl<M: Send + 'static, F: FnMut(M, &mut Context) + 'static> Receiver for FnReceiver<M, F> {
    type Message = M;
    fn receive(&mut self, message: M, thread: &mut Context) {
        (self.0)(message, thread);
    }
}

/// Returns a worker that logs its name and returns `true`.
pub(crate) fn log_calls(log: &Log, name: &'static str) -> FnWorker<impl FnMut(&mut Context) -> bool + use<>> {
    let log = log.clone();
    fn_worker(move |_| {
        log.add(name);
        true
    })
}

/// Returns a receiver that logs its name followed by the message.
pub(crate) fn log_messages(
    log: &Log,
    name: &'static str,
) -> FnReceiver<u32, impl FnMut(u32, &mut Context) + use<>> {
    let log = log.clone();
    fn_receiver(move |message: u32, _| log.add(format!("{name}{message}")))
}

/// Returns a receiver that forwards its messages to the test, and the channel to read them from.
pub(crate) fn forwarder<M: Send + 'static>() -> (impl Receiver<Message = M> + Send, mpsc::Receiver<M>) {
    let (inside, outside) = mpsc::channel();
    // The test may have dropped the channel.
    (fn_receiver(move |message, _| drop(inside.send(message))), outside)
}

/// Logs its name when it is dropped.
pub(crate) struct LogOnDrop(pub(crate) Log, pub(crate) &'static str);

impl Drop for LogOnDrop {
    fn drop(&mut self) {
        self.0.add(self.1);
    }
}

/// Returns a worker that owns a [`LogOnDrop`].
pub(crate) fn worker_holding(farewell: LogOnDrop) -> FnWorker<impl FnMut(&mut Context) -> bool> {
    fn_worker(move |_| {
        let LogOnDrop(..) = &farewell;
        true
    })
}

/// Starts an OS thread that does not belong to the runtime.
#[allow(clippy::disallowed_methods)]
pub(crate) fn plain_thread<T: Send + 'static>(
    body: impl FnOnce() -> T + Send + 'static,
) -> std::thread::JoinHandle<T> {
    std::thread::spawn(body)
}

/// Panics without printing the usual report to the terminal.
pub(crate) fn panic_quietly(reason: &str) -> ! {
    std::panic::resume_unwind(Box::new(reason.to_owned()))
}
