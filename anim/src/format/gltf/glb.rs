//! The binary container: a header of 12 bytes, then chunks (glTF 2.0 §4.4).

use super::check as code;
use crate::format::{ImportContext, ImportError, Place};

/// The parts of a container that the importer uses.
pub(super) struct Glb<'a> {
    pub(super) json: &'a [u8],
    /// Offset of `json` in the file.
    pub(super) json_at: u64,
    pub(super) bin: Option<&'a [u8]>,
}

const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;
const JSON: u32 = u32::from_le_bytes(*b"JSON");
const BIN: u32 = u32::from_le_bytes(*b"BIN\0");

/// Splits a container into its chunks. Bytes after the declared end, and chunks of other kinds, are left out with a
/// warning.
pub(super) fn parse<'a>(bytes: &'a [u8], context: &ImportContext<'_>) -> Result<Glb<'a>, ImportError> {
    let bytes = &bytes[..announced_length(bytes, context)?];
    let (mut json, mut bin) = (None, None);
    let mut at = HEADER;
    for number in 0.. {
        if at >= bytes.len() {
            break;
        }
        context.work(1)?;
        let (kind, body) = chunk(bytes, at)?;
        if body.len() % 4 != 0 {
            let text = format!("the chunk's length {} is not a multiple of 4", body.len());
            context.warn(Place::Byte(at as u64), code::GLB_CHUNK_LENGTH_UNALIGNED, text);
        }
        match (number, kind) {
            (0, JSON) => json = Some(body),
            (0, _) => {
                let reason = format!("the first chunk is of kind {kind:#010x}, expected JSON");
                return Err(invalid(at, code::GLB_UNEXPECTED_FIRST_CHUNK, reason));
            }
            (1, BIN) => bin = Some(body),
            _ => warn_left_out(kind, at, context),
        }
        at += CHUNK_HEADER + body.len();
    }
    let Some(json) = json else {
        return Err(invalid(
            HEADER,
            code::GLB_UNEXPECTED_END_OF_CHUNK_HEADER,
            "the container has no chunk".to_owned(),
        ));
    };
    if json.is_empty() {
        return Err(invalid(HEADER, code::GLB_EMPTY_CHUNK, "the JSON chunk is empty".to_owned()));
    }
    Ok(Glb { json, json_at: (HEADER + CHUNK_HEADER) as u64, bin })
}

/// Checks the header and returns the length of the container, at most the length of the file.
fn announced_length(bytes: &[u8], context: &ImportContext<'_>) -> Result<usize, ImportError> {
    if bytes.len() < HEADER {
        let reason = format!("the file ends inside its header: {} bytes of {HEADER}", bytes.len());
        return Err(invalid(bytes.len(), code::GLB_UNEXPECTED_END_OF_HEADER, reason));
    }
    if !bytes.starts_with(b"glTF") {
        return Err(invalid(0, code::GLB_INVALID_MAGIC, not_a_glb(bytes)));
    }
    let version = word(bytes, 4);
    if version != 2 {
        let place = Place::Byte(4);
        return Err(ImportError::Unsupported { place, feature: format!("GLB version {version}") });
    }
    let length = word(bytes, 8) as usize;
    if length < HEADER {
        let reason = format!("the length {length} is less than the header");
        return Err(invalid(8, code::GLB_LENGTH_TOO_SMALL, reason));
    }
    if length > bytes.len() {
        let reason = format!("the file is incomplete: {} of {length} bytes", bytes.len());
        return Err(invalid(8, code::GLB_LENGTH_MISMATCH, reason));
    }
    if length < bytes.len() {
        let text = format!("{} bytes after the declared end are left out", bytes.len() - length);
        context.warn(Place::Byte(8), code::GLB_LENGTH_MISMATCH, text);
    }
    Ok(length)
}

/// Returns the kind and body of the chunk at `at`.
fn chunk(bytes: &[u8], at: usize) -> Result<(u32, &[u8]), ImportError> {
    let rest = &bytes[at..];
    if rest.len() < CHUNK_HEADER {
        let reason = format!("the file ends inside a chunk's header: {} bytes of {CHUNK_HEADER}", rest.len());
        return Err(invalid(at, code::GLB_UNEXPECTED_END_OF_CHUNK_HEADER, reason));
    }
    let length = word(rest, 0) as usize;
    match rest[CHUNK_HEADER..].get(..length) {
        Some(body) => Ok((word(rest, 4), body)),
        None => {
            let reason = format!("the chunk declares {length} bytes, {} are left", rest.len() - CHUNK_HEADER);
            Err(invalid(at, code::GLB_CHUNK_TOO_BIG, reason))
        }
    }
}

fn warn_left_out(kind: u32, at: usize, context: &ImportContext<'_>) {
    let (code, what) = match kind {
        JSON => (code::GLB_DUPLICATE_CHUNK, "a second JSON chunk"),
        BIN => (code::GLB_UNEXPECTED_BIN_CHUNK, "a binary chunk that is not the second chunk"),
        _ => (code::GLB_UNKNOWN_CHUNK_TYPE, "a chunk of unknown kind"),
    };
    context.warn(Place::Byte(at as u64), code, format!("{what} is left out"));
}

/// Describes what a file that should be a container probably is instead.
fn not_a_glb(bytes: &[u8]) -> String {
    let instead = if bytes.starts_with(b"version https://git-lfs") {
        ": it is a git-lfs pointer, fetch the file itself with `git lfs pull`"
    } else if bytes.starts_with(b"PK") {
        ": it is a zip archive, unpack it first"
    } else if bytes.starts_with(&[0x1f, 0x8b]) {
        ": it is compressed with gzip, unpack it first"
    } else {
        ""
    };
    format!("this is not a glTF file{instead}")
}

fn word(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]])
}

fn invalid(at: usize, code: &'static str, reason: String) -> ImportError {
    ImportError::Invalid { place: Place::Byte(at as u64), code, reason }
}
