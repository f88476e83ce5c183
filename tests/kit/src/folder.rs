//! Temporary folders for tests, and the files of `tests/data`.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// A folder that is deleted when the value is dropped.
#[derive(Debug)]
pub struct Folder(PathBuf);

impl Folder {
    /// Creates an empty folder in the target's `tmp`, or at `name` where that is absolute. Two folders of one process never
    /// share a path, whatever their names.
    pub fn new(name: &str) -> Self {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = temporary().join(format!("{name}-{}-{number}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).expect("a folder");
        Self(path)
    }

    /// Returns the path of the folder.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Returns the path of `name` in the folder.
    pub fn join(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Returns the path of a file in `tests/data`.
pub fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../data").join(name)
}

/// Returns the folder for temporary files of tests, next to the folder of the test's own executable.
fn temporary() -> PathBuf {
    let program = std::env::current_exe().expect("a running test has an executable");
    let profile = program.ancestors().nth(2).expect("tests are built into target/PROFILE/deps");
    profile.parent().unwrap_or(profile).join("tmp")
}

/// Returns whether the long variants of random tests were requested (`DRAGONFLY_LONG`).
pub fn takes_long() -> bool {
    std::env::var_os("DRAGONFLY_LONG").is_some()
}
