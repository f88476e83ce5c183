//! Statements of OBJ and MTL texts: a keyword and its values, on one line or on several that end in a backslash.

use crate::format::text::{Lexicon, TextScanner, TextToken};
use crate::format::{ImportContext, ImportError, Place};
use std::borrow::Cow;

/// Returns the text in UTF-8; UTF-16 is recognized by its byte order mark.
pub(super) fn decoded<'a>(
    bytes: &'a [u8],
    context: &ImportContext<'_>,
) -> Result<Cow<'a, [u8]>, ImportError> {
    if matches!(bytes, [0xfe, 0xff, ..] | [0xff, 0xfe, ..]) {
        // Three bytes at most for each two, while the text doubles in size.
        context.charge(&Place::File, bytes.len() as u64 * 3)?;
        context.work(bytes.len())?;
    }
    Ok(in_utf_8(bytes))
}

/// Returns the text in UTF-8, without counting.
pub(super) fn in_utf_8(bytes: &[u8]) -> Cow<'_, [u8]> {
    let unit: fn([u8; 2]) -> u16 = match bytes {
        [0xfe, 0xff, ..] => u16::from_be_bytes,
        [0xff, 0xfe, ..] => u16::from_le_bytes,
        _ => return Cow::Borrowed(bytes),
    };
    let units = bytes[2..].chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
    let text: String =
        char::decode_utf16(units).map(|unit| unit.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
    Cow::Owned(text.into_bytes())
}

/// A statement.
#[derive(Clone, Copy)]
pub(super) struct Statement<'s, 'a> {
    /// The text that the statement is part of.
    bytes: &'a [u8],
    pub(super) keyword: TextToken<'a>,
    pub(super) values: &'s [TextToken<'a>],
}

impl Statement<'_, '_> {
    /// Returns the values as one text with its blanks: a name.
    pub(super) fn name(&self) -> String {
        self.name_from(0)
    }

    /// Returns the values from number `first` on as one text.
    pub(super) fn name_from(&self, first: usize) -> String {
        let values = self.values.get(first..).unwrap_or(&[]);
        let (Some(start), Some(end)) = (values.first(), values.last()) else { return String::new() };
        String::from_utf8_lossy(&self.bytes[start.at..end.at + end.text.len()]).into_owned()
    }
}

/// Returns the scanner that finds the places of a text and reads its numbers.
pub(super) fn places(bytes: &[u8]) -> TextScanner<'_> {
    TextScanner::new(bytes, &Lexicon::WORDS)
}

/// Reads the statements of a text one after the other.
pub(super) struct StatementReader<'a> {
    bytes: &'a [u8],
    at: usize,
    values: Vec<TextToken<'a>>,
}

impl<'a> StatementReader<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: places(bytes).at(), values: Vec::new() }
    }

    /// Returns the offset from which the next statement is searched.
    pub(super) fn at(&self) -> usize {
        self.at
    }

    /// Continues at another offset.
    pub(super) fn go_to(&mut self, at: usize) {
        self.at = at;
    }

    /// Returns the next statement; `None` at the end of the text.
    pub(super) fn next(
        &mut self,
        context: &ImportContext<'_>,
        places: &TextScanner<'_>,
    ) -> Result<Option<Statement<'_, 'a>>, ImportError> {
        let mut keyword = None;
        self.values.clear();
        while let Some(&byte) = self.bytes.get(self.at) {
            match byte {
                b'\n' | b'\r' if keyword.is_some() => break,
                b'\\' if self.continues() => {
                    self.at += 1 + usize::from(self.bytes[self.at + 1..].starts_with(b"\r\n")) + 1
                }
                0..=b' ' => self.at += 1,
                b'#' => {
                    let rest = &self.bytes[self.at..];
                    let is_end = |byte: &u8| matches!(byte, b'\n' | b'\r');
                    self.at += rest.iter().position(is_end).unwrap_or(rest.len());
                }
                _ => {
                    let start = self.at;
                    while let Some(&byte) = self.bytes.get(self.at) {
                        if byte <= b' ' || (byte == b'\\' && self.continues()) {
                            break;
                        }
                        self.at += 1;
                    }
                    let token = TextToken { text: &self.bytes[start..self.at], at: start };
                    if keyword.is_none() {
                        keyword = Some(token);
                        continue;
                    }
                    if self.values.len() == self.values.capacity() {
                        let more = self.values.len().max(64);
                        let bytes = (self.values.len() + more) * size_of::<TextToken<'_>>();
                        context.charge(&places.place(start), bytes as u64)?;
                        self.values.reserve_exact(more);
                    }
                    self.values.push(token);
                }
            }
        }
        Ok(keyword.map(|keyword| Statement { bytes: self.bytes, keyword, values: &self.values }))
    }

    /// Returns whether a line end follows the backslash at the current position.
    fn continues(&self) -> bool {
        matches!(self.bytes.get(self.at + 1), Some(b'\n' | b'\r'))
    }
}
