//! The jobs of the document: it continues to work while a file is read or a folder is searched, and survives an importer that
//! panics.

use super::clip_news::ClipNews;
use super::export::{ExportOrder, ExportReport};
use super::pose_library::PoseFolder;
use super::retarget_order::RetargetNews;
use super::scan::RecoveryScan;
use super::scene_includes::SceneIncludeNews;
use super::scene_models::SceneModelNews;
use super::take_check::CheckedTake;
use super::{LoadError, LoadedModel, Loader, OpenedModel, Progress, Source};
use dragonfly_runtime::{Address, Job, JobContext};
use dragonfly_store::Autosave;
use std::sync::Arc;

/// News of a job. A loading job has a ticket; the document ignores the news of one that it cancelled.
#[derive(Debug)]
pub(super) enum JobNews {
    /// The progress of the loading job with this ticket.
    Progress(u64, Progress),
    /// The result of the loading job with this ticket.
    Loaded(u64, Result<Box<OpenedModel>, LoadError>),
    /// The fraction of the save with this ticket that is done.
    SaveProgress(u64, f32),
    /// A step of the save with this ticket has ended.
    SaveStep(u64),
    /// The result of a search for unsaved work.
    Scanned(RecoveryScan),
    /// The result of a job for takes of another model.
    Retarget(RetargetNews),
    /// A file that takes are compared with.
    Compared(Result<Arc<LoadedModel>, String>),
    /// The takes of files for the open model.
    Clips(ClipNews),
    /// An export has ended, or what it would lose was found out.
    Exported(Box<(ExportOrder, Result<ExportReport, String>)>),
    /// The defects of a take.
    Checked(Result<CheckedTake, String>),
    /// A model of the open scene was read.
    SceneModel(Box<SceneModelNews>),
    /// Files that the script of the open scene includes were read.
    SceneIncludes(Box<SceneIncludeNews>),
    /// The folder of the pose library after an order.
    Poses(Result<PoseFolder, String>),
}

/// Starts loading `source` in a job, whose news reach the document with `ticket`. Dropping the job cancels it without
/// waiting for its end.
///
/// # Errors
/// The system cannot create a thread, or the document has stopped.
pub(super) fn start_loading(
    document: &Address<JobNews>,
    ticket: u64,
    source: Source,
    load: Loader,
) -> std::io::Result<Job> {
    let title = source.title();
    Job::start(
        document,
        "load",
        move |job| {
            let mut report =
                |progress: Progress| job.report(progress.done, |_| JobNews::Progress(ticket, progress));
            let loaded = load(&source, &mut report, job.cancel_flag());
            JobNews::Loaded(ticket, loaded.map(Box::new))
        },
        move |panic| {
            let reason = format!("the importer failed: {panic}");
            JobNews::Loaded(ticket, Err(LoadError::Format { title, reason }))
        },
    )
}

/// Starts a search for unsaved work of earlier sessions in a job, which replies also if it finds nothing.
///
/// # Errors
/// The system cannot create a thread, or the document has stopped.
pub(super) fn start_search(document: &Address<JobNews>, autosave: Autosave) -> std::io::Result<Job> {
    let search = move |_: &JobContext<_>| JobNews::Scanned(RecoveryScan::of(&autosave));
    let failed = |panic: &str| JobNews::Scanned(RecoveryScan::failed(panic));
    Job::start(document, "recovery", search, failed)
}
