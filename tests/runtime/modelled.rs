//! Replaces the standard library's lock and threads while a model checker runs: compiled into the runtime's
//! `sync` module, in builds with `--cfg loom` or `--cfg shuttle` only.

#[cfg(loom)]
pub use loom::sync::{Mutex, atomic};
#[cfg(shuttle)]
pub use shuttle::sync::{Mutex, atomic};

/// Returns whether the environment variable `PLANTED` selects the planted bug of this name.
pub(crate) fn planted(bug: &str) -> bool {
    static ON: std::sync::LazyLock<String> =
        std::sync::LazyLock::new(|| std::env::var("PLANTED").unwrap_or_default());
    *ON == bug
}

#[cfg(shuttle)]
pub use shuttle::thread;

/// loom's threads with a `park` that behaves like the standard library's.
///
/// loom 0.7's own `unpark` also wakes a thread that is blocked in a lock or a join, which then
/// panics inside loom. Here a token under loom's lock and condition variable wakes it.
#[cfg(loom)]
pub mod thread {
    use loom::sync::{Condvar, Mutex};
    pub use loom::thread::yield_now;
    use std::cell::RefCell;
    use std::io;
    use std::sync::Arc;

    /// Has the name of the type that it replaces, `std::thread::Thread`.
    #[derive(Clone)]
    pub struct Thread(Arc<ParkToken>);

    struct ParkToken {
        given: Mutex<bool>,
        changed: Condvar,
    }

    loom::thread_local! {
        static CURRENT: RefCell<Option<Thread>> = RefCell::new(None);
    }

    impl Thread {
        fn new() -> Self {
            Self(Arc::new(ParkToken { given: Mutex::new(false), changed: Condvar::new() }))
        }

        pub fn unpark(&self) {
            *self.0.given.lock().unwrap() = true;
            self.0.changed.notify_one();
        }

        pub fn id(&self) -> usize {
            Arc::as_ptr(&self.0) as usize
        }
    }

    pub fn current() -> Thread {
        CURRENT.with(|current| current.borrow_mut().get_or_insert_with(Thread::new).clone())
    }

    pub fn park() {
        let Thread(token) = current();
        let mut given = token.given.lock().unwrap();
        while !*given {
            given = token.changed.wait(given).unwrap();
        }
        *given = false;
    }

    pub struct Builder;

    impl Builder {
        pub fn new() -> Self {
            Self
        }

        pub fn name(self, _: String) -> Self {
            self
        }

        pub fn spawn<T: 'static>(
            self,
            body: impl FnOnce() -> T + Send + 'static,
        ) -> io::Result<JoinHandle<T>> {
            let thread = Thread::new();
            let theirs = thread.clone();
            let join = loom::thread::spawn(move || {
                CURRENT.with(|current| *current.borrow_mut() = Some(theirs));
                body()
            });
            Ok(JoinHandle { thread, join })
        }
    }

    pub struct JoinHandle<T> {
        thread: Thread,
        join: loom::thread::JoinHandle<T>,
    }

    impl<T> JoinHandle<T> {
        pub fn thread(&self) -> &Thread {
            &self.thread
        }

        pub fn join(self) -> std::thread::Result<T> {
            self.join.join()
        }
    }

    pub fn spawn<T: 'static>(body: impl FnOnce() -> T + Send + 'static) -> JoinHandle<T> {
        Builder::new().spawn(body).unwrap()
    }
}
