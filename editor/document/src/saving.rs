//! Saving the open document.

use super::copied_files::EarlierCopies;
use super::fault::FaultInjection;
use super::open::Open;
use super::recorded::EditsOrigin;
use super::save_job::{FailedWrite, PreparedSave, SaveInput, SaveTarget, WrittenSave};
use super::waiting_scene::WaitingScene;
use super::writing::{Overwrite, SaveFailure};
use super::{Editable, FileView, Source, formats};
use dragonfly_store::{Autosave, FileState, Journal, JournalError, RealFiles};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// The file that a save writes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SaveTo {
    /// The file of the document.
    Own,
    /// Another file, which becomes the file of the document.
    As(PathBuf),
    /// Another file; the document keeps its file.
    Copy(PathBuf),
}

/// The action that follows once nothing is unsaved.
#[derive(Clone, Debug, PartialEq)]
pub enum Then {
    /// End the program.
    Quit,
    /// Open another model.
    Open(Source),
}

/// A request to save.
#[derive(Clone, Debug, PartialEq)]
pub struct SaveOrder {
    /// The file to write.
    pub to: SaveTo,
    /// Overwrites another file, or changes of another program: the user has decided.
    pub anyway: bool,
    /// Replaces the whole file where the format needs it, see [`Format::is_rewritten`](dragonfly_anim::format::Format::is_rewritten): the user has decided.
    pub rewrite: bool,
    /// Files that exist where the document has new ones of these names, and that are replaced: the user has decided.
    pub replaces: Vec<PathBuf>,
    /// The action that follows.
    pub then: Option<Then>,
}

impl SaveOrder {
    /// Saves to the file of the document.
    pub fn own(then: Option<Then>) -> Self {
        Self { to: SaveTo::Own, anyway: false, rewrite: false, replaces: Vec::new(), then }
    }
}

/// A completed save.
#[derive(Clone, Debug, PartialEq)]
pub struct SavedFile {
    /// The file.
    pub path: PathBuf,
    /// Size of the file in bytes.
    pub bytes: usize,
    /// Number of other files that were written next to it.
    pub beside: usize,
    /// Whether it is a copy: the document is as unsaved as before.
    pub copy: bool,
    /// Files that were not copied, attributes of the old file that were lost, and content of the model that the format does not store, one sentence each. Later saves
    /// of the same file do not repeat the latter.
    pub notices: Vec<String>,
    /// The action that follows.
    pub then: Option<Then>,
}

/// The reason why nothing was saved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NotSaved {
    /// The document has no file yet: the user chooses one.
    NoFile,
    /// Another program changed this file: the one of the document, or one next to it that belongs to the document.
    Changed(PathBuf),
    /// A file of this name exists already.
    Exists(PathBuf),
    /// The whole file would be replaced, and lose what the program does not read: the user decides.
    Rewritten,
    /// The user stopped it. Contains the files in another folder that were written before and stay: mostly those of an earlier copy, which were
    /// replaced.
    Cancelled(Vec<PathBuf>),
    /// Any other failure, with path and reason.
    Failed(String),
}

/// A save that failed.
#[derive(Debug)]
pub(super) struct FailedSave {
    pub(super) reason: NotSaved,
    /// The file of the document, where some of its files were written before.
    pub(super) partly: Option<Box<Editable>>,
    /// The files in other folders that this save and earlier ones wrote; `None` where it wrote none.
    pub(super) copies: Option<EarlierCopies>,
}

impl From<NotSaved> for FailedSave {
    fn from(reason: NotSaved) -> Self {
        Self { reason, partly: None, copies: None }
    }
}

impl From<FailedWrite> for FailedSave {
    fn from(FailedWrite { reason, partly, copies }: FailedWrite) -> Self {
        Self { reason: reason.into(), partly, copies: Some(copies) }
    }
}

impl From<SaveFailure> for NotSaved {
    fn from(failure: SaveFailure) -> Self {
        match failure {
            SaveFailure::Changed(path) => Self::Changed(path),
            SaveFailure::Exists(path) => Self::Exists(path),
            SaveFailure::Cancelled(stay) => Self::Cancelled(stay),
            other @ SaveFailure::Other(_) => Self::Failed(other.to_string()),
        }
    }
}

impl Open {
    /// Returns what a save would change, one line each.
    pub(super) fn plan(&self) -> Result<String, String> {
        let editable = self.editable.as_ref().map_err(|reason| self.unsavable(reason))?;
        editable.plan(self.edited.adapter()).map(|plan| plan.to_string()).map_err(|error| error.to_string())
    }

    fn unsavable(&self, reason: &str) -> String {
        format!("{} cannot be saved: {reason}", self.file.title)
    }

    /// Begins a save of the present state, which [`prepare`](super::save_job::prepare) continues. `of_scene` is the scene that waits while
    /// this model of it is edited: it plays the file, so that the model keeps it.
    pub(super) fn begin_save(
        &mut self,
        order: &SaveOrder,
        of_scene: Option<&WaitingScene>,
        autosave: Option<&Autosave>,
        faults: FaultInjection,
        now: Instant,
    ) -> Result<SaveInput, NotSaved> {
        let unsavable = self.editable.as_ref().err().map(|reason| self.unsavable(reason));
        let Ok(editable) = &self.editable else {
            return Err(NotSaved::Failed(unsavable.unwrap_or_default()));
        };
        let copy = matches!(order.to, SaveTo::Copy(_));
        let output = match &order.to {
            SaveTo::Own => self.file.path.clone().ok_or(NotSaved::NoFile)?,
            SaveTo::As(path) | SaveTo::Copy(path) => {
                with_ending(path, &editable.ending()).map_err(NotSaved::Failed)?
            }
        };
        let own = self.file.path.is_some() && editable.is_own(&output);
        if own && copy {
            return Err(NotSaved::Failed("A copy of a file cannot be the file itself".to_owned()));
        }
        let target = match (own, copy) {
            (_, true) => SaveTarget::Copy,
            (true, false) => SaveTarget::Own,
            (false, false) => SaveTarget::Other,
        };
        if let (SaveTarget::Other, Some(scene)) = (target, of_scene)
            && self.file.path.as_deref() == Some(&*scene.model.path)
        {
            return Err(NotSaved::Failed(format!(
                "{} is edited for {}, which plays this file; save a copy instead",
                self.file.title, scene.open.file.title
            )));
        }
        let is_whole = editable.format().is_some_and(|format| format.is_rewritten());
        let is_decided = self.is_rewritten || order.rewrite;
        // A copy replaces nothing.
        if is_whole && !copy && !is_decided && !editable.is_unedited(self.edited.adapter()) {
            return Err(NotSaved::Rewritten);
        }
        let overwrite = match &order.to {
            SaveTo::Own if order.anyway => Overwrite::Anything,
            SaveTo::Own => Overwrite::AsRead,
            // The dialog does not report that another program changed the file, so a user who chose the same name is
            // still asked.
            _ if own => Overwrite::AsRead,
            _ if order.anyway => Overwrite::Anything,
            _ => Overwrite::Nothing,
        };
        let mut input =
            self.begin_saving(output, target, overwrite, autosave, faults, now).map_err(NotSaved::Failed)?;
        input.replaces.clone_from(&order.replaces);
        input.creates_folders = matches!(order.to, SaveTo::As(_) | SaveTo::Copy(_));
        Ok(input)
    }

    /// Begins a save of the present state as `output`. Old versions of the file are kept in `autosave`.
    ///
    /// # Errors
    ///
    /// The reason why the model cannot be saved.
    pub(super) fn begin_saving(
        &mut self,
        output: PathBuf,
        target: SaveTarget,
        overwrite: Overwrite,
        autosave: Option<&Autosave>,
        faults: FaultInjection,
        now: Instant,
    ) -> Result<SaveInput, String> {
        let editable = self.editable.as_ref().map_err(|reason| self.unsavable(reason))?.clone();
        let successor = if target == SaveTarget::Copy {
            None
        } else {
            self.edited.begin_save();
            // Created during the save, it would have neither the takes of the old file nor the record of the save.
            if self.journal_writer.lacks_steps() {
                self.snapshot(false, now);
            }
            self.journal_writer.begin_save(now)
        };
        Ok(SaveInput {
            editable,
            edited: self.edited.clone(),
            base: self.base(),
            about: self.about.clone(),
            output,
            overwrite,
            replaces: Vec::new(),
            target,
            creates_folders: false,
            autosave: autosave.cloned(),
            // The file will no longer have the takes with which the history starts.
            successor: successor.filter(|_| target == SaveTarget::Own),
            faults,
        })
    }

    /// Records that the prepared file is about to be written.
    pub(super) fn record_saving(&mut self, prepared: &mut PreparedSave, now: Instant) {
        if prepared.target() == SaveTarget::Own {
            let new = prepared.take_journal();
            self.journal_writer.record_saving(new, prepared.main_file(), now);
        }
    }

    /// Ends a save that failed. `partly` is the file of the document, where some of its files were written before, and `copies` are the files
    /// in other folders that were.
    pub(super) fn save_failed(&mut self, partly: Option<Box<Editable>>, copies: Option<EarlierCopies>) {
        self.edited.end_save(false);
        self.journal_writer.end_save(None);
        if let Some(editable) = partly {
            self.editable = Ok(*editable);
        }
        if let (Ok(editable), Some(copies)) = (&mut self.editable, copies) {
            editable.copies = copies;
        }
    }

    /// Ends a save: what was written is the file of the document, unless it is a copy.
    pub(super) fn end_save(
        &mut self,
        written: WrittenSave,
        autosave: Option<&Autosave>,
        now: Instant,
    ) -> SavedFile {
        let WrittenSave { editable, saved, lost, path, target, journal } = written;
        let copy = target == SaveTarget::Copy;
        let mut notices = saved.notices;
        let is_known = |text: &&String| target == SaveTarget::Own && self.lost.contains(text);
        notices.extend(lost.iter().filter(|text| !is_known(text)).cloned());
        if !copy {
            self.edited.end_save(true);
        } else if let Ok(own) = &mut self.editable {
            own.copies = editable.copies.clone();
        }
        if !copy {
            self.lost = lost;
            let stamp = editable.stamp().copied();
            self.base = Some(self.base());
            self.editable = Ok(editable);
            match target {
                SaveTarget::Other => self.move_to(&path, journal, autosave, now),
                SaveTarget::Own | SaveTarget::Copy => {
                    self.journal_writer.end_save(stamp.as_ref());
                    self.journal_writer.file_is(Some(path.clone()), stamp);
                }
            }
            self.look();
        }
        let beside = saved.files.iter().filter(|file| **file != path).count();
        SavedFile { path, bytes: saved.bytes, beside, copy, notices, then: None }
    }

    /// Makes `path` the file of the document, and `journal` its journal.
    fn move_to(
        &mut self,
        path: &Path,
        journal: Option<Result<Journal, JournalError>>,
        autosave: Option<&Autosave>,
        now: Instant,
    ) {
        let title = super::source::file_name(path);
        if let Some(scene) = &mut self.scene {
            scene.move_to(path);
        }
        let ending = self.editable.as_ref().map_or_else(|_| String::new(), Editable::ending);
        self.file = Arc::new(FileView { title, path: Some(path.to_path_buf()), ending });
        self.about = EditsOrigin::new(None, self.about.conventions());
        let (Some(autosave), Some(journal)) = (autosave, journal) else {
            return self.journal_writer.end_save(None);
        };
        let file = (Some(path.to_path_buf()), self.stamp());
        // The edits of the old journal are in a file now.
        let old = self.journal_writer.move_to(file, journal, &self.about, now);
        if let Some(Err(error)) = old.map(|old| autosave.discard_own(old)) {
            tracing::warn!("{error}");
        }
    }

    /// Returns how another program changed the file; `None` where it is unchanged or cannot be checked.
    pub(super) fn changed_on_disk(&self) -> Option<FileState> {
        let (path, stamp) = (self.file.path.as_deref()?, self.stamp()?);
        let state = stamp.state(&RealFiles, path).ok().filter(|state| *state != FileState::Same);
        state.or_else(|| self.editable.as_ref().ok()?.changed_beside().map(|(_, state)| state))
    }
}

/// Checks that a name does not have the extension of another format than `ending`.
///
/// # Errors
///
/// The reason why the name is wrong.
pub fn check_extension(path: &Path, ending: &str) -> Result<(), String> {
    let own = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    if own.eq_ignore_ascii_case(ending) || !formats().is_model_extension(own) {
        return Ok(());
    }
    Err(format!(
        "{}: the format of the file stays .{ending}, because all bytes that were not edited are kept; use that extension",
        path.display()
    ))
}

/// Returns `path` with the extension of the format, which is added where it is missing.
fn with_ending(path: &Path, ending: &str) -> Result<PathBuf, String> {
    // One with a separator at its end is a folder.
    let is_folder = path.to_string_lossy().ends_with(std::path::is_separator);
    if is_folder || path.file_name().is_none() {
        return Err(format!("{}: this is not a file name", path.display()));
    }
    check_extension(path, ending)?;
    match path.extension() {
        Some(other) if other.eq_ignore_ascii_case(ending) => Ok(path.to_path_buf()),
        _ => {
            let mut name = path.as_os_str().to_owned();
            name.push(".");
            name.push(ending);
            Ok(name.into())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_without_an_extension_gets_one_and_another_format_is_refused() {
        let ending = |path: &str| with_ending(Path::new(path), "glb").map(|path| path.display().to_string());
        assert_eq!(ending("a/fox"), Ok("a/fox.glb".to_owned()));
        assert_eq!(ending("a/fox.GLB"), Ok("a/fox.GLB".to_owned()));
        assert_eq!(ending("a/fox.v2"), Ok("a/fox.v2.glb".to_owned()));
        assert!(ending("a/fox.gltf").is_err_and(|reason| reason.contains("stays .glb")));
        assert!(ending("/").is_err() && ending("a/").is_err());
    }
}
