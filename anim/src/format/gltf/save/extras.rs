//! The data that this program keeps in the `extras` of an animation: written as one member; those of others stay.

use super::super::extras::EXTRAS_MEMBER;
use super::document::SourceDocument;
use super::json::list::{ListEdit, edit};
use super::json::patch::TextPatch;
use super::json::style::{Fresh, JsonStyle};
use super::json::tree::{Json, JsonKind, ValueId};
use crate::data::TakeExtras;

/// Name of the member of an animation that other programs may use, too.
const EXTRAS: &str = "extras";

/// Returns the value of the member of this program.
fn own(extras: &TakeExtras) -> Fresh<'_> {
    Fresh::Object(extras.iter().map(|(name, text)| (name, Fresh::Raw(text.to_string()))).collect())
}

/// Returns the `extras` of a new animation.
pub(super) fn fresh(extras: &TakeExtras) -> Fresh<'_> {
    Fresh::Object(vec![(EXTRAS_MEMBER, own(extras))])
}

/// Returns whether the `extras` of an animation are something into which nothing can be put.
pub(super) fn are_closed(json: Json<'_>, animation: ValueId) -> bool {
    json.member(animation, EXTRAS).is_some_and(|extras| json.kind(extras) != JsonKind::Object)
}

/// Replaces the data of this program in an animation. New and removed members of the animation itself go to `members`.
pub(super) fn patch(
    document: &SourceDocument<'_>,
    animation: ValueId,
    extras: &TakeExtras,
    members: &mut ListEdit,
    style: &JsonStyle,
    pointer: &str,
) -> Vec<TextPatch> {
    let json = document.json;
    if are_closed(json, animation) {
        return Vec::new();
    }
    let spot = style.spot(json, Some(animation), 3);
    let Some(all) = json.member(animation, EXTRAS) else {
        if !extras.is_empty() {
            members.inserted.push((None, style.member(EXTRAS, &fresh(extras), &spot)));
        }
        return Vec::new();
    };
    let pointer = format!("{pointer}/{EXTRAS}");
    let spot = style.spot(json, Some(all), 4);
    match json.member(all, EXTRAS_MEMBER) {
        Some(old) if extras.is_empty() && json.items(all).count() == 1 => {
            debug_assert!(json.items(all).any(|item| item == old));
            members.removed.push(all);
            Vec::new()
        }
        Some(old) if extras.is_empty() => {
            let change = ListEdit { removed: vec![old], inserted: Vec::new() };
            edit(json, all, &change, style, &spot, &pointer)
        }
        Some(old) => {
            let text = style.write(&own(extras), &spot);
            vec![TextPatch::new(json.span(old), text, format!("{pointer}/{EXTRAS_MEMBER}"))]
        }
        None if extras.is_empty() => Vec::new(),
        None => {
            let last = json.items(all).last();
            let text = style.member(EXTRAS_MEMBER, &own(extras), &spot);
            let change = ListEdit { removed: Vec::new(), inserted: vec![(last, text)] };
            edit(json, all, &change, style, &spot, &pointer)
        }
    }
}
