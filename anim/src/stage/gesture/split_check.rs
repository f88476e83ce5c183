//! The actions that cannot be split, and those that would change others.

use super::draft::keeps_prev;
use super::scene::{GestureRefusal, GestureScene, refused};
use crate::stage::moment::MomentText;
use crate::stage::script::ScriptElement;
use crate::stage::table::ElementGroup;
use crate::stage::time::StageTime;

/// Refuses a kind of action of which there are no two halves that do the same as the whole.
pub(super) fn check_kind(scene: &GestureScene<'_>, action: usize) -> Result<(), GestureRefusal> {
    let element = scene.script.element(action);
    if element.row.group != ElementGroup::Action {
        return refused("Only actions are split, not what contains them");
    }
    let name = element.row.name;
    match name {
        "play" | "look" | "title" => Ok(()),
        "shot" => refused("A shot is split by a cut to another camera"),
        "sound" => refused("A sound cannot be split: both halves would play from its start"),
        "run" => refused("An effect cannot be split: it would start again"),
        "move" | "turn" | "change" => {
            refused(format!("<{name}> cannot be split: both halves would go all the way"))
        }
        "place" | "attach" | "detach" | "set" => {
            refused(format!("<{name}> takes no time, so that there is nothing to split"))
        }
        _ => refused(format!("<{name}> cannot be split")),
    }
}

/// Refuses to split an action if the next one begins or ends relative to the start of it as `prev`: the one before that would be the second half.
pub(super) fn check_followers(scene: &GestureScene<'_>, action: usize) -> Result<(), GestureRefusal> {
    let refers = |&next: &usize| {
        let element = scene.script.element(next);
        ["begin", "end"].iter().any(|name| {
            let moment = element.value(name).and_then(|text| MomentText::parse(text, scene.script.rate()));
            matches!(moment, Some(MomentText::Of { action, point, .. }) if action == "prev" && point != "end")
        })
    };
    keeps_prev(scene.script, scene.script.next_sibling(action).filter(refers))
}

/// Refuses to split an action at `end` if another one began after it and decides over the same there: the second half, which begins later, would
/// decide instead.
pub(super) fn check_rivals(
    scene: &GestureScene<'_>,
    action: usize,
    end: StageTime,
) -> Result<(), GestureRefusal> {
    let (script, element) = (scene.script, scene.script.element(action));
    let Some(who) = element.value("who") else { return Ok(()) };
    let travels = element.row.name == "play" && moves(scene, element);
    let is_rival = |&other: &usize| {
        let (other_element, times) = (script.element(other), scene.times(other));
        let begins_between = (times.begin, other) > (scene.times(action).begin, action)
            && (times.begin, other) < (end, action);
        if !begins_between || other_element.value("who") != Some(who) {
            return false;
        }
        let fade_out = script.time(other_element, "fade-out").unwrap_or_default();
        let is_layer = lane_of(other_element).is_some_and(|lane| lane != MAIN);
        let releases = other_element.row.name == "look" || is_layer;
        let is_gone = times.stop <= end && script.is_released(other_element, fade_out, releases);
        let is_same_lane = lane_of(element).is_some() && lane_of(element) == lane_of(other_element);
        (is_same_lane && !is_gone) || (travels && moves(scene, other_element))
    };
    match (1..script.actions().len()).find(is_rival) {
        Some(other) => {
            let title = script.tree().title(script.actions()[other].element);
            refused(format!("{title} begins after it and decides there"))
        }
        None => Ok(()),
    }
}

/// The lane of what moves the whole body: without a layer and without bones.
const MAIN: [&str; 3] = ["pose", "", ""];

/// Returns the lane of an action in which the one that began last decides; `None` for one that shares its lane with no other.
fn lane_of(element: &ScriptElement) -> Option<[&str; 3]> {
    let value = |name: &str| element.value(name).unwrap_or_default();
    match element.row.name {
        "play" => Some(["pose", value("layer"), value("bones")]),
        "move" if element.value("take").is_some() => Some(MAIN),
        "look" => Some(["look", "", ""]),
        _ => None,
    }
}

/// Returns whether an action decides over the place or the direction of its thing.
fn moves(scene: &GestureScene<'_>, element: &ScriptElement) -> bool {
    match element.row.name {
        "place" | "move" | "turn" | "attach" | "detach" => true,
        "play" => lane_of(element) == Some(MAIN) && scene.take(element).is_some_and(|take| take.travels()),
        _ => false,
    }
}
