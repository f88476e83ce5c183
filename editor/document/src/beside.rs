//! The files next to a model that it refers to: each is read once, with a stamp, so that a change by another program is noticed before
//! a save.

use super::{FileAccessError, Folder};
use dragonfly_anim::format::{AssetError, AssetFs};
use dragonfly_store::{FileData, FileStamp, FileState, RealFiles};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

/// The folder of a model, for one import. The bytes of buffers are kept until they are read a second time, by what saves the model.
#[derive(Debug)]
pub(super) struct ReadOnce {
    folder: Folder,
    read: RefCell<BTreeMap<String, BufferFile>>,
}

/// A file that was read.
#[derive(Debug)]
struct BufferFile {
    path: PathBuf,
    stamp: FileStamp,
    bytes: Option<Vec<u8>>,
}

/// The stamps of the files that a save relies on.
#[derive(Clone, Debug, Default)]
pub(super) struct BesideStamps(BTreeMap<PathBuf, FileStamp>);

impl ReadOnce {
    /// Returns the folder of `file`.
    pub(super) fn of(file: &Path) -> Result<Self, FileAccessError> {
        Ok(Self::inside(Folder::of(file)?))
    }

    /// Returns this folder.
    pub(super) fn inside(folder: Folder) -> Self {
        Self { folder, read: RefCell::default() }
    }

    /// Returns the stamps of the buffers that were read.
    pub(super) fn stamps(&self) -> BesideStamps {
        BesideStamps(self.read.borrow().values().map(|file| (file.path.clone(), file.stamp)).collect())
    }
}

impl AssetFs for ReadOnce {
    fn read(&self, name: &str, limit: u64) -> Result<Vec<u8>, AssetError> {
        let kept = self.read.borrow_mut().get_mut(name).and_then(|file| file.bytes.take());
        if let Some(bytes) = kept.filter(|bytes| bytes.len() as u64 <= limit) {
            return Ok(bytes);
        }
        let path = self.folder.path_of(name)?;
        let before = FileStamp::before(&RealFiles, &path).ok();
        let bytes = self.folder.read(name, limit)?;
        if is_image(&bytes) {
            return Ok(bytes);
        }
        let changed = |_| AssetError::Failed("it changed while it was read; open the file again".to_owned());
        let stamp = stamp_of(Some(&*path).zip(before.as_ref()), &bytes).map_err(changed)?;
        if let Some(stamp) = stamp {
            let file = BufferFile { path, stamp, bytes: Some(bytes.clone()) };
            self.read.borrow_mut().insert(name.to_owned(), file);
        }
        Ok(bytes)
    }
}

/// Returns the stamp of a file that was read as `bytes` after its metadata was taken; `None` where there is no file, or its state cannot be examined.
///
/// # Errors
///
/// The file changed while it was read.
pub(super) fn stamp_of(file: Option<(&Path, &FileData)>, bytes: &[u8]) -> Result<Option<FileStamp>, String> {
    let Some((path, before)) = file else { return Ok(None) };
    match FileStamp::of_read(&RealFiles, path, before, bytes) {
        Ok(stamp) => Ok(Some(stamp)),
        Err(error) if error.kind() == io::ErrorKind::WouldBlock => {
            Err("the file changed while it was read; open it again".to_owned())
        }
        // A change that cannot be detected now will be noticed when the file is saved.
        Err(_) => Ok(None),
    }
}

/// Returns whether these are the bytes of an image, which no save reads.
fn is_image(bytes: &[u8]) -> bool {
    let beginnings: [&[u8]; 4] = [b"\x89PNG", b"\xff\xd8\xff", b"RIFF", b"\xabKTX"];
    beginnings.iter().any(|beginning| bytes.starts_with(beginning))
}

impl BesideStamps {
    /// Adds a file, or replaces its stamp.
    pub(super) fn add(&mut self, path: PathBuf, stamp: FileStamp) {
        self.0.insert(path, stamp);
    }

    /// Returns the stamp of a file.
    pub(super) fn of(&self, path: &Path) -> Option<&FileStamp> {
        let path = path.canonicalize().ok()?;
        self.0.get(&path)
    }

    /// Returns the stamp of a file that no other program changed.
    pub(super) fn unchanged(&self, path: &Path) -> Option<&FileStamp> {
        self.of(path).filter(|stamp| matches!(stamp.state(&RealFiles, path), Ok(FileState::Same)))
    }

    /// Adds the files of `other`, and replaces their stamps.
    pub(super) fn extend(&mut self, other: Self) {
        self.0.extend(other.0);
    }

    /// Returns the first file that another program changed, and how.
    pub(super) fn changed(&self) -> Option<(&Path, FileState)> {
        self.0.iter().find_map(|(path, stamp)| {
            let state = stamp.state(&RealFiles, path).ok()?;
            (state != FileState::Same).then_some((path.as_path(), state))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_buffer_is_read_once_for_the_import_and_for_the_save_and_an_image_only_for_the_import() {
        let folder = dragonfly_kit::folder::Folder::new("read-once");
        let [model, buffer, image] = ["a.gltf", "a.bin", "a.png"].map(|name| folder.join(name));
        std::fs::write(&buffer, b"numbers").expect("a file");
        std::fs::write(&image, b"\x89PNG and more").expect("a file");
        let door = ReadOnce::of(&model).expect("a folder");
        assert_eq!(door.read("a.bin", 100), Ok(b"numbers".to_vec()));
        assert!(door.read("a.png", 100).is_ok());
        std::fs::remove_file(&buffer).expect("it is there");
        std::fs::remove_file(&image).expect("it is there");
        assert_eq!(door.read("a.bin", 100), Ok(b"numbers".to_vec()), "kept");
        assert_eq!(door.read("a.png", 100), Err(AssetError::Missing));
        assert_eq!(door.read("a.bin", 100), Err(AssetError::Missing), "kept for one import");
        let stamps = door.stamps();
        assert!(matches!(stamps.changed(), Some((_, FileState::Missing))));
        std::fs::write(&buffer, b"numbers").expect("a file");
        assert!(stamps.changed().is_none(), "the same bytes");
        std::fs::write(&buffer, b"Numbers").expect("a file");
        assert!(matches!(stamps.changed(), Some((_, FileState::Changed))));
    }
}
