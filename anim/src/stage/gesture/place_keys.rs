//! Things put somewhere else from a time on.

use super::insert::{check_who, place_in_par};
use super::places::{face_splices, place_splices};
use super::scene::{GestureRefusal, GestureScene, refused};
use crate::stage::splice::{NewElement, TextSplices};
use crate::stage::time::StageTime;
use crate::stage::time_text::number_text;
use glam::DVec3;

/// Returns the replacements after which a thing is at `position`, meters, or has the direction `degrees`, from `time` on: those of its `place` that begins
/// then, otherwise a new one. Before that time it is where it was.
///
/// # Errors
///
/// There is no such thing, it cannot be moved, it follows a path or travels with its take at that time, or a number is not finite.
pub fn key_place_splices(
    scene: &GestureScene<'_>,
    thing: &str,
    time: StageTime,
    position: Option<DVec3>,
    degrees: Option<f64>,
) -> Result<TextSplices, GestureRefusal> {
    check_who(scene, thing, "place", "have places")?;
    if position.is_some_and(|position| !position.is_finite() || position.abs().max_element() >= 1e6) {
        return refused("The position is too far away");
    }
    if degrees.is_some_and(|degrees| !degrees.is_finite()) {
        return refused("The direction is not a number");
    }
    let index = scene.plan.thing_called(thing).unwrap_or_default();
    if let Some(action) = scene.plan.motion_in_progress(index, time) {
        let own = scene.element(action)?;
        let title = scene.script.tree().title(scene.script.actions()[action].element);
        return refused(match own.value("path") {
            Some(path) => {
                format!("{thing} follows the path {path} at this time: move the path, or go to its end")
            }
            None => format!(
                "{title} moves {thing} at this time: go to its end, or switch Auto-key off to move its start"
            ),
        });
    }
    let own = |&action: &usize| scene.script.element(action).value("who") == Some(thing);
    let is_then = |&action: &usize| {
        own(&action) && scene.script.element(action).row.name == "place" && scene.times(action).begin == time
    };
    let actions = 1..scene.script.actions().len();
    if actions.clone().any(|action| is_then(&action)) {
        return match (position, degrees) {
            (Some(position), degrees) => place_splices(scene, thing, time, position, degrees),
            (None, Some(degrees)) => face_splices(scene, thing, time, degrees),
            (None, None) => Ok(TextSplices::default()),
        };
    }
    let mut place = NewElement::new("place").with("who", thing);
    if let Some(position) = position {
        place = place.with("at", position.to_array().map(number_text).join(" "));
    }
    if let Some(degrees) = degrees {
        place = place.with("facing", number_text(degrees - 360.0 * ((degrees + 180.0) / 360.0).floor()));
    }
    place_in_par(scene, actions.rev().find(own)).added(scene, place, time.max(StageTime::ZERO))
}
