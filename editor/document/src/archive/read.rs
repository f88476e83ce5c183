//! Reads an archive. Nothing in it is trusted: not its names, not its sizes.

use super::{ArchiveError, ArchivedFile, MOST_FILES, MOST_UNPACKED, checked_name};
use std::collections::HashSet;
use std::io::{Cursor, Read};
use zip::read::{ArchiveOffset, Config};
use zip::result::ZipError;
use zip::{CompressionMethod, ZipArchive};

/// Signature of the record at the end, and more than the length of the longest one with its comment of up to 65535 bytes.
const END: &[u8] = b"PK\x05\x06";
const LONGEST_END: usize = 1 << 17;

/// Signature of what leads to a directory of 64 bits, and its length.
const LOCATOR: &[u8] = b"PK\x06\x07";
const LOCATOR_LENGTH: usize = 20;

/// Returns the files of an archive, in their order. Folders are left out.
///
/// # Errors
///
/// It is damaged, uses what is not supported, has names that lead elsewhere, or would unpack to too much.
pub fn read_archive(bytes: &[u8]) -> Result<Vec<ArchivedFile>, ArchiveError> {
    if is_zip64(bytes) {
        let (name, feature) = ("the archive".to_owned(), "the format for more than 4 GiB");
        return Err(ArchiveError::Unsupported { name, feature });
    }
    let config = Config { archive_offset: ArchiveOffset::Known(0) };
    let opened = ZipArchive::with_config(config, Cursor::new(bytes));
    let mut archive = opened.map_err(|error| refused("the archive", error))?;
    if archive.len() > MOST_FILES {
        return Err(ArchiveError::TooMany(archive.len()));
    }
    // The library keeps one of those with the same name.
    if archive.has_duplicate_names() {
        return Err(ArchiveError::Twice("one of its files".to_owned()));
    }
    let mut total = 0_u64;
    for index in 0..archive.len() {
        let entry = archive.by_index_data(index).map_err(|error| refused("the archive", error))?;
        total = total.checked_add(entry.size()).ok_or(ArchiveError::TooLarge)?;
    }
    if total > MOST_UNPACKED {
        return Err(ArchiveError::TooLarge);
    }
    let mut names = HashSet::new();
    let mut files = Vec::new();
    for index in 0..archive.len() {
        let Some((name, size)) = named(&archive, index)? else { continue };
        // On some systems the two would be the same file.
        if !names.insert(name.to_lowercase()) {
            return Err(ArchiveError::Twice(name));
        }
        let damaged = || ArchiveError::Checksum(name.clone());
        let file = archive.by_index(index).map_err(|error| refused(&name, error))?;
        let mut contents = Vec::new();
        // A file that unpacks to more than its stated size is refused before the memory for it is allocated. At the end of a file, the
        // library compares the checksum.
        file.take(size + 1).read_to_end(&mut contents).map_err(|_| damaged())?;
        if contents.len() as u64 != size {
            return Err(damaged());
        }
        files.push(ArchivedFile { name, bytes: contents });
    }
    Ok(files)
}

/// Returns whether a directory at the end may be one of 64 bits. The library allocates memory for all files that one announces, up to one
/// for each byte of the archive.
fn is_zip64(bytes: &[u8]) -> bool {
    let tail = &bytes[bytes.len().saturating_sub(LONGEST_END)..];
    tail.windows(LOCATOR_LENGTH + 4).any(|window| window.starts_with(LOCATOR) && window.ends_with(END))
}

/// Returns name and size of a file; `None` for a folder.
fn named(archive: &ZipArchive<Cursor<&[u8]>>, index: usize) -> Result<Option<(String, u64)>, ArchiveError> {
    let entry = archive.by_index_data(index).map_err(|error| refused("the archive", error))?;
    let name = str::from_utf8(entry.name_raw());
    let name = name.map_err(|_| ArchiveError::Damaged("a name is not UTF-8".to_owned()))?.to_owned();
    if name.ends_with('/') && entry.size() == 0 {
        return Ok(None);
    }
    checked_name(&name)?;
    let unsupported = |feature| Err(ArchiveError::Unsupported { name: name.clone(), feature });
    if entry.encrypted() {
        return unsupported("encryption");
    }
    if entry.is_symlink() {
        return unsupported("a symbolic link");
    }
    match entry.compression() {
        CompressionMethod::Stored | CompressionMethod::Deflated => Ok(Some((name, entry.size()))),
        _ => unsupported("this kind of compression"),
    }
}

/// Returns the reason why a file, or the archive, cannot be read.
fn refused(name: &str, error: ZipError) -> ArchiveError {
    match error {
        ZipError::UnsupportedArchive(feature) => ArchiveError::Unsupported { name: name.to_owned(), feature },
        other => ArchiveError::Damaged(other.to_string()),
    }
}
