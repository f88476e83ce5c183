//! Clips deleted and duplicated.

use super::begin::{is_usual, kept_follower, moved_moment};
use super::draft::ScriptDraft;
use super::scene::{Followers, GestureRefusal, GestureScene, refused};
use crate::stage::splice::{AttachedComments, delete, duplicate, named};
use crate::stage::time::StageTime;
use crate::stage::time_text::time_text;

/// Deletes an action with everything in it; comments stay.
///
/// # Errors
///
/// There is no such action, or others refer to it.
pub fn delete_clip(
    scene: &GestureScene<'_>,
    action: usize,
    followers: Followers,
) -> Result<String, GestureRefusal> {
    scene.element(action)?;
    let (own, times) = (&scene.script.actions()[action], scene.times(action));
    if let Some(user) = user_of(scene, own.element) {
        return refused(format!("{user} depends on it: change that first"));
    }
    let mut draft = ScriptDraft::of(scene.script.tree());
    if followers == Followers::Stay {
        let by = usual_begin(scene, action).map_or(StageTime::ZERO, |base| base - times.end);
        draft = draft.with(kept_follower(scene, action, by).as_slice())?;
    }
    draft.then(|tree| delete(tree, own.element, AttachedComments::Stay))?.finish()
}

/// Returns the time at which an action in a `seq` begins without a `begin`: the end of the one before.
fn usual_begin(scene: &GestureScene<'_>, action: usize) -> Option<StageTime> {
    let own = &scene.script.actions()[action];
    let parent = own.parent?;
    Some(match own.position.checked_sub(1).filter(|_| scene.is_seq(parent)) {
        Some(before) => scene.times(scene.script.actions()[parent].children[before]).end,
        None => scene.times(parent).begin,
    })
}

/// Returns `<NAME> (line N)` of an element that refers to an id inside `element` from outside of it.
fn user_of(scene: &GestureScene<'_>, element: usize) -> Option<String> {
    let tree = scene.script.tree();
    let range = tree.elements().get(element)?.range.clone();
    let is_inside = |other: usize| {
        tree.elements()[other].range.start >= range.start && tree.elements()[other].range.end <= range.end
    };
    let ids: Vec<&str> = (0..tree.elements().len())
        .filter(|&other| is_inside(other))
        .filter_map(|other| tree.elements()[other].value("id"))
        .collect();
    let user = (0..tree.elements().len()).filter(|&other| !is_inside(other)).find(|&other| {
        let attributes = &tree.elements()[other].attributes;
        attributes.iter().any(|attribute| named(attribute).is_some_and(|name| ids.contains(&name)))
    })?;
    let line = tree.place(tree.elements()[user].range.start).line;
    Some(format!("<{}> (line {line})", tree.elements()[user].row.name))
}

/// Inserts a copy of an action after it, with ids of its own. In a `seq` it begins when the original ends; elsewhere it gets a `begin`.
///
/// # Errors
///
/// There is no such action.
pub fn duplicate_clip(scene: &GestureScene<'_>, action: usize) -> Result<String, GestureRefusal> {
    scene.element(action)?;
    let (own, times) = (&scene.script.actions()[action], scene.times(action));
    let (tree, rate) = (scene.script.tree(), scene.script.rate());
    let end = tree.elements()[own.element].range.end;
    let inside = tree.elements()[own.element..].iter().take_while(|inner| inner.range.start < end).count();
    let draft = ScriptDraft::of(tree).then(|tree| duplicate(tree, own.element))?;
    let follows = own.parent.is_some_and(|parent| scene.is_seq(parent)) && is_usual(scene, action);
    let length = times.stop - times.begin;
    if follows || length == StageTime::ZERO {
        return draft.finish();
    }
    let (_, name, value) = moved_moment(scene, action, "begin", length);
    let value = value.unwrap_or_else(|| time_text(StageTime::ZERO, rate, ""));
    draft.with(&[(own.element + inside, name, Some(value))])?.finish()
}
