//! The files that the script of a scene includes: read in a job, and again when another program changes them.

use super::Folder;
use super::adapter::TextFiles;
use super::beside::{BesideStamps, ReadOnce};
use super::job::JobNews;
use super::text_source::text_of;
use dragonfly_anim::format::AssetFs;
use dragonfly_anim::stage::script::{IncludedScripts, MOST_BYTES, MissingScript};
use dragonfly_runtime::{Address, Job};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Number of names of scripts that are suggested in place of a missing one.
const MOST_SUGGESTED: usize = 100;

/// Distinguishes a job from those before.
type IncludeMark = Arc<()>;

/// A file that was read, or is missing.
#[derive(Clone, Debug)]
struct ReadInclude {
    text: Result<Arc<str>, MissingScript>,
    /// Its state.
    stamps: BesideStamps,
    /// Whether it is read again; what it had counts until then.
    is_old: bool,
}

/// The files that a job has read, by their names.
#[derive(Debug)]
pub(super) struct SceneIncludeNews {
    mark: IncludeMark,
    /// The reason why there is nothing, if the job failed.
    read: Result<BTreeMap<String, ReadInclude>, String>,
}

/// The files that the script of a scene includes.
#[derive(Default)]
pub(super) struct SceneIncludes {
    files: IncludedScripts,
    read: BTreeMap<String, ReadInclude>,
    job: Option<(IncludeMark, Job)>,
}

/// Reads the files that a script called `name` includes, directly or through others: those of `texts` are known already.
pub(super) fn read_includes(
    (name, text): (&str, &str),
    texts: &TextFiles,
    folder: Result<&Folder, String>,
) -> IncludedScripts {
    IncludedScripts::default().collected(name, text, |file| match texts.called(file) {
        Some(known) => Ok(Arc::clone(&known.text)),
        None => folder
            .clone()
            .map_or_else(|reason| Err(missing(reason)), |folder| ReadInclude::of(folder, file).text),
    })
}

fn missing(reason: String) -> MissingScript {
    MissingScript { reason: format!("cannot be read: {reason}"), beside: Vec::new() }
}

impl ReadInclude {
    fn of(folder: &Folder, file: &str) -> Self {
        let door = ReadOnce::inside(folder.clone());
        let read = door.read(file, MOST_BYTES as u64).map_err(|error| error.to_string());
        let text = read.and_then(text_of).map_err(|reason| {
            let beside = folder.names_beside(file, "xml", MOST_SUGGESTED);
            MissingScript { beside, ..missing(reason) }
        });
        Self { text, stamps: door.stamps(), is_old: false }
    }
}

impl SceneIncludes {
    /// Returns the files as far as they were read.
    pub(super) fn files(&self) -> &IncludedScripts {
        &self.files
    }

    /// Follows a script called `name`, and starts to read files that it includes and that were not read before.
    pub(super) fn update(
        &mut self,
        (name, text): (&Arc<str>, &Arc<str>),
        texts: &TextFiles,
        folder: Result<&Folder, String>,
        document: &Address<JobNews>,
    ) {
        let wanted = RefCell::new(false);
        let files = self.files.collected(name, text, |file| {
            if let Some(known) = texts.called(file) {
                return Ok(Arc::clone(&known.text));
            }
            let read = self.read.get(file);
            if read.is_none_or(|read| read.is_old) {
                wanted.replace(true);
            }
            read.map_or_else(|| Err("is being read".into()), |read| read.text.clone())
        });
        self.files = files;
        if !wanted.into_inner() {
            // A job that still runs reads what is not included any more.
            self.job = None;
            return;
        }
        if self.job.is_some() {
            return;
        }
        let mark = IncludeMark::default();
        let known: BTreeMap<String, ReadInclude> = self
            .read
            .iter()
            .filter(|(_, read)| !read.is_old)
            .map(|(file, read)| (file.clone(), read.clone()))
            .collect();
        let started = match folder {
            Ok(folder) => {
                let order = ReadOrder {
                    name: Arc::clone(name),
                    text: Arc::clone(text),
                    texts: texts.clone(),
                    folder: folder.clone(),
                    known,
                };
                order.start(document, Arc::clone(&mark)).map_err(|error| error.to_string())
            }
            Err(reason) => Err(reason),
        };
        match started {
            Ok(job) => self.job = Some((mark, job)),
            Err(reason) => self.give_up(&reason),
        }
    }

    /// Reports every file that is still to be read as missing.
    fn give_up(&mut self, reason: &str) {
        let unread: Vec<String> = self.files.missing().map(|(file, _)| file.to_owned()).collect();
        for file in unread {
            let text = Err(missing(reason.to_owned()));
            self.read.entry(file).or_insert(ReadInclude {
                text,
                stamps: BesideStamps::default(),
                is_old: false,
            });
        }
        self.read.values_mut().for_each(|read| read.is_old = false);
    }

    /// Takes what a job has read. Returns whether it was the newest one.
    pub(super) fn take(&mut self, news: SceneIncludeNews) -> bool {
        if self.job.take_if(|(mark, _)| Arc::ptr_eq(mark, &news.mark)).is_none() {
            return false;
        }
        match news.read {
            Ok(read) => self.read = read,
            Err(reason) => self.give_up(&reason),
        }
        true
    }

    /// Has those read again that are missing, because they may be there now, and those that another program changed. Returns whether there are any.
    pub(super) fn look_again(&mut self) -> bool {
        let mut any = false;
        for read in self.read.values_mut() {
            read.is_old |= read.text.is_err() || read.stamps.changed().is_some();
            any |= read.is_old;
        }
        any
    }

    /// Has all read again: the folder is another one.
    pub(super) fn forget(&mut self) {
        (self.read, self.job) = (BTreeMap::new(), None);
    }
}

/// Everything that a job needs.
struct ReadOrder {
    name: Arc<str>,
    text: Arc<str>,
    texts: TextFiles,
    folder: Folder,
    /// The files that need not be read again.
    known: BTreeMap<String, ReadInclude>,
}

impl ReadOrder {
    fn start(self, document: &Address<JobNews>, mark: IncludeMark) -> std::io::Result<Job> {
        let other = Arc::clone(&mark);
        Job::start(
            document,
            "includes",
            move |job| {
                let mut read = self.known;
                let _files = IncludedScripts::default().collected(&self.name, &self.text, |file| {
                    if let Some(known) = self.texts.called(file) {
                        return Ok(Arc::clone(&known.text));
                    }
                    if job.cancel_flag().is_cancelled() {
                        return Err("was not read".into());
                    }
                    let found =
                        read.entry(file.to_owned()).or_insert_with(|| ReadInclude::of(&self.folder, file));
                    found.text.clone()
                });
                JobNews::SceneIncludes(Box::new(SceneIncludeNews { mark, read: Ok(read) }))
            },
            move |panic| {
                let read = Err(format!("the reader failed: {panic}"));
                let news = SceneIncludeNews { mark: Arc::clone(&other), read };
                JobNews::SceneIncludes(Box::new(news))
            },
        )
    }
}
