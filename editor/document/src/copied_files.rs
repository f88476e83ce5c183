//! Files next to a document that it needs, and that a save into another folder copies there.

use super::beside::BesideStamps;
use super::editable::is_same_path;
use super::folder::{FileAccessError, open_file};
use super::new_folders::make_folder;
use super::{Cancel, Folder};
use dragonfly_anim::limits::FILE_BYTES;
use dragonfly_store::{ExpectedFile, FileStamp, RealFiles, SaveOptions, SaveOutcome, Versions, save};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Number of bytes of two files that are compared at once.
const COMPARED: usize = 64 << 10;

/// Number of files that cannot be copied, and of errors, of which a notice names each.
const NAMED: usize = 5;

/// The reason why a save that was cancelled ends.
pub(super) const CANCELLED: &str = "the save was cancelled";

/// Files that copies of the document wrote into other folders, each next to the main file that they belong to. Only a later copy under the same name
/// replaces them.
#[derive(Clone, Debug, Default)]
pub(super) struct EarlierCopies {
    /// The main file of the stamps.
    main: Option<PathBuf>,
    stamps: BesideStamps,
}

impl EarlierCopies {
    /// Returns the stamps of the files that belong to a main file; `None` where another one, or none, was written last.
    pub(super) fn of(&self, main: &Path) -> Option<&BesideStamps> {
        self.main.as_deref().is_some_and(|own| is_same_path(own, main)).then_some(&self.stamps)
    }

    /// Notes a file that was written for a main file. Those of another one are forgotten.
    pub(super) fn add(&mut self, main: &Path, path: PathBuf, stamp: FileStamp) {
        if self.of(main).is_none() {
            *self = Self { main: Some(main.to_path_buf()), stamps: BesideStamps::default() };
        }
        self.stamps.add(path, stamp);
    }

    /// Forgets all of them: they are files of the document now.
    pub(super) fn forget(&mut self) {
        *self = Self::default();
    }
}

/// Files of a folder that another folder gets under the same names. Their bytes are read when each is written, so that one is in memory at a time.
#[derive(Debug, Default)]
pub struct CopiedFiles {
    /// The folder that has them; `None` without files.
    from: Option<Folder>,
    files: Vec<FileCopy>,
    /// The paths at which the other folder has the same files already.
    present: Vec<PathBuf>,
    /// Files that cannot be copied, a sentence each.
    missing: Vec<String>,
    /// Errors because of which files that are needed may not be known, a sentence each.
    errors: Vec<String>,
}

/// A file that is copied.
#[derive(Debug)]
struct FileCopy {
    /// Its name in the folder that has it.
    name: String,
    /// The path of the copy.
    path: PathBuf,
    /// Its size in bytes when it was found.
    size: u64,
    /// The stamp of an earlier copy, which this one replaces.
    replaced: Option<FileStamp>,
}

impl CopiedFiles {
    /// Finds which of the files `names` of `from` the folder `to` lacks. Those that cannot be read are left out, with a notice. `earlier` are
    /// copies that the document wrote before, which are replaced unless they changed since.
    ///
    /// # Errors
    ///
    /// The path of a file that exists in `to` and is another one, or would be written outside of `to` through links; or it was cancelled.
    pub(super) fn find(
        from: Folder,
        to: &Path,
        names: impl IntoIterator<Item = String>,
        earlier: &BesideStamps,
        cancel: &Cancel,
    ) -> Result<Self, String> {
        let (mut files, mut present, mut missing) = (Vec::new(), Vec::new(), Vec::new());
        for name in names {
            if cancel.is_cancelled() {
                return Err(CANCELLED.to_owned());
            }
            let opened = from.open(&name).and_then(sized);
            let target = to.join(&name);
            if opened.is_ok() {
                ensure_inside(to, &target)?;
            }
            match opened {
                Ok((file, size)) if is_same(&file, size, &target) => present.push(target),
                Ok((_, size)) => {
                    let replaced = earlier.unchanged(&target).copied();
                    if replaced.is_none() && target.symlink_metadata().is_ok() {
                        return Err(other_file(&target));
                    }
                    files.push(FileCopy { name, path: target, size, replaced });
                }
                Err(reason) => missing.push(format!("{name} {reason}; it was not copied")),
            }
        }
        Ok(Self { from: Some(from), files, present, missing, errors: Vec::new() })
    }

    /// Adds a sentence about files that cannot be copied.
    pub(super) fn add_missing(&mut self, reason: String) {
        self.missing.push(reason);
    }

    /// Adds errors because of which the document may need more files, a sentence each.
    pub(super) fn add_errors(&mut self, errors: Vec<String>) {
        self.errors.extend(errors);
    }

    /// Returns sentences for the user: the first few files that are not copied and the number of the others, then the same of the errors.
    pub fn notices(&self) -> impl Iterator<Item = String> + '_ {
        let more = |list: &[String]| list.len().saturating_sub(NAMED);
        let files = match more(&self.missing) {
            0 => None,
            1 => Some("one more file was not copied".to_owned()),
            more => Some(format!("{more} more files were not copied")),
        };
        let errors = match (self.errors.len(), more(&self.errors)) {
            (0, _) => None,
            (_, 0) => Some("files that are needed may not be known because of these errors".to_owned()),
            (_, 1) => {
                Some("files that are needed may not be known because of these errors and one more".to_owned())
            }
            (_, more) => Some(format!(
                "files that are needed may not be known because of these errors and {more} more"
            )),
        };
        let missing = self.missing.iter().take(NAMED).cloned().chain(files);
        missing.chain(self.errors.iter().take(NAMED).cloned()).chain(errors)
    }

    /// Returns the paths of the copies.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.files.iter().map(|file| &*file.path)
    }

    /// Returns the number of bytes that are copied.
    pub(super) fn bytes(&self) -> u64 {
        self.files.iter().map(|file| file.size).sum()
    }

    /// Returns the paths at which the other folder has the same files already.
    pub(super) fn present(&self) -> impl Iterator<Item = &Path> {
        self.present.iter().map(|path| &**path)
    }

    /// Writes the copies, one after the other. `written` gets the path of each, its size in bytes, and what was saved.
    ///
    /// # Errors
    ///
    /// The path and the reason. Those before it were written, each as a whole. A file that is there by now is not overwritten.
    pub fn write(
        &self,
        versions: Option<&Versions>,
        cancel: &Cancel,
        mut written: impl FnMut(&Path, usize, SaveOutcome),
    ) -> Result<(), String> {
        let Some(from) = &self.from else { return Ok(()) };
        for FileCopy { name, path, replaced, .. } in &self.files {
            if cancel.is_cancelled() {
                return Err(CANCELLED.to_owned());
            }
            let bytes = from.read(name, FILE_BYTES).map_err(|reason| format!("{name} {reason}"))?;
            make_folder(path)?;
            let expected = replaced.as_ref().map_or(ExpectedFile::Nothing, ExpectedFile::Stamp);
            let versions = versions.filter(|_| replaced.is_some());
            let saved = save(&RealFiles, path, &bytes, &SaveOptions { expected, versions })
                .map_err(|error| error.to_string())?;
            written(path, bytes.len(), saved);
        }
        Ok(())
    }
}

/// Checks that a file below the folder `to` is not written outside of it through links.
///
/// # Errors
///
/// The path and the reason.
pub(super) fn ensure_inside(to: &Path, target: &Path) -> Result<(), String> {
    // A folder that does not exist yet has no links.
    let Ok(root) = to.canonicalize() else { return Ok(()) };
    // The file, or else the deepest folder that exists; those below it are created.
    let there = target.ancestors().find_map(|path| path.canonicalize().ok());
    match there.is_some_and(|there| there.starts_with(&root)) {
        true => Ok(()),
        false => Err(format!("{}: a link leads out of the folder; choose another folder", target.display())),
    }
}

/// Returns the reason why a file is not copied to a path at which there is another one.
pub(super) fn other_file(path: &Path) -> String {
    let path = path.display();
    format!("{path}: a file of this name exists and is not the one that is needed; choose another folder")
}

/// Returns a file with its size, if it can be copied.
fn sized(file: File) -> Result<(File, u64), FileAccessError> {
    match file.metadata()?.len() {
        size if size > FILE_BYTES => Err(FileAccessError::TooLarge { size, limit: FILE_BYTES }),
        size => Ok((file, size)),
    }
}

/// Returns whether there is a file at `path` with the same bytes as `file`, which has `length` of them.
pub(super) fn is_same(file: impl Read, length: u64, path: &Path) -> bool {
    let Ok(there) = open_file(path) else { return false };
    let is_as_long = there.metadata().is_ok_and(|data| data.len() == length);
    is_as_long && have_same_bytes(file, there).unwrap_or(false)
}

fn have_same_bytes(mut one: impl Read, mut other: impl Read) -> std::io::Result<bool> {
    let [mut a, mut b] = [vec![0; COMPARED], vec![0; COMPARED]];
    loop {
        let [read, also] = [filled(&mut one, &mut a)?, filled(&mut other, &mut b)?];
        if a[..read] != b[..also] {
            return Ok(false);
        }
        if read == 0 {
            return Ok(true);
        }
    }
}

/// Reads until the buffer is full or the file ends. Returns the number of bytes.
fn filled(file: &mut impl Read, buffer: &mut [u8]) -> std::io::Result<usize> {
    let mut read = 0;
    while read < buffer.len() {
        match file.read(&mut buffer[read..]) {
            Ok(0) => break,
            Ok(bytes) => read += bytes,
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(read)
}
