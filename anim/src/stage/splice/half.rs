//! The second half of an element that is split.

use super::insert::{ElementPlace, block};
use super::layout::indentation;
use super::tag::StartTag;
use super::{TextSplices, remove_attribute, set_attribute};
use crate::stage::script::ScriptTree;

/// Inserts an element after another one that has the attributes of that one as they are written, with this id or none, and copies of these parts of it.
///
/// `None` where there is no such element, and for the script itself.
pub(in crate::stage) fn insert_half(
    tree: &ScriptTree,
    element: usize,
    id: Option<&str>,
    parts: &[usize],
) -> Option<TextSplices> {
    let (text, own) = (tree.text(), tree.own(element)?);
    let (start, tag) = (own.range.start, StartTag::of(text, own));
    let mut half = text.get(start..tag.content_end())?.to_owned();
    let named = match id {
        Some(id) => set_attribute(tree, element, "id", id)?,
        None => remove_attribute(tree, element, "id")?,
    };
    for splice in named.list() {
        half.replace_range(splice.range.start - start..splice.range.end - start, &splice.text);
    }
    if parts.is_empty() {
        half += "/>";
    } else {
        half.push('>');
        for &part in parts {
            half += text.get(tree.own(part)?.range.clone())?;
        }
        half += &format!("</{}>", text.get(own.name.clone())?);
    }
    let old = indentation(text, start).unwrap_or_default();
    Some(TextSplices::of(vec![block(tree, ElementPlace::After(element), &half, old)?]))
}
