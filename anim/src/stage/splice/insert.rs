//! New elements.

use super::layout::{indentation, line_end, rest_of_line, unit};
use super::tag::StartTag;
use super::{TextSplice, TextSplices, escaped};
use crate::stage::script::ScriptTree;

/// A place for an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ElementPlace {
    /// In front of everything else in this element.
    First(usize),
    /// After this element, in the same parent.
    After(usize),
}

/// An element to write.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct NewElement {
    name: String,
    attributes: Vec<(String, String)>,
}

impl NewElement {
    /// Creates an element without attributes.
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), attributes: Vec::new() }
    }

    /// Adds an attribute after the others.
    #[must_use]
    pub fn with(mut self, name: impl Into<String>, value: impl Into<String>) -> Self {
        self.attributes.push((name.into(), value.into()));
        self
    }

    /// Returns its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    fn text(&self) -> String {
        let attributes: String = self
            .attributes
            .iter()
            .map(|(name, value)| format!(" {name}=\"{}\"", escaped(value, '"')))
            .collect();
        format!("<{}{attributes}/>", self.name)
    }
}

/// Inserts an element.
///
/// `None` where there is no such place: no such element, or nothing can be after the script itself.
pub fn insert(tree: &ScriptTree, place: ElementPlace, new: &NewElement) -> Option<TextSplices> {
    Some(TextSplices::of(vec![block(tree, place, &new.text(), "")?]))
}

/// Inserts an element that is written as `content`, whose lines are not indented.
///
/// `None` where there is no such place.
pub fn insert_text(tree: &ScriptTree, place: ElementPlace, content: &str) -> Option<TextSplices> {
    Some(TextSplices::of(vec![block(tree, place, content, "")?]))
}

/// Returns an element as it is written, with everything in it, without the indentation of its lines. `None` where there is no such element in
/// the text.
pub fn written_element(tree: &ScriptTree, element: usize) -> Option<String> {
    let own = tree.elements().get(element).filter(|element| element.is_own())?;
    let old = indentation(tree.text(), own.range.start).unwrap_or_default();
    Some(super::layout::indented(tree.text().get(own.range.clone())?, old, ""))
}

/// Inserts a text of one element, whose lines have the indentation `old` from the second one on.
pub(super) fn block(tree: &ScriptTree, place: ElementPlace, content: &str, old: &str) -> Option<TextSplice> {
    let text = tree.text();
    let end = line_end(text);
    let in_line = |at: usize| TextSplice { range: at..at, text: content.to_owned() };
    let in_lines = |indent: &str| format!("{end}{indent}{}", super::layout::indented(content, old, indent));
    match place {
        ElementPlace::After(sibling) => {
            let sibling = tree.own(sibling).filter(|sibling| sibling.parent.is_some())?;
            let own_end = sibling.range.end;
            let Some(indent) = indentation(text, sibling.range.start) else { return Some(in_line(own_end)) };
            let at = rest_of_line(text, own_end, true).unwrap_or(own_end);
            Some(TextSplice { range: at..at, text: in_lines(indent) })
        }
        ElementPlace::First(parent) => {
            let element = tree.own(parent)?;
            let tag = StartTag::of(text, element);
            let own = indentation(text, element.range.start);
            let first = tree.elements().iter().find(|child| child.parent == Some(parent));
            let indent = match first {
                Some(first) => indentation(text, first.range.start).map(str::to_owned),
                None => own.map(|own| format!("{own}{}", unit(tree))),
            };
            if tag.is_empty {
                let name = element.row.name;
                let text = match (own, indent) {
                    (Some(own), Some(indent)) => format!(">{}{end}{own}</{name}>", in_lines(&indent)),
                    (Some(_) | None, _) => format!(">{content}</{name}>"),
                };
                return Some(TextSplice { range: tag.content_end()..tag.end(), text });
            }
            let at = tag.end();
            let Some(indent) = indent else { return Some(in_line(at)) };
            if let Some(line) = rest_of_line(text, at, true) {
                return Some(TextSplice { range: line..line, text: in_lines(&indent) });
            }
            // The end tag follows in the same line.
            let own = own.filter(|_| text.get(at..).is_some_and(|rest| rest.starts_with("</")));
            let after = own.map_or(String::new(), |own| format!("{end}{own}"));
            Some(TextSplice { range: at..at, text: in_lines(&indent) + &after })
        }
    }
}
