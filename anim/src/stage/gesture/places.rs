//! Things put somewhere else.

use super::draft::spliced_text;
use super::scene::{GestureRefusal, GestureScene, refused};
use crate::stage::splice::{TextSplices, set_attribute};
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
    spliced_text(scene.script, place_splices(scene, thing, time, position)?)
}

/// Returns the replacements of [`place_thing`]; the new text is not checked.
///
/// # Errors
///
/// As [`place_thing`].
pub fn place_splices(
    scene: &GestureScene<'_>,
    thing: &str,
    time: StageTime,
    position: DVec3,
) -> Result<TextSplices, GestureRefusal> {
    let at = starting_place(scene, thing, time, "at")?;
    if !position.is_finite() || position.abs().max_element() >= 1e6 {
        return refused("The position is too far away");
    }
    let position = match at {
        PlaceOf::Action(_) => position,
        PlaceOf::Cast(element) => {
            let index = scene.plan.thing_called(thing).unwrap_or_default();
            let now = scene.plan.placement(index, time).map_or(DVec3::ZERO, |place| place.position);
            let start =
                scene.script.tree().elements()[element].value("at").and_then(vector).unwrap_or_default();
            start + (position - now)
        }
    };
    let value = position.to_array().map(number_text).join(" ");
    written(set_attribute(scene.script.tree(), at.element(), "at", &value))
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
    spliced_text(scene.script, face_splices(scene, thing, time, degrees)?)
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
    let (tree, element) = (scene.script.tree(), at.element());
    let value = number_text(turned);
    let is_written = tree.elements()[element].attribute("facing").is_some();
    match is_written || value != "0" {
        true => written(set_attribute(tree, element, "facing", &value)),
        false => Ok(TextSplices::default()),
    }
}

fn written(splices: Option<TextSplices>) -> Result<TextSplices, GestureRefusal> {
    splices.ok_or_else(|| GestureRefusal("There is no place for it in the script".to_owned()))
}

/// The element that puts a thing where it is.
enum PlaceOf {
    /// Its element in the cast.
    Cast(usize),
    /// An action `place`.
    Action(usize),
}

impl PlaceOf {
    fn element(&self) -> usize {
        match self {
            Self::Cast(element) | Self::Action(element) => *element,
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
        return Ok(PlaceOf::Action(scene.script.actions()[last].element));
    }
    let Some(cast) = scene.script.thing_element(thing) else {
        return refused(format!("No thing of the cast has the id \"{thing}\""));
    };
    if tree.elements()[cast].row.attribute(attribute).is_none() {
        return refused(format!("A {} has no place of its own", tree.elements()[cast].row.name));
    }
    Ok(PlaceOf::Cast(cast))
}
