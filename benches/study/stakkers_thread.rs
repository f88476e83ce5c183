//! The one thread of the process in which stakker runs.
//!
//! With its default features, where it is quickest, it allows but one thread for as long as the process lives. Tests
//! run in a thread each, and so would find it taken.

use dragonfly_runtime::Thread;
use std::sync::{LazyLock, mpsc};

static THREAD: LazyLock<Thread> =
    LazyLock::new(|| Thread::start("stakker").expect("the system has a thread left"));

/// Runs `job` there, behind what others have it do. Its answer comes through the channel; when `job` panics, there is
/// none.
pub fn run<T: Send + 'static>(job: impl FnOnce() -> T + Send + 'static) -> mpsc::Receiver<T> {
    let (answer, found) = mpsc::channel();
    let job = move |_: &mut dragonfly_runtime::Context| {
        // Who asked may have given up.
        let _ = answer.send(job());
    };
    THREAD.handle().run(job).expect("it never stops");
    found
}
