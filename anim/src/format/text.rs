//! A scanner of text files: tokens with their places, and numbers.
//!
//! A token ends at white space. A format can add separators (`;` in DirectX files), characters that are a token on their own
//! (`{`), and comments. Positions are offsets in bytes; [`TextScanner::place`] turns one into line and column.

use super::decimal::{parse_number, parse_whole, short_decimal, single};
use super::{ImportError, Place};
use std::cell::Cell;

/// Code of an error where the text ends too early.
pub(super) const UNEXPECTED_END: &str = "UNEXPECTED_END";

/// Code of an error where something else was expected.
pub(super) const UNEXPECTED_TOKEN: &str = "UNEXPECTED_TOKEN";

/// Code of an error where a number was expected, or one in range.
pub(super) const NUMBER_INVALID: &str = "NUMBER_INVALID";

/// Treatment of one byte.
#[derive(Clone, Copy, PartialEq)]
enum ByteClass {
    /// Separates tokens.
    Blank,
    /// A token on its own.
    Single,
    /// Part of a token.
    Word,
    /// Part of a token; at its start, possibly that of a comment.
    Mark,
}

impl ByteClass {
    /// Returns whether a byte is part of the token to which the byte before it belongs.
    fn continues(self) -> bool {
        match self {
            Self::Word | Self::Mark => true,
            Self::Blank | Self::Single => false,
        }
    }
}

/// How a format divides text into tokens.
#[derive(Clone, Copy)]
pub(super) struct Lexicon {
    classes: [ByteClass; 256],
    comments: &'static [&'static [u8]],
}

impl Lexicon {
    /// Tokens separated by white space, nothing else.
    pub(super) const WORDS: Self = Self::new(b"", b"", &[]);

    /// Returns a lexicon with further separators, characters that are a token on their own, and the texts that start a
    /// comment to the end of the line.
    pub(super) const fn new(separators: &[u8], single: &[u8], comments: &'static [&'static [u8]]) -> Self {
        let mut classes = [ByteClass::Word; 256];
        let mut byte = 0;
        while byte <= b' ' as usize {
            classes[byte] = ByteClass::Blank;
            byte += 1;
        }
        let mut index = 0;
        while index < comments.len() {
            classes[comments[index][0] as usize] = ByteClass::Mark;
            index += 1;
        }
        let mut index = 0;
        while index < separators.len() {
            classes[separators[index] as usize] = ByteClass::Blank;
            index += 1;
        }
        let mut index = 0;
        while index < single.len() {
            classes[single[index] as usize] = ByteClass::Single;
            index += 1;
        }
        Self { classes, comments }
    }

    fn class(&self, byte: u8) -> ByteClass {
        self.classes[usize::from(byte)]
    }
}

/// A token: its bytes, and their offset in the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TextToken<'a> {
    /// The bytes; never empty.
    pub(super) text: &'a [u8],
    /// Offset of the first byte.
    pub(super) at: usize,
}

impl TextToken<'_> {
    /// Returns whether the token is `word`, in any case.
    pub(super) fn is(&self, word: &str) -> bool {
        self.text.eq_ignore_ascii_case(word.as_bytes())
    }

    /// Returns the token for a message.
    pub(super) fn shown(&self) -> String {
        shown(self.text)
    }
}

/// Reads tokens and numbers from the bytes of a text.
pub(super) struct TextScanner<'a> {
    bytes: &'a [u8],
    at: usize,
    lexicon: &'a Lexicon,
    counted: Cell<CountedLine>,
}

/// Line of an offset, from which later offsets are counted.
#[derive(Clone, Copy)]
struct CountedLine {
    at: usize,
    line: u32,
    start: usize,
}

const FIRST_LINE: CountedLine = CountedLine { at: 0, line: 1, start: 0 };

impl<'a> TextScanner<'a> {
    /// Returns a scanner at the start of a text, after its byte order mark if there is one.
    pub(super) fn new(bytes: &'a [u8], lexicon: &'a Lexicon) -> Self {
        let at = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Self { bytes, at, lexicon, counted: Cell::new(FIRST_LINE) }
    }

    /// Returns the offset of the next byte.
    pub(super) fn at(&self) -> usize {
        self.at
    }

    /// Returns the number of bytes that are left.
    pub(super) fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// Continues at another offset.
    pub(super) fn go_to(&mut self, at: usize) {
        self.at = at.min(self.bytes.len());
    }

    /// Returns line and column of an offset. Fast where the offsets of successive calls ascend.
    pub(super) fn place(&self, at: usize) -> Place {
        let at = at.min(self.bytes.len());
        let mut counted = self.counted.get();
        if at < counted.at {
            counted =
                if at < counted.start { FIRST_LINE } else { CountedLine { at: counted.start, ..counted } };
        }
        let (lines, start) = line_ends(self.bytes, counted.at, at);
        counted.line = counted.line.saturating_add(lines);
        counted.start = start.unwrap_or(counted.start);
        counted.at = at;
        self.counted.set(counted);
        let column = u32::try_from(at - counted.start + 1).unwrap_or(u32::MAX);
        Place::Line(counted.line, column)
    }

    /// Skips separators and comments.
    #[inline]
    pub(super) fn skip_blank(&mut self) {
        while let Some(&byte) = self.bytes.get(self.at) {
            match self.lexicon.class(byte) {
                ByteClass::Blank => self.at += 1,
                ByteClass::Mark if self.is_comment() => self.skip_line(),
                ByteClass::Mark | ByteClass::Single | ByteClass::Word => break,
            }
        }
    }

    /// Returns whether a comment starts at the next byte.
    fn is_comment(&self) -> bool {
        let rest = &self.bytes[self.at..];
        self.lexicon.comments.iter().any(|comment| rest.starts_with(comment))
    }

    /// Skips the rest of the line, without its end.
    pub(super) fn skip_line(&mut self) {
        let rest = &self.bytes[self.at..];
        self.at += rest.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(rest.len());
    }

    /// Returns the bytes up to the first `end`, without it, and skips them; `None`, and nothing is skipped, where there
    /// is none.
    pub(super) fn until(&mut self, end: u8) -> Option<TextToken<'a>> {
        let at = self.at;
        let length = self.bytes[at..].iter().position(|&byte| byte == end)?;
        self.at += length;
        Some(TextToken { text: &self.bytes[at..at + length], at })
    }

    /// Returns the bytes up to `end` or the end of the line, without it, and skips them.
    pub(super) fn line_until(&mut self, end: u8) -> TextToken<'a> {
        let (at, rest) = (self.at, &self.bytes[self.at..]);
        let is_end = |byte: &u8| *byte == end || matches!(byte, b'\n' | b'\r');
        let length = rest.iter().position(is_end).unwrap_or(rest.len());
        self.at += length;
        TextToken { text: &rest[..length], at }
    }

    /// Returns the next token; `None` at the end of the text.
    #[inline]
    pub(super) fn token(&mut self) -> Option<TextToken<'a>> {
        self.skip_blank();
        let at = self.at;
        let first = self.lexicon.class(*self.bytes.get(at)?);
        let mut end = at + 1;
        if first.continues() {
            while self.bytes.get(end).is_some_and(|&byte| self.lexicon.class(byte).continues()) {
                end += 1;
            }
        }
        self.at = end;
        Some(TextToken { text: &self.bytes[at..end], at })
    }

    /// Returns the next token without skipping it.
    pub(super) fn peek(&mut self) -> Option<TextToken<'a>> {
        let token = self.token()?;
        self.at = token.at;
        Some(token)
    }

    /// Returns the next token; an error at the end of the text. `what` describes what was expected.
    pub(super) fn need(&mut self, what: &str) -> Result<TextToken<'a>, ImportError> {
        self.token().ok_or_else(|| {
            let reason = format!("the text ends where {what} was expected");
            self.invalid(self.bytes.len(), UNEXPECTED_END, reason)
        })
    }

    /// Skips the token `word`, in any case; any other one is an error.
    pub(super) fn expect(&mut self, word: &str) -> Result<TextToken<'a>, ImportError> {
        let token = self.need(&format!("\"{word}\""))?;
        if token.is(word) { Ok(token) } else { Err(self.unexpected(token, &format!("\"{word}\""))) }
    }

    /// Returns the next token, and skips it, if it is a decimal number of few digits.
    #[inline]
    pub(super) fn short_number(&mut self) -> Option<f64> {
        self.skip_blank();
        let (number, length) = short_decimal(self.bytes.get(self.at..)?)?;
        let end = self.at + length;
        if self.bytes.get(end).is_some_and(|&byte| self.lexicon.class(byte).continues()) {
            return None;
        }
        self.at = end;
        Some(number)
    }

    /// Returns the next token as a number; `what` describes it.
    #[inline]
    pub(super) fn number(&mut self, what: &str) -> Result<f64, ImportError> {
        if let Some(number) = self.short_number() {
            return Ok(number);
        }
        let token = self.need(what)?;
        self.number_of(token, what)
    }

    /// Returns the next token as a number in single precision, which is finite; `what` describes it.
    #[inline]
    pub(super) fn float(&mut self, what: &str) -> Result<f32, ImportError> {
        let token = self.need(what)?;
        self.float_of(token, what)
    }

    /// Returns a token as a number in single precision, which is finite; `what` describes it.
    #[inline]
    pub(super) fn float_of(&self, token: TextToken<'_>, what: &str) -> Result<f32, ImportError> {
        let number = single(self.number_of(token, what)?, token.text);
        if number.is_finite() {
            return Ok(number);
        }
        let reason = format!("{} is too large for {what}", token.shown());
        Err(self.invalid(token.at, NUMBER_INVALID, reason))
    }

    /// Returns the next token as a whole number of at most `limit`; `what` describes it.
    pub(super) fn whole(&mut self, what: &str, limit: u64) -> Result<u64, ImportError> {
        let token = self.need(what)?;
        match parse_whole(token.text) {
            Some(number) if number <= limit => Ok(number),
            Some(number) => {
                let reason = format!("{number} is too large for {what}, at most {limit}");
                Err(self.invalid(token.at, NUMBER_INVALID, reason))
            }
            None => {
                let reason = format!("{} is no whole number where {what} was expected", token.shown());
                Err(self.invalid(token.at, NUMBER_INVALID, reason))
            }
        }
    }

    /// Returns a token as a finite number; `what` describes it.
    #[inline]
    pub(super) fn number_of(&self, token: TextToken<'_>, what: &str) -> Result<f64, ImportError> {
        // With what follows the token, eight characters are there at once.
        let rest = self.bytes.get(token.at..).unwrap_or(token.text);
        let found = match short_decimal(rest) {
            Some((number, length)) if length == token.text.len() => Some(number),
            Some(_) | None => parse_number(token.text),
        };
        match found {
            Some(number) if number.is_finite() => Ok(number),
            found => Err(self.no_number(token, what, found.is_some())),
        }
    }

    #[cold]
    fn no_number(&self, token: TextToken<'_>, what: &str, is_number: bool) -> ImportError {
        let problem = if is_number { "is not finite" } else { "is no number" };
        let reason = format!("{} {problem} where {what} was expected", token.shown());
        self.invalid(token.at, NUMBER_INVALID, reason)
    }

    /// Returns the error that a token is not `what`.
    #[cold]
    pub(super) fn unexpected(&self, token: TextToken<'_>, what: &str) -> ImportError {
        self.invalid(token.at, UNEXPECTED_TOKEN, format!("{} where {what} was expected", token.shown()))
    }

    /// Returns an error at an offset.
    #[cold]
    pub(super) fn invalid(&self, at: usize, code: &'static str, reason: impl Into<String>) -> ImportError {
        ImportError::Invalid { place: self.place(at), code, reason: reason.into() }
    }
}

/// Returns the number of lines that end in `bytes[from..to]`, and where the line after the last of them starts.
fn line_ends(bytes: &[u8], from: usize, to: usize) -> (u32, Option<usize>) {
    // A line ends with LF, with CR LF or with CR alone.
    let is_end = |byte: u8, next: u8| (byte == b'\n') | ((byte == b'\r') & (next != b'\n'));
    let next = |at: usize| bytes.get(at + 1).copied().unwrap_or(0);
    let (passed, after) = (&bytes[from..to], bytes.get(from + 1..).unwrap_or_default());
    let mut lines = 0;
    // The sum of 128 bytes fits in a byte, so that compilers count many of them at once.
    let (passed, after) = (passed.as_chunks::<128>().0, after.as_chunks::<128>().0);
    for (chunk, after) in passed.iter().zip(after) {
        let count: u8 = chunk.iter().zip(after).map(|(&byte, &next)| u8::from(is_end(byte, next))).sum();
        lines += u32::from(count);
    }
    let rest = from + 128 * passed.len().min(after.len());
    lines += (rest..to).filter(|&at| is_end(bytes[at], next(at))).count() as u32;
    let last = if lines > 0 { (from..to).rev().find(|&at| is_end(bytes[at], next(at))) } else { None };
    (lines, last.map(|at| at + 1))
}

/// Returns text of a file for a message, in quotes and shortened.
pub(super) fn shown(text: &[u8]) -> String {
    const SHOWN: usize = 40;
    let more = if text.len() > SHOWN { "…" } else { "" };
    format!("\"{}{more}\"", String::from_utf8_lossy(&text[..text.len().min(SHOWN)]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use dragonfly_kit::random::{Random, seed};

    const OBJECTS: Lexicon = Lexicon::new(b";,", b"{}", &[b"//", b"#"]);

    fn tokens(text: &str, lexicon: &Lexicon) -> Vec<String> {
        let mut scanner = TextScanner::new(text.as_bytes(), lexicon);
        std::iter::from_fn(|| scanner.token().map(|token| String::from_utf8_lossy(token.text).into_owned()))
            .collect()
    }

    #[test]
    fn tokens_end_at_blanks_separators_and_single_characters() {
        assert_eq!(tokens("\u{feff} a\tb{1;\r\n", &Lexicon::WORDS), ["a", "b{1;"]);
        assert_eq!(tokens("a{1;2,,}// x\rb #c\n/d", &OBJECTS), ["a", "{", "1", "2", "}", "b", "/d"]);
        assert_eq!(tokens("", &OBJECTS), [""; 0]);
    }

    #[test]
    fn places_are_lines_and_columns_for_every_kind_of_line_end_and_in_any_order() {
        let text = b"ab\r\nc\rd\n\ne";
        let scanner = TextScanner::new(text, &Lexicon::WORDS);
        let places = [(1, 1), (1, 2), (1, 3), (1, 4), (2, 1), (2, 2), (3, 1), (3, 2), (4, 1), (5, 1), (5, 2)];
        let forward = (0..places.len()).chain((0..places.len()).rev()).chain([3, 9, 0, 10, 5]);
        for at in forward {
            assert_eq!(scanner.place(at), Place::Line(places[at].0, places[at].1), "{at}");
        }
        assert_eq!(scanner.place(99), Place::Line(5, 2));
    }

    #[test]
    fn lines_are_counted_alike_over_any_distance() {
        let seed = seed(73);
        let mut random = Random::new(seed);
        for _ in 0..200 {
            let ends = random.choice(&[3, 10, 1000]);
            let text: Vec<u8> = (0..700)
                .map(|_| if random.below(ends) == 0 { b"\r\n"[random.below(2)] } else { b'a' })
                .collect();
            let scanner = TextScanner::new(&text, &Lexicon::WORDS);
            let mut at = 0;
            while at <= text.len() {
                // One byte after the other, as an independent count.
                let (mut line, mut column) = (1, 1);
                for index in 0..at {
                    let is_half = text[index] == b'\r' && text.get(index + 1) == Some(&b'\n');
                    let is_end = text[index] == b'\n' || (text[index] == b'\r' && !is_half);
                    (line, column) = if is_end { (line + 1, 1) } else { (line, column + 1) };
                }
                assert_eq!(scanner.place(at), Place::Line(line, column), "seed {seed}, {at}");
                let most = random.choice(&[2, 40, 400]);
                at += 1 + random.below(most);
            }
        }
    }

    #[test]
    fn errors_name_the_place_and_what_was_expected() {
        let errors = |text: &str| {
            let mut scanner = TextScanner::new(text.as_bytes(), &OBJECTS);
            scanner
                .expect("Frame")
                .and_then(|_| scanner.whole("a count", 9))
                .and_then(|_| scanner.float("x"))
                .unwrap_err()
        };
        for (text, error) in [
            ("\n Mesh", "line 2 column 2: \"Mesh\" where \"Frame\" was expected"),
            ("frame", "line 1 column 6: the text ends where a count was expected"),
            ("frame 10", "line 1 column 7: 10 is too large for a count, at most 9"),
            ("frame -1", "line 1 column 7: \"-1\" is no whole number where a count was expected"),
            ("frame 1\nnan", "line 2 column 1: \"nan\" is not finite where x was expected"),
            ("frame 1;;1.2.3", "line 1 column 10: \"1.2.3\" is no number where x was expected"),
            ("frame 1 1e39", "line 1 column 9: \"1e39\" is too large for x"),
        ] {
            assert_eq!(errors(text).to_string(), error);
        }
    }

    #[test]
    fn text_is_read_up_to_a_character() {
        let mut scanner = TextScanner::new(b"ROOT a b {", &OBJECTS);
        scanner.expect("root").unwrap();
        assert_eq!(scanner.until(b'}'), None);
        assert_eq!(scanner.until(b'{').map(|token| (token.text, token.at)), Some((b" a b ".as_slice(), 4)));
        assert_eq!(scanner.peek().map(|token| token.text), Some(b"{".as_slice()));
        assert_eq!(scanner.at(), 9);
        scanner.go_to(4);
        assert_eq!(scanner.line_until(b'{').text, b" a b ");
        scanner.go_to(0);
        scanner.skip_line();
        assert_eq!((scanner.at(), scanner.token()), (10, None));
    }
}
