//! The takes that a job imports from several files, and its news.

use super::adapter::ModelAdapter;
use super::clip_order::ClipOrder;
use super::clips::{ClipSettings, ClipTakes, TakeNames, clip_takes};
use super::source::file_name;
use super::{Cancel, Loader, Source};
use crate::edit::AddTake;
use dragonfly_anim::data::ModelData;
use dragonfly_anim::retarget::FigureOptions;

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
    pub(super) takes: Vec<AddTake>,
    files: usize,
    /// Number of files whose skeleton is not that of the model.
    retargeted: usize,
    /// Names of moved bones that no bone of the model follows.
    unmatched: Vec<String>,
    /// The files that could not be imported, and why.
    pub(super) failed: Vec<String>,
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
    pub(super) fn summary(&self) -> String {
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
            [] => return format!("{takes}{retargeted}"),
            [name] => format!("; no bone follows {name}"),
            [first, more @ ..] => format!("; no bone follows {first} and {} more", more.len()),
        };
        format!("{takes}{retargeted}{unmatched}. The map of bones can be corrected in “Retarget from file…”")
    }
}

/// Reads the files one after the other, for the model `target` with the takes of `adapter`. One that cannot be imported does not stop the others.
pub(super) fn imported(
    order: &ClipOrder,
    adapter: &ModelAdapter,
    target: &ModelData,
    load: Loader,
    cancel: &Cancel,
    progress: &mut dyn FnMut(usize),
) -> ImportedClips {
    let (mut result, mut names) = (ImportedClips::default(), TakeNames::of(adapter));
    let figure = FigureOptions { contacts: order.contacts, ..FigureOptions::default() };
    let settings = ClipSettings { map: order.map.clone(), figure, ..ClipSettings::default() };
    for (index, path) in order.files.iter().enumerate() {
        if cancel.is_cancelled() {
            break;
        }
        progress(index);
        let title = file_name(path);
        let done = load(&Source::File(path.clone()), &mut |_| {}, cancel)
            .map_err(|error| error.to_string())
            .and_then(|opened| {
                let clip = &opened.loaded.model;
                if clip.animation.takes.is_empty() {
                    return Err(format!("{title}: the file has no takes"));
                }
                clip_takes(&title, clip, &|_, _| true, target, &mut names, &settings)
                    .map_err(|reason| format!("{title}: {reason}"))
            });
        match done {
            Ok(done) => result.add(done),
            Err(reason) => result.failed.push(reason),
        }
    }
    result
}
