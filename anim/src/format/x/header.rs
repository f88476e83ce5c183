//! The header of 16 bytes, and the text or the tokens after it.

use super::check as code;
use super::inflate::{HEADER, inflate};
use super::lexer::XLexer;
use crate::format::{ImportContext, ImportError, Place};
use std::borrow::Cow;

/// What a file consists of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum XEncoding {
    Text,
    Binary,
    CompressedText,
    CompressedBinary,
}

impl XEncoding {
    pub(super) fn is_binary(self) -> bool {
        matches!(self, Self::Binary | Self::CompressedBinary)
    }
}

/// An opened file: its bytes with the header, not compressed.
pub(super) struct XFile<'a> {
    pub(super) encoding: XEncoding,
    bytes: Cow<'a, [u8]>,
    /// Whether a float of the binary encoding has 64 bits.
    is_wide: bool,
}

impl<'a> XFile<'a> {
    pub(super) fn open(bytes: &'a [u8], context: &ImportContext<'_>) -> Result<Self, ImportError> {
        let invalid = |at: u64, reason: &str| {
            let (place, reason) = (Place::Byte(at), reason.to_owned());
            Err(ImportError::Invalid { place, code: code::HEADER_INVALID, reason })
        };
        let Some(header) = bytes.get(..HEADER) else {
            return invalid(bytes.len() as u64, "the header has 16 bytes, the file ends before");
        };
        if !header.starts_with(b"xof ") {
            return invalid(0, "the file does not start with \"xof \"");
        }
        if !matches!(&header[4..8], b"0302" | b"0303") {
            let version = String::from_utf8_lossy(&header[4..8]).into_owned();
            let text = format!("version \"{version}\" is not known; the file is read as version 0303");
            context.warn(Place::Byte(4), code::VERSION_UNKNOWN, text);
        }
        let encoding = match &header[8..12] {
            b"txt " => XEncoding::Text,
            b"bin " => XEncoding::Binary,
            b"tzip" => XEncoding::CompressedText,
            b"bzip" => XEncoding::CompressedBinary,
            _ => return invalid(8, "the encoding is none of \"txt \", \"bin \", \"tzip\" and \"bzip\""),
        };
        let is_wide = match &header[12..16] {
            b"0064" => true,
            b"0032" => false,
            _ if !encoding.is_binary() => false,
            _ => return invalid(12, "the size of floats is neither \"0032\" nor \"0064\""),
        };
        let bytes = match encoding {
            XEncoding::Text | XEncoding::Binary => Cow::Borrowed(bytes),
            XEncoding::CompressedText | XEncoding::CompressedBinary => Cow::Owned(inflate(bytes, context)?),
        };
        Ok(Self { encoding, bytes, is_wide })
    }

    /// Returns the bytes with the header, not compressed.
    pub(super) fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Returns a lexer after the header.
    pub(super) fn lexer(&self) -> XLexer<'_> {
        XLexer::new(&self.bytes, self.encoding.is_binary(), self.is_wide)
    }
}
