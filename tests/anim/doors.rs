//! Implementations of [`AssetFs`] for tests: files in memory with a record of the reads, and folders of test data.

use dragonfly_anim::format::{AssetError, AssetFs};
use std::cell::RefCell;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Files in memory, and a record of the paths that were read.
#[derive(Default)]
pub(crate) struct MemoryFs {
    files: HashMap<String, Vec<u8>>,
    asked: RefCell<Vec<String>>,
}

impl MemoryFs {
    /// Returns access to the given files.
    pub(crate) fn with(files: &[(&str, &[u8])]) -> Self {
        let files = files.iter().map(|(path, bytes)| ((*path).to_owned(), bytes.to_vec())).collect();
        Self { files, asked: RefCell::default() }
    }

    /// Returns every path that was read, in order.
    pub(crate) fn asked(&self) -> Vec<String> {
        self.asked.borrow().clone()
    }
}

impl AssetFs for MemoryFs {
    fn read(&self, path: &str, limit: u64) -> Result<Vec<u8>, AssetError> {
        self.asked.borrow_mut().push(path.to_owned());
        let bytes = self.files.get(path).ok_or(AssetError::Missing)?;
        let size = bytes.len() as u64;
        if size > limit { Err(AssetError::TooLarge { size, limit }) } else { Ok(bytes.clone()) }
    }
}

/// Access to the files of a folder of test data.
pub(crate) struct TestFolder(pub(crate) PathBuf);

impl AssetFs for TestFolder {
    fn read(&self, path: &str, limit: u64) -> Result<Vec<u8>, AssetError> {
        let path = self.0.join(path);
        let size = std::fs::metadata(&path).map_err(|_| AssetError::Missing)?.len();
        if size > limit {
            return Err(AssetError::TooLarge { size, limit });
        }
        std::fs::read(path).map_err(|error| AssetError::Failed(error.to_string()))
    }
}

/// Returns the folder of test data in the repository.
pub(crate) fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data")
}

/// Returns the folders of `tests/data` with models that can be read, some with folders in them.
pub(crate) fn model_folders() -> [PathBuf; 7] {
    ["gltf", "bench", "collection", "bvh", "obj", "m3d", "x"].map(|folder| data().join(folder))
}

/// Returns every glTF file in the folders with models, sorted.
pub(crate) fn model_files() -> Vec<PathBuf> {
    gltf_files(Vec::from(model_folders()))
}

/// Returns every glTF file in `folders` and the folders in them, sorted.
pub(crate) fn gltf_files(mut folders: Vec<PathBuf>) -> Vec<PathBuf> {
    let mut found = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder of test data") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "glb" || ending == "gltf") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}
