//! The part of the text at the cursor: the name of an element, of an attribute, or a value.

use super::tokens::{ScriptToken, TokenKind, tokens};
use crate::stage::table::{ElementRow, element};
use std::ops::Range;

/// The place of the cursor in a text.
#[derive(Debug, PartialEq)]
pub(super) enum CursorPlace<'a> {
    /// In the name of an element, inside of another one; `None` at the start of the text.
    Element {
        /// The bytes of the name.
        typed: Range<usize>,
        /// Name of the element around.
        around: Option<&'a str>,
    },
    /// In the name of an end tag.
    End {
        /// The bytes of the name.
        typed: Range<usize>,
        /// Name of the element around.
        around: &'a str,
    },
    /// In the name of an attribute, or where one may be.
    Attribute {
        /// The bytes of the name.
        typed: Range<usize>,
        /// The tag that it is in.
        tag: OpenTag<'a>,
    },
    /// In a value.
    Value {
        /// The bytes from the start of the value to the cursor.
        typed: Range<usize>,
        /// The bytes of the whole value without its quotes.
        whole: Range<usize>,
        /// Name of the attribute.
        attribute: &'a str,
        /// The tag that it is in.
        tag: OpenTag<'a>,
    },
}

/// A start tag.
#[derive(Debug, PartialEq)]
pub(super) struct OpenTag<'a> {
    /// Name of the element.
    pub(super) name: &'a str,
    /// Its attributes with their values.
    pub(super) attributes: Vec<(&'a str, &'a str)>,
}

impl OpenTag<'_> {
    /// Returns the row of the element.
    pub(super) fn row(&self) -> Option<&'static ElementRow> {
        element(self.name)
    }

    /// Returns the value of an attribute.
    pub(super) fn value(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(other, _)| *other == name).map(|(_, value)| *value)
    }
}

/// Returns the place of the cursor at byte `at`; `None` between elements, in comments, and for no boundary of a character.
pub(super) fn place(text: &str, at: usize) -> Option<CursorPlace<'_>> {
    text.get(..at)?;
    let all = tokens(text);
    let of = |token: &ScriptToken| text.get(token.range.clone()).unwrap_or_default();
    let before = all.partition_point(|token| token.range.start < at);
    let last = all[..before].last()?;
    let inside = at < last.range.end;
    if matches!(last.kind, TokenKind::Comment | TokenKind::Declaration) {
        return None;
    }
    let open = all[..before].iter().rposition(|token| matches!(of(token), "<" | "</"))?;
    let ends = |token: &ScriptToken| token.kind == TokenKind::Sign && matches!(of(token), ">" | "/>");
    if all[open..before].iter().any(|token| ends(token) && token.range.end <= at) {
        return None;
    }
    let around = stack(text, &all[..open]).pop();
    let name = all.get(open + 1).filter(|token| token.kind == TokenKind::Element);
    let Some(name) = name.filter(|name| name.range.start <= at && name.range.start == all[open].range.end)
    else {
        return Some(named(text, &all[open], at..at, around));
    };
    if at <= name.range.end {
        return Some(named(text, &all[open], name.range.start..at.max(name.range.start), around));
    }
    if of(&all[open]) == "</" {
        return None;
    }
    let close = all[open + 1..].iter().position(|token| ends(token) || of(token) == "<" || of(token) == "</");
    let parts = &all[open + 1..close.map_or(all.len(), |close| open + 1 + close)];
    let tag = OpenTag { name: of(name), attributes: attributes(text, parts) };
    match last.kind {
        TokenKind::Value if inside || !is_closed(of(last)) => {
            let attribute = parts
                .iter()
                .rev()
                .find(|token| token.kind == TokenKind::Attribute && token.range.end <= last.range.start)?;
            let end = last.range.end - usize::from(is_closed(of(last)));
            let whole = last.range.start + 1..end.max(last.range.start + 1);
            Some(CursorPlace::Value {
                typed: whole.start..at.max(whole.start),
                whole,
                attribute: of(attribute),
                tag,
            })
        }
        TokenKind::Attribute if at <= last.range.end => {
            Some(CursorPlace::Attribute { typed: last.range.start..at, tag })
        }
        // A name may begin only after a blank.
        _ if text.get(..at)?.ends_with([' ', '\t', '\n', '\r']) => {
            Some(CursorPlace::Attribute { typed: at..at, tag })
        }
        _ => None,
    }
}

fn named<'a>(
    text: &str,
    open: &ScriptToken,
    typed: Range<usize>,
    around: Option<&'a str>,
) -> CursorPlace<'a> {
    match (text.get(open.range.clone()), around) {
        (Some("</"), Some(around)) => CursorPlace::End { typed, around },
        _ => CursorPlace::Element { typed, around },
    }
}

fn is_closed(value: &str) -> bool {
    value.len() > 1 && value.ends_with(['"', '\'']) && value.chars().next() == value.chars().next_back()
}

/// Returns the attributes of a tag with their values.
fn attributes<'a>(text: &'a str, parts: &[ScriptToken]) -> Vec<(&'a str, &'a str)> {
    let of = |token: &ScriptToken| text.get(token.range.clone()).unwrap_or_default();
    let mut found: Vec<(&str, &str)> = Vec::new();
    for token in parts {
        match token.kind {
            TokenKind::Attribute => found.push((of(token), "")),
            TokenKind::Value => {
                if let Some((_, value)) = found.last_mut() {
                    *value = of(token).trim_matches(['"', '\'']);
                }
            }
            TokenKind::Sign | TokenKind::Element | TokenKind::Comment | TokenKind::Declaration => {}
        }
    }
    found
}

/// Returns the names of the elements that are open after these tokens, the innermost last.
fn stack<'a>(text: &'a str, before: &[ScriptToken]) -> Vec<&'a str> {
    let of = |token: &ScriptToken| text.get(token.range.clone()).unwrap_or_default();
    let (mut open, mut is_end) = (Vec::new(), false);
    for token in before {
        match (token.kind, of(token)) {
            (TokenKind::Sign, "<") => is_end = false,
            (TokenKind::Sign, "</") => is_end = true,
            (TokenKind::Element, name) if is_end => {
                if let Some(at) = open.iter().rposition(|other| *other == name) {
                    open.truncate(at);
                }
            }
            (TokenKind::Element, name) => open.push(name),
            (TokenKind::Sign, "/>") => {
                open.pop();
            }
            _ => {}
        }
    }
    open
}
