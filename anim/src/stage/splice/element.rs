//! Whole elements: deleted, moved, duplicated.

use super::insert::{ElementPlace, block};
use super::layout::{after_line_end, comments_above, indentation, line_start, rest_of_line};
use super::names::with_new_ids;
use super::{TextSplice, TextSplices};
use crate::stage::script::ScriptTree;
use std::ops::Range;

/// Treatment of the comments directly above an element and after it in its line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AttachedComments {
    /// They stay where they are.
    Stay,
    /// They go with the element.
    Follow,
}

/// Deletes an element with everything in it.
///
/// References to it stay, and are errors of the new script: see [`super::elements_that_name`]. `None` where there is no such element,
/// and for the script itself.
pub fn delete(tree: &ScriptTree, element: usize, comments: AttachedComments) -> Option<TextSplices> {
    Some(TextSplices::one(taken(tree, element, comments)?, ""))
}

/// Moves an element with everything in it to another place.
///
/// `None` where there is no such element or place, for the script itself, and for a place inside the element.
pub fn move_to(
    tree: &ScriptTree,
    element: usize,
    place: ElementPlace,
    comments: AttachedComments,
) -> Option<TextSplices> {
    let (ElementPlace::First(near) | ElementPlace::After(near)) = place;
    if place == ElementPlace::After(element) {
        return Some(TextSplices::default());
    }
    let mut around = Some(near);
    while let Some(index) = around {
        if index == element {
            return None;
        }
        around = tree.elements().get(index)?.parent;
    }
    let (text, range) = (tree.text(), taken(tree, element, comments)?);
    let old = indentation(text, tree.own(element)?.range.start).unwrap_or_default();
    let content = text.get(range.clone())?.trim_matches([' ', '\t', '\r', '\n']);
    let put = block(tree, place, content, old)?;
    if range.contains(&put.range.start) && put.range.start > range.start {
        return Some(TextSplices::default());
    }
    Some(TextSplices::of(vec![TextSplice { range, text: String::new() }, put]))
}

/// Moves elements with everything in them after another one, in this order. None of them may be inside of another one of them; the other one may be
/// one of them.
///
/// `None` where there is no such element, for the script itself, and for a place inside one of the elements.
pub fn move_all_after(
    tree: &ScriptTree,
    elements: &[usize],
    after: usize,
    comments: AttachedComments,
) -> Option<TextSplices> {
    let text = tree.text();
    let place = ElementPlace::After(after);
    let around = |element: &usize| tree.elements().get(*element)?.parent;
    let mut splices: Vec<TextSplice> = Vec::with_capacity(elements.len() + 1);
    let mut put: Option<TextSplice> = None;
    for &element in elements {
        if std::iter::successors(Some(after), around).skip(1).any(|around| around == element) {
            return None;
        }
        let range = taken(tree, element, comments)?;
        let old = indentation(text, tree.own(element)?.range.start).unwrap_or_default();
        let content = text.get(range.clone())?.trim_matches([' ', '\t', '\r', '\n']);
        let block = block(tree, place, content, old)?;
        match &mut put {
            Some(put) => put.text += &block.text,
            None => put = Some(block),
        }
        splices.push(TextSplice { range, text: String::new() });
    }
    let Some(put) = put else { return Some(TextSplices::default()) };
    // The place is after one of them: all are written in place of that one.
    match elements.iter().position(|&element| element == after).and_then(|own| splices.get_mut(own)) {
        Some(own) if put.range.start < own.range.end => {
            let end = text.get(put.range.start..own.range.end)?;
            own.text = put.text.trim_start_matches(['\r', '\n']).to_owned() + end;
        }
        Some(own) if put.range.start == own.range.end => own.text = put.text.trim_start().to_owned(),
        Some(_) | None => splices.push(put),
    }
    TextSplices::new(splices)
}

/// Inserts a copy of an element after it. The copy has new ids, and its references to the old ids inside of it follow.
///
/// `None` where there is no such element, and for the script itself.
pub fn duplicate(tree: &ScriptTree, element: usize) -> Option<TextSplices> {
    let own = tree.own(element)?;
    let old = indentation(tree.text(), own.range.start).unwrap_or_default();
    let copy = with_new_ids(tree, element)?;
    Some(TextSplices::of(vec![block(tree, ElementPlace::After(element), &copy, old)?]))
}

/// Returns the bytes that are taken out with an element: its whole lines where nothing else is in them.
fn taken(tree: &ScriptTree, element: usize, comments: AttachedComments) -> Option<Range<usize>> {
    let (text, element) = (tree.text(), tree.own(element)?);
    element.parent?;
    let own = element.range.clone();
    let with_comments = comments == AttachedComments::Follow;
    let line = indentation(text, own.start).and(rest_of_line(text, own.end, with_comments));
    let Some(line) = line else { return Some(own) };
    let mut start = line_start(text, own.start);
    if with_comments {
        start = comments_above(text, start);
    }
    Some(start..after_line_end(text, line))
}
