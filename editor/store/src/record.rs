//! The byte format of a journal. Numbers are little-endian.
//!
//! ```text
//! header   magic 8 · version 4 · length of the text 4 · text (JSON) · CRC-32C of all that 4
//! record   length of the bytes 4 · kind 1 · CRC-32C 4 · bytes
//! ```
//!
//! The checksum of a record covers the journal's own number (8), the record's number in the journal (8, from 0), its
//! length, its kind and its bytes. So a record is valid only in its own journal and at its own position: remains of
//! an earlier file on the disk, or a moved record, fail the check.
//!
//! The frame of the header is the same in all versions, so that a newer journal can be recognized.

use super::stamp::FileStamp;
use super::vfs::{VfsFile, retry};
use crc::{CRC_32_ISCSI, Crc, Table};
use serde::{Deserialize, Serialize};
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

/// First bytes of a journal. The non-ASCII byte and the line ends reveal a transfer in text mode.
pub(super) const MAGIC: [u8; 8] = *b"\x89DFJ\r\n\x1a\n";

/// Version of the format that this program writes.
pub(super) const VERSION: u32 = 1;

/// Longest text of a header, in bytes.
const LONGEST_TEXT: usize = 1 << 20;

/// Longest record, in bytes.
pub const LONGEST_RECORD: usize = 1 << 30;

/// Number of bytes in a record before its content.
pub(super) const FRAME: usize = 9;

/// Kind of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tag {
    /// The whole document.
    Snapshot = 1,
    /// One edit.
    Edit = 2,
    /// A process opened the journal; content: [`JournalOwner`].
    Opened = 3,
    /// The document is about to be saved; content: [`Saving`].
    Saving = 4,
    /// The document was saved; content: its [`FileStamp`].
    Saved = 5,
    /// The process that had the journal closed it normally.
    Closed = 6,
}

impl Tag {
    fn of(byte: u8) -> Option<Self> {
        [Self::Snapshot, Self::Edit, Self::Opened, Self::Saving, Self::Saved, Self::Closed]
            .into_iter()
            .find(|tag| *tag as u8 == byte)
    }
}

/// Content of a header.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct JournalHeader {
    /// Random number that identifies the journal.
    pub(super) number: u64,
    /// The document's file, links resolved; `None` if it was never saved.
    pub(super) document: Option<PathText>,
    /// Stamp of that file when the journal began.
    pub(super) stamp: Option<FileStamp>,
}

/// A path in JSON: text, or its bytes when it is not valid Unicode.
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

/// Size and hash of the bytes of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileContents {
    /// Size in bytes.
    pub size: u64,
    /// Its [`hash`](super::hash()).
    pub hash: u64,
}

/// A save that is about to write the document's file: if the program is killed before it records [`Tag::Saved`], the file is compared
/// with what was to be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Saving {
    /// The bytes; `None` where the save writes only other files, so that the file does not show whether it ended.
    #[serde(flatten)]
    pub(super) file: Option<FileContents>,
    /// Number of the last edits that the file does not contain, because they were made while it was computed.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub(super) newer: u64,
}

fn is_zero(number: &u64) -> bool {
    *number == 0
}

impl Saving {
    /// Returns whether the file with this stamp shows that this save has ended.
    pub(super) fn made(&self, stamp: &FileStamp) -> bool {
        self.file.is_some_and(|file| (file.size, file.hash) == (stamp.size, stamp.hash))
    }
}

/// Reasons why a file cannot be read as a journal.
#[derive(Debug)]
pub(super) enum ReadFailure {
    /// Written in a later version of the format.
    Newer(u32),
    /// The header is incomplete, or missing.
    Damaged(&'static str),
    Io(io::Error),
}

impl From<io::Error> for ReadFailure {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// Serializes a header.
pub(super) fn header(header: &JournalHeader) -> io::Result<Vec<u8>> {
    let text = serde_json::to_vec(header)?;
    let mut bytes = MAGIC.to_vec();
    bytes.extend(VERSION.to_le_bytes());
    let length = u32::try_from(text.len()).ok().filter(|_| text.len() <= LONGEST_TEXT);
    bytes.extend(length.ok_or(io::ErrorKind::InvalidInput)?.to_le_bytes());
    bytes.extend(text);
    bytes.extend(checksum_of(&[&bytes]).to_le_bytes());
    Ok(bytes)
}

/// Appends a record to `out`. The caller has checked its length.
pub(super) fn push(out: &mut Vec<u8>, journal: u64, number: u64, tag: Tag, bytes: &[u8]) {
    let length = (bytes.len() as u32).to_le_bytes();
    out.extend(length);
    out.push(tag as u8);
    out.extend(record_checksum(journal, number, length, tag as u8, bytes).to_le_bytes());
    out.extend(bytes);
}

fn record_checksum(journal: u64, number: u64, length: [u8; 4], tag: u8, bytes: &[u8]) -> u32 {
    checksum_of(&[&journal.to_le_bytes(), &number.to_le_bytes(), &length, &[tag], bytes])
}

/// CRC-32C (Castagnoli), 16 bytes at a time.
static CRC_32C: Crc<u32, Table<16>> = Crc::<u32, Table<16>>::new(&CRC_32_ISCSI);

/// Returns the CRC-32C of all `parts`, in order.
fn checksum_of(parts: &[&[u8]]) -> u32 {
    let mut digest = CRC_32C.digest();
    parts.iter().for_each(|part| digest.update(part));
    digest.finalize()
}

/// Result of reading a journal.
#[derive(Debug)]
pub(super) struct JournalScan {
    pub(super) header: JournalHeader,
    /// Number of valid records at the start.
    pub(super) records: u64,
    /// Number of bytes of the header and those records.
    pub(super) valid: u64,
    /// Size of the file in bytes.
    pub(super) size: u64,
}

/// Reads the valid part at the start of a journal and calls `visit` with each record. `visit` returns `false` for a
/// record that it cannot parse, which ends the valid part before it.
///
/// Uses memory for the longest record, which is never longer than the file.
pub(super) fn scan(
    file: &dyn VfsFile,
    mut visit: impl FnMut(Tag, &[u8]) -> bool,
) -> Result<JournalScan, ReadFailure> {
    let size = retry(|| file.metadata())?.size;
    let mut reader = BufReader::with_capacity(1 << 16, SequentialReader { file, offset: 0 }.take(size));
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
    Ok(JournalScan { header, records, valid, size })
}

fn read_header(reader: &mut impl BufRead, size: u64) -> Result<(JournalHeader, u64), ReadFailure> {
    let short = ReadFailure::Damaged("it ends within its header");
    let mut fixed = [0; 16];
    if !fill(reader, &mut fixed)? {
        return Err(if size == 0 { ReadFailure::Damaged("it is empty") } else { short });
    }
    if fixed[..8] != MAGIC {
        return Err(ReadFailure::Damaged("it does not start with the mark of a journal"));
    }
    let (version, length) = (number(&fixed[8..12]), number(&fixed[12..16]) as usize);
    if length > LONGEST_TEXT || length as u64 > size {
        return Err(ReadFailure::Damaged("its header has an impossible length"));
    }
    let mut text = vec![0; length + 4];
    if !fill(reader, &mut text)? {
        return Err(short);
    }
    let (text, sum) = text.split_at(length);
    // A fuzzer cannot guess a checksum; what follows must be safe without one.
    if checksum_of(&[&fixed, text]) != number(sum) && !cfg!(fuzzing) {
        return Err(ReadFailure::Damaged("the checksum of its header is wrong"));
    }
    if version == 0 {
        return Err(ReadFailure::Damaged("its version is 0"));
    }
    if version > VERSION {
        return Err(ReadFailure::Newer(version));
    }
    let header =
        serde_json::from_slice(text).map_err(|_| ReadFailure::Damaged("its header cannot be parsed"))?;
    Ok((header, (fixed.len() + length + 4) as u64))
}

/// Reads the next record into `bytes`; `None` at the end of the file or where the record is not valid.
fn read_record(
    reader: &mut impl BufRead,
    bytes: &mut Vec<u8>,
    left: u64,
    journal: u64,
    record: u64,
) -> Result<Option<Tag>, ReadFailure> {
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
    let right =
        record_checksum(journal, record, length, frame[4], bytes) == number(&frame[5..]) || cfg!(fuzzing);
    Ok(right.then_some(tag))
}

/// Fills `bytes`. Returns `false` when the file ends first; a disk error stays an error, because it does not mean
/// that the journal is damaged.
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

/// Reads a file sequentially from its start.
struct SequentialReader<'a> {
    file: &'a dyn VfsFile,
    offset: u64,
}

impl Read for SequentialReader<'_> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let got = retry(|| self.file.read_at(bytes, self.offset))?;
        self.offset += got as u64;
        Ok(got)
    }
}

#[cfg(test)]
mod tests {
    use super::checksum_of;

    #[test]
    fn the_checksum_is_the_crc_32c_of_the_standard() {
        // RFC 3720, B.4.
        assert_eq!(checksum_of(&[&[0; 32]]), 0x8a91_36aa);
        assert_eq!(checksum_of(&[&[0xff; 32]]), 0x62a8_ab43);
        let ascending: Vec<u8> = (0..32).collect();
        assert_eq!(checksum_of(&[&ascending]), 0x46dd_794e);
        assert_eq!(checksum_of(&[b"123456789"]), 0xe306_9283);
        assert_eq!(checksum_of(&[b"1234", b"", b"56789"]), 0xe306_9283);
    }
}
