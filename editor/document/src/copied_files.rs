//! Files next to a document that it needs, and that a save into another folder copies there.

use super::editable::make_folder;
use super::folder::{FileAccessError, open_file};
use super::{Cancel, Folder};
use dragonfly_anim::limits::FILE_BYTES;
use dragonfly_store::{ExpectedFile, RealFiles, SaveOptions, SaveOutcome, save};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Number of bytes of two files that are compared at once.
const COMPARED: usize = 64 << 10;

/// Number of files that cannot be copied of which a notice names each.
const NAMED: usize = 5;

/// Files of a folder that another folder gets under the same names. Their bytes are read when each is written, so that one is in memory at a time.
#[derive(Debug, Default)]
pub struct CopiedFiles {
    /// The folder that has them; `None` without files.
    from: Option<Folder>,
    /// The name of each in that folder, and the path of its copy.
    files: Vec<(String, PathBuf)>,
    /// Files that cannot be copied, a sentence each.
    missing: Vec<String>,
}

impl CopiedFiles {
    /// Finds which of the files `names` of `from` the folder `to` lacks. Those that cannot be read are left out, with a notice.
    ///
    /// # Errors
    ///
    /// The path of a file that exists in `to` and is another one; or it was cancelled.
    pub(super) fn find(
        from: Folder,
        to: &Path,
        names: impl IntoIterator<Item = String>,
        cancel: &Cancel,
    ) -> Result<Self, String> {
        let (mut files, mut missing) = (Vec::new(), Vec::new());
        for name in names {
            if cancel.is_cancelled() {
                return Err("the save was cancelled".to_owned());
            }
            let opened = from.open(&name).and_then(sized);
            let target = to.join(&name);
            match opened {
                Ok((file, size)) if is_same(&file, size, &target) => {}
                Ok(_) if target.symlink_metadata().is_ok() => return Err(other_file(&target)),
                Ok(_) => files.push((name, target)),
                Err(reason) => missing.push(format!("{name} {reason}; it was not copied")),
            }
        }
        Ok(Self { from: Some(from), files, missing })
    }

    /// Adds reasons why the document may need more files, a sentence each.
    pub(super) fn add_missing(&mut self, reasons: Vec<String>) {
        self.missing.extend(reasons);
    }

    /// Returns sentences for the user about files that are not copied, the first few.
    pub fn notices(&self) -> impl Iterator<Item = String> + '_ {
        let more = self.missing.len().saturating_sub(NAMED);
        let more = (more > 0).then(|| format!("{more} more files were not copied"));
        self.missing.iter().take(NAMED).cloned().chain(more)
    }

    /// Returns the paths of the copies.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.files.iter().map(|(_, path)| &**path)
    }

    /// Writes the copies, one after the other. `written` gets the path of each, its size in bytes, and what was saved.
    ///
    /// # Errors
    ///
    /// The path and the reason. Those before it were written. A file that is there by now is not overwritten.
    pub fn write(
        &self,
        cancel: &Cancel,
        mut written: impl FnMut(&Path, usize, SaveOutcome),
    ) -> Result<(), String> {
        let Some(from) = &self.from else { return Ok(()) };
        for (name, path) in &self.files {
            if cancel.is_cancelled() {
                return Err("the save was cancelled".to_owned());
            }
            let bytes = from.read(name, FILE_BYTES).map_err(|reason| format!("{name} {reason}"))?;
            make_folder(path)?;
            let options = SaveOptions { expected: ExpectedFile::Nothing, versions: None };
            let saved = save(&RealFiles, path, &bytes, &options).map_err(|error| error.to_string())?;
            written(path, bytes.len(), saved);
        }
        Ok(())
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
