//! Clips moved in time.

use super::begin::{ends_with_another, following_end, is_usual, kept_follower, moved_moment};
use super::draft::{AttributeChange, ScriptDraft, keeps_prev};
use super::insert::place_index;
use super::mixes::{ActionOrigins, lengths_after, mixed};
use super::scene::{Followers, GestureRefusal, GestureScene};
use crate::stage::schedule::resolve;
use crate::stage::script::ActionMoment;
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

/// A place that an action gets among its neighbors in a `seq`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SequenceMove {
    /// Its number there, from 1 on.
    pub number: usize,
    /// The time at which it begins there.
    pub begin: StageTime,
}

/// Moves an action so that it begins at `to`; at zero for an earlier time. Where a clip overlaps the one before it after that, it mixes with it
/// for as long as they overlap.
///
/// # Errors
///
/// There is no such action; the new text would be no script, such as one in which an action begins relative to itself; the action would
/// begin after its end, which is a moment of another one; or it would come between an action and the one that this calls `prev`.
pub fn move_clip(
    scene: &GestureScene<'_>,
    action: usize,
    to: StageTime,
    order: SequenceOrder,
    followers: Followers,
) -> Result<String, GestureRefusal> {
    scene.element(action)?;
    let times = scene.times(action);
    let draft = ScriptDraft::of(scene.script);
    if order == SequenceOrder::Change
        && let Some(place) = sequence_place(scene, action, to)
    {
        return reordered(scene, action, place)?.0.finish();
    }
    let by = to.max(StageTime::ZERO) - times.begin;
    let mut changes: Vec<AttributeChange<'_>> = Vec::new();
    if by != StageTime::ZERO {
        let begin = moved_moment(scene, action, "begin", by);
        changes.push(begin.change);
        changes.extend(following_end(scene, action, begin.by));
        // An end at a moment of another action stays there.
        if followers == Followers::Stay && !ends_with_another(scene, action) {
            changes.extend(kept_follower(scene, action, begin.by));
        }
    }
    let draft = mixed(scene, draft.with(&changes)?, &ActionOrigins::same(scene))?;
    draft.finish_with(&scene.lengths(), |changed| scene.keeps_length(action, changed, action))
}

/// Returns where an action is among its neighbors in a `seq` after [`move_clip`] brought it to a [`sequence_place`]; `None` where that is refused. Reads
/// the new text.
pub fn sequence_move(scene: &GestureScene<'_>, action: usize, place: ElementPlace) -> Option<SequenceMove> {
    let (draft, origins) = reordered(scene, action, place).ok()?;
    let script = draft.read().ok()??;
    let origins = origins.in_script(scene, &script);
    let new = origins.iter().position(|origin| *origin == Some(action))?;
    let schedule = resolve(&script, &lengths_after(scene, &script, &origins)).ok()?;
    let begin = schedule.times().get(new)?.begin;
    Some(SequenceMove { number: script.actions().get(new)?.position + 1, begin })
}

/// Returns the other place in a `seq` to which [`move_clip`] brings an action that is moved to `to` with [`SequenceOrder::Change`]; `None` where it stays in
/// its own, and for an action that does not exist. A time before the start brings a long clip before a short one, too.
pub fn sequence_place(scene: &GestureScene<'_>, action: usize, to: StageTime) -> Option<ElementPlace> {
    scene.element(action).ok()?;
    let is_free = scene.script.actions()[action].passive || !ends_with_another(scene, action);
    if is_usual(scene, action) && is_free { new_place(scene, action, to) } else { None }
}

/// Returns the text in which an action is at another place of a `seq`, and what its actions were before.
fn reordered<'a>(
    scene: &GestureScene<'a>,
    action: usize,
    place: ElementPlace,
) -> Result<(ScriptDraft<'a>, ActionOrigins), GestureRefusal> {
    let own = &scene.script.actions()[action];
    let mut changes: Vec<AttributeChange<'_>> = vec![(own.element, "begin", None)];
    if let Some(ActionMoment::Offset(begin)) = own.begin {
        changes.extend(following_end(scene, action, -begin));
    }
    // Three actions have another one before them. What was first had none, so that it refers to none.
    let behind = match place {
        ElementPlace::First(_) => None,
        ElementPlace::After(near) => {
            let before = scene.script.actions().iter().position(|other| other.element == near);
            before.and_then(|before| scene.script.next_sibling(before))
        }
    };
    keeps_prev(
        scene.script,
        [Some(action), scene.script.next_sibling(action), behind].into_iter().flatten(),
    )?;
    let draft = ScriptDraft::of(scene.script)
        .with(&changes)?
        .then(|tree| move_to(tree, own.element, place, AttachedComments::Follow))?;
    let origins = ActionOrigins::moved(scene, scene.script.branch(action), new_index(scene, action, place));
    Ok((mixed(scene, draft, &origins)?, origins))
}

/// Returns the position among the actions that an action has after it went to a place.
pub(super) fn new_index(scene: &GestureScene<'_>, action: usize, place: ElementPlace) -> usize {
    let (own, after) = (scene.script.branch(action), place_index(scene, place));
    if after > own.start { after.saturating_sub(own.len()) } else { after }
}

/// Returns the place in a `seq` where an action that begins at `to` belongs; `None` where that is its own.
fn new_place(scene: &GestureScene<'_>, action: usize, to: StageTime) -> Option<ElementPlace> {
    let actions = scene.script.actions();
    let own = &actions[action];
    let parent = own.parent.filter(|&parent| scene.script.is_seq(parent))?;
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
