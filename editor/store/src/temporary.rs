//! Temporary files next to the file that is being saved.

use super::owner;
use super::stamp::hash;
use super::vfs::{Vfs, VfsFile, folder_of, retry};
use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};

/// Longest file name that file systems support, in bytes.
const LONGEST_NAME: usize = 255;

/// Ending of the names of files that are being written.
const UNFINISHED: &str = ".part";

/// Number of names tried for a temporary file.
const TRIES: usize = 100;

/// Returns `.name.`, the start of the names of temporary files of `target`.
fn temporary_prefix(target: &Path) -> OsString {
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

/// Creates a new file in the folder of `target` and returns it with its path.
pub(super) fn create_temporary(
    files: &dyn Vfs,
    target: &Path,
    private: bool,
) -> io::Result<(PathBuf, Box<dyn VfsFile>)> {
    let mut taken = None;
    for number in 0..TRIES {
        let mut name = temporary_prefix(target);
        name.push(format!("{:x}-{}-{number}{UNFINISHED}", owner::host_hash(), std::process::id()));
        let temporary = target.with_file_name(name);
        match retry(|| files.create_new(&temporary, private)) {
            Ok(file) => return Ok((temporary, file)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => taken = Some(error),
            Err(error) => return Err(error),
        }
    }
    Err(taken.unwrap_or_else(|| io::Error::from(io::ErrorKind::AlreadyExists)))
}

/// Removes temporary files that killed programs on this computer left while saving `target`. Failing to remove one
/// does no harm.
pub(super) fn remove_leftovers(files: &dyn Vfs, target: &Path) {
    let begins = temporary_prefix(target);
    for name in retry(|| files.list(folder_of(target))).unwrap_or_default() {
        let Some(rest) = name.as_encoded_bytes().strip_prefix(begins.as_encoded_bytes()) else { continue };
        if std::str::from_utf8(rest).is_ok_and(is_leftover) {
            let _ = retry(|| files.remove(&target.with_file_name(&name)));
        }
    }
}

/// Removes what killed programs on this computer left of the files in `folder` that they were writing and whose name `is_ours`. Failing to
/// remove one does no harm.
pub fn remove_unfinished(files: &dyn Vfs, folder: &Path, is_ours: &dyn Fn(&str) -> bool) {
    for name in retry(|| files.list(folder)).unwrap_or_default() {
        let found = name.to_str().and_then(|name| {
            let (name, rest) = name.strip_prefix('.')?.strip_suffix(UNFINISHED)?.rsplit_once('.')?;
            (is_ours(name) && is_leftover(&format!("{rest}{UNFINISHED}"))).then_some(())
        });
        if found.is_some() {
            let _ = retry(|| files.remove(&folder.join(&name)));
        }
    }
}

/// Returns whether `rest` is `host-process-number.part` of a process that no longer runs.
fn is_leftover(rest: &str) -> bool {
    let mut parts = rest.strip_suffix(UNFINISHED).unwrap_or_default().split('-');
    let host = parts.next().and_then(|host| u32::from_str_radix(host, 16).ok());
    let process = parts.next().and_then(|process| process.parse().ok());
    let number = parts.next().is_some_and(|number| number.bytes().all(|byte| byte.is_ascii_digit()));
    host == Some(owner::host_hash())
        && number
        && parts.next().is_none()
        && process.is_some_and(|process| owner::process_runs(process) == Some(false))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_temporary_file_of_a_running_process_or_another_machine_is_no_leftover() {
        let host = owner::host_hash();
        assert!(!is_leftover(&format!("{host:x}-{}-0.part", std::process::id())));
        assert!(!is_leftover(&format!("{:x}-4194999-0.part", host ^ 1)));
        assert!(!is_leftover("part"));
        assert!(!is_leftover(&format!("{host:x}-4194999-0-1.part")));
        // 4194999 is larger than any process number.
        assert_eq!(is_leftover(&format!("{host:x}-4194999-0.part")), cfg!(unix));
    }

    #[test]
    fn the_name_of_a_temporary_file_is_never_longer_than_file_systems_allow() {
        for length in [1, 200, 206, 207, 208, 255] {
            let target = PathBuf::from("x".repeat(length));
            let mut name = temporary_prefix(&target);
            name.push(format!("{:x}-{}-{}{UNFINISHED}", u32::MAX, u32::MAX, TRIES));
            assert!(name.len() <= LONGEST_NAME, "{length}: {}", name.len());
        }
    }
}
