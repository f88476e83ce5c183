//! Collects everything that a project, or the script of a scene, needs into one archive, and unpacks it again.

use super::archive::{ArchiveError, ArchivedFile, read_archive, write_archive};
use super::needed_files::NeededFiles;
use super::source::{LoadError, file_name};
use super::text_source::{is_project, read_texts};
use super::{Cancel, FileAccessError, Folder, make_folder, read_file};
use dragonfly_anim::limits::FILE_BYTES;
use dragonfly_store::{ExpectedFile, RealFiles, SaveOptions, save};
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
    let needed = NeededFiles::of(&read.texts, is_project(path), &folder, cancel, &|_| {});
    if cancel.is_cancelled() {
        return Err(LoadError::Cancelled.into());
    }
    let mut reasons = read.warnings;
    reasons.extend(needed.reasons);
    let mut files: Vec<ArchivedFile> = Vec::new();
    for file in read.texts.list() {
        files.push(ArchivedFile { name: file.name.to_string(), bytes: file.text.as_bytes().to_vec() });
    }
    for name in needed.names {
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
