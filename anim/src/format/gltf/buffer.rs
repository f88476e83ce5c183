//! The bytes behind a document: the binary chunk, data URIs, files beside it.

use super::check as code;
use crate::format::uri::{DataUri, UriError, relative_path};
use crate::format::{AssetError, AssetFs, ImportError, Place, guard::Guard};
use crate::limits::EXTERNAL_FILES;
use gltf::json;
use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::Arc;

/// Whom an importer asks for bytes that are elsewhere. Each file is read once.
pub(super) struct Store<'a> {
    door: &'a dyn AssetFs,
    guard: &'a Guard<'a>,
    files: RefCell<HashMap<String, Arc<[u8]>>>,
}

/// Bytes, and the type that a data URI gives them.
pub(super) struct Fetched {
    pub(super) bytes: Arc<[u8]>,
    pub(super) mime: String,
    /// The checked relative path, when they came through the door.
    pub(super) path: Option<String>,
}

impl<'a> Store<'a> {
    pub(super) fn new(door: &'a dyn AssetFs, guard: &'a Guard<'a>) -> Self {
        Self { door, guard, files: RefCell::default() }
    }

    /// What `uri` stands for. Only a limit or a cancel is an error that nobody may mend.
    pub(super) fn fetch(&self, uri: &str, place: &Place) -> Result<Fetched, ImportError> {
        match DataUri::parse(uri) {
            Some(data) => self.embedded(data.map_err(|error| not_followed(uri, place, &error))?, place, uri),
            None => self.external(uri, place),
        }
    }

    fn embedded(&self, data: DataUri<'_>, place: &Place, uri: &str) -> Result<Fetched, ImportError> {
        self.guard.work(data.capacity())?;
        let mut bytes = self.guard.vec(place, data.capacity())?;
        data.decode(&mut bytes).map_err(|error| not_followed(uri, place, &error))?;
        self.guard.charge(place, bytes.len() as u64)?;
        Ok(Fetched { bytes: bytes.into(), mime: data.mime.to_owned(), path: None })
    }

    fn external(&self, uri: &str, place: &Place) -> Result<Fetched, ImportError> {
        let path = relative_path(uri).map_err(|error| not_followed(uri, place, &error))?;
        let known = self.files.borrow().get(&path).cloned();
        let bytes = match known {
            Some(bytes) => bytes,
            None => self.through_the_door(&path, uri, place)?,
        };
        Ok(Fetched { bytes, mime: String::new(), path: Some(path) })
    }

    fn through_the_door(&self, path: &str, uri: &str, place: &Place) -> Result<Arc<[u8]>, ImportError> {
        let known = self.files.borrow().len();
        if known >= EXTERNAL_FILES {
            let (size, limit) = (known as u64 + 1, EXTERNAL_FILES as u64);
            return Err(ImportError::TooLarge { place: place.clone(), what: "external files", size, limit });
        }
        self.guard.progress(0.2)?;
        // Twice: once as read, once shared.
        let limit = self.guard.remaining() / 2;
        let read = self.door.read(path, limit).and_then(|bytes| match bytes.len() as u64 {
            size if size > limit => Err(AssetError::TooLarge { size, limit }),
            _ => Ok(bytes),
        });
        let bytes = read.map_err(|error| external(uri, place, code::IO_ERROR, error.to_string()))?;
        self.guard.charge(place, bytes.len() as u64 * 2)?;
        self.guard.input(bytes.len());
        let bytes: Arc<[u8]> = bytes.into();
        self.files.borrow_mut().insert(path.to_owned(), bytes.clone());
        Ok(bytes)
    }
}

/// One buffer: its bytes and how many of them count.
#[derive(Clone)]
pub(super) enum Buffer<'a> {
    /// Has no URI and no binary chunk: an error for whoever needs it.
    Missing,
    Chunk(&'a [u8]),
    Fetched(Arc<[u8]>, usize),
}

impl Buffer<'_> {
    pub(super) fn bytes(&self) -> &[u8] {
        match self {
            Self::Missing => &[],
            Self::Chunk(bytes) => bytes,
            Self::Fetched(bytes, length) => &bytes[..*length],
        }
    }
}

/// All buffers of `root`, each at least as long as it announces.
pub(super) fn load<'a>(
    root: &json::Root,
    bin: Option<&'a [u8]>,
    store: &Store<'_>,
    guard: &Guard<'_>,
) -> Result<Vec<Buffer<'a>>, ImportError> {
    let mut buffers = guard.vec(&Place::Pointer("/buffers".to_owned()), root.buffers.len())?;
    for (index, buffer) in root.buffers.iter().enumerate() {
        guard.work(1)?;
        let place = Place::Pointer(format!("/buffers/{index}"));
        let announced = buffer.byte_length.0;
        let loaded = match &buffer.uri {
            Some(uri) => {
                let place = Place::Pointer(format!("/buffers/{index}/uri"));
                Buffer::Fetched(store.fetch(uri, &place)?.bytes, 0)
            }
            None => match bin.filter(|_| index == 0) {
                Some(bytes) => Buffer::Chunk(bytes),
                None => {
                    let text = "the buffer has no URI, and there is no binary chunk for it";
                    guard.warn(place, code::BUFFER_MISSING_GLB_DATA, text);
                    buffers.push(Buffer::Missing);
                    continue;
                }
            },
        };
        buffers.push(cut(loaded, announced, &place, guard)?);
    }
    Ok(buffers)
}

/// The first `announced` bytes of a buffer.
fn cut<'a>(
    buffer: Buffer<'a>,
    announced: u64,
    place: &Place,
    guard: &Guard<'_>,
) -> Result<Buffer<'a>, ImportError> {
    let present = match &buffer {
        Buffer::Missing => 0,
        Buffer::Chunk(bytes) => bytes.len(),
        Buffer::Fetched(bytes, _) => bytes.len(),
    };
    let length = usize::try_from(announced).ok().filter(|&length| length <= present).ok_or_else(|| {
        let reason = format!("{announced} bytes are announced, {present} are there");
        let place = place.clone();
        ImportError::Invalid { place, code: code::BUFFER_BYTE_LENGTH_MISMATCH, reason }
    })?;
    // A binary chunk is padded to a multiple of four.
    let slack = if matches!(buffer, Buffer::Chunk(_)) { 3 } else { 0 };
    if present - length > slack {
        let text = format!("{announced} bytes are announced, {present} are there");
        guard.warn(place.clone(), code::BUFFER_GLB_CHUNK_TOO_BIG, text);
    }
    Ok(match buffer {
        Buffer::Missing => Buffer::Missing,
        Buffer::Chunk(bytes) => Buffer::Chunk(&bytes[..length]),
        Buffer::Fetched(bytes, _) => Buffer::Fetched(bytes, length),
    })
}

fn not_followed(uri: &str, place: &Place, error: &UriError) -> ImportError {
    external(uri, place, code::INVALID_URI, error.to_string())
}

fn external(uri: &str, place: &Place, code: &'static str, reason: String) -> ImportError {
    let uri = match uri.char_indices().nth(120) {
        Some((end, _)) => format!("{}…", &uri[..end]),
        None => uri.to_owned(),
    };
    ImportError::External { place: place.clone(), code, uri, reason }
}
