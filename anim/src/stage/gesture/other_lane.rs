//! Clips moved to another thing of the cast.

use super::begin::ends_with_another;
use super::draft::{AttributeChange, ScriptDraft, keeps_prev};
use super::insert::{ActionPlace, check_who, place_in_par, place_index};
use super::mixes::{ActionOrigins, mixed};
use super::moving::new_index;
use super::scene::{Followers, GestureRefusal, GestureScene, refused};
use super::several::outermost;
use crate::stage::script::{ActionMoment, ScriptElement};
use crate::stage::splice::{AttachedComments, ElementPlace, move_all_after, move_to};
use crate::stage::table::ElementGroup;
use crate::stage::time::StageTime;
use crate::stage::time_text::{readable, time_text};

/// Gives an action to the thing `onto`, beginning at `to`; in the text it goes after what that thing does, into a `par`. What followed it in a
/// `seq` moves up, or stays where it is.
///
/// # Errors
///
/// There is no such action or thing, the thing does not do such actions, its model lacks a take or a bone that the action names, the
/// action or the one after it refers to `prev`, or the times would depend on themselves.
pub fn move_to_lane(
    scene: &GestureScene<'_>,
    action: usize,
    to: StageTime,
    onto: &str,
    followers: Followers,
) -> Result<String, GestureRefusal> {
    scene.element(action)?;
    let (own, times) = (&scene.script.actions()[action], scene.times(action));
    may_go_onto(scene, action, onto)?;
    keeps_prev(scene.script, scene.script.next_sibling(action))?;
    let does = |&other: &usize| other != action && scene.script.element(other).value("who") == Some(onto);
    let near = (1..scene.script.actions().len()).rfind(does);
    // Not after itself in a sequence, where it would be cut off from the time that it gets.
    let ActionPlace { place, base } = place_in_par(scene, near.or_else(|| around_seq(scene, action)));
    let rate = scene.script.rate();
    let to = to.max(StageTime::ZERO);
    let begin = readable(to - base, rate);
    let written = |time: StageTime| time_text(time, rate, "");
    let mut changes: Vec<AttributeChange<'_>> = vec![(own.element, "who", Some(onto.to_owned()))];
    changes.push((own.element, "begin", (begin != StageTime::ZERO).then(|| written(begin))));
    if let Some(ActionMoment::Offset(_)) = own.end {
        changes.push((own.element, "end", Some(written(begin + (times.end - times.begin)))));
    }
    if followers == Followers::Stay && !ends_with_another(scene, action) {
        let by = super::begin::usual_begin(scene, action) - times.end;
        changes.extend(super::begin::kept_follower(scene, action, by));
    }
    let origins = ActionOrigins::moved(scene, scene.script.branch(action), new_index(scene, action, place));
    let draft = ScriptDraft::of(scene.script)
        .with(&changes)?
        .then(|tree| move_to(tree, own.element, place, AttachedComments::Follow))?;
    mixed(scene, draft, &origins)?.finish()
}

/// Actions that went to the lane of another thing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MovedToLane {
    /// The new text.
    pub text: String,
    /// Why some of the actions stay where they are; `None` where all went there.
    pub left: Option<GestureRefusal>,
}

/// Gives selected actions to the thing `onto`, moved by the same time; the first one begins at zero at the earliest. Those that this thing cannot do stay as
/// they are. One action goes there as by [`move_to_lane`].
///
/// # Errors
///
/// None of the actions can go there: the reasons are those of [`move_to_lane`]. Also where an action that stays refers to one of them as `prev`.
pub fn move_clips_to_lane(
    scene: &GestureScene<'_>,
    actions: &[usize],
    by: StageTime,
    onto: &str,
    followers: Followers,
) -> Result<MovedToLane, GestureRefusal> {
    let outer = outermost(scene, actions)?;
    if let [action] = outer[..] {
        let text = move_to_lane(scene, action, scene.times(action).begin + by, onto, followers)?;
        return Ok(MovedToLane { text, left: None });
    }
    let mut moved: Vec<usize> = Vec::with_capacity(outer.len());
    let mut refusals: Vec<GestureRefusal> = Vec::new();
    for action in outer {
        match may_go_onto(scene, action, onto) {
            Ok(()) => moved.push(action),
            Err(refusal) => refusals.push(refusal),
        }
    }
    let left = refusals.first().map(|first| {
        let count = refusals.len();
        let what = if count == 1 { "1 action stays".to_owned() } else { format!("{count} actions stay") };
        GestureRefusal(format!("{what}: {first}"))
    });
    if moved.is_empty() {
        return Err(refusals.swap_remove(0));
    }
    let stays = |action: &usize| moved.binary_search(action).is_err();
    keeps_prev(scene.script, moved.iter().filter_map(|&own| scene.script.next_sibling(own)).filter(stays))?;
    let first = moved.iter().map(|&action| scene.times(action).begin).min().unwrap_or_default();
    let by = by.max(-first);
    let does = |action: &usize| stays(action) && scene.script.element(*action).value("who") == Some(onto);
    let near = (1..scene.script.actions().len()).rfind(does);
    let ActionPlace { place, base } = place_in_par(scene, near.or_else(|| around_seq(scene, moved[0])));
    let rate = scene.script.rate();
    let mut changes: Vec<AttributeChange<'_>> = Vec::new();
    for &action in &moved {
        let (own, times) = (&scene.script.actions()[action], scene.times(action));
        let begin = readable(times.begin + by - base, rate);
        let written = |time: StageTime| time_text(time, rate, "");
        changes.push((own.element, "who", Some(onto.to_owned())));
        changes.push((own.element, "begin", (begin != StageTime::ZERO).then(|| written(begin))));
        if let Some(ActionMoment::Offset(_)) = own.end {
            changes.push((own.element, "end", Some(written(begin + (times.end - times.begin)))));
        }
        let next = scene.script.next_sibling(action).filter(stays);
        if followers == Followers::Stay && next.is_some() && !ends_with_another(scene, action) {
            // The first of those in a row that go together.
            let before = |own: &usize| scene.script.before_in_seq(*own).filter(|before| !stays(before));
            let first = std::iter::successors(Some(action), before).last().unwrap_or(action);
            let by = super::begin::usual_begin(scene, first) - times.end;
            changes.extend(super::begin::kept_follower(scene, action, by));
        }
    }
    let origins = ActionOrigins::gathered(scene, &moved, place_index(scene, place));
    let elements: Vec<usize> = moved.iter().map(|&action| scene.script.actions()[action].element).collect();
    let draft = ScriptDraft::of(scene.script).with(&changes)?.then(|tree| match place {
        ElementPlace::After(after) => move_all_after(tree, &elements, after, AttachedComments::Follow),
        // Only a script without actions has such a place.
        ElementPlace::First(_) => None,
    })?;
    let text = mixed(scene, draft, &origins)?.finish()?;
    Ok(MovedToLane { text, left })
}

/// Refuses an action that does not go to the lane of a thing.
fn may_go_onto(scene: &GestureScene<'_>, action: usize, onto: &str) -> Result<(), GestureRefusal> {
    let element = scene.element(action)?;
    if element.row.group != ElementGroup::Action || element.value("who").is_none() {
        return refused(format!("<{}> belongs to no thing of the cast", element.row.name));
    }
    fits_onto(scene, element, onto)?;
    keeps_prev(scene.script, [action])
}

/// Returns the outermost `seq` around an action.
fn around_seq(scene: &GestureScene<'_>, action: usize) -> Option<usize> {
    let parent = |action: usize| scene.script.actions()[action].parent;
    let mut found = None;
    let mut around = parent(action);
    while let Some(container) = around.filter(|&container| scene.script.is_seq(container)) {
        found = Some(container);
        around = parent(container);
    }
    found
}

/// Refuses to give an action to a thing that does no such actions, or whose model lacks what the action names: all of it is listed.
pub(super) fn fits_onto(
    scene: &GestureScene<'_>,
    element: &ScriptElement,
    onto: &str,
) -> Result<(), GestureRefusal> {
    if element.row.name == "attach" && element.value("who") != Some(onto) {
        return refused(
            "An attachment stays with the thing that is held: attach the other one by its own menu",
        );
    }
    check_who(scene, onto, element.row.name, &format!("do <{}>", element.row.name))?;
    let model = scene.plan.thing_called(onto).and_then(|thing| scene.plan.things()[thing].model.as_ref());
    let Some(model) = model else { return Ok(()) };
    let mut missing: Vec<String> = Vec::new();
    if let Some(take) = element.value("take").filter(|take| model.take_called(take).is_none()) {
        missing.push(format!("the take \"{take}\""));
    }
    for bone in element.value("bones").unwrap_or_default().split(',').map(str::trim) {
        if !bone.is_empty() && !model.skeleton().bones.iter().any(|own| *own.name == *bone) {
            missing.push(format!("the bone \"{bone}\""));
        }
    }
    match missing.is_empty() {
        true => Ok(()),
        false => refused(format!("The model of {onto} lacks {}", missing.join(" and "))),
    }
}
