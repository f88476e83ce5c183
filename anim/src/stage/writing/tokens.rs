//! The parts of a text of XML, broken or not.

use std::ops::Range;

/// A kind of part of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TokenKind {
    /// `<`, `</`, `>`, `/>`, `=`.
    Sign,
    /// The name of an element.
    Element,
    /// The name of an attribute.
    Attribute,
    /// A value with its quotes.
    Value,
    /// A comment.
    Comment,
    /// `<?xml … ?>` and the like.
    Declaration,
}

/// A part of a text. Blanks and text between elements are no tokens.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScriptToken {
    /// Its kind.
    pub kind: TokenKind,
    /// Its bytes.
    pub range: Range<usize>,
}

/// Returns the parts of a text in its order. They do not overlap, and their ends are boundaries of characters.
///
/// A quote that is not closed ends in front of the next attribute, or at the end of its line, so that one does not color the rest of the
/// text.
pub fn tokens(text: &str) -> Vec<ScriptToken> {
    let mut lexer = ScriptLexer { bytes: text.as_bytes(), at: 0, found: Vec::with_capacity(text.len() / 8) };
    while let Some(open) = lexer.find(lexer.at, b'<') {
        lexer.at = open;
        lexer.markup();
    }
    lexer.found
}

struct ScriptLexer<'a> {
    bytes: &'a [u8],
    at: usize,
    found: Vec<ScriptToken>,
}

impl ScriptLexer<'_> {
    fn find(&self, from: usize, byte: u8) -> Option<usize> {
        let rest = self.bytes.get(from..)?;
        rest.iter().position(|&other| other == byte).map(|at| from + at)
    }

    /// Returns the end of what begins at `self.at` and ends with `end`; the end of the text where that is missing.
    fn until(&self, end: &[u8]) -> usize {
        let rest = &self.bytes[self.at..];
        let found = rest.windows(end.len()).position(|part| part == end);
        found.map_or(self.bytes.len(), |at| self.at + at + end.len())
    }

    fn add(&mut self, kind: TokenKind, end: usize) {
        self.found.push(ScriptToken { kind, range: self.at..end });
        self.at = end;
    }

    /// Reads what begins with `<`.
    fn markup(&mut self) {
        let rest = &self.bytes[self.at..];
        if rest.starts_with(b"<!--") {
            let end = self.until(b"-->");
            return self.add(TokenKind::Comment, end);
        }
        if rest.starts_with(b"<?") {
            let end = self.until(b"?>");
            return self.add(TokenKind::Declaration, end);
        }
        if rest.starts_with(b"<!") {
            let end = self.until(b">");
            return self.add(TokenKind::Declaration, end);
        }
        let open = if rest.starts_with(b"</") { 2 } else { 1 };
        self.add(TokenKind::Sign, self.at + open);
        self.name(TokenKind::Element);
        self.tag();
    }

    fn name(&mut self, kind: TokenKind) {
        let rest = &self.bytes[self.at..];
        let ends = |byte: &u8| {
            byte.is_ascii_whitespace() || matches!(byte, b'<' | b'>' | b'/' | b'=' | b'"' | b'\'')
        };
        let length = rest.iter().position(ends).unwrap_or(rest.len());
        if length > 0 {
            self.add(kind, self.at + length);
        }
    }

    /// Reads what follows the name of an element, to its `>` or to the next `<`.
    fn tag(&mut self) {
        while let Some(&byte) = self.bytes.get(self.at) {
            match byte {
                b'<' => return,
                b'>' => return self.add(TokenKind::Sign, self.at + 1),
                b'/' if self.bytes.get(self.at + 1) == Some(&b'>') => {
                    return self.add(TokenKind::Sign, self.at + 2);
                }
                b'=' | b'/' => self.add(TokenKind::Sign, self.at + 1),
                b'"' | b'\'' => self.value(byte),
                byte if byte.is_ascii_whitespace() => self.at += 1,
                _ => self.name(TokenKind::Attribute),
            }
        }
    }

    fn value(&mut self, quote: u8) {
        let rest = &self.bytes[self.at + 1..];
        let closed = rest.iter().position(|&byte| byte == quote);
        // Looked for only as far as the value goes, since a text may be one long line.
        let until = &rest[..closed.unwrap_or(rest.len())];
        let line = until.iter().position(|&byte| byte == b'\n');
        let length = match closed {
            // A value may have several lines; one that contains the start of an element was not closed.
            Some(closed) if line.is_none() || !until.contains(&b'<') => {
                let next = opens_another(rest, closed).then(|| next_attribute(until)).flatten();
                next.unwrap_or(closed + 1)
            }
            Some(_) | None => {
                let first = &until[..line.unwrap_or(until.len())];
                next_attribute(first).unwrap_or_else(|| without_end(first))
            }
        };
        self.add(TokenKind::Value, self.at + 1 + length);
    }
}

/// Returns whether the quote that seems to close a value opens the next one: `NAME=` is before it, and neither a blank nor the end of the
/// tag is after it.
fn opens_another(rest: &[u8], closed: usize) -> bool {
    let next = rest.get(closed + 1);
    rest[..closed].trim_ascii_end().ends_with(b"=")
        && next.is_some_and(|&byte| !byte.is_ascii_whitespace() && !matches!(byte, b'/' | b'>' | b'?'))
}

/// Returns the start of the blanks before the first `NAME=` that a quote follows, or the end of `value`.
fn next_attribute(value: &[u8]) -> Option<usize> {
    let mut at = 0;
    while at < value.len() {
        let blanks = at + value[at..].iter().position(u8::is_ascii_whitespace)?;
        let skip = |from: usize, is_in: fn(&u8) -> bool| {
            from + value[from..].iter().position(|byte| !is_in(byte)).unwrap_or(value.len() - from)
        };
        let name = skip(blanks, u8::is_ascii_whitespace);
        let end = skip(name, |byte| byte.is_ascii_alphanumeric() || matches!(byte, b'-' | b'_' | b':'));
        let sign = skip(end, u8::is_ascii_whitespace);
        if end > name && value[name].is_ascii_alphabetic() && value.get(sign) == Some(&b'=') {
            let quote = value.get(skip(sign + 1, u8::is_ascii_whitespace));
            if quote.is_none_or(|quote| matches!(quote, b'"' | b'\'')) {
                return Some(blanks);
            }
        }
        at = end.max(name).max(blanks + 1);
    }
    None
}

/// Returns the length of a line without the end of a tag that is at its end.
fn without_end(line: &[u8]) -> usize {
    let text = line.trim_ascii_end();
    let inside = text.strip_suffix(b"/>").or_else(|| text.strip_suffix(b">"));
    inside.map_or(line.len(), <[u8]>::len)
}
