//! What a journal is made of, byte by byte. Numbers are little-endian.
//!
//! ```text
//! header   magic 8 · version 4 · length of the text 4 · text (JSON) · CRC-32C of all that 4
//! record   length of the bytes 4 · kind 1 · CRC-32C 4 · bytes
//! ```
//!
//! The checksum of a record is over the journal's own number (8), the record's number in the journal (8, from 0), its
//! length, its kind and its bytes. So a record is valid only in its journal and at its place: what an earlier file
//! left on the disk, or a record that moved, is not taken for one.
//!
//! The frame of the header is the same in all versions, so that a newer journal is known for what it is.

use super::crc::crc32c;
use super::owner::Owner;
use super::stamp::FileStamp;
use super::vfs::{VfsFile, again};
use serde::{Deserialize, Serialize};
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

/// Begins a journal. The byte that is no text and the line ends show a transfer that took it for text.
pub(super) const MAGIC: [u8; 8] = *b"\x89DFJ\r\n\x1a\n";

/// The version written here.
pub(super) const VERSION: u32 = 1;

/// Longest text of a header, in bytes.
const LONGEST_TEXT: usize = 1 << 20;

/// Longest record, in bytes.
pub const LONGEST_RECORD: usize = 1 << 30;

/// Bytes before those of a record.
pub(super) const FRAME: usize = 9;

/// What a record is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tag {
    /// The whole document.
    Snapshot = 1,
    /// One edit.
    Edit = 2,
    /// A process took the journal; [`Opened`].
    Opened = 3,
    /// The document is about to be saved; [`Saving`].
    Saving = 4,
    /// The document was saved; its [`FileStamp`].
    Saved = 5,
    /// The process that had the journal let go of it in order.
    Closed = 6,
}

impl Tag {
    fn of(byte: u8) -> Option<Self> {
        [Self::Snapshot, Self::Edit, Self::Opened, Self::Saving, Self::Saved, Self::Closed]
            .into_iter()
            .find(|tag| *tag as u8 == byte)
    }
}

/// What a header says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Header {
    /// The journal's own number, in no other journal.
    pub(super) number: u64,
    /// The document's file, free of links; none for one never saved.
    pub(super) document: Option<PathText>,
    /// What that file was when the journal began.
    pub(super) stamp: Option<FileStamp>,
}

/// A path in JSON: text, or its bytes when it is no text.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub(super) enum PathText {
    Text(String),
    Bytes(Vec<u8>),
}

impl PathText {
    pub(super) fn new(path: &Path) -> Self {
        match path.to_str() {
            Some(text) => Self::Text(text.to_owned()),
            None => Self::Bytes(path.as_os_str().as_encoded_bytes().to_vec()),
        }
    }

    pub(super) fn path(&self) -> PathBuf {
        match self {
            Self::Text(text) => text.into(),
            #[cfg(unix)]
            Self::Bytes(bytes) => {
                use std::os::unix::ffi::OsStrExt;
                std::ffi::OsStr::from_bytes(bytes).into()
            }
            #[cfg(not(unix))]
            Self::Bytes(bytes) => String::from_utf8_lossy(bytes).into_owned().into(),
        }
    }
}

/// What the file is about to become: if the program is killed before it says [`Tag::Saved`], the file tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Saving {
    pub(super) size: u64,
    pub(super) hash: u64,
}

impl Saving {
    /// Is it this save that made the file what it is?
    pub(super) fn made(&self, stamp: &FileStamp) -> bool {
        (self.size, self.hash) == (stamp.size, stamp.hash)
    }
}

/// Who took the journal.
pub(super) type Opened = Owner;

/// Why a file is no journal that can be read.
#[derive(Debug)]
pub(super) enum Refused {
    /// Written by a later version of the format.
    Newer(u32),
    /// The header is not whole, or no header at all.
    Damaged(&'static str),
    Io(io::Error),
}

impl From<io::Error> for Refused {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// The bytes of a header.
pub(super) fn header(header: &Header) -> io::Result<Vec<u8>> {
    let text = serde_json::to_vec(header)?;
    let mut bytes = MAGIC.to_vec();
    bytes.extend(VERSION.to_le_bytes());
    let length = u32::try_from(text.len()).ok().filter(|_| text.len() <= LONGEST_TEXT);
    bytes.extend(length.ok_or(io::ErrorKind::InvalidInput)?.to_le_bytes());
    bytes.extend(text);
    bytes.extend(crc32c(&[&bytes]).to_le_bytes());
    Ok(bytes)
}

/// Puts the record after what is in `out`; the caller has seen that it is not too long.
pub(super) fn push(out: &mut Vec<u8>, journal: u64, number: u64, tag: Tag, bytes: &[u8]) {
    let length = (bytes.len() as u32).to_le_bytes();
    out.extend(length);
    out.push(tag as u8);
    out.extend(checksum(journal, number, length, tag as u8, bytes).to_le_bytes());
    out.extend(bytes);
}

fn checksum(journal: u64, number: u64, length: [u8; 4], tag: u8, bytes: &[u8]) -> u32 {
    crc32c(&[&journal.to_le_bytes(), &number.to_le_bytes(), &length, &[tag], bytes])
}

/// What reading a journal came to.
#[derive(Debug)]
pub(super) struct Scan {
    pub(super) header: Header,
    /// Records that are valid, from the first on.
    pub(super) records: u64,
    /// Bytes of the header and of those records.
    pub(super) valid: u64,
    /// Bytes of the file.
    pub(super) size: u64,
}

/// Reads the longest valid beginning of a journal and shows its records one after another. `visit` answers `false`
/// for one that it cannot understand, which ends the valid part before it.
///
/// Memory is that of the longest record, which is never longer than the file.
pub(super) fn scan(file: &dyn VfsFile, mut visit: impl FnMut(Tag, &[u8]) -> bool) -> Result<Scan, Refused> {
    let size = again(|| file.metadata())?.size;
    let mut reader = BufReader::with_capacity(1 << 16, Cursor { file, offset: 0 }.take(size));
    let header = read_header(&mut reader, size)?;
    let mut valid = header.1;
    let header = header.0;
    let mut records = 0;
    let mut bytes = Vec::new();
    while let Some(tag) = read_record(&mut reader, &mut bytes, size - valid, header.number, records)? {
        if !visit(tag, &bytes) {
            break;
        }
        records += 1;
        valid += (FRAME + bytes.len()) as u64;
    }
    Ok(Scan { header, records, valid, size })
}

fn read_header(reader: &mut impl BufRead, size: u64) -> Result<(Header, u64), Refused> {
    let short = Refused::Damaged("it ends within its header");
    let mut fixed = [0; 16];
    if !fill(reader, &mut fixed)? {
        return Err(if size == 0 { Refused::Damaged("it is empty") } else { short });
    }
    if fixed[..8] != MAGIC {
        return Err(Refused::Damaged("it does not begin as one"));
    }
    let (version, length) = (number(&fixed[8..12]), number(&fixed[12..16]) as usize);
    if length > LONGEST_TEXT || length as u64 > size {
        return Err(Refused::Damaged("its header says that it is longer than it can be"));
    }
    let mut text = vec![0; length + 4];
    if !fill(reader, &mut text)? {
        return Err(short);
    }
    let (text, sum) = text.split_at(length);
    if crc32c(&[&fixed, text]) != number(sum) {
        return Err(Refused::Damaged("the checksum of its header is wrong"));
    }
    if version == 0 {
        return Err(Refused::Damaged("its version is 0"));
    }
    if version > VERSION {
        return Err(Refused::Newer(version));
    }
    let header =
        serde_json::from_slice(text).map_err(|_| Refused::Damaged("its header is not understood"))?;
    Ok((header, (fixed.len() + length + 4) as u64))
}

/// The next record, its bytes in `bytes`; `None` at the end or where it is not valid.
fn read_record(
    reader: &mut impl BufRead,
    bytes: &mut Vec<u8>,
    left: u64,
    journal: u64,
    record: u64,
) -> Result<Option<Tag>, Refused> {
    let mut frame = [0; FRAME];
    if !fill(reader, &mut frame)? {
        return Ok(None);
    }
    let length = number(&frame[..4]) as usize;
    let Some(tag) = Tag::of(frame[4]) else { return Ok(None) };
    if length > LONGEST_RECORD || (FRAME + length) as u64 > left {
        return Ok(None);
    }
    bytes.clear();
    bytes.try_reserve(length).map_err(|_| io::Error::from(io::ErrorKind::OutOfMemory))?;
    bytes.resize(length, 0);
    if !fill(reader, bytes)? {
        return Ok(None);
    }
    let length = [frame[0], frame[1], frame[2], frame[3]];
    let right = checksum(journal, record, length, frame[4], bytes) == number(&frame[5..]);
    Ok(right.then_some(tag))
}

/// Fills `bytes`; `false` when the file ends before. An error of the disk is none of the journal's: it stays one.
fn fill(reader: &mut impl Read, bytes: &mut [u8]) -> io::Result<bool> {
    match reader.read_exact(bytes) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(false),
        Err(error) => Err(error),
    }
}

fn number(bytes: &[u8]) -> u32 {
    bytes.first_chunk::<4>().map_or(0, |bytes| u32::from_le_bytes(*bytes))
}

/// Reads a file from its beginning.
struct Cursor<'a> {
    file: &'a dyn VfsFile,
    offset: u64,
}

impl Read for Cursor<'_> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let got = again(|| self.file.read_at(bytes, self.offset))?;
        self.offset += got as u64;
        Ok(got)
    }
}
