//! Splits the bytes of a file into its parts: length, ending, checksums, headers. The content of the parts is not read
//! here.

use super::code::{DFM_CHECKSUM, DFM_ENDING, DFM_LENGTH, DFM_NEWER, DFM_PARTS, DFM_SIZE};
use super::error::invalid;
use super::part::{DIRECTORY_TAG, DfmPart, ENDING_MAGIC, PartLayout, PartList, VERSION};
use super::record::RecordFields;
use crate::checksum::CRC_32;
use crate::format::ImportContext;
use crate::format::{ImportError, Place};
use crate::limits::CANCEL_EVERY;

/// Size of the ending in bytes: offset of the directory, version, checksum, magic.
const ENDING: usize = 16;

/// Size in bytes of one entry of the directory, and of its header.
const ENTRY: usize = 16;
const HEADER: usize = 12;

/// A part of the file.
pub(super) struct FoundPart<'a> {
    /// Offset of the part in the file.
    pub(super) at: usize,
    /// Number of elements.
    pub(super) count: u32,
    /// Size of one element in bytes; for takes: of a take, a track and a key-frame.
    pub(super) sizes: [usize; 3],
    /// The elements.
    pub(super) bytes: &'a [u8],
}

/// Finds every part of the list.
pub(super) fn open<'a>(
    parts: &PartList,
    bytes: &'a [u8],
    context: &ImportContext<'_>,
) -> Result<Vec<FoundPart<'a>>, ImportError> {
    length(bytes)?;
    let (directory_at, newer) = ending(bytes)?;
    let directory = &bytes[directory_at..bytes.len() - ENDING];
    let mut header = RecordFields::new(directory);
    let tag: [u8; 4] = header.take();
    let (count, size) = (header.u32() as usize, header.u32() as usize);
    let entries = &directory[HEADER..];
    if tag != DIRECTORY_TAG || size != ENTRY || Some(entries.len()) != count.checked_mul(ENTRY) {
        let reason = format!("a directory of {count} entries of {size} bytes in {} bytes", entries.len());
        return Err(invalid(directory_at, DFM_PARTS, reason));
    }
    let entries = entries.chunks_exact(ENTRY);
    check_count(entries.len(), parts.len(), newer, directory_at)?;
    let mut found = context.vec(&Place::Byte(directory_at as u64), parts.len())?;
    let mut at = 4;
    for (number, entry) in entries.enumerate() {
        let entry_at = directory_at + HEADER + number * ENTRY;
        let layout = parts.get(number);
        let part = extent(bytes, entry, (entry_at, at, directory_at), layout, context)?;
        if let Some(layout) = layout {
            found.push(header_of(layout, at, part, newer)?);
        }
        at += part.len();
    }
    if at != directory_at {
        let reason = format!("the parts end here, the directory starts at byte {directory_at}");
        return Err(invalid(at, DFM_PARTS, reason));
    }
    if newer {
        let text = "written by a newer version; unknown content is left out";
        context.warn(Place::File, DFM_NEWER, text);
    }
    Ok(found)
}

/// Checks that the file has the length that it specifies.
fn length(bytes: &[u8]) -> Result<(), ImportError> {
    let len = bytes.len();
    let Some(total) = bytes.first_chunk::<4>().map(|total| u32::from_le_bytes(*total) as usize) else {
        return Err(invalid(len, DFM_LENGTH, "the file ends within its first number".to_owned()));
    };
    if len < total {
        return Err(invalid(
            len,
            DFM_LENGTH,
            format!("the file ends here; its header specifies {total} bytes"),
        ));
    }
    if len > total {
        let reason = format!("the file has {len} bytes; its header specifies that it ends here");
        return Err(invalid(total, DFM_LENGTH, reason));
    }
    if len < 4 + HEADER + ENDING {
        return Err(invalid(len, DFM_LENGTH, "the file is too short for its ending".to_owned()));
    }
    Ok(())
}

/// Returns the offset of the directory, and whether the file has a newer minor version.
fn ending(bytes: &[u8]) -> Result<(usize, bool), ImportError> {
    let at = bytes.len() - ENDING;
    let mut fields = RecordFields::new(&bytes[at..]);
    let (directory_at, major, minor) = (fields.u32() as usize, fields.u16(), fields.u16());
    let (checksum, magic): (u32, [u8; 4]) = (fields.u32(), fields.take());
    if magic != ENDING_MAGIC {
        let reason = format!("the file ends with {magic:02x?} instead of {ENDING_MAGIC:02x?}");
        return Err(invalid(at + 12, DFM_ENDING, reason));
    }
    let begins = |from: usize| bytes[from..at].starts_with(&DIRECTORY_TAG);
    if directory_at < 4 || directory_at > at - HEADER || !begins(directory_at) {
        let reason = format!("there is no directory at byte {directory_at}, to which the file refers here");
        return Err(invalid(at, DFM_ENDING, reason));
    }
    let computed = CRC_32.checksum(&bytes[directory_at..at + 8]);
    if computed != checksum && !cfg!(fuzzing) {
        return Err(altered(directory_at, "checksums", computed, checksum));
    }
    if major != VERSION.0 {
        let feature = format!("version {major}.{minor} of the format (this is {}.{})", VERSION.0, VERSION.1);
        return Err(ImportError::Unsupported { place: Place::Byte((at + 4) as u64), feature });
    }
    Ok((directory_at, minor > VERSION.1))
}

fn altered(at: usize, what: &str, computed: u32, written: u32) -> ImportError {
    let reason = format!(
        "the {what} here were changed: their checksum is {computed:08x}, the stored one {written:08x}"
    );
    invalid(at, DFM_CHECKSUM, reason)
}

/// Checks the number of parts. A newer file may have more; one of this version has exactly these.
fn check_count(count: usize, known: usize, newer: bool, at: usize) -> Result<(), ImportError> {
    if count == known || (newer && count > known) {
        return Ok(());
    }
    Err(invalid(at, DFM_PARTS, format!("{count} parts, this version has {known}")))
}

/// Returns the bytes of the part that `entry` describes, which must start at `at`, end before the directory, and be
/// unchanged.
fn extent<'a>(
    bytes: &'a [u8],
    entry: &[u8],
    (entry_at, at, directory_at): (usize, usize, usize),
    layout: Option<&PartLayout>,
    context: &ImportContext<'_>,
) -> Result<&'a [u8], ImportError> {
    let mut fields = RecordFields::new(entry);
    let tag: [u8; 4] = fields.take();
    let (offset, size, checksum) = (fields.u32() as usize, fields.u32() as usize, fields.u32());
    if let Some(expected) = layout.map(|layout| layout.tag).filter(|&expected| expected != tag) {
        let reason = format!("part {} where {} should stand", tag.escape_ascii(), expected.escape_ascii());
        return Err(invalid(entry_at, DFM_PARTS, reason));
    }
    if offset != at || size > directory_at - at {
        let reason =
            format!("part {} of {size} bytes is at byte {offset} instead of {at}", tag.escape_ascii());
        return Err(invalid(entry_at, DFM_PARTS, reason));
    }
    let part = &bytes[at..at + size];
    let mut hasher = CRC_32.digest();
    for piece in part.chunks(CANCEL_EVERY) {
        context.work(piece.len())?;
        hasher.update(piece);
    }
    let name = layout.map_or("unknown elements", |layout| layout.name);
    let computed = hasher.finalize();
    if computed != checksum && !cfg!(fuzzing) {
        return Err(altered(at, name, computed, checksum));
    }
    Ok(part)
}

/// Splits `bytes`, found at `at`, into header and elements.
fn header_of<'a>(
    layout: &PartLayout,
    at: usize,
    bytes: &'a [u8],
    newer: bool,
) -> Result<FoundPart<'a>, ImportError> {
    let part = layout.part;
    let Some((header, elements)) = bytes.split_at_checked(part.header_bytes()) else {
        let reason = format!("the {} end within their header", layout.name);
        return Err(invalid(at + bytes.len(), DFM_SIZE, reason));
    };
    let mut fields = RecordFields::new(header);
    if !part.is_of_thesis() {
        let tag: [u8; 4] = fields.take();
        if tag != layout.tag {
            let reason = format!("{} where {} should stand", tag.escape_ascii(), layout.tag.escape_ascii());
            return Err(invalid(at, DFM_PARTS, reason));
        }
    }
    let (count, size) = (fields.u32(), fields.u32() as usize);
    let mut sizes = [size, 0, 0];
    if part == DfmPart::Takes {
        sizes = [size, fields.u32() as usize, fields.u32() as usize];
    } else if (count as usize).checked_mul(size) != Some(elements.len()) {
        let reason = format!("{count} {} of {size} bytes in {} bytes", layout.name, elements.len());
        return Err(invalid(at, DFM_SIZE, reason));
    }
    let fits = |(&size, &known): (&usize, &usize)| size == known || (newer && size > known);
    if !sizes.iter().zip(&layout.sizes).all(fits) {
        let reason =
            format!("{}: elements of {sizes:?} bytes, this version has {:?}", layout.name, layout.sizes);
        return Err(invalid(at, DFM_SIZE, reason));
    }
    Ok(FoundPart { at, count, sizes, bytes: elements })
}
