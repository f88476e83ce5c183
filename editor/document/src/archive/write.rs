//! Writes an archive. The same files give the same bytes: no times are stored.

use super::{ArchiveError, ArchivedFile, MOST_FILES, MOST_UNPACKED, checked_name};
use dragonfly_anim::limits::FILE_BYTES;
use std::collections::HashSet;
use std::io::Cursor;
use zip::result::ZipResult;
use zip::write::{PreparedZipFile, SimpleFileOptions};
use zip::{CompressionMethod, DateTime, ZipWriter};

/// Level of compression, from 0 to 9.
const LEVEL: i64 = 7;

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
    let mut names = HashSet::new();
    for file in files {
        checked_name(&file.name)?;
        if !names.insert(file.name.to_lowercase()) {
            return Err(ArchiveError::Twice(file.name.clone()));
        }
    }
    let out = packed(files).map_err(|error| ArchiveError::Unwritten(error.to_string()))?;
    match out.len() as u64 {
        length if length > most_bytes => Err(ArchiveError::TooLong(length)),
        _ => Ok(out),
    }
}

fn packed(files: &[ArchivedFile]) -> ZipResult<Vec<u8>> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    let stored = SimpleFileOptions::default()
        .last_modified_time(DateTime::default())
        .compression_method(CompressionMethod::Stored);
    let deflated = stored.compression_method(CompressionMethod::Deflated).compression_level(Some(LEVEL));
    for ArchivedFile { name, bytes } in files {
        let mut file = PreparedZipFile::from_data(name, deflated, bytes)?;
        // Pictures and compressed meshes would become larger.
        if file.compressed_size() >= bytes.len() as u64 {
            file = PreparedZipFile::from_data(name, stored, bytes)?;
        }
        writer.add_prepared_file(file)?;
    }
    Ok(writer.finish()?.into_inner())
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
