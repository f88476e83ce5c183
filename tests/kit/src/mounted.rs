//! File systems for tests: small ones, full ones, and ones whose power is cut.

use crate::skip::{TestNeed, skip};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Returns whether this process may mount; skips the test otherwise.
pub fn may_mount(test: &str) -> bool {
    let root = rustix::process::geteuid().is_root();
    if !root {
        skip(TestNeed::Root, format!("{test}: only root may mount"));
    }
    root
}

/// A mounted file system, unmounted when the value is dropped.
#[derive(Debug)]
pub struct Mounted(PathBuf);

impl Mounted {
    /// Mounts a file system in memory of `bytes` bytes; skips the test if the system refuses.
    pub fn in_memory(at: &Path, bytes: usize) -> Option<Self> {
        Self::mount(at, &["-t", "tmpfs", "-o", &format!("size={bytes}"), "tmpfs"])
    }

    /// Mounts the file system in the file `image`; skips the test if the system refuses.
    pub fn image(at: &Path, image: &Path) -> Option<Self> {
        Self::mount(at, &["-o", "loop", &image.to_string_lossy()])
    }

    fn mount(at: &Path, arguments: &[&str]) -> Option<Self> {
        std::fs::create_dir_all(at).expect("a folder");
        let is_mounted = succeeds(Command::new("mount").args(arguments).arg(at));
        if !is_mounted {
            skip(TestNeed::FileSystem, format!("mount {arguments:?} is refused"));
        }
        is_mounted.then(|| Self(at.to_path_buf()))
    }

    /// The folder at which the file system is mounted.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Remounts the file system read-only or writable.
    pub fn read_only(&self, read_only: bool) {
        let option = if read_only { "remount,ro" } else { "remount,rw" };
        assert!(succeeds(Command::new("mount").args(["-o", option]).arg(&self.0)));
    }
}

impl Drop for Mounted {
    fn drop(&mut self) {
        if !succeeds(Command::new("umount").arg(&self.0)) {
            // A file is still open: the file system is detached when that is closed.
            succeeds(Command::new("umount").arg("-l").arg(&self.0));
        }
    }
}

/// Runs `command`. Returns whether it succeeded; its error output is printed.
pub fn succeeds(command: &mut Command) -> bool {
    match command.output() {
        Ok(output) if output.status.success() => true,
        Ok(output) => {
            println!("{command:?}: {}", String::from_utf8_lossy(&output.stderr).trim());
            false
        }
        Err(error) => {
            println!("{command:?}: {error}");
            false
        }
    }
}

/// Creates an empty folder in memory where the system has one, so that syncing takes no time: for tests that make
/// thousands of calls fail, and cut no power.
pub fn quick_folder(name: &str) -> crate::folder::Folder {
    let memory = Path::new("/dev/shm");
    let place = if memory.is_dir() { memory.join(format!("dragonfly-{name}")) } else { PathBuf::from(name) };
    crate::folder::Folder::new(&place.to_string_lossy())
}
