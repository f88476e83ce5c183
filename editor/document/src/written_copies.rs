//! The files that a save has written into another folder, which are removed again where the save is stopped or fails.

use dragonfly_store::{FileStamp, FileState, RealFiles, Vfs, folder_of};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Files and folders that a save has created in another folder.
#[derive(Debug, Default)]
pub(super) struct WrittenCopies {
    /// The paths at which there was a file before.
    occupied: BTreeSet<PathBuf>,
    /// The folders that did not exist before, each after the one that contains it.
    folders: BTreeSet<PathBuf>,
    /// The files that were created, with their stamps.
    created: Vec<(PathBuf, FileStamp)>,
    /// The files that are not removed.
    kept: Vec<PathBuf>,
}

impl WrittenCopies {
    /// Notes what there is, before a save writes files at these paths.
    pub(super) fn before<'a>(paths: impl Iterator<Item = &'a Path>) -> Self {
        let mut copies = Self::default();
        for path in paths {
            if path.symlink_metadata().is_ok() {
                copies.occupied.insert(path.to_path_buf());
            }
            let folders = folder_of(path).ancestors();
            let missing = folders.take_while(|folder| !folder.as_os_str().is_empty() && !folder.is_dir());
            copies.folders.extend(missing.map(Path::to_path_buf));
        }
        copies
    }

    /// Adds a file that was written. One that was there before is kept: it was an earlier copy.
    pub(super) fn add(&mut self, path: &Path, stamp: FileStamp) {
        match self.occupied.contains(path) {
            true => self.kept.push(path.to_path_buf()),
            false => self.created.push((path.to_path_buf(), stamp)),
        }
    }

    /// Keeps all files that were added so far, because another file that refers to them stays.
    pub(super) fn keep(&mut self) {
        self.kept.extend(self.created.drain(..).map(|(path, _)| path));
    }

    /// Removes the files and folders that were created. Returns the files that stay: those that are kept, and those that cannot be removed or
    /// that another program has changed.
    pub(super) fn remove(self) -> Vec<PathBuf> {
        let mut stay = self.kept;
        for (path, stamp) in self.created {
            let is_gone = match stamp.state(&RealFiles, &path) {
                Ok(FileState::Same) => RealFiles.remove(&path).is_ok(),
                Ok(FileState::Missing) => true,
                Ok(FileState::Changed) | Err(_) => false,
            };
            if !is_gone {
                stay.push(path);
            }
        }
        for folder in self.folders.iter().rev() {
            // One that is not empty stays.
            let _ = std::fs::remove_dir(folder);
        }
        stay
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn only_files_that_were_created_and_are_unchanged_are_removed_with_their_folders() {
        let folder = dragonfly_kit::folder::Folder::new("written-copies");
        let names = ["own/a/one.txt", "own/two.txt", "changed.txt", "old.txt"];
        let paths = names.map(|name| folder.join(name));
        fs::write(&paths[3], "an earlier copy").expect("a file");
        let mut copies = WrittenCopies::before(paths.iter().map(|path| &**path));
        for path in &paths {
            fs::create_dir_all(folder_of(path)).expect("a folder");
            fs::write(path, "new").expect("a file");
            copies.add(path, FileStamp::take(&RealFiles, path).expect("a stamp"));
        }
        fs::write(&paths[2], "of another program").expect("a file");
        let mut stay = copies.remove();
        stay.sort();
        assert_eq!(stay, paths[2..]);
        assert!(!folder.join("own").exists());
        assert_eq!(fs::read_to_string(&paths[3]).expect("a file"), "new");
    }
}
