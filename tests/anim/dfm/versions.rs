//! Other versions: a newer minor version is read as far as it is known, a newer major version is refused.

use super::frame::{byte_of, checksum, directory, fix_checksums, parts};
use super::golden::{file, model};
use dragonfly_anim::format::{NoFiles, ReadOptions, dfm, read};

/// Returns the same file with `extra` zeros after each bone, and an additional part at the end, as version 1.`minor`.
fn grown(extra: usize, minor: u16) -> Vec<u8> {
    let old = file();
    let mut bytes = old[..4].to_vec();
    let mut entries = Vec::new();
    let own = (*b"NEWS", *b"NEWS\x01\0\0\0\x02\0\0\0ab");
    let old_parts =
        parts(&old).unwrap().into_iter().map(|(tag, at, size)| (tag, old[at..at + size].to_vec()));
    for (tag, mut part) in old_parts.chain((minor > 0).then(|| (own.0, own.1.to_vec()))) {
        if tag == *b"BONE" {
            let size = 184 + extra as u32;
            part[4..8].copy_from_slice(&size.to_le_bytes());
            for bone in (1..=2).rev() {
                let end = 8 + 184 * bone;
                part.splice(end..end, vec![7; extra]);
            }
        }
        entries.extend_from_slice(&tag);
        for number in [bytes.len(), part.len(), checksum(&part) as usize] {
            entries.extend_from_slice(&(number as u32).to_le_bytes());
        }
        bytes.extend(part);
    }
    let directory = bytes.len() as u32;
    bytes.extend_from_slice(b"SUMS");
    for number in [entries.len() as u32 / 16, 16] {
        bytes.extend_from_slice(&number.to_le_bytes());
    }
    bytes.extend(entries);
    bytes.extend_from_slice(&directory.to_le_bytes());
    bytes.extend_from_slice(&[1, 0]);
    bytes.extend_from_slice(&minor.to_le_bytes());
    bytes.extend_from_slice(b"0000dfm\x1a");
    fix_checksums(&mut bytes);
    bytes
}

#[test]
fn additions_of_a_newer_minor_version_are_left_out_with_a_warning() {
    assert_eq!(grown(0, 0), file(), "the test makes such files correctly");
    for extra in [0, 4, 5] {
        let imported = read("a.dfm", &grown(extra, 1), &NoFiles, &ReadOptions::default()).unwrap();
        assert_eq!(imported.model, model());
        let codes: Vec<&str> = imported.warnings.iter().map(|warning| warning.code).collect();
        assert_eq!(codes, ["DFM_NEWER"]);
    }
}

#[test]
fn elements_of_another_size_are_refused_in_a_file_of_this_version() {
    let bytes = grown(4, 0);
    let error = dfm::read(&bytes).unwrap_err();
    assert_eq!((error.code(), byte_of(&error)), ("DFM_SIZE", parts(&bytes).unwrap()[4].1), "{error}");
}

#[test]
fn a_newer_major_version_is_refused() {
    let mut bytes = file();
    let at = bytes.len() - 12;
    bytes[at] = 2;
    fix_checksums(&mut bytes);
    let error = dfm::read(&bytes).unwrap_err();
    assert_eq!(
        error.to_string(),
        format!("byte {at}: needs version 2.0 of the format (this is 1.0), which is not supported")
    );
    assert!(directory(&bytes).unwrap() < at);
}
