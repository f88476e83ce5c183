//! Advisory locks of journals.

use super::vfs::{VfsFile, retry};
use std::io;
use std::time::Duration;

/// Result of locking a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LockResult {
    Ours,
    Held,
    /// The file system has no locks.
    Unsupported,
}

/// Takes the lock of `file` without waiting.
pub(super) fn lock(file: &dyn VfsFile) -> io::Result<LockResult> {
    match retry(|| file.try_lock()) {
        Ok(true) => Ok(LockResult::Ours),
        Ok(false) => Ok(LockResult::Held),
        Err(error) if error.kind() == io::ErrorKind::Unsupported => Ok(LockResult::Unsupported),
        Err(error) => Err(error),
    }
}

/// Number of attempts to take a lock, 2 ms apart. Inspecting a journal holds its lock for a moment, editing holds it
/// until the document is closed.
const LOCK_ATTEMPTS: usize = 50;

/// Takes the lock of `file`, retrying for a tenth of a second while another process holds it.
pub(super) fn lock_with_retries(file: &dyn VfsFile) -> io::Result<LockResult> {
    for _ in 1..LOCK_ATTEMPTS {
        match lock(file)? {
            LockResult::Held => std::thread::park_timeout(Duration::from_millis(2)),
            other => return Ok(other),
        }
    }
    lock(file)
}
