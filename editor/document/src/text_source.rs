//! Reads the texts of a document: the script of a scene, or a project with its scripts and its file of lines.

use super::adapter::{TextFile, TextFiles};
use super::beside::stamp_of;
use super::beside::{BesideStamps, ReadOnce};
use super::source::{LoadError, file_name};
use super::{FileAccessError, read_file};
use dragonfly_anim::format::AssetFs;
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::{MOST_BYTES, ScriptError, ScriptTree};
use dragonfly_store::{FileStamp, RealFiles};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Texts as they were read.
#[derive(Debug)]
pub(super) struct ReadTexts {
    /// The main file.
    pub(super) path: PathBuf,
    /// The texts, that of the main file first.
    pub(super) texts: TextFiles,
    /// The state of the main file.
    pub(super) stamp: Option<FileStamp>,
    /// The states of the other files.
    pub(super) beside: BesideStamps,
    /// Files that could not be read, one sentence each.
    pub(super) warnings: Vec<String>,
}

/// Returns whether a file is a script by its name.
pub fn is_script(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("xml"))
}

/// Returns whether a file is a script of a scene or a project by its name.
pub fn is_scene(path: &Path) -> bool {
    is_script(path) || is_project(path)
}

/// Returns whether a file is a project by its name.
pub fn is_project(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("meproj"))
}

/// Returns whether a file contains a script or a project that can be read.
pub(super) fn contains_scene(path: &Path) -> bool {
    let Ok(bytes) = read_file(path, MOST_BYTES as u64) else { return false };
    text_of(bytes)
        .is_ok_and(|text| ScriptTree::read(Arc::clone(&text)).is_ok() || StageProject::read(text).is_ok())
}

/// Reads the texts of the document at `path`.
///
/// # Errors
///
/// A file cannot be read, is no UTF-8 text, is too large, or changed while it was read.
pub(super) fn read_texts(path: &Path) -> Result<ReadTexts, LoadError> {
    let (text, stamp) = read_stamped(path)?;
    let name = file_name(path).into();
    let mut read = ReadTexts {
        path: path.to_owned(),
        texts: TextFiles::default(),
        stamp,
        beside: BesideStamps::default(),
        warnings: Vec::new(),
    };
    let mut files = vec![TextFile { name, text: Arc::clone(&text) }];
    // A project with errors is opened without its files: its text is there to be corrected.
    if is_project(path)
        && let Ok(project) = StageProject::read(text)
    {
        read.files_of(&project, &mut files)?;
    }
    read.texts = files.into_iter().collect();
    Ok(read)
}

impl ReadTexts {
    /// Reads the scripts, the lines and the edits of models of a project.
    fn files_of(&mut self, project: &StageProject, files: &mut Vec<TextFile>) -> Result<(), LoadError> {
        let failed = |reason| LoadError::File { path: self.path.clone(), reason };
        let door = ReadOnce::of(&self.path).map_err(failed)?;
        let edits = project.elements_called("edits").filter_map(|edits| edits.value("src"));
        for name in project.scripts().chain(project.lines()).chain(edits) {
            if files.iter().any(|file| &*file.name == name) {
                continue;
            }
            let read = door.read(name, MOST_BYTES as u64).map_err(|error| error.to_string());
            match read.and_then(text_of) {
                Ok(text) => files.push(TextFile { name: name.into(), text }),
                Err(reason) => self.warnings.push(format!("{name}: {reason}")),
            }
        }
        self.beside = door.stamps();
        Ok(())
    }
}

/// Reads the main text, with the state of its file.
fn read_stamped(path: &Path) -> Result<(Arc<str>, Option<FileStamp>), LoadError> {
    let failed = |reason: FileAccessError| LoadError::File { path: path.to_owned(), reason };
    let wrong = |reason: String| LoadError::Format { title: file_name(path), reason };
    let before = FileStamp::before(&RealFiles, path).ok();
    let bytes = read_file(path, MOST_BYTES as u64).map_err(failed)?;
    let stamp = stamp_of(Some(path).zip(before.as_ref()), &bytes).map_err(wrong)?;
    Ok((text_of(bytes).map_err(wrong)?, stamp))
}

/// Returns the first script of a project that is among `texts`, or else the script that is alone.
pub(super) fn first_script<'a>(project: Option<&StageProject>, texts: &'a TextFiles) -> Option<&'a TextFile> {
    match project {
        Some(project) => project.scripts().find_map(|name| texts.called(name)),
        None => texts.list().first(),
    }
}

/// Returns the bytes as text; the place and the reason where they are none.
pub(super) fn text_of(bytes: Vec<u8>) -> Result<Arc<str>, String> {
    let text = String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let before = String::from_utf8_lossy(error.as_bytes());
        ScriptError::at(&before, at..at, "this is not UTF-8 text", "save the file as UTF-8").to_string()
    })?;
    Ok(text.into())
}
