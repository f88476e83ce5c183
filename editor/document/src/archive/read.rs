//! Reads an archive. Nothing in it is trusted: not its names, not its sizes.

use super::{ArchiveError, ArchivedFile, CENTRAL, DEFLATED, END, LOCAL, MOST_UNPACKED, STORED, checked_name};
use miniz_oxide::inflate::decompress_to_vec_with_limit;
use std::collections::HashSet;

/// Length of the record at the end, without its comment.
const END_LENGTH: usize = 22;

/// An entry of the directory at the end of an archive.
struct DirectoryEntry {
    name: String,
    flags: u16,
    method: u16,
    checksum: u32,
    packed: usize,
    size: u64,
    offset: usize,
}

/// Returns the files of an archive, in their order. Folders are left out.
///
/// # Errors
///
/// It is damaged, uses what is not supported, has names that lead elsewhere, or would unpack to too much.
pub fn read_archive(bytes: &[u8]) -> Result<Vec<ArchivedFile>, ArchiveError> {
    let entries = directory(bytes)?;
    let total = entries.iter().try_fold(0_u64, |sum, entry| sum.checked_add(entry.size));
    if total.is_none_or(|total| total > MOST_UNPACKED) {
        return Err(ArchiveError::TooLarge);
    }
    let mut names = HashSet::new();
    let mut files = Vec::new();
    for entry in entries.into_iter().filter(|entry| !(entry.name.ends_with('/') && entry.size == 0)) {
        checked_name(&entry.name)?;
        // On some systems the two would be the same file.
        if !names.insert(entry.name.to_lowercase()) {
            return Err(ArchiveError::Twice(entry.name));
        }
        let contents = unpacked(bytes, &entry)?;
        files.push(ArchivedFile { name: entry.name, bytes: contents });
    }
    Ok(files)
}

/// Returns the entries of the directory.
fn directory(bytes: &[u8]) -> Result<Vec<DirectoryEntry>, ArchiveError> {
    let cut = || ArchiveError::Damaged("it ends too early");
    // A comment of up to 65535 bytes may follow.
    let last = bytes.len().checked_sub(END_LENGTH).ok_or_else(cut)?;
    let first = last.saturating_sub(usize::from(u16::MAX));
    let end = (first..=last).rev().find(|&at| {
        let comment = short(bytes, at + 20).map(usize::from);
        long(bytes, at) == Some(END) && comment.is_some_and(|length| at + END_LENGTH + length == bytes.len())
    });
    let end = end.ok_or(ArchiveError::Damaged("it has no directory"))?;
    let whole = |feature| ArchiveError::Unsupported { name: "the archive".to_owned(), feature };
    let count = short(bytes, end + 10).ok_or_else(cut)?;
    if short(bytes, end + 4) != Some(0) || short(bytes, end + 8) != Some(count) {
        return Err(whole("an archive of several parts"));
    }
    let start = long(bytes, end + 16).ok_or_else(cut)?;
    if start == u32::MAX || count == u16::MAX {
        return Err(whole("the format for more than 4 GiB"));
    }
    let mut at = start as usize;
    let mut entries = Vec::new();
    for _ in 0..count {
        let (entry, next) = entry(bytes, at)?;
        entries.push(entry);
        at = next;
    }
    Ok(entries)
}

/// Returns the entry of the directory at `at`, and where the next one is.
fn entry(bytes: &[u8], at: usize) -> Result<(DirectoryEntry, usize), ArchiveError> {
    let cut = || ArchiveError::Damaged("its directory is cut off");
    let short = |offset: usize| short(bytes, at.saturating_add(offset)).ok_or_else(cut);
    let long = |offset: usize| long(bytes, at.saturating_add(offset)).ok_or_else(cut);
    if long(0)? != CENTRAL {
        return Err(ArchiveError::Damaged("its directory is not where it should be"));
    }
    let [name_length, extra, comment] = [28, 30, 32].map(|offset| short(offset).map(usize::from));
    let (start, length) = (at + 46, name_length?);
    let name = bytes.get(start..start + length).ok_or_else(cut)?;
    let name = str::from_utf8(name).map_err(|_| ArchiveError::Damaged("a name is not UTF-8"))?;
    let entry = DirectoryEntry {
        name: name.to_owned(),
        flags: short(8)?,
        method: short(10)?,
        checksum: long(16)?,
        packed: long(20)? as usize,
        size: u64::from(long(24)?),
        offset: long(42)? as usize,
    };
    Ok((entry, start + length + extra? + comment?))
}

/// Returns the contents of a file.
fn unpacked(bytes: &[u8], entry: &DirectoryEntry) -> Result<Vec<u8>, ArchiveError> {
    let unsupported = |feature| ArchiveError::Unsupported { name: entry.name.clone(), feature };
    if entry.flags & 1 != 0 {
        return Err(unsupported("encryption"));
    }
    let cut = || ArchiveError::Damaged("a file is cut off");
    if long(bytes, entry.offset) != Some(LOCAL) {
        return Err(ArchiveError::Damaged("a file is not where the directory says"));
    }
    let [name, extra] = [26, 28].map(|offset| short(bytes, entry.offset + offset).map(usize::from));
    let start = entry.offset + 30 + name.ok_or_else(cut)? + extra.ok_or_else(cut)?;
    let data = bytes.get(start..start.saturating_add(entry.packed)).ok_or_else(cut)?;
    let size = usize::try_from(entry.size).map_err(|_| ArchiveError::TooLarge)?;
    let contents = match entry.method {
        STORED => data.to_vec(),
        // What unpacks to more than it says is refused before it is there.
        DEFLATED => decompress_to_vec_with_limit(data, size)
            .map_err(|_| ArchiveError::Checksum(entry.name.clone()))?,
        _ => return Err(unsupported("this kind of compression")),
    };
    if contents.len() != size || crc32fast::hash(&contents) != entry.checksum {
        return Err(ArchiveError::Checksum(entry.name.clone()));
    }
    Ok(contents)
}

fn short(bytes: &[u8], at: usize) -> Option<u16> {
    bytes.get(at..)?.first_chunk().map(|chunk| u16::from_le_bytes(*chunk))
}

fn long(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..)?.first_chunk().map(|chunk| u32::from_le_bytes(*chunk))
}
