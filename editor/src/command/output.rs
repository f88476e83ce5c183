//! Output of results: to stdout, or to a file that is written completely or not at all.

use super::Failure;
use dragonfly_store::{ExpectedFile, FileSaveError, RealFiles, SaveOptions};
use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Runs `write` on a buffered stdout; a closed pipe is no error.
pub(super) fn print(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
    let mut stdout = BufWriter::new(io::stdout().lock());
    write(&mut stdout).and_then(|()| stdout.flush()).map_err(|error| stdout_failure(&error))
}

/// Writes `value` to stdout as one JSON document and a line end.
pub(super) fn print_json(value: &impl serde::Serialize) -> Result<(), Failure> {
    print(|out| {
        serde_json::to_writer(&mut *out, value)?;
        out.write_all(b"\n")
    })
}

fn stdout_failure(error: &io::Error) -> Failure {
    if error.kind() == io::ErrorKind::BrokenPipe {
        Failure::OutputClosed
    } else {
        Failure::Machine(format!("standard output: {error}"))
    }
}

/// Writes `bytes` to the file at `path`, or to stdout for `-`.
///
/// An existing file is replaced atomically, so that a full disk or a crash leaves the old one intact. A link is
/// followed, and a file that is not regular (a device, a pipe) is written to directly.
pub(super) fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    if path == Path::new("-") {
        return print(|out| out.write_all(bytes));
    }
    let special = fs::metadata(path).is_ok_and(|metadata| !metadata.is_file());
    if !special {
        let saved =
            dragonfly_store::replace(path, bytes).map_err(|error| Failure::Input(error.to_string()))?;
        for notice in saved.notices {
            tracing::warn!("{}: {notice}", path.display());
        }
        return Ok(());
    }
    match write_through(path, bytes) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Err(Failure::OutputClosed),
        Err(error) => Err(Failure::input(path.display(), format_args!("cannot be written: {error}"))),
        Ok(()) => Ok(()),
    }
}

fn write_through(target: &Path, bytes: &[u8]) -> io::Result<()> {
    if target.is_dir() {
        return Err(io::Error::from(io::ErrorKind::IsADirectory));
    }
    fs::OpenOptions::new().write(true).open(target)?.write_all(bytes)
}

/// Writes `bytes` to a new file `stem.extension` in `folder`; if a different file has that name, to
/// `stem-2.extension` and so on. A file that already contains the same bytes is left unchanged.
pub(super) fn write_new(
    folder: &Path,
    stem: &str,
    extension: &str,
    bytes: &[u8],
) -> Result<PathBuf, Failure> {
    for number in 1..1000 {
        let name =
            if number == 1 { format!("{stem}.{extension}") } else { format!("{stem}-{number}.{extension}") };
        let path = folder.join(name);
        let options = SaveOptions { expected: ExpectedFile::Nothing, ..SaveOptions::default() };
        match dragonfly_store::save(&RealFiles, &path, bytes, &options) {
            Ok(_) => return Ok(path),
            // A folder counts as a different file.
            Err(FileSaveError::Exists { .. } | FileSaveError::NotRegular { .. }) => {
                let same = dragonfly_document::read_file(&path, bytes.len() as u64)
                    .is_ok_and(|existing| existing == bytes);
                if same {
                    return Ok(path);
                }
            }
            Err(error) => return Err(Failure::Input(error.to_string())),
        }
    }
    Err(Failure::input(folder.display(), format_args!("already contains a thousand files called {stem}")))
}
