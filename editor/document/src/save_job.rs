//! The work of a save that takes long. It runs in two jobs, so that the document can be edited while a large file is written:
//!
//! 1. [`prepare`] computes the bytes of the file, and writes a journal with a snapshot of the history.
//! 2. The document switches to that journal, with the edits made since, and records that the file is about to be written.
//! 3. [`PreparedSave::write`] writes the file.
//! 4. The document records the end. Edits made since the beginning are unsaved.

use super::Cancel;
use super::copied_files::EarlierCopies;
use super::editable::Editable;
use super::fault::{FaultInjection, FaultPoint};
use super::history::Edited;
use super::new_folders::{NewFolders, ensure_folder, missing_folders};
use super::recorded::{EditsOrigin, Snapshot};
use super::save_files::SaveFiles;
use super::writing::{FilesSaved, Overwrite, SaveFailure, Writing};
use dragonfly_anim::data::Take;
use dragonfly_anim::format::ChangeReport;
use dragonfly_store::{
    Autosave, FileContents, Journal, JournalError, RealFiles, Successor, SuccessorJournal, folder_of,
};
use std::path::PathBuf;
use std::sync::Arc;

/// The role of the written file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SaveTarget {
    /// It replaces the file of the document.
    Own,
    /// It becomes the file of the document.
    Other,
    /// The document keeps its file.
    Copy,
}

/// The state of the document when a save began, and what is to be written.
#[derive(Debug)]
pub(super) struct SaveInput {
    pub(super) editable: Editable,
    pub(super) edited: Edited,
    /// The takes with which the history starts.
    pub(super) base: Arc<[Arc<Take>]>,
    pub(super) about: EditsOrigin,
    pub(super) output: PathBuf,
    pub(super) overwrite: Overwrite,
    /// Files that are replaced whatever they contain.
    pub(super) replaces: Vec<PathBuf>,
    pub(super) target: SaveTarget,
    /// Whether folders of `output` that do not exist are created: the user typed the path.
    pub(super) creates_folders: bool,
    pub(super) autosave: Option<Autosave>,
    /// The successor of the document's journal.
    pub(super) successor: Option<Successor>,
    pub(super) faults: FaultInjection,
}

/// A save whose bytes are computed and not yet written.
#[derive(Debug)]
pub(super) struct PreparedSave {
    input: SaveInput,
    files: SaveFiles,
    changes: Option<ChangeReport>,
    /// Content of the model that the format does not store, one sentence each.
    lost: Vec<String>,
    /// Contents of the main file; `None` where it stays as it is.
    main: Option<FileContents>,
    journal: Option<Result<SuccessorJournal, JournalError>>,
}

/// A save that failed while its files were written.
#[derive(Debug)]
pub(super) struct FailedWrite {
    pub(super) reason: SaveFailure,
    /// The file of the document with the files that were written before; `None` where they are files of a copy.
    pub(super) partly: Option<Box<Editable>>,
    /// The files in other folders that this save and earlier ones wrote.
    pub(super) copies: EarlierCopies,
}

/// A save that has succeeded.
#[derive(Debug)]
pub(super) struct WrittenSave {
    /// The file as it is now.
    pub(super) editable: Editable,
    pub(super) saved: FilesSaved,
    /// Content of the model that the format does not store, one sentence each.
    pub(super) lost: Vec<String>,
    pub(super) path: PathBuf,
    pub(super) target: SaveTarget,
    /// The journal of another file that becomes the file of the document, where work is recorded.
    pub(super) journal: Option<Result<Journal, JournalError>>,
}

/// Computes the files that a save writes, and writes the successor of the journal. `progress` is called with the fraction of the models of a scene
/// that were read to know which files they need.
///
/// # Errors
/// The reason why it cannot be saved, or it was cancelled. Nothing was written.
pub(super) fn prepare(
    mut input: SaveInput,
    cancel: &Cancel,
    progress: &dyn Fn(f32),
) -> Result<PreparedSave, String> {
    input.faults.reach(FaultPoint::PrepareSave);
    let plan = input.editable.plan(input.edited.adapter()).map_err(|error| error.to_string())?;
    match input.creates_folders {
        true => missing_folders(folder_of(&input.output)).map(drop)?,
        // A mistyped name makes no folder.
        false => ensure_folder(&input.output)?,
    }
    let files = input.editable.files(&plan, &input.output, cancel, progress)?;
    let bytes = files.written.last().map_or(&[][..], |(_, bytes)| bytes);
    let is_main_written = !input.editable.keeps_main(&input.output, bytes, input.overwrite);
    let main = FileContents { size: bytes.len() as u64, hash: dragonfly_store::hash(bytes) };
    let main = Some(main).filter(|_| is_main_written);
    let journal = match input.successor.take() {
        Some(successor) => {
            let snapshot = input.snapshot()?;
            Some(successor.write(&snapshot, input.edited.is_saved()))
        }
        None => None,
    };
    let lost = plan.lost.iter().map(ToString::to_string).collect();
    Ok(PreparedSave { input, files, changes: plan.changes, lost, main, journal })
}

impl SaveInput {
    /// Returns whether the files that a scene needs are copied along, which may take long.
    pub(super) fn copies_along(&self) -> bool {
        self.editable.format().is_none() && self.editable.is_elsewhere(&self.output)
    }

    /// Returns the whole history as bytes for a journal.
    fn snapshot(&self) -> Result<Vec<u8>, String> {
        Snapshot::bytes(self.about.clone(), &self.edited, Some(&*self.base))
            .map_err(|error| format!("the history cannot be written as JSON: {error}"))
    }

    /// Begins the journal of a file that has just been written and becomes the file of the document.
    fn begin_journal(&mut self) -> Option<Result<Journal, JournalError>> {
        let autosave = self.autosave.as_ref()?;
        let stamp = self.editable.stamp().copied();
        self.edited.end_save(true);
        self.about = EditsOrigin::new(None, self.about.conventions());
        let snapshot = self.snapshot().inspect_err(|reason| tracing::error!("{reason}")).ok()?;
        let journal = autosave.begin_another(Some(&self.output), stamp.as_ref()).and_then(|mut journal| {
            journal.compact_as(&snapshot, true)?;
            Ok(journal)
        });
        Some(journal)
    }
}

impl PreparedSave {
    /// Returns whether the files that a scene needs are copied along.
    pub(super) fn copies_along(&self) -> bool {
        self.input.copies_along()
    }

    pub(super) fn target(&self) -> SaveTarget {
        self.input.target
    }

    /// Returns the changes of the file; `None` where the whole file is written.
    pub(super) fn changes(&self) -> Option<&ChangeReport> {
        self.changes.as_ref()
    }

    /// Returns the content of the model that the format does not store, one sentence each.
    pub(super) fn lost(&self) -> &[String] {
        &self.lost
    }

    /// Returns the contents that the main file gets; `None` where it stays as it is.
    pub(super) fn main_file(&self) -> Option<FileContents> {
        self.main
    }

    /// Takes the successor of the journal.
    pub(super) fn take_journal(&mut self) -> Option<Result<SuccessorJournal, JournalError>> {
        self.journal.take()
    }

    /// Writes the files. `progress` is called with the fraction of the copies that were made.
    ///
    /// # Errors
    /// The reason why it was not saved, and what was written before.
    pub(super) fn write(self, cancel: &Cancel, progress: &dyn Fn(f32)) -> Result<WrittenSave, FailedWrite> {
        let Self { mut input, files, lost, .. } = self;
        input.faults.reach(FaultPoint::WriteSave);
        let faults = input.faults.clone();
        let copied = |files: usize, done: f32| {
            progress(done);
            faults.reach(FaultPoint::CopiedFile(files));
        };
        let target = input.target;
        let versions = input.autosave.as_ref().map(Autosave::versions);
        let becomes = target != SaveTarget::Copy;
        let is_elsewhere = files.is_elsewhere;
        let how = Writing {
            disk: &RealFiles,
            overwrite: input.overwrite,
            replaces: &input.replaces,
            versions,
            becomes,
            is_elsewhere,
            copied: &copied,
        };
        let folders = match input.creates_folders {
            true => NewFolders::create(folder_of(&input.output)),
            false => Ok(NewFolders::default()),
        };
        let folders = match folders {
            Ok(folders) => folders,
            Err(reason) => {
                let copies = input.editable.copies.clone();
                return Err(FailedWrite { reason: reason.into(), partly: None, copies });
            }
        };
        let saved = match input.editable.write(input.edited.adapter(), files, how, cancel) {
            Ok(saved) => saved,
            Err(reason) => {
                folders.remove();
                let copies = input.editable.copies.clone();
                let partly = (target == SaveTarget::Own).then(|| Box::new(input.editable));
                return Err(FailedWrite { reason, partly, copies });
            }
        };
        let journal = if target == SaveTarget::Other { input.begin_journal() } else { None };
        Ok(WrittenSave { editable: input.editable, saved, lost, path: input.output, target, journal })
    }
}
