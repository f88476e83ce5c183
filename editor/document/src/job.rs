//! Loading in a thread of its own: the document goes on while a file is read, and outlives an importer that panics.

use super::{Cancel, LoadError, Loader, Opened, Progress, Source};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread::JoinHandle;

/// What a job tells its owner.
#[derive(Debug)]
pub(super) enum JobNews {
    /// It goes on.
    Progress(Progress),
    /// It is over.
    Done(Result<Box<Opened>, LoadError>),
}

/// A model being loaded. Dropping it cancels the job and lets it end by itself.
pub(super) struct LoadJob {
    cancel: Cancel,
    thread: Option<JoinHandle<()>>,
}

impl LoadJob {
    /// Starts loading; `load` and `tell` are called in the job's thread.
    pub(super) fn start(
        source: Source,
        load: Loader,
        tell: impl Fn(JobNews) + Send + 'static,
    ) -> std::io::Result<Self> {
        let cancel = Cancel::default();
        let seen = cancel.clone();
        let thread = std::thread::Builder::new().name("load".to_owned()).spawn(move || {
            let title = source.title();
            let mut last = -1.0;
            let mut progress = |progress: Progress| {
                // A hundred steps are enough for any bar.
                if progress.done - last >= 0.01 {
                    last = progress.done;
                    tell(JobNews::Progress(progress));
                }
            };
            // Nothing of a failed job is kept, so nothing half done can be seen.
            let loaded = catch_unwind(AssertUnwindSafe(|| load(&source, &mut progress, &seen)));
            tell(JobNews::Done(loaded.map(|loaded| loaded.map(Box::new)).unwrap_or_else(|panic| {
                let reason = format!("the importer failed: {}", panic_text(&*panic));
                Err(LoadError::Format { title, reason })
            })));
        })?;
        Ok(Self { cancel, thread: Some(thread) })
    }

    /// Has it ended?
    pub(super) fn is_finished(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }
}

impl Drop for LoadJob {
    fn drop(&mut self) {
        self.cancel.cancel();
        // A job that reads from a slow disk cannot be interrupted; nobody waits for it.
        if self.is_finished()
            && let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            tracing::error!("a load job panicked outside its guard");
        }
    }
}

fn panic_text(panic: &(dyn std::any::Any + Send)) -> &str {
    if let Some(text) = panic.downcast_ref::<&str>() {
        text
    } else if let Some(text) = panic.downcast_ref::<String>() {
        text
    } else {
        "it gave no reason"
    }
}
