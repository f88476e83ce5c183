//! The ids that a text has, also while it is broken.

use super::tokens::{TokenKind, tokens};

/// An id of a text.
#[derive(Debug, PartialEq)]
pub(super) struct NamedElement<'a> {
    /// Name of the element.
    pub(super) kind: &'a str,
    /// The id.
    pub(super) id: &'a str,
    /// Names of its moments: those of the `at` in it.
    pub(super) points: Vec<&'a str>,
}

/// Returns the elements of a text that have an id, in its order.
pub(super) fn named_elements(text: &str) -> Vec<NamedElement<'_>> {
    let mut found: Vec<NamedElement<'_>> = Vec::new();
    let (mut kind, mut attribute) = ("", "");
    // Whether the element that was named last is still open.
    let mut is_open = false;
    for token in tokens(text) {
        let part = text.get(token.range.clone()).unwrap_or_default();
        match token.kind {
            TokenKind::Element => {
                is_open &= part == "at";
                kind = part;
            }
            TokenKind::Attribute => attribute = part,
            TokenKind::Value => {
                let value = part.trim_matches(['"', '\'']);
                match (kind, attribute) {
                    ("at", "name") if is_open => {
                        if let Some(last) = found.last_mut() {
                            last.points.push(value);
                        }
                    }
                    (_, "id") if !value.is_empty() => {
                        found.push(NamedElement { kind, id: value, points: Vec::new() });
                        is_open = kind == "play";
                    }
                    _ => {}
                }
            }
            TokenKind::Sign | TokenKind::Comment | TokenKind::Declaration => {}
        }
    }
    found
}
