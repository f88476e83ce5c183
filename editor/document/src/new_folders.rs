//! Folders that files are written into and that do not exist yet. Those that a save creates because the user typed a path in them are removed
//! again where it fails.

use dragonfly_store::{RealFiles, Vfs, folder_of};
use std::path::{Path, PathBuf};

/// Creates the folder of `path` if it does not exist, and flushes its name to the disk.
pub fn make_folder(path: &Path) -> Result<(), String> {
    let folder = folder_of(path);
    let missing: Vec<&Path> = folder.ancestors().take_while(is_missing).collect();
    let made = std::fs::create_dir_all(folder)
        .and_then(|()| missing.iter().try_for_each(|made| RealFiles.sync_folder(folder_of(made))));
    made.map_err(|error| format!("{}: the folder cannot be created: {error}", folder.display()))
}

fn is_missing(folder: &&Path) -> bool {
    !folder.as_os_str().is_empty() && !folder.is_dir()
}

/// Checks that the folder of `path` exists.
///
/// # Errors
///
/// The path and the reason.
pub fn ensure_folder(path: &Path) -> Result<(), String> {
    match folder_of(path).is_dir() {
        true => Ok(()),
        false => Err(format!("{}: its folder does not exist", path.display())),
    }
}

/// Returns the folders from `folder` outwards that do not exist, `folder` itself first; none where it exists.
///
/// # Errors
///
/// The path and the reason why they cannot be created.
pub(super) fn missing_folders(folder: &Path) -> Result<Vec<&Path>, String> {
    let missing: Vec<&Path> = folder.ancestors().take_while(is_missing).collect();
    if let Some(other) = missing.iter().find(|folder| folder.symlink_metadata().is_ok()) {
        return Err(format!("{}: this is not a folder", other.display()));
    }
    // A drive cannot be created, and `..` leads elsewhere once the folder before it exists.
    if missing.iter().any(|folder| folder.file_name().is_none()) {
        return Err(format!("{}: this folder does not exist", folder.display()));
    }
    Ok(missing)
}

/// Returns the folders that a save into `folder` creates, as a path in the one that exists; `None` where it creates none or fails.
pub(super) fn new_folders(folder: &Path) -> Option<PathBuf> {
    let missing = missing_folders(folder).ok()?;
    let inside = missing.last()?.parent()?;
    folder.strip_prefix(inside).ok().map(Path::to_path_buf)
}

/// Folders that a save has created, the innermost one first.
#[derive(Debug, Default)]
pub(super) struct NewFolders(Vec<PathBuf>);

impl NewFolders {
    /// Creates `folder`, and the folders that it is in, where they do not exist.
    ///
    /// # Errors
    ///
    /// The path and the reason. None was created then.
    pub(super) fn create(folder: &Path) -> Result<Self, String> {
        let new = Self(missing_folders(folder)?.into_iter().map(Path::to_path_buf).collect());
        if new.0.is_empty() {
            return Ok(new);
        }
        match make_folder(&folder.join("file")) {
            Ok(()) => Ok(new),
            Err(reason) => {
                new.remove();
                Err(reason)
            }
        }
    }

    /// Removes those that are empty.
    pub(super) fn remove(self) {
        for folder in self.0 {
            // One with files in it stays.
            let _ = std::fs::remove_dir(folder);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn only_folders_that_can_be_created_are_named_and_only_empty_ones_are_removed() {
        let folder = dragonfly_kit::folder::Folder::new("new-folders");
        assert_eq!(new_folders(folder.path()), None);
        assert_eq!(new_folders(&folder.join("a/b")), Some(PathBuf::from("a/b")));
        assert_eq!(new_folders(Path::new("no such folder/b")), Some(PathBuf::from("no such folder/b")));
        fs::write(folder.join("file"), "").expect("a file");
        for place in ["file", "file/a", "a/../b"] {
            assert_eq!(new_folders(&folder.join(place)), None, "{place}");
            assert!(NewFolders::create(&folder.join(place)).is_err(), "{place}");
        }
        assert!(!folder.join("a").exists());
        let new = NewFolders::create(&folder.join("a/b/c")).expect("folders");
        fs::write(folder.join("a/other"), "").expect("a file");
        new.remove();
        assert!(folder.join("a").is_dir() && !folder.join("a/b").exists());
    }
}
