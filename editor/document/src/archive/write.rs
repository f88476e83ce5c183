//! Writes an archive. The same files give the same bytes: no times are stored.

use super::{
    ArchiveError, ArchivedFile, CENTRAL, DEFLATED, END, LOCAL, MOST_FILES, MOST_UNPACKED, STORED, UTF8,
    checked_name,
};
use dragonfly_anim::limits::FILE_BYTES;
use miniz_oxide::deflate::compress_to_vec;
use std::collections::HashSet;

/// Level of compression, from 0 to 10.
const LEVEL: u8 = 7;

/// 1 January 1980, the first day of the format.
const NO_DATE: u16 = 0x21;

/// Version of the format that is needed to read it, times 10.
const VERSION: u16 = 20;

/// Returns an archive of `files`, in their order.
///
/// # Errors
///
/// Names that lead elsewhere or occur twice; too many files or bytes for [`read_archive`](super::read_archive) or for a file that is read
/// again.
pub fn write_archive(files: &[ArchivedFile]) -> Result<Vec<u8>, ArchiveError> {
    written(files, MOST_UNPACKED, FILE_BYTES)
}

/// Returns an archive of at most `most_bytes` bytes of files with at most `most_unpacked` bytes.
fn written(files: &[ArchivedFile], most_unpacked: u64, most_bytes: u64) -> Result<Vec<u8>, ArchiveError> {
    if files.len() > MOST_FILES {
        return Err(ArchiveError::TooMany(files.len()));
    }
    if files.iter().map(|file| file.bytes.len() as u64).sum::<u64>() > most_unpacked {
        return Err(ArchiveError::TooLarge);
    }
    let (mut out, mut central, mut names) = (Vec::new(), Vec::new(), HashSet::new());
    for file in files {
        checked_name(&file.name)?;
        if !names.insert(file.name.to_lowercase()) {
            return Err(ArchiveError::Twice(file.name.clone()));
        }
        let offset = size(out.len())?;
        let packed = compress_to_vec(&file.bytes, LEVEL);
        // Pictures and compressed meshes would become larger.
        let (method, data) =
            if packed.len() < file.bytes.len() { (DEFLATED, &packed) } else { (STORED, &file.bytes) };
        let mut fields = Vec::with_capacity(26);
        for short in [VERSION, UTF8, method, 0, NO_DATE] {
            fields.extend(short.to_le_bytes());
        }
        for long in [crc32fast::hash(&file.bytes), size(data.len())?, size(file.bytes.len())?] {
            fields.extend(long.to_le_bytes());
        }
        // The names of files are shorter than 4 KiB, as was checked.
        fields.extend((file.name.len() as u16).to_le_bytes());
        fields.extend([0, 0]);
        out.extend(LOCAL.to_le_bytes());
        out.extend(&fields);
        out.extend(file.name.bytes());
        out.extend(data);
        central.extend(CENTRAL.to_le_bytes());
        central.extend(VERSION.to_le_bytes());
        central.extend(&fields);
        // No comment, first disk, no attributes.
        central.extend([0; 10]);
        central.extend(offset.to_le_bytes());
        central.extend(file.name.bytes());
    }
    let (start, length) = (size(out.len())?, size(central.len())?);
    out.extend(central);
    out.extend(END.to_le_bytes());
    out.extend([0; 4]);
    for _ in 0..2 {
        out.extend((files.len() as u16).to_le_bytes());
    }
    out.extend(length.to_le_bytes());
    out.extend(start.to_le_bytes());
    out.extend([0; 2]);
    match out.len() as u64 {
        length if length > most_bytes => Err(ArchiveError::TooLong(length)),
        _ => Ok(out),
    }
}

/// Returns a size as the format stores it.
fn size(size: usize) -> Result<u32, ArchiveError> {
    u32::try_from(size).ok().filter(|&size| size < u32::MAX).ok_or(ArchiveError::TooLarge)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_could_not_be_unpacked_again_is_not_packed() {
        let zeros = |name: &str| ArchivedFile { name: name.to_owned(), bytes: vec![0; 1000] };
        let files = [zeros("a"), zeros("b")];
        assert_eq!(written(&files, 1999, 1000), Err(ArchiveError::TooLarge));
        let length = written(&files, 2000, 1000).expect("an archive").len() as u64;
        assert_eq!(written(&files, 2000, length - 1), Err(ArchiveError::TooLong(length)));
        assert!(written(&files, 2000, length).is_ok());
    }
}
