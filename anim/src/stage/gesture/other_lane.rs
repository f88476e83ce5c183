//! Clips moved to another thing of the cast.

use super::begin::ends_with_another;
use super::draft::{AttributeChange, ScriptDraft, keeps_prev};
use super::insert::{ActionPlace, check_who, place_in_par};
use super::mixes::{ActionOrigins, mixed};
use super::moving::new_index;
use super::scene::{Followers, GestureRefusal, GestureScene, refused};
use super::several::outermost;
use crate::stage::script::{ActionMoment, ScriptElement};
use crate::stage::splice::{AttachedComments, move_to};
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
    let element = scene.element(action)?;
    let (own, times) = (&scene.script.actions()[action], scene.times(action));
    if element.row.group != ElementGroup::Action || element.value("who").is_none() {
        return refused(format!("<{}> belongs to no thing of the cast", element.row.name));
    }
    fits_onto(scene, element, onto)?;
    keeps_prev(scene.script, [Some(action), scene.script.next_sibling(action)].into_iter().flatten())?;
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

/// Gives one selected action to the thing `onto`, moved by a time; it begins at zero at the earliest. What is selected inside of it goes with it.
///
/// # Errors
///
/// As [`move_to_lane`]; and where several actions are selected, because only one at a time goes to another lane.
pub fn move_clips_to_lane(
    scene: &GestureScene<'_>,
    actions: &[usize],
    by: StageTime,
    onto: &str,
    followers: Followers,
) -> Result<String, GestureRefusal> {
    match outermost(scene, actions)?[..] {
        [action] => move_to_lane(scene, action, scene.times(action).begin + by, onto, followers),
        _ => refused("Only one action at a time goes to another lane: copy them and paste them there"),
    }
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
