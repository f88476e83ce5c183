//! The hash of everything that a model or a scene is made of, by which a movie of it is recognized.

use super::needed_files::NeededFiles;
use super::source::{LoadError, Source};
use super::text_source::{is_project, is_scene, read_texts};
use super::{Cancel, FileAccessError, Folder, read_file};
use crate::demo::DRAGONFLY_GLB;
use dragonfly_anim::limits::FILE_BYTES;
use dragonfly_store::hash;

/// Returns a hash of the file at a source and of every file that it needs: of a scene its texts, models with the files that they need
/// themselves, and sounds. Files that are missing count by their names. The folder and times of the files do not count.
///
/// # Errors
///
/// The file itself cannot be read, or it was cancelled.
pub fn content_hash(source: &Source, cancel: &Cancel) -> Result<u64, LoadError> {
    let Some(path) = source.path() else { return Ok(hash(DRAGONFLY_GLB)) };
    let unread = |reason: FileAccessError| LoadError::File { path: path.to_owned(), reason };
    let folder = Folder::of(path).map_err(unread)?;
    let mut content = ContentList::default();
    let needed = if is_scene(path) {
        let read = read_texts(path)?;
        for file in read.texts.list() {
            content.add(&file.name, Some(file.text.as_bytes()));
        }
        NeededFiles::of(&read.texts, is_project(path), &folder, cancel, &|_| {})
    } else {
        let bytes = read_file(path, FILE_BYTES).map_err(unread)?;
        content.add("", Some(&bytes));
        NeededFiles::of_model(path, &bytes, cancel).map_err(unread)?
    };
    for name in &needed.names {
        if cancel.is_cancelled() {
            return Err(LoadError::Cancelled);
        }
        content.add(name, folder.read(name, FILE_BYTES).ok().as_deref());
    }
    Ok(content.hash())
}

/// Names of files with the hashes of their bytes, in order.
#[derive(Default)]
struct ContentList(String);

impl ContentList {
    /// Adds a file; `None` for one that is missing. Names have no line ends.
    fn add(&mut self, name: &str, bytes: Option<&[u8]>) {
        let bytes = bytes.map_or_else(|| "missing".to_owned(), |bytes| format!("{:016x}", hash(bytes)));
        self.0.push_str(&format!("{bytes} {name}\n"));
    }

    fn hash(&self) -> u64 {
        hash(self.0.as_bytes())
    }
}
