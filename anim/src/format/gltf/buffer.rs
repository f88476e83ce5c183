//! Bytes of a document's buffers: the binary chunk, data URIs, referenced files.

use super::accessor::invalid;
use super::check as code;
use crate::format::context::{IO_ERROR, external};
use crate::format::uri::{DataUri, UriError, relative_path};
use crate::format::{ImportContext, ImportError, Place};
use gltf::json;
use std::sync::Arc;

/// Bytes that a URI contains or refers to.
pub(super) struct Fetched {
    pub(super) bytes: Arc<[u8]>,
    /// Media type of a data URI; empty for a file.
    pub(super) mime: String,
    /// Checked relative path of a file; `None` for a data URI.
    pub(super) path: Option<String>,
}

/// Returns the bytes that `uri` contains or refers to. [`ImportError::External`] leaves the rest of the file readable.
pub(super) fn fetch(uri: &str, place: &Place, context: &ImportContext<'_>) -> Result<Fetched, ImportError> {
    match DataUri::parse(uri) {
        Some(data) => {
            let data = data.map_err(|error| not_followed(uri, place, &error))?;
            decoded(&data, place, uri, context)
        }
        None => {
            context.progress(0.2)?;
            let bytes = context.read_neighbor(uri, place)?;
            Ok(Fetched { bytes, mime: String::new(), path: relative_path(uri).ok() })
        }
    }
}

/// Returns the bytes that a data URI contains.
fn decoded(
    data: &DataUri<'_>,
    place: &Place,
    uri: &str,
    context: &ImportContext<'_>,
) -> Result<Fetched, ImportError> {
    context.work(data.capacity())?;
    let mut bytes = context.vec(place, data.capacity())?;
    data.decode(&mut bytes).map_err(|error| not_followed(uri, place, &error))?;
    context.charge(place, bytes.len() as u64)?;
    Ok(Fetched { bytes: bytes.into(), mime: data.mime.to_owned(), path: None })
}

/// Bytes of one buffer.
#[derive(Clone)]
pub(super) enum BufferData<'a> {
    /// A buffer without a URI and without a binary chunk, or whose file cannot be read: this error as soon as something
    /// needs it.
    Missing(ImportError),
    /// The binary chunk of the file.
    Chunk(&'a [u8]),
    /// Other bytes, and the length of the buffer in them.
    Fetched(Arc<[u8]>, usize),
}

impl BufferData<'_> {
    pub(super) fn bytes(&self) -> &[u8] {
        match self {
            Self::Missing(_) => &[],
            Self::Chunk(bytes) => bytes,
            Self::Fetched(bytes, length) => &bytes[..*length],
        }
    }
}

/// Returns all buffers of `root`, each with exactly the length that its JSON declares. Those that are fallbacks, for
/// programs without an extension that this importer supports, are left out.
pub(super) fn load<'a>(
    root: &json::Root,
    bin: Option<&'a [u8]>,
    is_fallback: &[bool],
    context: &ImportContext<'_>,
) -> Result<Vec<BufferData<'a>>, ImportError> {
    let mut buffers = context.vec(&Place::Pointer("/buffers".to_owned()), root.buffers.len())?;
    for (index, buffer) in root.buffers.iter().enumerate() {
        context.work(1)?;
        let place = Place::Pointer(format!("/buffers/{index}"));
        let announced = buffer.byte_length.0;
        if is_fallback.get(index) == Some(&true) {
            let reason = "the buffer is for programs without an extension that is supported here".to_owned();
            let error = invalid(place, code::BUFFER_MISSING_GLB_DATA, reason);
            buffers.push(BufferData::Missing(error));
            continue;
        }
        let loaded = match &buffer.uri {
            Some(uri) => {
                let place = Place::Pointer(format!("/buffers/{index}/uri"));
                match fetch(uri, &place, context) {
                    Ok(fetched) => BufferData::Fetched(fetched.bytes, 0),
                    Err(error) if is_missing(&error) => {
                        let text = format!("{}; nothing that needs the file is shown", reason(&error));
                        context.warn(place, error.code(), text);
                        buffers.push(BufferData::Missing(error));
                        continue;
                    }
                    Err(error) => return Err(error),
                }
            }
            None => match bin.filter(|_| index == 0) {
                Some(bytes) => BufferData::Chunk(bytes),
                None => {
                    let text = "the buffer has no URI, and the file has no binary chunk for it";
                    let error = invalid(place.clone(), code::BUFFER_MISSING_GLB_DATA, text.to_owned());
                    context.warn(place, code::BUFFER_MISSING_GLB_DATA, text);
                    buffers.push(BufferData::Missing(error));
                    continue;
                }
            },
        };
        buffers.push(cut(loaded, announced, &place, context)?);
    }
    Ok(buffers)
}

/// Returns the buffer shortened to `announced` bytes.
fn cut<'a>(
    buffer: BufferData<'a>,
    announced: u64,
    place: &Place,
    context: &ImportContext<'_>,
) -> Result<BufferData<'a>, ImportError> {
    let present = match &buffer {
        BufferData::Missing(_) => 0,
        BufferData::Chunk(bytes) => bytes.len(),
        BufferData::Fetched(bytes, _) => bytes.len(),
    };
    let length = usize::try_from(announced).ok().filter(|&length| length <= present).ok_or_else(|| {
        let reason = format!("byteLength is {announced}, but there are {present} bytes");
        let place = place.clone();
        ImportError::Invalid { place, code: code::BUFFER_BYTE_LENGTH_MISMATCH, reason }
    })?;
    // A binary chunk is padded to a multiple of four.
    let slack = if matches!(buffer, BufferData::Chunk(_)) { 3 } else { 0 };
    if present - length > slack {
        let text = format!("byteLength is {announced}, but there are {present} bytes");
        context.warn(place.clone(), code::BUFFER_GLB_CHUNK_TOO_BIG, text);
    }
    Ok(match buffer {
        BufferData::Missing(error) => BufferData::Missing(error),
        BufferData::Chunk(bytes) => BufferData::Chunk(&bytes[..length]),
        BufferData::Fetched(bytes, _) => BufferData::Fetched(bytes, length),
    })
}

/// Returns whether the error is that of a buffer that is not there: one that only matters where something needs it.
pub(super) fn is_missing(error: &ImportError) -> bool {
    [IO_ERROR, code::BUFFER_MISSING_GLB_DATA].contains(&error.code())
}

/// Returns the name of the file that could not be read, and the reason.
fn reason(error: &ImportError) -> String {
    match error {
        ImportError::External { uri, reason, .. } => format!("\"{uri}\": {reason}"),
        other => other.to_string(),
    }
}

fn not_followed(uri: &str, place: &Place, error: &UriError) -> ImportError {
    external(uri, place, code::INVALID_URI, error.to_string())
}
