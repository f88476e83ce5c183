//! Collects everything that a project, or the script of a scene, needs into one archive, and unpacks it again.

use super::adapter::{TextFile, TextFiles};
use super::archive::{ArchiveError, ArchivedFile, read_archive, write_archive};
use super::import::{self, ImportDoor};
use super::scene_includes::read_includes;
use super::source::{LoadError, file_name};
use super::text_source::{ReadTexts, is_project, read_texts};
use super::{Cancel, FileAccessError, Folder, make_folder, read_file};
use dragonfly_anim::format::{AssetError, AssetFs, Conventions};
use dragonfly_anim::limits::FILE_BYTES;
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::{ScriptContext, ScriptElement, StageScript};
use dragonfly_store::{ExpectedFile, RealFiles, SaveOptions, save};
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// The reason why a project cannot be packed or unpacked.
#[derive(Debug, Error)]
pub enum PackError {
    /// The project cannot be read.
    #[error(transparent)]
    Project(#[from] LoadError),
    /// Files that it names are missing or cannot be read, a line each.
    #[error("{}", .0.join("\n"))]
    Files(Vec<String>),
    /// The archive cannot be read or written.
    #[error("{title}: {reason}")]
    Archive {
        /// Name of the archive.
        title: String,
        /// The reason.
        reason: ArchiveError,
    },
    /// The archive's file cannot be read.
    #[error("{}: {reason}", path.display())]
    Read {
        /// Its path.
        path: PathBuf,
        /// The reason.
        reason: FileAccessError,
    },
    /// A file cannot be written.
    #[error("{0}")]
    Write(String),
}

/// Returns an archive with the project or script at `path` and every file that it needs: scripts, lines, edits, models with the files that
/// they need themselves, sounds. All names are relative to the folder of `path`.
///
/// # Errors
///
/// It cannot be read, has errors, names files that are missing or outside of its folder, or is too large to be unpacked again.
pub fn pack(path: &Path, cancel: &Cancel) -> Result<Vec<u8>, PackError> {
    let title = file_name(path);
    let read = read_texts(path)?;
    let unread = |reason| LoadError::File { path: path.to_owned(), reason };
    let folder = Folder::of(path).map_err(unread)?;
    let mut needed = NeededFiles { folder: &folder, cancel, names: BTreeSet::new(), reasons: Vec::new() };
    needed.of_texts(&read, is_project(path));
    if cancel.is_cancelled() {
        return Err(LoadError::Cancelled.into());
    }
    let NeededFiles { names, mut reasons, .. } = needed;
    let mut files: Vec<ArchivedFile> = Vec::new();
    for file in read.texts.list() {
        files.push(ArchivedFile { name: file.name.to_string(), bytes: file.text.as_bytes().to_vec() });
    }
    for name in names {
        if files.iter().any(|file| file.name == name) {
            continue;
        }
        match folder.read(&name, FILE_BYTES) {
            Ok(bytes) => files.push(ArchivedFile { name, bytes }),
            Err(reason) => reasons.push(format!("{name}: {reason}")),
        }
    }
    if !reasons.is_empty() {
        return Err(PackError::Files(reasons));
    }
    write_archive(&files).map_err(|reason| PackError::Archive { title, reason })
}

/// Unpacks the archive at `path` into `folder`, which is created. Returns the paths of the files. No file is overwritten.
///
/// # Errors
///
/// The archive cannot be read or is refused, a file exists already or cannot be written. Files that were written before stay.
pub fn unpack(path: &Path, folder: &Path) -> Result<Vec<PathBuf>, PackError> {
    let bytes = read_file(path, FILE_BYTES);
    let bytes = bytes.map_err(|reason| PackError::Read { path: path.to_owned(), reason })?;
    let title = file_name(path);
    let files = read_archive(&bytes).map_err(|reason| PackError::Archive { title, reason })?;
    let paths: Vec<PathBuf> = files.iter().map(|file| folder.join(&file.name)).collect();
    // Nothing is written if one of them is there.
    if let Some(there) = paths.iter().find(|path| path.exists()) {
        return Err(PackError::Write(format!("{}: this file exists already", there.display())));
    }
    for (file, path) in files.iter().zip(&paths) {
        make_folder(path).map_err(PackError::Write)?;
        let options = SaveOptions { expected: ExpectedFile::Nothing, versions: None };
        save(&RealFiles, path, &file.bytes, &options).map_err(|error| PackError::Write(error.to_string()))?;
    }
    Ok(paths)
}

/// The files that a project needs, while they are found.
struct NeededFiles<'a> {
    folder: &'a Folder,
    cancel: &'a Cancel,
    names: BTreeSet<String>,
    reasons: Vec<String>,
}

impl NeededFiles<'_> {
    fn of_texts(&mut self, read: &ReadTexts, is_project: bool) {
        self.reasons.extend(read.warnings.iter().cloned());
        let Some((main, scripts)) = read.texts.list().split_first() else { return };
        if !is_project {
            return self.of_script(main, &read.texts, None);
        }
        match StageProject::read(main.text.clone()) {
            Ok(project) => {
                let own: Vec<String> = project.files().into_iter().map(str::to_owned).collect();
                for model in project.tree().elements().iter().filter_map(|element| model_of(element)) {
                    self.of_model(project.source_of(model));
                }
                self.names.extend(own);
                for file in scripts.iter().filter(|file| project.scripts().any(|name| *name == *file.name)) {
                    self.of_script(file, &read.texts, Some(&project));
                }
            }
            Err(errors) => self.reasons.extend(errors.iter().map(|error| error.in_file(&main.name))),
        }
    }

    fn of_script(&mut self, file: &TextFile, texts: &TextFiles, project: Option<&StageProject>) {
        let TextFile { name, text } = file;
        let files = read_includes((name, text), texts, Ok(self.folder), self.cancel);
        let context = ScriptContext { name: name.clone(), project: project.cloned(), files };
        match StageScript::read_in(text.clone(), &context) {
            Ok(script) => {
                self.names.extend(script.tree().included_files().into_iter().map(str::to_owned));
                for element in script.tree().elements() {
                    if let Some(model) = element.value("model") {
                        self.of_model(project.map_or(model, |project| project.source_of(model)));
                    }
                    if let Some(source) = element.value("src").filter(|_| element.row.name != "include") {
                        self.names.insert(source.to_owned());
                    }
                }
            }
            Err(errors) => self.reasons.extend(errors.iter().map(|error| error.in_file(name))),
        }
    }

    /// Adds a model and the files that it needs.
    fn of_model(&mut self, name: &str) {
        if !self.names.insert(name.to_owned()) {
            return;
        }
        let inside = name.rsplit_once('/').map_or("", |(folder, _)| folder);
        let found = self.folder.path_of(name).and_then(|path| {
            let bytes = self.folder.read(name, FILE_BYTES)?;
            Ok((Folder::of(&path)?, path, bytes))
        });
        // A missing model is found when it is packed.
        let Ok((beside, path, bytes)) = found else { return };
        let door = RecordingDoor { folder: beside, names: RefCell::default() };
        let files = ImportDoor { files: &door, conventions: Conventions::default() };
        if let Err(error) = import::read(&file_name(&path), &bytes, files, &|_| {}, self.cancel) {
            self.reasons.push(format!("{name}: {error}"));
        }
        let below = |own: String| if inside.is_empty() { own } else { format!("{inside}/{own}") };
        self.names.extend(door.names.into_inner().into_iter().map(below));
    }
}

/// Returns the model that an element of a project names by its file or its id, or is.
fn model_of(element: &ScriptElement) -> Option<&str> {
    match element.row.name {
        "model" => element.value("src"),
        _ => element.value("model"),
    }
}

/// The folder of a model, which notes the names of the files that were read.
struct RecordingDoor {
    folder: Folder,
    names: RefCell<BTreeSet<String>>,
}

impl AssetFs for RecordingDoor {
    fn read(&self, name: &str, limit: u64) -> Result<Vec<u8>, AssetError> {
        let bytes = self.folder.read(name, limit)?;
        self.names.borrow_mut().insert(name.to_owned());
        Ok(bytes)
    }
}
