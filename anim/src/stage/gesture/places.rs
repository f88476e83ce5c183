//! Things put somewhere else.

use super::draft::ScriptDraft;
use super::scene::{GestureRefusal, GestureScene, refused};
use crate::stage::table::vector;
use crate::stage::time::StageTime;
use crate::stage::time_text::number_text;
use glam::DVec3;

/// Moves a thing so that it is at `position`, meters, at `time`: the last `place` of it before that time, otherwise its `at` in the cast.
///
/// What a thing walks to is another matter: only its start moves.
///
/// # Errors
///
/// There is no such thing, it has no place, or a number is not finite.
pub fn place_thing(
    scene: &GestureScene<'_>,
    thing: &str,
    time: StageTime,
    position: DVec3,
) -> Result<String, GestureRefusal> {
    let at = starting_place(scene, thing, time, "at")?;
    if !position.is_finite() || position.abs().max_element() >= 1e6 {
        return refused("The position is too far away");
    }
    // The start moves by as much as the thing, which may have traveled since.
    let index = scene.plan.thing_called(thing).unwrap_or_default();
    let position_at =
        |time: StageTime| scene.plan.placement(index, time).map_or(DVec3::ZERO, |place| place.position);
    let elements = scene.script.tree().elements();
    let start = match at {
        PlaceOf::Action(element, begin) => {
            elements[element].value("at").and_then(vector).unwrap_or_else(|| position_at(begin))
        }
        PlaceOf::Cast(element) => elements[element].value("at").and_then(vector).unwrap_or_default(),
    };
    let value = (start + (position - position_at(time))).to_array().map(number_text).join(" ");
    let mut changes = vec![(at.element(), "at", Some(value))];
    if let PlaceOf::Action(element, begin) = at
        && elements[element].attribute("facing").is_none()
        && elements[element].value("at").is_some_and(|at| is_mark(scene, at))
    {
        // The direction of the mark stays.
        let facing = scene.plan.placement(index, begin).map_or(0.0, |place| place.facing.to_degrees());
        changes.push((element, "facing", Some(number_text(facing))));
    }
    ScriptDraft::of(scene.script).with(&changes)?.finish()
}

fn is_mark(scene: &GestureScene<'_>, id: &str) -> bool {
    let thing = scene.plan.thing_called(id).and_then(|thing| scene.plan.things().get(thing));
    thing.is_some_and(|thing| thing.kind == "mark")
}

/// Turns a thing so that it has the direction `degrees` at `time`: 0 looks along +z, 90 along +x.
///
/// # Errors
///
/// As [`place_thing`].
pub fn face_thing(
    scene: &GestureScene<'_>,
    thing: &str,
    time: StageTime,
    degrees: f64,
) -> Result<String, GestureRefusal> {
    let at = starting_place(scene, thing, time, "facing")?;
    if !degrees.is_finite() {
        return refused("The direction is not a number");
    }
    // From -180 to 180.
    let turned = degrees - 360.0 * ((degrees + 180.0) / 360.0).floor();
    let element = &scene.script.tree().elements()[at.element()];
    let value = number_text(turned);
    let is_written = element.attribute("facing").is_some();
    let value = (is_written || value != "0").then_some(value);
    ScriptDraft::of(scene.script).with(&[(at.element(), "facing", value)])?.finish()
}

/// The element that puts a thing where it is.
#[derive(Clone, Copy)]
enum PlaceOf {
    /// Its element in the cast.
    Cast(usize),
    /// An action `place`, with its begin.
    Action(usize, StageTime),
}

impl PlaceOf {
    fn element(&self) -> usize {
        match self {
            Self::Cast(element) | Self::Action(element, _) => *element,
        }
    }
}

fn starting_place(
    scene: &GestureScene<'_>,
    thing: &str,
    time: StageTime,
    attribute: &str,
) -> Result<PlaceOf, GestureRefusal> {
    let tree = scene.script.tree();
    let places = (1..scene.script.actions().len()).filter(|&action| {
        let element = scene.script.element(action);
        element.row.name == "place"
            && element.value("who") == Some(thing)
            && scene.times(action).begin <= time
    });
    if let Some(last) = places.max_by_key(|&action| (scene.times(action).begin, action)) {
        return Ok(PlaceOf::Action(scene.script.actions()[last].element, scene.times(last).begin));
    }
    let cast = tree
        .elements()
        .iter()
        .position(|element| element.value("id") == Some(thing) && scene.script.thing_called(thing).is_some());
    let Some(cast) = cast else { return refused(format!("No thing of the cast has the id \"{thing}\"")) };
    if tree.elements()[cast].is_shared {
        return refused(format!("\"{thing}\" belongs to the project: change it there"));
    }
    if tree.elements()[cast].row.attribute(attribute).is_none() {
        return refused(format!("A {} has no place of its own", tree.elements()[cast].row.name));
    }
    Ok(PlaceOf::Cast(cast))
}
