//! The job that imports the takes of files onto the open model, as one edit.

use super::adapter::ModelAdapter;
use super::clips::{ClipSettings, ClipTakes, TakeNames, clip_takes};
use super::job::JobNews;
use super::message::DocumentReply;
use super::owner::Document;
use super::source::file_name;
use super::{Cancel, Change, Loader, Source};
use crate::edit::{AddTake, AddTakes, Edit};
use crate::text::sentence;
use dragonfly_runtime::{Job, JobContext};
use std::path::PathBuf;
use std::time::Instant;

/// News of the job.
#[derive(Debug)]
pub(super) enum ClipNews {
    /// The number of files that were read, and of all.
    Progress(usize, usize),
    /// The takes of all files.
    Done(ImportedClips),
    /// The job failed.
    Failed(String),
}

/// The takes of several files.
#[derive(Debug, Default)]
pub(super) struct ImportedClips {
    takes: Vec<AddTake>,
    files: usize,
    /// Number of files whose skeleton is not that of the model.
    retargeted: usize,
    /// Names of moved bones that no bone of the model follows.
    unmatched: Vec<String>,
    /// The files that could not be imported, and why.
    failed: Vec<String>,
}

impl ImportedClips {
    fn add(&mut self, done: ClipTakes) {
        self.files += 1;
        self.retargeted += usize::from(!done.is_copied);
        self.takes.extend(done.takes);
        for name in done.unmatched {
            if !self.unmatched.contains(&name) {
                self.unmatched.push(name);
            }
        }
    }

    /// Returns a sentence about what was imported.
    fn summary(&self) -> String {
        let takes = match &*self.takes {
            [take] => format!("Added {}", take.name),
            takes => format!("Added {} takes of {} files", takes.len(), self.files),
        };
        let retargeted = match self.retargeted {
            0 => String::new(),
            count if count == self.files => ", retargeted".to_owned(),
            count => format!(", {count} of the files retargeted"),
        };
        let unmatched = match &*self.unmatched {
            [] => String::new(),
            [name] => format!("; no bone follows {name}"),
            [first, more @ ..] => format!("; no bone follows {first} and {} more", more.len()),
        };
        format!("{takes}{retargeted}{unmatched}")
    }
}

/// Reads the files one after the other. One that cannot be imported does not stop the others.
fn imported(
    files: &[PathBuf],
    adapter: &ModelAdapter,
    load: Loader,
    cancel: &Cancel,
    progress: &mut dyn FnMut(usize),
) -> ImportedClips {
    let (mut result, mut names) = (ImportedClips::default(), TakeNames::of(adapter));
    let settings = ClipSettings::default();
    for (index, path) in files.iter().enumerate() {
        if cancel.is_cancelled() {
            break;
        }
        progress(index);
        let title = file_name(path);
        let done = load(&Source::File(path.clone()), &mut |_| {}, cancel)
            .map_err(|error| error.to_string())
            .and_then(|opened| {
                let animation = &opened.loaded.model.animation;
                if animation.takes.is_empty() {
                    return Err(format!("{title}: the file has no takes"));
                }
                clip_takes(&title, animation, &|_, _| true, adapter.skeleton(), &mut names, &settings)
                    .map_err(|reason| format!("{title}: {reason}"))
            });
        match done {
            Ok(done) => result.add(done),
            Err(reason) => result.failed.push(reason),
        }
    }
    result
}

impl Document {
    /// Imports the takes of files onto the open model, in a job.
    pub(super) fn import_takes(&mut self, files: Vec<PathBuf>) {
        let Some(open) = &self.open else {
            return self.reply(DocumentReply::Refused("Open a model first".to_owned()));
        };
        let (adapter, load) = (open.edited.adapter().clone(), self.load);
        let count = files.len();
        let work = move |job: &JobContext<JobNews>| {
            let mut progress = |read: usize| {
                job.report(read as f32 / count.max(1) as f32, |_| {
                    JobNews::Clips(ClipNews::Progress(read, count))
                });
            };
            let done = imported(&files, &adapter, load, job.cancel_flag(), &mut progress);
            JobNews::Clips(match job.is_cancelled() {
                true => ClipNews::Failed("the import was cancelled".to_owned()),
                false => ClipNews::Done(done),
            })
        };
        let failed = |panic: &str| JobNews::Clips(ClipNews::Failed(format!("the importer failed: {panic}")));
        match Job::start(&self.own, "import takes", work, failed) {
            Ok(job) => self.clip_import = Some(job),
            Err(error) => self.reply(DocumentReply::Warning(error.to_string())),
        }
    }

    /// Cancels the import of takes. Returns whether one was running.
    pub(super) fn cancel_import(&mut self) -> bool {
        self.clip_import.take().is_some()
    }

    /// Handles news of the job. News of a cancelled one are ignored.
    pub(super) fn clip_news(&mut self, news: ClipNews, now: Instant) {
        if self.clip_import.is_none() {
            return;
        }
        match news {
            ClipNews::Progress(read, all) => {
                self.reply(DocumentReply::Notice(format!("Importing takes: {read} of {all} files")));
            }
            ClipNews::Failed(reason) => {
                self.clip_import = None;
                self.reply(DocumentReply::Refused(sentence(&reason)));
            }
            ClipNews::Done(done) => {
                self.clip_import = None;
                let summary = done.summary();
                if !done.takes.is_empty() {
                    let edit = Edit::AddTakes(AddTakes { takes: done.takes });
                    self.change(Change::Edit(edit, None), None, now);
                }
                match &*done.failed {
                    [] => self.reply(DocumentReply::Notice(summary)),
                    [reason] => self.reply(DocumentReply::Warning(reason.clone())),
                    [first, more @ ..] => {
                        let text = format!("{first}; and {} more files were not imported", more.len());
                        self.reply(DocumentReply::Warning(text));
                    }
                }
            }
        }
    }
}
