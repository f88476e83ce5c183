//! Loading on a separate thread: the document continues to work while a file is read, and survives an importer that
//! panics.

use super::{Cancel, LoadError, Loader, OpenedModel, Progress, Source};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread::JoinHandle;

/// News of a loading job.
#[derive(Debug)]
pub(super) enum JobNews {
    /// The progress so far.
    Progress(Progress),
    /// The result.
    Done(Result<Box<OpenedModel>, LoadError>),
}

/// A model that is loading. Dropping it cancels the job without waiting for its end.
pub(super) struct LoadJob {
    cancel: Cancel,
    thread: Option<JoinHandle<()>>,
}

impl LoadJob {
    /// Starts loading. `load` and `tell` are called on the thread of the job.
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
                // A progress bar needs no more than a hundred steps.
                if progress.done - last >= 0.01 {
                    last = progress.done;
                    tell(JobNews::Progress(progress));
                }
            };
            // Nothing of a failed job is used, so no partial state is visible.
            let loaded = catch_unwind(AssertUnwindSafe(|| load(&source, &mut progress, &seen)));
            tell(JobNews::Done(loaded.map(|loaded| loaded.map(Box::new)).unwrap_or_else(|panic| {
                let reason = format!("the importer failed: {}", panic_text(&*panic));
                Err(LoadError::Format { title, reason })
            })));
        })?;
        Ok(Self { cancel, thread: Some(thread) })
    }

    /// Returns whether the job has ended.
    pub(super) fn is_finished(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }
}

impl Drop for LoadJob {
    fn drop(&mut self) {
        self.cancel.cancel();
        // A job that reads from a slow disk cannot be interrupted, and is not waited for.
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
