//! Start tags, read again from the text, because a tree leaves out the attributes of other namespaces.

use crate::stage::script::ScriptElement;
use std::ops::Range;

/// A start tag of a text that is XML.
pub(super) struct StartTag {
    /// The byte after the name of the element.
    pub(super) name_end: usize,
    /// Bytes of each attribute: name, `=` and value with its quotes.
    pub(super) attributes: Vec<Range<usize>>,
    /// The byte of `>` or `/>`.
    pub(super) close: usize,
    /// Whether it ends with `/>`, so that there is no end tag.
    pub(super) is_empty: bool,
}

impl StartTag {
    pub(super) fn of(text: &str, element: &ScriptElement) -> Self {
        let bytes = text.as_bytes();
        let find = |from: usize, is_found: &dyn Fn(u8) -> bool| {
            let rest = bytes.get(from..).unwrap_or_default();
            rest.iter().position(|&byte| is_found(byte)).map_or(bytes.len(), |at| from + at)
        };
        let mut tag = Self {
            name_end: element.name.end,
            attributes: Vec::new(),
            close: element.range.end,
            is_empty: false,
        };
        let mut at = element.name.end;
        loop {
            at = find(at, &|byte| !byte.is_ascii_whitespace());
            match bytes.get(at) {
                None => return tag,
                Some(b'>' | b'/') => {
                    (tag.close, tag.is_empty) = (at, bytes.get(at) == Some(&b'/'));
                    return tag;
                }
                Some(_) => {
                    let open = find(at, &|byte| matches!(byte, b'"' | b'\''));
                    let quote = bytes.get(open).copied().unwrap_or(b'"');
                    let end = (find(open + 1, &|byte| byte == quote) + 1).min(bytes.len());
                    tag.attributes.push(at..end);
                    at = end;
                }
            }
        }
    }

    /// Returns the byte after the last attribute, or after the name where there is none.
    pub(super) fn content_end(&self) -> usize {
        self.attributes.last().map_or(self.name_end, |last| last.end)
    }

    /// Returns the byte after the tag.
    pub(super) fn end(&self) -> usize {
        self.close + if self.is_empty { 2 } else { 1 }
    }
}
