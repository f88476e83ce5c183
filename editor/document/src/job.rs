//! Loading in a job: the document continues to work while a file is read, and survives an importer that panics.

use super::message::{DocumentMessage, JobNews, NewsBox};
use super::{LoadError, Loader, Progress, Source};
use dragonfly_runtime::{Address, Job};

/// Starts loading `source` in a job, whose news reach the document with `ticket`. Dropping the job cancels it without
/// waiting for its end.
///
/// # Errors
/// The system cannot create a thread, or the document has stopped.
pub(super) fn start_loading(
    document: &Address<DocumentMessage>,
    ticket: u64,
    source: Source,
    load: Loader,
) -> std::io::Result<Job> {
    let news = move |news| DocumentMessage::News(ticket, NewsBox(Box::new(news)));
    let title = source.title();
    Job::start(
        document,
        "load",
        move |job| {
            let mut report =
                |progress: Progress| job.report(progress.done, |_| news(JobNews::Progress(progress)));
            let loaded = load(&source, &mut report, job.cancel_flag());
            news(JobNews::Done(loaded.map(Box::new)))
        },
        move |panic| {
            let reason = format!("the importer failed: {panic}");
            news(JobNews::Done(Err(LoadError::Format { title, reason })))
        },
    )
}
