//! Where results go: stdout, or a file that is either whole or not there.

use super::Failure;
use dragonfly_store::{Expected, RealFiles, SaveError, SaveOptions};
use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Writes to stdout whatever `write` writes; a closed pipe ends quietly.
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
        Failure::NobodyListens
    } else {
        Failure::Machine(format!("standard output: {error}"))
    }
}

/// Puts `bytes` into the file at `path`, or on stdout for `-`.
///
/// A file of that name is replaced in one step, so that a full disk or a crash leaves the old one whole. A link is
/// followed, and what is no regular file (a device, a pipe) is written to as it is.
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
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Err(Failure::NobodyListens),
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

/// Puts `bytes` into a new file `stem.extension` in `folder`; when that name is taken by something else, into
/// `stem-2.extension` and so on. A file that already holds the same bytes is left as it is.
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
        let options = SaveOptions { expected: Expected::Nothing, ..SaveOptions::default() };
        match dragonfly_store::save(&RealFiles, &path, bytes, &options) {
            Ok(_) => return Ok(path),
            // A folder of that name is something else, too.
            Err(SaveError::Exists { .. } | SaveError::NotRegular { .. }) => {
                let same = dragonfly_document::read_file(&path, bytes.len() as u64)
                    .is_ok_and(|existing| existing == bytes);
                if same {
                    return Ok(path);
                }
            }
            Err(error) => return Err(Failure::Input(error.to_string())),
        }
    }
    Err(Failure::input(folder.display(), format_args!("holds a thousand files called {stem} already")))
}
