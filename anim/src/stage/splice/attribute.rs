//! Attributes: changed, added, removed.

use super::tag::StartTag;
use super::{TextSplices, escaped};
use crate::stage::script::ScriptTree;

/// Sets the attribute `name` of an element to `value`. The same text if it has that value already.
///
/// `None` where there is no such element in the text: those of the project and of included files are not.
pub fn set_attribute(tree: &ScriptTree, element: usize, name: &str, value: &str) -> Option<TextSplices> {
    let (text, element) = (tree.text(), tree.own(element)?);
    if let Some(old) = element.attribute(name) {
        if &*old.value == value {
            return Some(TextSplices::default());
        }
        let quote = text.get(..old.value_range.start)?.chars().next_back()?;
        return Some(TextSplices::one(old.value_range.clone(), escaped(value, quote)));
    }
    let tag = StartTag::of(text, element);
    let gap = match tag.attributes.as_slice() {
        [.., before, last] => text.get(before.end..last.start)?,
        [only] => text.get(tag.name_end..only.start)?,
        [] => " ",
    };
    // In a line of its own where the last attribute has one.
    let gap = gap
        .rfind('\n')
        .map_or(" ".to_owned(), |line| format!("{}{}", super::layout::line_end(text), &gap[line + 1..]));
    let at = tag.content_end();
    Some(TextSplices::one(at..at, format!("{gap}{name}=\"{}\"", escaped(value, '"'))))
}

/// Removes the attribute `name` of an element, with the blanks in front of it. The same text if it is not written.
///
/// `None` where there is no such element in the text: those of the project and of included files are not.
pub fn remove_attribute(tree: &ScriptTree, element: usize, name: &str) -> Option<TextSplices> {
    let (text, element) = (tree.text(), tree.own(element)?);
    let Some(old) = element.attribute(name) else { return Some(TextSplices::default()) };
    let tag = StartTag::of(text, element);
    let before = tag.attributes.iter().rev().find(|other| other.end <= old.range.start);
    let start = before.map_or(tag.name_end, |before| before.end);
    Some(TextSplices::one(start..old.range.end, ""))
}
