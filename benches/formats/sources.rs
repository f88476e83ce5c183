//! Models of the repository and of a folder that the user names, and the files next to them.

use dragonfly_anim::format::{AssetError, AssetFs, Formats, OutputFile};
use dragonfly_fbx::FBX;
use dragonfly_kit::figures::root;
use std::path::{Path, PathBuf};

/// Folders of `tests/data` with models.
const FOLDERS: [&str; 8] = ["gltf", "bench", "collection", "bvh", "obj", "m3d", "x", "fbx"];

/// Returns all formats, FBX included.
pub(crate) fn formats() -> Formats {
    Formats::builtin().with(FBX)
}

/// Returns the paths of all models, sorted.
pub(crate) fn models() -> Vec<PathBuf> {
    let mut found = Vec::new();
    let named = std::env::var_os("DRAGONFLY_MODELS").map(PathBuf::from);
    let own = FOLDERS.iter().map(|folder| root().join("tests/data").join(folder));
    for folder in own.chain(named) {
        collect(&folder, &mut found);
    }
    found.sort();
    found
}

fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        // Meshes to compare with, not models of their own.
        let is_reference = path.ends_with("groundtruth");
        if path.is_dir() && !is_reference {
            collect(&path, found);
        } else if path.extension().is_some_and(|end| formats().is_model_extension(&end.to_string_lossy())) {
            found.push(path);
        }
    }
}

/// The files in the folder of a model.
pub(crate) struct NeighborFiles(pub(crate) PathBuf);

impl AssetFs for NeighborFiles {
    fn read(&self, path: &str, limit: u64) -> Result<Vec<u8>, AssetError> {
        let bytes = std::fs::read(self.0.join(path)).map_err(|_| AssetError::Missing)?;
        let size = bytes.len() as u64;
        if size > limit { Err(AssetError::TooLarge { size, limit }) } else { Ok(bytes) }
    }
}

/// Files that were written, in memory.
pub(crate) struct WrittenFiles<'a>(pub(crate) &'a [OutputFile]);

impl AssetFs for WrittenFiles<'_> {
    fn read(&self, path: &str, _limit: u64) -> Result<Vec<u8>, AssetError> {
        let found = self.0.iter().find(|file| file.name == path).ok_or(AssetError::Missing)?;
        Ok(found.bytes.clone())
    }
}
