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
/// A quote that is not closed ends at the end of its line, so that one does not color the rest of the text.
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
        let line = rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
        let end = match closed {
            // A value may have several lines; one that contains the start of an element was not closed.
            Some(closed) if closed < line || !rest[..closed].contains(&b'<') => self.at + closed + 2,
            Some(_) | None => self.at + 1 + line,
        };
        self.add(TokenKind::Value, end);
    }
}
