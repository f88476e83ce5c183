//! MSZIP: blocks of deflated data, each with the 32 KiB before it as a dictionary.

use super::check as code;
use crate::format::{ImportContext, ImportError, Place};
use miniz_oxide::inflate::TINFLStatus;
use miniz_oxide::inflate::core::inflate_flags::TINFL_FLAG_USING_NON_WRAPPING_OUTPUT_BUF;
use miniz_oxide::inflate::core::{DecompressorOxide, decompress};

/// Largest size of a block that is not compressed.
const BLOCK: usize = 32_768;

/// Length of the header.
pub(super) const HEADER: usize = 16;

/// Bytes before the data of a block: the sizes of both, and a signature.
const BLOCK_HEADER: usize = 6;

/// Returns the header, and the data after it, not compressed.
///
/// Every block gives at most 32 KiB, and memory is charged for it before.
pub(super) fn inflate(bytes: &[u8], context: &ImportContext<'_>) -> Result<Vec<u8>, ImportError> {
    let invalid = |at: usize, reason: String| {
        let place = Place::Byte(at as u64);
        Err(ImportError::Invalid { place, code: code::COMPRESSED_DATA_INVALID, reason })
    };
    let mut out = context.vec(&Place::Byte(0), HEADER)?;
    out.extend_from_slice(&bytes[..HEADER]);
    let Some(total) = bytes.get(HEADER..HEADER + 4).and_then(|size| size.first_chunk()) else {
        return invalid(
            bytes.len(),
            "the file ends where its size without compression was expected".to_owned(),
        );
    };
    let total = u32::from_le_bytes(*total) as usize;
    let mut at = HEADER + 4;
    let mut state = Box::new(DecompressorOxide::new());
    while at < bytes.len() {
        context.work(BLOCK)?;
        let Some(&[a, b, c, d, s, t]) = bytes.get(at..).and_then(|rest| rest.first_chunk::<BLOCK_HEADER>())
        else {
            return invalid(at, "a block ends before its data".to_owned());
        };
        let size = usize::from(u16::from_le_bytes([a, b]));
        // The signature belongs to the data.
        let packed = usize::from(u16::from_le_bytes([c, d]));
        if [s, t] != *b"CK" {
            return invalid(at + 4, "a block does not start with \"CK\"".to_owned());
        }
        let Some(data) = bytes.get(at + BLOCK_HEADER..(at + 4).saturating_add(packed)) else {
            return invalid(at + 2, format!("a block of {packed} bytes is longer than the file"));
        };
        if size > BLOCK || packed < 2 {
            return invalid(at, format!("a block of {size} bytes; at most {BLOCK} are possible"));
        }
        let start = out.len();
        context.charge(
            &Place::Byte(at as u64),
            if start + size > out.capacity() { out.capacity() as u64 + size as u64 } else { 0 },
        )?;
        out.resize(start + size, 0);
        state.init();
        let flags = TINFL_FLAG_USING_NON_WRAPPING_OUTPUT_BUF;
        // The distance of a copy is at most 32 KiB, and it may reach into the blocks before.
        let (status, _, written) = decompress(&mut state, data, &mut out, start, flags);
        if status != TINFLStatus::Done || written != size {
            return invalid(
                at + BLOCK_HEADER,
                format!("a block of {size} bytes is damaged: {written} bytes, {status:?}"),
            );
        }
        at += 4 + packed;
    }
    if out.len() != total {
        return invalid(HEADER, format!("{} bytes without compression, {total} are announced", out.len()));
    }
    Ok(out)
}
