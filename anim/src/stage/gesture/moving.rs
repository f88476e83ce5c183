//! Clips moved in time.

use super::begin::{is_usual, kept_follower, moved_moment};
use super::draft::{AttributeChange, ScriptDraft};
use super::scene::{Followers, GestureRefusal, GestureScene};
use crate::stage::splice::{AttachedComments, ElementPlace, move_to};
use crate::stage::time::StageTime;

/// Whether a moved clip may change places with its neighbors in a `seq`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SequenceOrder {
    /// It goes before or after those whose middle its own middle passes, and begins where the one before ends.
    Change,
    /// It stays in its place of the text, with an earlier or later `begin`.
    Keep,
}

/// Moves an action so that it begins at `to`; at zero for an earlier time.
///
/// # Errors
///
/// There is no such action, or the new text would be no script, such as one in which an action begins relative to itself.
pub fn move_clip(
    scene: &GestureScene<'_>,
    action: usize,
    to: StageTime,
    order: SequenceOrder,
    followers: Followers,
) -> Result<String, GestureRefusal> {
    let element = scene.script.actions().get(action).map_or(0, |own| own.element);
    scene.element(action)?;
    let times = scene.times(action);
    let draft = ScriptDraft::of(scene.script.tree());
    // Also for a time before the start, which brings a long clip before a short one.
    if order == SequenceOrder::Change
        && is_usual(scene, action)
        && let Some(place) = new_place(scene, action, to)
    {
        return draft
            .with(&[(element, "begin", None)])?
            .then(|tree| move_to(tree, element, place, AttachedComments::Follow))?
            .finish();
    }
    let by = to.max(StageTime::ZERO) - times.begin;
    let mut changes: Vec<AttributeChange<'_>> = Vec::new();
    if by != StageTime::ZERO {
        changes.push(moved_moment(scene, action, "begin", by));
    }
    // The end follows only where it is relative to what moves.
    if followers == Followers::Stay && moves_end(scene, action) {
        changes.extend(kept_follower(scene, action, by));
    }
    draft.with(&changes)?.finish()
}

/// Returns whether the end of an action moves with its begin.
fn moves_end(scene: &GestureScene<'_>, action: usize) -> bool {
    scene.script.actions()[action].end.is_none()
}

/// Returns the place in a `seq` where an action that begins at `to` belongs; `None` where that is its own.
fn new_place(scene: &GestureScene<'_>, action: usize, to: StageTime) -> Option<ElementPlace> {
    let actions = scene.script.actions();
    let own = &actions[action];
    let parent = own.parent.filter(|&parent| scene.is_seq(parent))?;
    let siblings = &actions[parent].children;
    // Twice the middle, so that it is a whole number of ticks.
    let middle = |action: usize| scene.times(action).begin + scene.times(action).stop;
    let times = scene.times(action);
    let new = to + to + (times.stop - times.begin);
    let later = siblings[own.position + 1..].iter().take_while(|&&other| middle(other) < new).last();
    if let Some(&later) = later.filter(|_| new > middle(action)) {
        return Some(ElementPlace::After(actions[later].element));
    }
    let earlier = siblings[..own.position].iter().rev().take_while(|&&other| middle(other) > new).last();
    let &earlier = earlier.filter(|_| new < middle(action))?;
    Some(match actions[earlier].position.checked_sub(1) {
        Some(before) => ElementPlace::After(actions[siblings[before]].element),
        None => ElementPlace::First(actions[parent].element),
    })
}
