//! The objects that play in these tests.

use dragonfly_runtime::{Context, Receiver, Worker};
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// Long enough for any machine; a test that waits this long has failed.
pub(crate) const LIMIT: Duration = Duration::from_secs(20);

/// [`LIMIT`] from now.
pub(crate) fn deadline() -> Instant {
    Instant::now() + LIMIT
}

/// What happened on a stage, in order.
#[derive(Clone, Default)]
pub(crate) struct Log(Rc<RefCell<Vec<String>>>);

impl Log {
    pub(crate) fn add(&self, line: impl Into<String>) {
        self.0.borrow_mut().push(line.into());
    }

    /// Takes what was logged since the last time, with spaces between.
    pub(crate) fn take(&self) -> String {
        self.0.take().join(" ")
    }
}

/// A worker made of a closure.
pub(crate) struct Work<F>(F);

pub(crate) fn work<F: FnMut(&mut Context) -> bool>(act: F) -> Work<F> {
    Work(act)
}

impl<F: FnMut(&mut Context) -> bool + 'static> Worker for Work<F> {
    fn update(&mut self, thread: &mut Context) -> bool {
        (self.0)(thread)
    }
}

/// A receiver made of a closure.
pub(crate) struct Hear<M, F>(F, std::marker::PhantomData<fn(M)>);

pub(crate) fn hear<M, F: FnMut(M, &mut Context)>(act: F) -> Hear<M, F> {
    Hear(act, std::marker::PhantomData)
}

impl<M: Send + 'static, F: FnMut(M, &mut Context) + 'static> Receiver for Hear<M, F> {
    type Message = M;
    fn receive(&mut self, message: M, thread: &mut Context) {
        (self.0)(message, thread);
    }
}

/// A worker that logs its name, and goes on.
pub(crate) fn note(log: &Log, name: &'static str) -> Work<impl FnMut(&mut Context) -> bool + use<>> {
    let log = log.clone();
    work(move |_| {
        log.add(name);
        true
    })
}

/// A receiver that logs what it gets, behind its name.
pub(crate) fn listen(log: &Log, name: &'static str) -> Hear<u32, impl FnMut(u32, &mut Context) + use<>> {
    let log = log.clone();
    hear(move |message: u32, _| log.add(format!("{name}{message}")))
}

/// Passes what it gets out of its thread, to the test.
pub(crate) fn outlet<M: Send + 'static>() -> (impl Receiver<Message = M> + Send, mpsc::Receiver<M>) {
    let (inside, outside) = mpsc::channel();
    // The test may have seen enough and gone.
    (hear(move |message, _| drop(inside.send(message))), outside)
}

/// Logs when it is dropped.
pub(crate) struct Farewell(pub(crate) Log, pub(crate) &'static str);

impl Drop for Farewell {
    fn drop(&mut self) {
        self.0.add(self.1);
    }
}

/// A worker that holds a [`Farewell`].
pub(crate) fn keep(farewell: Farewell) -> Work<impl FnMut(&mut Context) -> bool> {
    work(move |_| {
        let Farewell(..) = &farewell;
        true
    })
}

/// A thread that the runtime knows nothing of: a sender from outside.
#[allow(clippy::disallowed_methods)]
pub(crate) fn plain_thread<T: Send + 'static>(
    body: impl FnOnce() -> T + Send + 'static,
) -> std::thread::JoinHandle<T> {
    std::thread::spawn(body)
}

/// Panics without the usual report on the terminal, which a test of panics does not want.
pub(crate) fn panic_quietly(reason: &str) -> ! {
    std::panic::resume_unwind(Box::new(reason.to_owned()))
}
