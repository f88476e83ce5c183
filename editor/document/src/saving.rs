//! Saving what is open, and what is to come after.

use super::open::Open;
use super::writing::{Overwrite, SaveFailure, Writing};
use super::{FileView, Source, formats};
use dragonfly_store::{Autosave, FileState, RealFiles};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// Where to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SaveTo {
    /// Its own file.
    Own,
    /// Another file, which is its own from then on.
    As(PathBuf),
    /// Another file; its own stays what it is.
    Copy(PathBuf),
}

/// What is to happen once nothing unsaved stands in the way.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Then {
    /// The program ends.
    Quit,
    /// Another model is opened.
    Open(Source),
}

/// What a person wants saved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SaveOrder {
    /// Where to.
    pub to: SaveTo,
    /// Even if another file is there, or somebody else changed it: the person was asked.
    pub anyway: bool,
    /// What comes after.
    pub then: Option<Then>,
}

impl SaveOrder {
    /// Saves where it was saved before.
    pub fn own(then: Option<Then>) -> Self {
        Self { to: SaveTo::Own, anyway: false, then }
    }
}

/// What was saved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SavedFile {
    /// Where.
    pub path: PathBuf,
    /// Bytes of the file.
    pub bytes: usize,
    /// Files that were written beside it.
    pub beside: usize,
    /// A copy: what is open is as unsaved as before.
    pub copy: bool,
    /// What could not be kept of the old file.
    pub notices: Vec<String>,
    /// What comes after.
    pub then: Option<Then>,
}

/// Why nothing was saved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NotSaved {
    /// It never was: the person says where.
    NoFile,
    /// Somebody else changed the file.
    Changed,
    /// Another file is there.
    Exists(PathBuf),
    /// Anything else, with place and reason.
    Failed(String),
}

impl From<SaveFailure> for NotSaved {
    fn from(failure: SaveFailure) -> Self {
        match failure {
            SaveFailure::Changed(_) => Self::Changed,
            SaveFailure::Exists(path) => Self::Exists(path),
            other @ SaveFailure::Other(_) => Self::Failed(other.to_string()),
        }
    }
}

impl Open {
    /// What a save would write, a line each.
    pub(super) fn plan(&self) -> Result<String, String> {
        let editable = self.editable.as_ref().map_err(|reason| self.unsavable(reason))?;
        editable.plan(self.edited.adapter()).map(|plan| plan.to_string()).map_err(|error| error.to_string())
    }

    fn unsavable(&self, reason: &str) -> String {
        format!("{} cannot be saved: {reason}", self.file.title)
    }

    /// Saves. The journal knows of it, and keeps the history.
    pub(super) fn save(
        &mut self,
        order: &SaveOrder,
        autosave: Option<&Autosave>,
        now: Instant,
    ) -> Result<SavedFile, NotSaved> {
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
        let plan =
            editable.plan(self.edited.adapter()).map_err(|error| NotSaved::Failed(error.to_string()))?;
        if own {
            // What the history begins with will not be in the file any more.
            self.snapshot(true, now);
        }
        let overwrite = match &order.to {
            SaveTo::Own if order.anyway => Overwrite::Anything,
            SaveTo::Own => Overwrite::AsRead,
            // Whoever chose its own name again in a dialog did not hear that somebody else changed it.
            _ if own => Overwrite::AsRead,
            _ if order.anyway => Overwrite::Anything,
            _ => Overwrite::Nothing,
        };
        let journal = if own { self.keeper.journal() } else { None };
        let how = Writing { overwrite, journal, versions: autosave.map(Autosave::versions), becomes: !copy };
        let Ok(editable) = &mut self.editable else { return Err(NotSaved::NoFile) };
        let saved = editable.save_with(self.edited.adapter(), &plan, &output, how)?;
        if !copy {
            self.edited.mark_saved();
            if self.base.is_none() {
                self.base = Some(self.loaded.model.animation.takes.clone().into());
            }
            if !own {
                self.move_to(&output, autosave, now);
            }
            self.look();
        }
        let beside = saved.files.len().saturating_sub(1);
        let (bytes, notices, then) = (saved.bytes, saved.notices, order.then.clone());
        Ok(SavedFile { path: output, bytes, beside, copy, notices, then })
    }

    /// It is the document of the file at `path` from now on; so is its journal.
    fn move_to(&mut self, path: &Path, autosave: Option<&Autosave>, now: Instant) {
        let title = super::load::file_name(path);
        self.file = Arc::new(FileView { title, path: Some(path.to_path_buf()) });
        self.about = super::recorded::About::new(None);
        let Some(autosave) = autosave else { return };
        let stamp = self.stamp();
        match autosave.begin_beside(Some(path), stamp.as_ref()) {
            Ok(journal) => {
                let old = self.keeper.set(journal);
                self.snapshot(true, now);
                if let (Some(journal), Some(stamp)) = (self.keeper.journal(), stamp)
                    && let Err(error) = journal.saved(&stamp)
                {
                    tracing::warn!("{error}");
                }
                // Its work is in a file now.
                if let Some(Err(error)) = old.map(|old| autosave.put_away(old)) {
                    tracing::warn!("{error}");
                }
            }
            Err(error) => self.keeper.never(&error),
        }
    }

    /// Did somebody else change the file? `None` when it is as it was, or cannot be asked.
    pub(super) fn changed_on_disk(&self) -> Option<FileState> {
        let (path, stamp) = (self.file.path.as_deref()?, self.stamp()?);
        stamp.state(&RealFiles, path).ok().filter(|state| *state != FileState::Same)
    }
}

/// Does a name not say that the file is of another format than that with this `ending`?
///
/// # Errors
///
/// Why it should not be called so.
pub fn fits(path: &Path, ending: &str) -> Result<(), String> {
    let own = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    if own.eq_ignore_ascii_case(ending) || !formats().is_model_extension(own) {
        return Ok(());
    }
    Err(format!(
        "{}: the file is a .{ending} and stays one, since every byte that was not edited is kept; give it that ending",
        path.display()
    ))
}

/// `path` with the ending of the format, which is added where there is none.
fn with_ending(path: &Path, ending: &str) -> Result<PathBuf, String> {
    if path.file_name().is_none() {
        return Err(format!("{}: is no name of a file", path.display()));
    }
    fits(path, ending)?;
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
    fn a_name_without_an_ending_gets_one_and_another_format_is_refused() {
        let ending = |path: &str| with_ending(Path::new(path), "glb").map(|path| path.display().to_string());
        assert_eq!(ending("a/fox"), Ok("a/fox.glb".to_owned()));
        assert_eq!(ending("a/fox.GLB"), Ok("a/fox.GLB".to_owned()));
        assert_eq!(ending("a/fox.v2"), Ok("a/fox.v2.glb".to_owned()));
        assert!(ending("a/fox.gltf").is_err_and(|reason| reason.contains("stays one")));
        assert!(ending("/").is_err());
    }
}
