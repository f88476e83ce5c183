//! Several clips moved or deleted in one step.

use super::begin::{ends_with_another, following_end, kept_follower, moved_moment, usual_begin};
use super::draft::{AttributeChange, ScriptDraft, keeps_prev};
use super::mixes::{ActionOrigins, mixed};
use super::moving::{SequenceOrder, move_clip};
use super::removal::{delete_clip, user_of};
use super::scene::{Followers, GestureRefusal, GestureScene, refused};
use crate::stage::schedule::{Schedule, TimeNode, TimesAlong, resolve};
use crate::stage::splice::{AttachedComments, TextSplices, delete};
use crate::stage::time::{MILLISECOND, StageTime};
use std::borrow::Cow;

/// Number of times that a begin is corrected which depends on others that move too.
const MOST_TRIES: u8 = 3;

/// An action, and the time at which it is to begin.
struct ClipTarget {
    action: usize,
    begin: StageTime,
    /// Number of times that its begin was written.
    tries: u8,
}

impl ClipTarget {
    fn new(action: usize, begin: StageTime) -> Self {
        Self { action, begin, tries: 0 }
    }
}

fn begin_of(schedule: &Schedule, action: usize) -> StageTime {
    schedule.times().get(action).copied().unwrap_or_default().begin
}

/// Moves actions by the same time; the first one begins at zero at the earliest. Several of them keep their order in a `seq`, and one is moved
/// as by [`move_clip`].
///
/// # Errors
///
/// There is no such action, none is given, or one of them cannot be moved; then none is.
pub fn move_clips(
    scene: &GestureScene<'_>,
    actions: &[usize],
    by: StageTime,
    order: SequenceOrder,
    followers: Followers,
) -> Result<String, GestureRefusal> {
    let actions = outermost(scene, actions)?;
    if let [action] = actions[..] {
        return move_clip(scene, action, scene.times(action).begin + by, order, followers);
    }
    let first = actions.iter().map(|&action| scene.times(action).begin).min().unwrap_or_default();
    let by = by.max(-first);
    let lengths = scene.lengths();
    let mut script = Cow::Borrowed(scene.script);
    let mut schedule = Cow::Borrowed(scene.schedule());
    let mut targets: Vec<ClipTarget> =
        actions.iter().map(|&action| ClipTarget::new(action, scene.times(action).begin + by)).collect();
    if followers == Followers::Stay {
        let moves = |&&action: &&usize| !ends_with_another(scene, action);
        let after = |action: &usize| kept_follower(scene, *action, by).and(scene.script.next_in_seq(*action));
        let stay = actions
            .iter()
            .filter(moves)
            .filter_map(after)
            .filter(|next| actions.binary_search(next).is_err());
        targets.extend(stay.map(|next| ClipTarget::new(next, scene.times(next).begin)));
    }
    loop {
        let wrong: Vec<(usize, StageTime)> = targets
            .iter()
            .enumerate()
            .filter(|(_, target)| target.tries < MOST_TRIES)
            .map(|(at, target)| (at, target.begin - begin_of(&schedule, target.action)))
            // As near as begins are written.
            .filter(|(_, rest)| rest.ticks().abs() >= MILLISECOND.ticks())
            .collect();
        if wrong.is_empty() {
            break;
        }
        // A clip that depends on another one of them waits: it moves along, most likely to the right time.
        let begins: Vec<TimeNode> =
            wrong.iter().map(|&(at, _)| TimeNode::Begin(targets[at].action)).collect();
        let along = TimesAlong::by_others(&script, &begins);
        let next = GestureScene { script: &script, plan: scene.plan };
        let mut changes: Vec<AttributeChange<'_>> = Vec::new();
        for &(at, rest) in &wrong {
            let target = &mut targets[at];
            if along.begin(target.action) {
                continue;
            }
            target.tries += 1;
            let begin = moved_moment(&next, target.action, "begin", rest);
            changes.push(begin.change);
            changes.extend(following_end(&next, target.action, begin.by));
        }
        if changes.is_empty() {
            break;
        }
        if let Some(changed) = ScriptDraft::of(&script).with(&changes)?.read()? {
            schedule = Cow::Owned(resolve(&changed, &lengths)?);
            script = Cow::Owned(changed);
        }
    }
    let draft = ScriptDraft::of(scene.script).becoming(&script);
    let draft = mixed(scene, draft, &ActionOrigins::same(scene))?;
    draft.finish_with(&lengths, |changed| {
        actions.iter().try_for_each(|&action| scene.keeps_length(action, changed, action))
    })
}

/// Deletes actions with everything in them; comments stay.
///
/// # Errors
///
/// There is no such action, none is given, or an action that stays refers to one of them, also as `prev`; then none is deleted.
pub fn delete_clips(
    scene: &GestureScene<'_>,
    actions: &[usize],
    followers: Followers,
) -> Result<String, GestureRefusal> {
    let actions = outermost(scene, actions)?;
    if let [action] = actions[..] {
        return delete_clip(scene, action, followers);
    }
    let elements: Vec<usize> = actions.iter().map(|&action| scene.script.actions()[action].element).collect();
    if let Some(user) = user_of(scene, &elements) {
        return refused(format!("{user} depends on what is deleted: change that first"));
    }
    let mut kept: Vec<AttributeChange<'_>> = Vec::new();
    for &action in &actions {
        let next = scene.script.next_sibling(action).filter(|next| actions.binary_search(next).is_err());
        keeps_prev(scene.script, next)?;
        if followers == Followers::Stay && next.is_some() {
            // The first of those that are deleted together.
            let mut first = action;
            while let Some(before) =
                scene.script.before_in_seq(first).filter(|before| actions.binary_search(before).is_ok())
            {
                first = before;
            }
            let by = usual_begin(scene, first) - scene.times(action).end;
            kept.extend(kept_follower(scene, action, by));
        }
    }
    let draft = ScriptDraft::of(scene.script).with(&kept)?.then(|tree| {
        let parts: Option<Vec<TextSplices>> =
            elements.iter().map(|&element| delete(tree, element, AttachedComments::Stay)).collect();
        TextSplices::joined(parts?)
    })?;
    mixed(scene, draft, &ActionOrigins::without(scene, &actions))?.finish()
}

/// Returns the actions in the order of the text, each once, without those inside of others.
pub(super) fn outermost(scene: &GestureScene<'_>, actions: &[usize]) -> Result<Vec<usize>, GestureRefusal> {
    let mut sorted = actions.to_vec();
    sorted.sort_unstable();
    sorted.dedup();
    for &action in &sorted {
        scene.element(action)?;
    }
    let (mut outer, mut end): (Vec<usize>, usize) = (Vec::new(), 0);
    for action in sorted {
        if action >= end {
            end = scene.script.branch(action).end;
            outer.push(action);
        }
    }
    if outer.is_empty() {
        return refused("No action is selected");
    }
    Ok(outer)
}
