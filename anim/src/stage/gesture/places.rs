//! Things put somewhere else.

use super::cast::set_on_thing;
use super::draft::spliced_text;
use super::scene::{GestureRefusal, GestureScene, NO_PLACE, in_scene_texts, in_this_text, refused};
use crate::stage::splice::TextSplices;
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
    text_of(scene, thing, place_splices(scene, thing, time, position, None)?)
}

/// Returns the script with replacements; refuses those of the project.
fn text_of(scene: &GestureScene<'_>, thing: &str, splices: TextSplices) -> Result<String, GestureRefusal> {
    if let Some(element) = scene.script.thing_element(thing).filter(|_| splices.has_shared()) {
        in_this_text(scene.script.tree(), element)?;
    }
    spliced_text(scene.script, splices)
}

/// Returns the replacements of [`place_thing`], and of [`face_thing`] where there are `degrees`; the new text is not checked.
///
/// # Errors
///
/// As [`place_thing`].
pub fn place_splices(
    scene: &GestureScene<'_>,
    thing: &str,
    time: StageTime,
    position: DVec3,
    degrees: Option<f64>,
) -> Result<TextSplices, GestureRefusal> {
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
    let placed = written(scene, at, "at", &value)?;
    let faced = match (degrees, at) {
        (Some(degrees), _) => face_splices(scene, thing, time, degrees)?,
        // The direction of the mark stays.
        (None, PlaceOf::Action(element, begin)) if has_facing_of_mark(scene, element) => {
            let facing = scene.plan.placement(index, begin).map_or(0.0, |place| place.facing.to_degrees());
            written(scene, at, "facing", &number_text(facing))?
        }
        (None, PlaceOf::Action(..) | PlaceOf::Cast(_)) => TextSplices::default(),
    };
    TextSplices::joined([placed, faced]).ok_or_else(no_place)
}

/// Returns whether an element puts a thing at a mark and does not turn it, so that it has the direction of the mark.
fn has_facing_of_mark(scene: &GestureScene<'_>, element: usize) -> bool {
    let element = &scene.script.tree().elements()[element];
    let mark = element.value("at").filter(|_| element.attribute("facing").is_none());
    let thing = mark.and_then(|id| scene.plan.things().get(scene.plan.thing_called(id)?));
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
    text_of(scene, thing, face_splices(scene, thing, time, degrees)?)
}

/// Returns the replacements of [`face_thing`]; the new text is not checked.
///
/// # Errors
///
/// As [`place_thing`].
pub fn face_splices(
    scene: &GestureScene<'_>,
    thing: &str,
    time: StageTime,
    degrees: f64,
) -> Result<TextSplices, GestureRefusal> {
    let at = starting_place(scene, thing, time, "facing")?;
    if !degrees.is_finite() {
        return refused("The direction is not a number");
    }
    // From -180 to 180.
    let turned = degrees - 360.0 * ((degrees + 180.0) / 360.0).floor();
    let value = number_text(turned);
    let is_written = scene.script.tree().elements()[at.element()].attribute("facing").is_some();
    match is_written || value != "0" || has_facing_of_mark(scene, at.element()) {
        true => written(scene, at, "facing", &value),
        false => Ok(TextSplices::default()),
    }
}

fn written(
    scene: &GestureScene<'_>,
    at: PlaceOf,
    name: &str,
    value: &str,
) -> Result<TextSplices, GestureRefusal> {
    set_on_thing(scene.script, at.element(), name, Some(value)).ok_or_else(no_place)
}

fn no_place() -> GestureRefusal {
    GestureRefusal(NO_PLACE.to_owned())
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
        let element = scene.script.actions()[last].element;
        in_this_text(tree, element)?;
        return Ok(PlaceOf::Action(element, scene.times(last).begin));
    }
    let Some(cast) = scene.script.thing_element(thing) else {
        return refused(format!("No thing of the cast has the id \"{thing}\""));
    };
    in_scene_texts(tree, cast)?;
    if tree.elements()[cast].row.attribute(attribute).is_none() {
        return refused(format!("A {} has no place of its own", tree.elements()[cast].row.name));
    }
    Ok(PlaceOf::Cast(cast))
}
