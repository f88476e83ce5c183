//! The structure of a file, known to the tests independently of the library: where its parts are, and how to correct
//! the checksums after a change.

use dragonfly_anim::format::{ImportError, Place};

/// CRC-32, bit by bit.
pub(crate) fn checksum(bytes: &[u8]) -> u32 {
    let mut remainder = u32::MAX;
    for &byte in bytes {
        remainder ^= u32::from(byte);
        for _ in 0..8 {
            remainder = (remainder >> 1) ^ if remainder & 1 == 1 { 0xEDB8_8320 } else { 0 };
        }
    }
    !remainder
}

pub(crate) fn number(bytes: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(bytes.get(at..at.checked_add(4)?)?.try_into().unwrap()))
}

/// Returns tag, offset and size of each part; `None` for a file whose directory cannot be found.
pub(crate) fn parts(bytes: &[u8]) -> Option<Vec<([u8; 4], usize, usize)>> {
    let directory = directory(bytes)?;
    let count = number(bytes, directory + 4)? as usize;
    let entries = bytes.get(directory + 12..bytes.len() - 16)?.chunks_exact(16).take(count);
    let entry = |entry: &[u8]| {
        let number = |at| number(entry, at).unwrap() as usize;
        (entry[..4].try_into().unwrap(), number(4), number(8))
    };
    Some(entries.map(entry).collect())
}

/// Returns the offset of the directory.
pub(crate) fn directory(bytes: &[u8]) -> Option<usize> {
    let at = number(bytes, bytes.len().checked_sub(16)?)? as usize;
    (at + 28 <= bytes.len()).then_some(at)
}

/// Corrects the total and every checksum, as far as the directory can be found.
pub(crate) fn fix_checksums(bytes: &mut [u8]) {
    if bytes.len() >= 4 {
        let total = (bytes.len() as u32).to_le_bytes();
        bytes[..4].copy_from_slice(&total);
    }
    let (Some(parts), Some(directory)) = (parts(bytes), directory(bytes)) else { return };
    for (index, (_, at, size)) in parts.into_iter().enumerate() {
        let Some(part) = at.checked_add(size).and_then(|end| bytes.get(at..end)) else { continue };
        let entry = directory + 12 + 16 * index;
        let sum = checksum(part).to_le_bytes();
        bytes[entry + 12..entry + 16].copy_from_slice(&sum);
    }
    let end = bytes.len() - 8;
    let sum = checksum(&bytes[directory..end]).to_le_bytes();
    bytes[end..end + 4].copy_from_slice(&sum);
}

/// Returns the place of an error, in bytes.
#[track_caller]
pub(crate) fn byte_of(error: &ImportError) -> usize {
    match error.place() {
        Place::Byte(at) => *at as usize,
        other => panic!("{error}: {other} instead of a byte"),
    }
}
