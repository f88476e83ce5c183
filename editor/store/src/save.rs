//! Replacing a file in one step: at every instant, and after a power cut, its name leads to the old bytes or to the
//! new ones, whole; and once it is said to be saved, to the new ones.
//!
//! A new file is made in the same folder, given the old one's owner, permissions and attributes, written, brought to
//! the disk, and renamed over the old one; then the folder is brought to the disk. Only after that is it saved. A
//! link is followed first, so that the file it points to is replaced and not the link.
//!
//! A file with several names (hard links) would lose the others that way. It is overwritten where it is, after its
//! old content was brought to the disk beside it: see [`in_place`](super::in_place).

use super::error::{SaveError, Step};
use super::in_place;
use super::owner;
use super::stamp::{FileStamp, FileState, hash};
use super::versions::Versions;
use super::vfs::{FileData, Kind, Vfs, VfsFile, again, folder_of, look, write_all};
use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};

/// What a file must be before it is overwritten.
#[derive(Clone, Copy, Debug, Default)]
pub enum Expected<'a> {
    /// Anything: a person was asked, or it is a file of our own.
    #[default]
    Anything,
    /// There must be none.
    Nothing,
    /// What it was when this stamp was made; or gone, for then nobody's work is overwritten.
    Stamp(&'a FileStamp),
}

/// How to save.
#[derive(Clone, Copy, Debug, Default)]
pub struct SaveOptions<'a> {
    /// What must be there before.
    pub expected: Expected<'a>,
    /// Where the old version is kept, if it is.
    pub versions: Option<&'a Versions>,
}

/// What a save came to.
#[derive(Debug)]
pub struct Saved {
    /// The file that was written, free of links.
    pub path: PathBuf,
    /// What it is now.
    pub stamp: FileStamp,
    /// It has this many names and was overwritten in place, so that it keeps them; 1 when it was replaced.
    pub links: u64,
    /// Where the old version is.
    pub kept: Option<PathBuf>,
    /// What could not be kept of the old file, for a person to know.
    pub notices: Vec<String>,
}

/// Saves `bytes` in the file at `path`.
///
/// # Errors
/// When they are not on the disk. Except for [`SaveError::Unconfirmed`] and [`SaveError::Torn`] the old file is
/// then as it was, and nothing is left beside it.
pub fn save(
    files: &dyn Vfs,
    path: &Path,
    bytes: &[u8],
    options: &SaveOptions<'_>,
) -> Result<Saved, SaveError> {
    let target = resolved(files, path)?;
    let old = regular(files, &target)?;
    if let Some(old) = &old {
        not_protected(files, &target, old)?;
    }
    in_place::not_cut_off(files, &target)?;
    expect(files, &target, options.expected)?;
    let mut notices = Vec::new();
    let mut kept = None;
    if let (Some(versions), Some(_)) = (options.versions, &old) {
        match versions.keep(files, &target) {
            Ok(path) => kept = Some(path),
            // The new work matters more than the old version does.
            Err(error) => notices.push(format!("the old version could not be kept: {error}")),
        }
    }
    let links = old.map_or(1, |data| data.links.max(1));
    let stamp = if links > 1 {
        in_place::overwrite(files, &target, bytes, options.expected)?
    } else {
        replace_file(files, &target, old.as_ref(), bytes, options.expected, &mut notices)?
    };
    remove_leftovers(files, &target);
    Ok(Saved { path: target, stamp, links, kept, notices })
}

/// Saves `bytes` in a file of the program's own, whatever was there.
///
/// # Errors
/// As [`save`].
pub fn replace(path: &Path, bytes: &[u8]) -> Result<Saved, SaveError> {
    save(&super::RealFiles, path, bytes, &SaveOptions::default())
}

/// Most links that lead to a file one after another.
const MOST_LINKS: usize = 40;

/// The path of the file that `path` means, links followed; it need not exist, its folder must.
pub(super) fn resolved(files: &dyn Vfs, path: &Path) -> Result<PathBuf, SaveError> {
    let no_name = || SaveError::NoName { path: path.to_path_buf() };
    let mut at = path.to_path_buf();
    for _ in 0..MOST_LINKS {
        let name = at.file_name().ok_or_else(no_name)?.to_owned();
        let folder = again(|| files.resolve(folder_of(&at))).map_err(SaveError::at(path, Step::Create))?;
        at = folder.join(name);
        let found = look(files, &at).map_err(SaveError::at(path, Step::Look))?;
        if found.is_none_or(|data| data.kind != Kind::Link) {
            return Ok(at);
        }
        let points = again(|| files.read_link(&at)).map_err(SaveError::at(path, Step::Look))?;
        at = folder.join(points);
    }
    Err(no_name())
}

/// What is there now, which must be a file if it is anything.
pub(super) fn regular(files: &dyn Vfs, target: &Path) -> Result<Option<FileData>, SaveError> {
    let old = look(files, target).map_err(SaveError::at(target, Step::Look))?;
    match old {
        Some(data) if data.kind != Kind::File => Err(SaveError::NotRegular { path: target.to_path_buf() }),
        other => Ok(other),
    }
}

/// May it be written? A file can be replaced in a folder that one may write to, whatever it is itself; but who protects a
/// file, as systems for versions do, means its content.
fn not_protected(files: &dyn Vfs, target: &Path, old: &FileData) -> Result<(), SaveError> {
    let denied = |error: &io::Error| error.kind() == io::ErrorKind::PermissionDenied;
    let nobody = old.mode & 0o222 == 0;
    if nobody || again(|| files.open_to_write(target)).is_err_and(|error| denied(&error)) {
        return Err(SaveError::Protected { path: target.to_path_buf() });
    }
    Ok(())
}

/// Is there what is expected?
pub(super) fn expect(files: &dyn Vfs, target: &Path, expected: Expected<'_>) -> Result<(), SaveError> {
    let path = || target.to_path_buf();
    match expected {
        Expected::Anything => Ok(()),
        Expected::Nothing => match look(files, target).map_err(SaveError::at(target, Step::Look))? {
            None => Ok(()),
            Some(_) => Err(SaveError::Exists { path: path() }),
        },
        Expected::Stamp(stamp) => {
            match stamp.state(files, target).map_err(SaveError::at(target, Step::Look))? {
                FileState::Same | FileState::Missing => Ok(()),
                FileState::Changed => Err(SaveError::Changed { path: path() }),
            }
        }
    }
}

fn replace_file(
    files: &dyn Vfs,
    target: &Path,
    old: Option<&FileData>,
    bytes: &[u8],
    expected: Expected<'_>,
    notices: &mut Vec<String>,
) -> Result<FileStamp, SaveError> {
    let (beside, file) =
        create_beside(files, target, old.is_some()).map_err(SaveError::at(target, Step::Create))?;
    let written = fill(files, target, &*file, old, bytes, notices).and_then(|data| {
        // Asked again as late as can be: writing may have taken long.
        expect(files, target, expected)?;
        // Closed before it moves: some systems move no open file.
        drop(file);
        match expected {
            Expected::Nothing => again(|| files.rename_to_new(&beside, target)),
            Expected::Anything | Expected::Stamp(_) => again(|| files.rename(&beside, target)),
        }
        .map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => SaveError::Exists { path: target.to_path_buf() },
            _ => SaveError::at(target, Step::Replace)(error),
        })?;
        Ok(data)
    });
    if written.is_err() {
        // What is half written helps nobody; that it cannot be removed changes nothing.
        let _ = again(|| files.remove(&beside));
    }
    let data = written?;
    again(|| files.sync_folder(folder_of(target)))
        .map_err(|error| SaveError::Unconfirmed { path: target.to_path_buf(), error })?;
    // Moving it may have changed one of its times. If somebody was quicker to replace it again, it is not ours.
    let now = look(files, target).ok().flatten().filter(|now| {
        (now.device, now.inode, now.size, now.modified) == (data.device, data.inode, data.size, data.modified)
    });
    Ok(FileStamp::of(&now.unwrap_or(data), hash(bytes)))
}

fn fill(
    files: &dyn Vfs,
    target: &Path,
    file: &dyn VfsFile,
    old: Option<&FileData>,
    bytes: &[u8],
    notices: &mut Vec<String>,
) -> Result<FileData, SaveError> {
    if let Some(old) = old {
        inherit(files, target, file, old, notices).map_err(SaveError::at(target, Step::Attributes))?;
    }
    write_all(file, bytes, 0).map_err(SaveError::at(target, Step::Write))?;
    again(|| file.sync_all()).map_err(SaveError::at(target, Step::Sync))?;
    again(|| file.metadata()).map_err(SaveError::at(target, Step::Look))
}

/// Gives `file` what belongs to the file at `target` besides its bytes.
fn inherit(
    files: &dyn Vfs,
    target: &Path,
    file: &dyn VfsFile,
    old: &FileData,
    notices: &mut Vec<String>,
) -> io::Result<()> {
    let new = again(|| file.metadata())?;
    let mut mode = old.mode;
    if (new.owner, new.group) != (old.owner, old.group)
        && !allowed(again(|| file.set_owner(Some(old.owner), old.group)))?
    {
        // Whoever may not give it away may still be of its group.
        let group = allowed(again(|| file.set_owner(None, old.group)))?;
        let what = if group { "owner" } else { "owner and group" };
        notices.push(format!("its {what} could not be kept: it now belongs to you"));
        // Not to run with the rights of another one.
        mode &= 0o1777;
        if !group {
            mode &= !0o070;
        }
    }
    again(|| file.set_mode(mode))?;
    // The source may have been made unreadable meanwhile, even to us.
    let source = match again(|| files.open(target)) {
        Err(error) if error.kind() == io::ErrorKind::PermissionDenied => return Ok(()),
        other => other?,
    };
    for (name, value) in again(|| source.attributes())? {
        // The system gives every file its own label; it is not the person's.
        if !allowed(again(|| file.set_attribute(&name, &value)))? && !name.starts_with(b"security.") {
            let name = String::from_utf8_lossy(&name).into_owned();
            notices.push(format!("its attribute {name} could not be kept"));
        }
    }
    Ok(())
}

/// `false` when it may not be done or cannot be done here; other errors stay errors.
fn allowed(done: io::Result<()>) -> io::Result<bool> {
    match done {
        Ok(()) => Ok(true),
        Err(error)
            if matches!(error.kind(), io::ErrorKind::PermissionDenied | io::ErrorKind::Unsupported) =>
        {
            Ok(false)
        }
        Err(error) => Err(error),
    }
}

/// Longest name that file systems take, in bytes.
const LONGEST_NAME: usize = 255;

/// Ends the names of files that are being written.
const UNFINISHED: &str = ".part";

/// Names tried for a file beside the target.
const TRIES: usize = 100;

/// `.name.`: what names of files beside `target` begin with.
fn beside_begins(target: &Path) -> OsString {
    let name = target.file_name().unwrap_or_default();
    let mut begins = OsString::from(".");
    if name.len() <= LONGEST_NAME - 48 {
        begins.push(name);
    } else {
        begins.push(format!("{:016x}", hash(name.as_encoded_bytes())));
    }
    begins.push(".");
    begins
}

/// A new file in the folder of `target`, with its path.
pub(super) fn create_beside(
    files: &dyn Vfs,
    target: &Path,
    private: bool,
) -> io::Result<(PathBuf, Box<dyn VfsFile>)> {
    let mut taken = None;
    for number in 0..TRIES {
        let mut name = beside_begins(target);
        name.push(format!("{:x}-{}-{number}{UNFINISHED}", owner::host_hash(), std::process::id()));
        let beside = target.with_file_name(name);
        match again(|| files.create_new(&beside, private)) {
            Ok(file) => return Ok((beside, file)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => taken = Some(error),
            Err(error) => return Err(error),
        }
    }
    Err(taken.unwrap_or_else(|| io::Error::from(io::ErrorKind::AlreadyExists)))
}

/// Removes what a program of this machine that was killed while saving this very file left beside it. That it
/// cannot be removed changes nothing.
pub(super) fn remove_leftovers(files: &dyn Vfs, target: &Path) {
    let begins = beside_begins(target);
    for name in again(|| files.list(folder_of(target))).unwrap_or_default() {
        let Some(rest) = name.as_encoded_bytes().strip_prefix(begins.as_encoded_bytes()) else { continue };
        if std::str::from_utf8(rest).is_ok_and(is_leftover) {
            let _ = again(|| files.remove(&target.with_file_name(&name)));
        }
    }
}

/// Is it `host-process-number.part` of a process that is no more?
fn is_leftover(rest: &str) -> bool {
    let mut parts = rest.strip_suffix(UNFINISHED).unwrap_or_default().split('-');
    let host = parts.next().and_then(|host| u32::from_str_radix(host, 16).ok());
    let process = parts.next().and_then(|process| process.parse().ok());
    let number = parts.next().is_some_and(|number| number.bytes().all(|byte| byte.is_ascii_digit()));
    host == Some(owner::host_hash())
        && number
        && parts.next().is_none()
        && process.is_some_and(|process| owner::process_lives(process) == Some(false))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_of_a_living_process_or_of_another_machine_is_no_leftover() {
        let host = owner::host_hash();
        assert!(!is_leftover(&format!("{host:x}-{}-0.part", std::process::id())));
        assert!(!is_leftover(&format!("{:x}-4194999-0.part", host ^ 1)));
        assert!(!is_leftover("part"));
        assert!(!is_leftover(&format!("{host:x}-4194999-0-1.part")));
        // Beyond the largest number a process can have.
        assert_eq!(is_leftover(&format!("{host:x}-4194999-0.part")), cfg!(unix));
    }

    #[test]
    fn a_name_beside_is_never_longer_than_names_may_be() {
        for length in [1, 200, 206, 207, 208, 255] {
            let target = PathBuf::from("x".repeat(length));
            let mut name = beside_begins(&target);
            name.push(format!("{:x}-{}-{}{UNFINISHED}", u32::MAX, u32::MAX, TRIES));
            assert!(name.len() <= LONGEST_NAME, "{length}: {}", name.len());
        }
    }
}
