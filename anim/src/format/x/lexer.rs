//! Tokens of text and binary files alike.

use super::binary::BinaryTokens;
use super::check as code;
use super::inflate::HEADER;
use crate::format::text::{
    Lexicon, NUMBER_INVALID, TextScanner, TextToken, UNEXPECTED_END, UNEXPECTED_TOKEN, shown,
};
use crate::format::{ImportContext, ImportError, Place};
use std::ops::Range;

/// Separators are blanks: every list has its count, and exporters disagree about them.
const LEXICON: Lexicon = Lexicon::new(b";,", b"{}\"<", &[b"//", b"#"]);

/// A token.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum XToken<'a> {
    /// A name, or in a text a number.
    Word(&'a [u8]),
    /// A number of a binary file.
    Number(f64),
    /// A string, without quotes.
    Text(&'a [u8]),
    Open,
    Close,
    /// An identifier of a template, or a token that only templates have.
    Other,
}

/// A token with its place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lexeme<'a> {
    pub(super) token: XToken<'a>,
    pub(super) at: usize,
    pub(super) end: usize,
}

impl Lexeme<'_> {
    pub(super) fn range(&self) -> Range<usize> {
        self.at..self.end
    }

    fn shown(&self) -> String {
        match self.token {
            XToken::Word(text) | XToken::Text(text) => shown(text),
            XToken::Number(number) => format!("\"{number}\""),
            XToken::Open => "\"{\"".to_owned(),
            XToken::Close => "\"}\"".to_owned(),
            XToken::Other => "an identifier".to_owned(),
        }
    }
}

/// Reads tokens.
pub(super) struct XLexer<'a> {
    bytes: &'a [u8],
    text: TextScanner<'a>,
    binary: Option<BinaryTokens<'a>>,
}

impl<'a> XLexer<'a> {
    pub(super) fn new(bytes: &'a [u8], is_binary: bool, is_wide: bool) -> Self {
        let mut text = TextScanner::new(bytes, &LEXICON);
        text.go_to(HEADER);
        let binary = is_binary.then(|| BinaryTokens::new(bytes, HEADER, is_wide));
        Self { bytes, text, binary }
    }

    /// Returns the offset of the next byte.
    pub(super) fn at(&self) -> usize {
        self.binary.map_or(self.text.at(), |binary| binary.at)
    }

    /// Continues at another offset of a text.
    pub(super) fn go_to(&mut self, at: usize) {
        self.text.go_to(at);
    }

    /// Returns a place for a message: line and column of a text, otherwise the offset without compression.
    pub(super) fn place(&self, at: usize) -> Place {
        match self.binary {
            Some(_) => Place::Byte(at as u64),
            None => self.text.place(at),
        }
    }

    pub(super) fn invalid(&self, at: usize, code: &'static str, reason: impl Into<String>) -> ImportError {
        ImportError::Invalid { place: self.place(at), code, reason: reason.into() }
    }

    /// Returns the next token; `None` at the end of the file.
    pub(super) fn next(&mut self) -> Result<Option<Lexeme<'a>>, ImportError> {
        if let Some(mut binary) = self.binary {
            let at = binary.at;
            let token = binary.next().map_err(|(at, reason)| self.invalid(at, UNEXPECTED_TOKEN, reason))?;
            self.binary = Some(binary);
            return Ok(token.map(|token| Lexeme { token, at, end: binary.at }));
        }
        let Some(TextToken { text, at }) = self.text.token() else { return Ok(None) };
        let token = match text {
            b"{" => XToken::Open,
            b"}" => XToken::Close,
            b"\"" => XToken::Text(self.quoted(at, b'"')?),
            b"<" => {
                self.quoted(at, b'>')?;
                XToken::Other
            }
            word => XToken::Word(word),
        };
        Ok(Some(Lexeme { token, at, end: self.text.at() }))
    }

    /// Returns the bytes up to `end`, and skips it.
    fn quoted(&mut self, at: usize, end: u8) -> Result<&'a [u8], ImportError> {
        let Some(text) = self.text.until(end) else {
            let reason = format!("a string has no end: there is no {}", char::from(end));
            return Err(self.text.invalid(at, UNEXPECTED_END, reason));
        };
        self.text.go_to(text.at + text.text.len() + 1);
        Ok(text.text)
    }

    /// Returns the next token; an error at the end of the file. `what` describes what was expected.
    pub(super) fn need(&mut self, what: &str) -> Result<Lexeme<'a>, ImportError> {
        let next = self.next()?;
        next.ok_or_else(|| {
            let reason = format!("the file ends where {what} was expected");
            self.invalid(self.bytes.len(), UNEXPECTED_END, reason)
        })
    }

    #[cold]
    pub(super) fn unexpected(&self, found: Lexeme<'_>, what: &str) -> ImportError {
        self.invalid(found.at, UNEXPECTED_TOKEN, format!("{} where {what} was expected", found.shown()))
    }

    /// Returns the next token as a finite number; `what` describes it.
    #[inline]
    pub(super) fn number(&mut self, what: &str) -> Result<f64, ImportError> {
        if self.binary.is_none()
            && let Some(number) = self.text.short_number()
        {
            return Ok(number);
        }
        let found = self.need(what)?;
        match found.token {
            XToken::Word(text) => self.text.number_of(TextToken { text, at: found.at }, what),
            XToken::Number(number) if number.is_finite() => Ok(number),
            XToken::Number(number) => {
                let reason = format!("{number} is not finite where {what} was expected");
                Err(self.invalid(found.at, NUMBER_INVALID, reason))
            }
            XToken::Text(_) | XToken::Open | XToken::Close | XToken::Other => {
                Err(self.unexpected(found, what))
            }
        }
    }

    /// Returns `N` numbers in single precision.
    #[inline]
    pub(super) fn floats<const N: usize>(&mut self, what: &str) -> Result<[f32; N], ImportError> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.number(what)? as f32;
            if number.abs() > crate::limits::HUGE {
                let reason = format!("{what} is too large");
                return Err(self.invalid(self.at(), code::HUGE_POSITION, reason));
            }
        }
        Ok(numbers)
    }

    /// Returns the next token as a whole number of at most `limit`.
    pub(super) fn whole(&mut self, what: &str, limit: u32) -> Result<u32, ImportError> {
        let at = self.at();
        let number = self.number(what)?;
        let whole = number as u32;
        if f64::from(whole) == number && whole <= limit {
            return Ok(whole);
        }
        let reason = format!("{number} where {what} was expected, a whole number of at most {limit}");
        Err(self.invalid(self.first_of(at), NUMBER_INVALID, reason))
    }

    /// Returns an index below `count`.
    pub(super) fn index(&mut self, what: &str, count: usize) -> Result<u32, ImportError> {
        let at = self.at();
        let index = self.whole(what, u32::MAX)?;
        if (index as usize) < count {
            return Ok(index);
        }
        let reason = format!("{what} is {index}, there are {count}");
        Err(self.invalid(self.first_of(at), code::INDEX_OUT_OF_RANGE, reason))
    }

    /// Returns the number of items of a list; each of them has at least `numbers` numbers, for which there must be text.
    pub(super) fn count(&mut self, what: &str, numbers: usize) -> Result<usize, ImportError> {
        let at = self.at();
        let count = self.whole(what, u32::MAX)? as usize;
        // Two bytes are the least for a number and what separates it from the next.
        let possible = (self.bytes.len() - self.at()).div_ceil(2) / numbers.max(1);
        if count <= possible {
            return Ok(count);
        }
        let reason = format!("{what} is {count}, the file is too short for more than {possible}");
        Err(self.invalid(self.first_of(at), UNEXPECTED_END, reason))
    }

    /// Returns the bytes of a place in the file.
    pub(super) fn text(&self, range: Range<usize>) -> &'a [u8] {
        &self.bytes[range]
    }

    /// Returns the offset of the next token, and of what separates it from the last one in a binary file.
    pub(super) fn next_at(&mut self) -> usize {
        if self.binary.is_none() {
            self.text.skip_blank();
        }
        self.at()
    }

    /// Returns the place of the token that was read last, which was the only one from `before` on.
    pub(super) fn last_of(&self, before: usize) -> Range<usize> {
        self.first_of(before)..self.at()
    }

    /// Returns the offset of the first token from `at` on.
    fn first_of(&self, at: usize) -> usize {
        let mut text = TextScanner::new(self.bytes, &LEXICON);
        text.go_to(at);
        text.skip_blank();
        if self.binary.is_some() { at } else { text.at() }
    }

    /// Returns the next token as a string. Some exporters leave out the quotes.
    pub(super) fn string(&mut self, what: &str) -> Result<Lexeme<'a>, ImportError> {
        let found = self.need(what)?;
        match found.token {
            XToken::Text(_) | XToken::Word(_) => Ok(found),
            XToken::Number(_) | XToken::Open | XToken::Close | XToken::Other => {
                Err(self.unexpected(found, what))
            }
        }
    }

    /// Skips the name of an object, if it has one, and its opening brace. Returns the place of the name.
    pub(super) fn open(&mut self) -> Result<Option<Range<usize>>, ImportError> {
        let mut name: Option<Range<usize>> = None;
        loop {
            let found = self.need("\"{\"")?;
            match found.token {
                XToken::Open => return Ok(name),
                XToken::Word(_) => {
                    let word = self.word_range(found);
                    name = Some(name.map_or(word.clone(), |name| name.start..word.end));
                }
                XToken::Other => {}
                XToken::Close | XToken::Number(_) | XToken::Text(_) => {
                    return Err(self.unexpected(found, "\"{\""));
                }
            }
        }
    }

    /// Returns the place of the letters of a word.
    pub(super) fn word_range(&self, found: Lexeme<'_>) -> Range<usize> {
        match found.token {
            XToken::Word(text) | XToken::Text(text) if self.binary.is_some() => {
                found.end - text.len()..found.end
            }
            _ => found.range(),
        }
    }

    /// Skips the rest of an object, with all objects in it, and its closing brace. Returns the offset of that brace.
    pub(super) fn close(&mut self, context: &ImportContext<'_>) -> Result<usize, ImportError> {
        let start = self.at();
        let mut depth = 1_usize;
        loop {
            context.work(1)?;
            let Some(found) = self.next()? else {
                return Err(self.invalid(start, code::BRACE_INVALID, "the object has no end"));
            };
            match found.token {
                XToken::Open => depth += 1,
                XToken::Close => depth -= 1,
                XToken::Word(_) | XToken::Number(_) | XToken::Text(_) | XToken::Other => {}
            }
            if depth == 0 {
                return Ok(found.at);
            }
        }
    }

    /// Skips a reference `{ name }` after its opening brace. Returns the name; `None` where there is only an identifier.
    pub(super) fn reference(&mut self, context: &ImportContext<'_>) -> Result<Option<String>, ImportError> {
        let mut name: Option<Range<usize>> = None;
        loop {
            context.work(1)?;
            let found = self.need("\"}\"")?;
            match found.token {
                XToken::Close => return Ok(name.map(|name| super::names::decoded(&self.bytes[name]))),
                XToken::Word(_) | XToken::Text(_) => {
                    let word = match found.token {
                        XToken::Text(_) if self.binary.is_none() => found.at + 1..found.end - 1,
                        _ => self.word_range(found),
                    };
                    name = Some(name.map_or(word.clone(), |name| name.start..word.end));
                }
                XToken::Other => {}
                XToken::Open | XToken::Number(_) => return Err(self.unexpected(found, "\"}\"")),
            }
        }
    }
}
