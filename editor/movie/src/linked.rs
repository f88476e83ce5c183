//! Overwriting a file with several names (hard links) by a movie, so that all of them show the movie.
//!
//! As where models are saved: the old content is copied next to the file and flushed to the disk before the file is changed, and restored where the
//! movie cannot be written. Where the machine stops in between, the copy remains, and the next save of the file asks what to do with it.

use dragonfly_store::{
    Vfs, VfsFile, discard_old_content, folder_of, hash, interrupted_save, restore_old_content,
};
use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};

/// Bytes that are copied at once.
const PIECE: usize = 256 << 10;

/// Longest file name that is part of the name of its copy, in bytes.
const LONGEST_NAME: usize = 200;

/// Writes the bytes of the complete file at `from` into the file at `target`, and removes `from`. Where that fails, the old content of `target` is
/// restored, and `from` stays.
pub(crate) fn overwrite(files: &dyn Vfs, from: &Path, target: &Path) -> io::Result<()> {
    copy_old_content(files, target)?;
    let written = files_opened(files, from, target).and_then(|(from, to)| {
        let size = copy(&*from, &*to)?;
        retry(|| to.set_size(size))?;
        retry(|| to.sync_all())
    });
    if let Err(error) = written {
        return Err(match restore_old_content(files, target) {
            Ok(()) => error,
            Err(torn) => io::Error::other(torn.to_string()),
        });
    }
    discard_old_content(files, target).map_err(|error| io::Error::other(error.to_string()))?;
    // It has done its work; if it cannot be removed, it does no harm.
    let _ = retry(|| files.remove(from));
    Ok(())
}

fn files_opened(
    files: &dyn Vfs,
    from: &Path,
    target: &Path,
) -> io::Result<(Box<dyn VfsFile>, Box<dyn VfsFile>)> {
    Ok((retry(|| files.open(from))?, retry(|| files.open_to_write(target))?))
}

/// Copies the content of the file at `target` to where saving looks for it, completely or not at all.
fn copy_old_content(files: &dyn Vfs, target: &Path) -> io::Result<()> {
    let old = old_content_path(target);
    let mut part = old.clone().into_os_string();
    part.push(".part");
    let part = PathBuf::from(part);
    // A program that was killed may have left it.
    let _ = retry(|| files.remove(&part));
    let to = retry(|| files.create_new(&part, true))?;
    let copied = retry(|| files.open(target)).and_then(|from| {
        copy(&*from, &*to)?;
        retry(|| to.sync_all())
    });
    // Closed before the rename, because some systems cannot rename an open file.
    drop(to);
    let copied = copied.and_then(|()| retry(|| files.rename(&part, &old)));
    let gone = if copied.is_ok() { &old } else { &part };
    let found = copied.and_then(|()| {
        retry(|| files.sync_folder(folder_of(target)))?;
        let found = interrupted_save(files, target).map_err(|error| io::Error::other(error.to_string()))?;
        // The name is chosen by the crate that saves, and only it can restore the copy.
        if found.as_deref() == Some(&*old) { Ok(()) } else { Err(io::Error::other("its copy is not found")) }
    });
    if found.is_err() {
        let _ = retry(|| files.remove(gone));
    }
    found
}

/// Returns the path of the copy of the old content, as the crate that saves chooses it.
fn old_content_path(target: &Path) -> PathBuf {
    let name = target.file_name().unwrap_or_default();
    let mut old = OsString::from(".");
    if name.len() < LONGEST_NAME {
        old.push(name);
    } else {
        old.push(format!("{:016x}", hash(name.as_encoded_bytes())));
    }
    old.push(".dragonfly-old");
    target.with_file_name(old)
}

/// Copies all of a file to the start of another. Returns the number of bytes.
fn copy(from: &dyn VfsFile, to: &dyn VfsFile) -> io::Result<u64> {
    let mut piece = vec![0; PIECE];
    let mut offset = 0;
    loop {
        let read = retry(|| from.read_at(&mut piece, offset))?;
        if read == 0 {
            return Ok(offset);
        }
        let mut rest = &piece[..read];
        while !rest.is_empty() {
            match retry(|| to.write_at(rest, offset))? {
                0 => return Err(io::Error::from(io::ErrorKind::WriteZero)),
                written => {
                    rest = rest.get(written..).unwrap_or_default();
                    offset += written as u64;
                }
            }
        }
    }
}

/// Repeats a call while signals interrupt it.
fn retry<T>(mut call: impl FnMut() -> io::Result<T>) -> io::Result<T> {
    loop {
        match call() {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            done => return done,
        }
    }
}
