//! The files that the script of a scene includes: read in a job, and again when another program changes them.

use super::adapter::TextFiles;
use super::beside::{BesideStamps, ReadOnce};
use super::job::JobNews;
use super::text_source::text_of;
use super::{Cancel, Folder};
use dragonfly_anim::format::AssetFs;
use dragonfly_anim::stage::script::{IncludedScripts, MOST_BYTES, MOST_ERRORS, MissingScript};
use dragonfly_runtime::{Address, Job};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
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

/// What a job has read.
#[derive(Debug)]
pub(super) struct SceneIncludeNews {
    mark: IncludeMark,
    /// The reason why there is nothing, if the job failed.
    read: Result<ReadIncludes, String>,
}

/// Files by their names, and the same with their elements.
#[derive(Debug)]
struct ReadIncludes {
    read: BTreeMap<String, ReadInclude>,
    files: IncludedScripts,
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
    cancel: &Cancel,
) -> IncludedScripts {
    let mut reader = folder.map(|folder| IncludeReader::new(folder, cancel));
    IncludedScripts::default().collected(name, text, |file| match (texts.called(file), &mut reader) {
        (Some(known), _) => Ok(Arc::clone(&known.text)),
        (None, Ok(reader)) => reader.read(file).text,
        (None, Err(reason)) => Err(missing(reason.clone())),
    })
}

fn missing(reason: String) -> MissingScript {
    MissingScript { reason: format!("cannot be read: {reason}"), beside: Vec::new() }
}

/// Reads files of a folder until it is cancelled, or too many are missing for a user to look at.
struct IncludeReader<'a> {
    folder: &'a Folder,
    cancel: &'a Cancel,
    /// The scripts in the folders of missing files, by the folder.
    beside: BTreeMap<Box<str>, Vec<String>>,
    /// Number of files that are missing.
    missing: usize,
}

impl<'a> IncludeReader<'a> {
    fn new(folder: &'a Folder, cancel: &'a Cancel) -> Self {
        Self { folder, cancel, beside: BTreeMap::new(), missing: 0 }
    }

    fn read(&mut self, file: &str) -> ReadInclude {
        let reason = match self.cancel.is_cancelled() {
            true => Some("was not read"),
            false => (self.missing >= MOST_ERRORS).then_some("was not read, because many others are missing"),
        };
        if let Some(reason) = reason {
            return ReadInclude { text: Err(reason.into()), stamps: BesideStamps::default(), is_old: false };
        }
        let door = ReadOnce::inside(self.folder.clone());
        let read = door.read(file, MOST_BYTES as u64).map_err(|error| error.to_string());
        let text = read.and_then(text_of).map_err(|reason| {
            self.missing += 1;
            MissingScript { beside: self.names_beside(file), ..missing(reason) }
        });
        ReadInclude { text, stamps: door.stamps(), is_old: false }
    }

    /// Returns names that may be meant by that of a missing file. Each folder is listed once.
    fn names_beside(&mut self, file: &str) -> Vec<String> {
        let inside = file.rsplit_once('/').map_or("", |(folder, _)| folder);
        let list = || self.folder.names_in(inside, "xml", MOST_SUGGESTED);
        self.beside.entry(inside.into()).or_insert_with(list).clone()
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
        let mut named = BTreeSet::new();
        let files = self.files.collected(name, text, |file| {
            if let Some(known) = texts.called(file) {
                return Ok(Arc::clone(&known.text));
            }
            named.insert(file.to_owned());
            let read = self.read.get(file);
            if read.is_none_or(|read| read.is_old) {
                wanted.replace(true);
            }
            read.map_or_else(|| Err("is being read".into()), |read| read.text.clone())
        });
        self.files = files;
        // Files that are not included any more need not be looked at again.
        self.read.retain(|file, _| named.contains(file));
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
                    files: self.files.clone(),
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
            Ok(ReadIncludes { read, files }) => (self.read, self.files) = (read, files),
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
    /// Files whose elements are known.
    files: IncludedScripts,
}

impl ReadOrder {
    fn start(self, document: &Address<JobNews>, mark: IncludeMark) -> std::io::Result<Job> {
        let other = Arc::clone(&mark);
        Job::start(
            document,
            "includes",
            move |job| {
                let mut read = self.known;
                let mut reader = IncludeReader::new(&self.folder, job.cancel_flag());
                let files = self.files.collected(&self.name, &self.text, |file| {
                    if let Some(known) = self.texts.called(file) {
                        return Ok(Arc::clone(&known.text));
                    }
                    let found = read.entry(file.to_owned()).or_insert_with(|| reader.read(file));
                    found.text.clone()
                });
                let read = Ok(ReadIncludes { read, files });
                JobNews::SceneIncludes(Box::new(SceneIncludeNews { mark, read }))
            },
            move |panic| {
                let read = Err(format!("the reader failed: {panic}"));
                let news = SceneIncludeNews { mark: Arc::clone(&other), read };
                JobNews::SceneIncludes(Box::new(news))
            },
        )
    }
}
