//! Buffer files that earlier saves of a model wrote next to it, and that are not used any more.
//!
//! A save never overwrites or removes such a file: until the new model is on the disk, the old one needs it, and a copy of the model
//! may still need it. They are removed on request only, each after a search for models that refer to it.

use super::read_file;
use dragonfly_anim::format::gltf::save::buffer_of_save;
use dragonfly_anim::limits::FILE_BYTES;
use dragonfly_store::{RealFiles, Vfs, folder_of, hash};
use std::path::{Path, PathBuf};

/// Extensions of files that refer to no buffers.
const NO_MODELS: [&str; 9] = ["bin", "png", "jpg", "jpeg", "webp", "ktx2", "ktx", "bmp", "tga"];

/// A buffer file of an earlier save.
struct UnusedFile {
    path: PathBuf,
    /// Hash of its content when it was written.
    hash: u64,
}

/// Returns the buffer files of earlier saves of `model` that are not among the files that it refers to. The content of the folder is not
/// read.
fn unused(model: &Path, needed: &[String]) -> Vec<UnusedFile> {
    let folder = folder_of(model);
    let name = model.file_name().unwrap_or_default().to_string_lossy();
    let names = RealFiles.list(folder).unwrap_or_default();
    let found = names.into_iter().filter_map(|other| {
        let other = other.to_str()?;
        let hash = buffer_of_save(other, &name)?;
        (!needed.iter().any(|needed| needed == other)).then(|| UnusedFile { path: folder.join(other), hash })
    });
    let mut found: Vec<_> = found.collect();
    found.sort_by(|a, b| a.path.cmp(&b.path));
    found
}

/// Returns a sentence for the user where there are unused files.
pub(super) fn notice(model: &Path, needed: &[String]) -> Option<String> {
    let (files, are) = match unused(model, needed).len() {
        0 => return None,
        1 => ("1 buffer file".to_owned(), "is"),
        count => (format!("{count} buffer files"), "are"),
    };
    Some(format!(
        "{files} of earlier saves {are} not used any more; `dragonfly edit --compact` removes what no model uses"
    ))
}

/// Removes the unused files that still have the content with which they were written, and to which no model in the folder or in the
/// folder above refers. Returns their paths.
pub(super) fn remove(model: &Path, needed: &[String]) -> Vec<PathBuf> {
    let mut unused = unused(model, needed);
    unused.retain(|file| read_file(&file.path, FILE_BYTES).is_ok_and(|bytes| hash(&bytes) == file.hash));
    if unused.is_empty() {
        return Vec::new();
    }
    let folder = folder_of(model);
    let above = folder.canonicalize().ok().and_then(|folder| folder.parent().map(Path::to_path_buf));
    for place in [Some(folder.to_path_buf()), above].into_iter().flatten() {
        for name in RealFiles.list(&place).unwrap_or_default() {
            let path = place.join(name);
            let ending = path.extension().and_then(|end| end.to_str()).unwrap_or_default();
            if !path.is_file() || NO_MODELS.iter().any(|other| ending.eq_ignore_ascii_case(other)) {
                continue;
            }
            match read_file(&path, FILE_BYTES) {
                Ok(bytes) => unused.retain(|file| !mentions(&bytes, file.hash)),
                // It may refer to any of them.
                Err(_) => return Vec::new(),
            }
        }
    }
    let mut removed = Vec::new();
    for file in unused {
        if RealFiles.remove(&file.path).is_ok() {
            removed.push(file.path);
        }
    }
    removed
}

/// Returns whether a file contains the hash in the name of a buffer file.
fn mentions(bytes: &[u8], hash: u64) -> bool {
    let wanted = format!("{hash:016x}");
    let first = wanted.as_bytes().first().map(u8::to_ascii_uppercase);
    // Most places are excluded by their first byte, which costs a fraction of a comparison.
    bytes.windows(wanted.len()).any(|window| {
        window.first().map(u8::to_ascii_uppercase) == first && window.eq_ignore_ascii_case(wanted.as_bytes())
    })
}
