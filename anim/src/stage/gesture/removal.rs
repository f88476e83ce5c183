//! Clips deleted and duplicated.

use super::begin::{ends_with_another, is_usual, kept_follower, moved_moment, usual_begin, written_out};
use super::draft::{AttributeChange, ScriptDraft, keeps_prev};
use super::mixes::{ActionOrigins, mixed};
use super::scene::{Followers, GestureRefusal, GestureScene, refused};
use crate::stage::splice::{AttachedComments, delete, duplicate, named};
use crate::stage::time::StageTime;

/// Deletes an action with everything in it; comments stay.
///
/// # Errors
///
/// There is no such action, or others refer to it, also as `prev`.
pub fn delete_clip(
    scene: &GestureScene<'_>,
    action: usize,
    followers: Followers,
) -> Result<String, GestureRefusal> {
    scene.element(action)?;
    let (own, times) = (&scene.script.actions()[action], scene.times(action));
    if let Some(user) = user_of(scene, &[own.element]) {
        return refused(format!("{user} depends on it: change that first"));
    }
    keeps_prev(scene.script, scene.script.next_sibling(action))?;
    let mut draft = ScriptDraft::of(scene.script);
    if followers == Followers::Stay {
        let by = usual_begin(scene, action) - times.end;
        draft = draft.with(kept_follower(scene, action, by).as_slice())?;
    }
    let draft = draft.then(|tree| delete(tree, own.element, AttachedComments::Stay))?;
    mixed(scene, draft, &ActionOrigins::without(scene, &[action]))?.finish()
}

/// Returns the title of an element that refers to an id inside one of `elements` from outside of all of them.
pub(super) fn user_of(scene: &GestureScene<'_>, elements: &[usize]) -> Option<String> {
    let tree = scene.script.tree();
    let ranges = || elements.iter().filter_map(|&element| Some(&tree.elements().get(element)?.range));
    let is_inside = |other: usize| {
        let other = &tree.elements()[other].range;
        ranges().any(|range| other.start >= range.start && other.end <= range.end)
    };
    let ids: Vec<&str> = (0..tree.elements().len())
        .filter(|&other| is_inside(other))
        .filter_map(|other| tree.elements()[other].value("id"))
        .collect();
    // An included file has names of its own.
    let may_refer = |other: &usize| !is_inside(*other) && !tree.elements()[*other].is_included();
    let user = (0..tree.elements().len()).filter(may_refer).find(|&other| {
        let attributes = &tree.elements()[other].attributes;
        attributes.iter().any(|attribute| named(attribute).is_some_and(|name| ids.contains(&name)))
    })?;
    Some(tree.title(user))
}

/// Inserts a copy of an action after it, with ids of its own. In a `seq` it begins when the original ends; elsewhere it gets a `begin`. It is as
/// long as the original.
///
/// # Errors
///
/// There is no such action; the action after it refers to it as `prev`; or the copy would begin when it ends, because that is a moment of
/// another action.
pub fn duplicate_clip(scene: &GestureScene<'_>, action: usize) -> Result<String, GestureRefusal> {
    scene.element(action)?;
    let (own, times) = (&scene.script.actions()[action], scene.times(action));
    keeps_prev(scene.script, scene.script.next_sibling(action))?;
    let tree = scene.script.tree();
    let end = tree.elements()[own.element].range.end;
    let elements = tree.elements()[own.element..].iter().take_while(|inner| inner.range.start < end).count();
    let (copy, element) = (scene.script.branch(action).end, own.element + elements);
    let is_in_seq = scene.script.is_in_seq(action);
    let length = times.stop - times.begin;
    let base = if is_in_seq { times.end } else { usual_begin(scene, action) };
    let mut changes: Vec<AttributeChange<'_>> = Vec::new();
    let follows = is_in_seq && is_usual(scene, action);
    if scene.script.refers_to_prev(action) || !(follows || length == StageTime::ZERO) {
        // The action before the copy is the original.
        let is_prev = |name: &str| scene.script.names_prev(action, name);
        changes.push(if is_usual(scene, action) || is_prev("begin") {
            written_out(scene, action, element, "begin", [base, times.begin + length])
        } else {
            let (_, name, value) = moved_moment(scene, action, "begin", length).change;
            (element, name, value)
        });
        if own.end.is_some() && (!ends_with_another(scene, action) || is_prev("end")) {
            changes.push(written_out(scene, action, element, "end", [base, times.end + length]));
        }
    }
    let mut lengths = scene.lengths();
    let copied = lengths[action..copy].to_vec();
    lengths.splice(copy..copy, copied);
    let draft = ScriptDraft::of(scene.script).then(|tree| duplicate(tree, own.element))?.with(&changes)?;
    mixed(scene, draft, &ActionOrigins::copied(scene, &[action]))?
        .finish_with(&lengths, |changed| scene.keeps_length(action, changed, copy))
}
