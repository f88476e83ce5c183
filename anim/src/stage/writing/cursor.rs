//! The part of the text at the cursor: the name of an element, of an attribute, or a value.

use super::tokens::{ScriptToken, TokenKind, tokens};
use crate::stage::table::{ElementRow, Vocabulary};
use std::ops::Range;

/// The place of the cursor in a text.
#[derive(Debug, PartialEq)]
pub(super) enum CursorPlace<'a> {
    /// In the name of an element, inside of another one; `None` at the start of the text.
    Element {
        /// The bytes of the name.
        name: Range<usize>,
        /// Whether attributes or the end of the tag follow.
        continues: bool,
        /// Name of the element around.
        around: Option<&'a str>,
    },
    /// In the name of an end tag.
    End {
        /// The bytes of the name, and to the `>` after it if there is one.
        name: Range<usize>,
        /// Name of the element around.
        around: &'a str,
    },
    /// In the name of an attribute, or where one may be.
    Attribute {
        /// The bytes of the name.
        name: Range<usize>,
        /// The sign after the name.
        next: AfterName,
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

/// The sign after the name of an attribute.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum AfterName {
    /// `=`: a value.
    Sign,
    /// Another name, without a blank in between.
    Name,
    /// Anything else.
    Gap,
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
    /// Returns the row of the element in a kind of text.
    pub(super) fn row(&self, vocabulary: &Vocabulary) -> Option<&'static ElementRow> {
        vocabulary.element(self.name)
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
        return Some(named(text, &all, open, at..at, around));
    };
    if at <= name.range.end {
        return Some(named(text, &all, open, name.range.clone(), around));
    }
    if of(&all[open]) == "</" {
        return None;
    }
    let close = all[open + 1..].iter().position(|token| ends(token) || of(token) == "<" || of(token) == "</");
    let parts = &all[open + 1..close.map_or(all.len(), |close| open + 1 + close)];
    let tag = OpenTag { name: of(name), attributes: attributes(text, parts) };
    match last.kind {
        TokenKind::Value if inside || (!is_closed(of(last)) && at == last.range.end) => {
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
            let next = after_name(text, last.range.end, all.get(before));
            Some(CursorPlace::Attribute { name: last.range.clone(), next, tag })
        }
        // A name may begin only after a blank.
        _ if text.get(..at)?.ends_with([' ', '\t', '\n', '\r']) => {
            Some(CursorPlace::Attribute { name: at..at, next: after_name(text, at, all.get(before)), tag })
        }
        _ => None,
    }
}

/// Returns the place in the name of the tag that begins with the token at `open`.
fn named<'a>(
    text: &str,
    all: &[ScriptToken],
    open: usize,
    name: Range<usize>,
    around: Option<&'a str>,
) -> CursorPlace<'a> {
    let is_written = all.get(open + 1).is_some_and(|token| token.range == name && !name.is_empty());
    let next = all.get(open + 1 + usize::from(is_written));
    let part = |token: &ScriptToken| text.get(token.range.clone()).unwrap_or_default();
    match (text.get(all[open].range.clone()), around) {
        (Some("</"), Some(around)) => {
            let end = next.filter(|next| part(next) == ">").map_or(name.end, |next| next.range.end);
            CursorPlace::End { name: name.start..end, around }
        }
        _ => {
            let begins = |token: &ScriptToken| {
                matches!(token.kind, TokenKind::Comment | TokenKind::Declaration)
                    || matches!(part(token), "<" | "</")
            };
            CursorPlace::Element { name, continues: next.is_some_and(|next| !begins(next)), around }
        }
    }
}

/// Returns what follows the name of an attribute that ends at `end`, before the token `next`.
fn after_name(text: &str, end: usize, next: Option<&ScriptToken>) -> AfterName {
    match next {
        Some(next) if text.get(next.range.clone()) == Some("=") => AfterName::Sign,
        Some(next) if next.range.start == end && next.kind == TokenKind::Attribute => AfterName::Name,
        Some(_) | None => AfterName::Gap,
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
