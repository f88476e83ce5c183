//! One run of one benchmark: when it began, who says that it is over, and how nothing hangs or fails unseen.

use std::mem;
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// A run that takes longer is stuck.
pub(crate) const DEADLINE: Duration = Duration::from_secs(60);

/// What a run came to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Finish {
    /// From before the first actor was created to the last message that matters.
    pub(crate) took: Duration,
    /// Messages that the benchmark's answer needs; see each benchmark for what it counts.
    pub(crate) messages: u64,
    /// Requests that were refused and made again, where a benchmark has such.
    pub(crate) retries: Option<u64>,
}

/// What the actors of a run share. Every actor can say that the run is over, and none can panic unseen.
pub(crate) struct Run {
    begin: Instant,
    verdict: mpsc::Sender<Result<Finish, Panicked>>,
}

/// Some actor panicked; the reason has been printed.
struct Panicked;

impl Run {
    /// Starts the clock.
    pub(crate) fn begin() -> (Self, Verdict) {
        let (verdict, found) = mpsc::channel();
        (Self { begin: Instant::now(), verdict }, Verdict(found))
    }

    /// Stops the clock.
    pub(crate) fn finish(&self, messages: u64, retries: Option<u64>) {
        let finish = Finish { took: self.begin.elapsed(), messages, retries };
        // Nobody listens any more when the run was given up.
        let _ = self.verdict.send(Ok(finish));
    }

    /// Calls an actor; a panic fails the run at once, whatever the actor's system makes of it.
    ///
    /// Costs nothing as long as there is none: what says so is a drop that only an unwinding stack reaches.
    pub(crate) fn watch<T>(&self, call: impl FnOnce() -> T) -> T {
        struct Alarm<'a>(&'a Run);
        impl Drop for Alarm<'_> {
            fn drop(&mut self) {
                let _ = self.0.verdict.send(Err(Panicked));
            }
        }
        let alarm = Alarm(self);
        let answer = call();
        mem::forget(alarm);
        answer
    }
}

/// Where the end of a run is awaited.
pub(crate) struct Verdict(mpsc::Receiver<Result<Finish, Panicked>>);

impl Verdict {
    /// Waits for the end. `Err` says why there is none.
    pub(crate) fn wait(&self) -> Result<Finish, String> {
        self.within(DEADLINE)
    }

    /// The end, of a run in which nobody has anything left to do. `Err` says why there is none.
    pub(crate) fn now(&self) -> Result<Finish, String> {
        self.within(Duration::ZERO).map_err(|_| "all is done, and nobody said that it is over".into())
    }

    /// Has an actor panicked behind the end?
    pub(crate) fn is_clean(&self) -> bool {
        self.0.try_iter().all(|end| end.is_ok())
    }

    fn within(&self, limit: Duration) -> Result<Finish, String> {
        match self.0.recv_timeout(limit) {
            Ok(Ok(finish)) => Ok(finish),
            Ok(Err(Panicked)) => Err("an actor panicked".into()),
            Err(_) => Err(format!("no end within {limit:?}")),
        }
    }
}
