//! Fades, speed and repetitions of clips.

use super::draft::ScriptDraft;
use super::mixes::{ActionOrigins, mixed};
use super::scene::{GestureRefusal, GestureScene, NO_LENGTH, SHORTEST, refused};
use super::trim::text;
use crate::stage::script::StageRepeat;
use crate::stage::time::StageTime;
use crate::stage::time_text::number_text;

/// The fade of an action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FadeEnd {
    /// At its start; of a shot, the blend from the camera before.
    In,
    /// At its end.
    Out,
}

/// Sets the duration of a fade, limited to the duration of the action. Zero removes the attribute.
///
/// # Errors
///
/// There is no such action, or it has no such fade.
pub fn set_fade(
    scene: &GestureScene<'_>,
    action: usize,
    fade: FadeEnd,
    length: StageTime,
) -> Result<String, GestureRefusal> {
    let element = scene.element(action)?;
    let names: &[&str] = match fade {
        FadeEnd::In => &["fade-in", "blend"],
        FadeEnd::Out => &["fade-out"],
    };
    let Some(name) = names.iter().find(|name| element.row.attribute(name).is_some()) else {
        return refused(format!("<{}> has no such fade", element.row.name));
    };
    let times = scene.times(action);
    let whole = times.stop - times.begin;
    let most = if whole > StageTime::ZERO { whole } else { length };
    let length = length.max(StageTime::ZERO).min(most);
    let value = (length > StageTime::ZERO).then(|| text(scene, element, name, length));
    // It moves nothing in time, so that no overlap changes.
    ScriptDraft::of(scene.script).with(&[(scene.script.actions()[action].element, name, value)])?.finish()
}

/// Sets the speed: a factor for a take, below 0 backwards; meters per second for a move.
///
/// # Errors
///
/// There is no such action, it has no speed, or it cannot be that: 0, not finite, or negative for a move.
pub fn set_speed(scene: &GestureScene<'_>, action: usize, speed: f64) -> Result<String, GestureRefusal> {
    let element = scene.element(action)?;
    let Some(row) = element.row.attribute("speed") else {
        return refused(format!("<{}> has no speed", element.row.name));
    };
    if !speed.is_finite() || speed.abs() > 1e6 {
        return refused("The speed is too large");
    }
    let value = number_text(speed);
    if !row.value.accepts(&value, scene.script.rate()) {
        return refused(format!("The speed has to be {}", row.value.expected));
    }
    change(scene, action, "speed", (value != row.default).then_some(value))
}

/// Sets the speed with which an action ends at `to`: as often as it repeats, and backwards if it plays so.
///
/// # Errors
///
/// There is no such action, it has no speed, or none that brings its end there: its `dur`, its `end` or the time that there is decides.
pub fn stretch_to(scene: &GestureScene<'_>, action: usize, to: StageTime) -> Result<String, GestureRefusal> {
    let element = scene.element(action)?;
    let (own, times) = (&scene.script.actions()[action], scene.times(action));
    let name = element.row.name;
    if element.row.attribute("speed").is_none() {
        return refused(format!("<{name}> has no speed"));
    }
    if let Some(decides) = ["dur", "end"].into_iter().find(|name| element.attribute(name).is_some()) {
        return refused(format!("Its `{decides}` decides when this <{name}> ends: drag the end without Alt"));
    }
    let (StageRepeat::Times(repeat), false) = (own.repeat, own.passive) else {
        return refused(format!("This <{name}> goes on for as long as there is time, whatever its speed"));
    };
    let now = (times.end - times.begin).seconds();
    let new = (to - times.begin).max(SHORTEST).seconds();
    if now <= 0.0 {
        return refused(NO_LENGTH);
    }
    let way = element.value("who").and_then(|who| scene.plan.thing_called(who));
    let way = way.and_then(|thing| scene.plan.way_length(thing, action));
    let speed = match way {
        // Meters per second, also where the stride of its take was the speed until now.
        Some(way) => way * repeat.to_f64() / new,
        None if name == "move" => return refused("The length of this way is not known"),
        None => scene.script.speed(action).to_f64() * now / new,
    };
    set_speed(scene, action, speed)
}

/// Sets how often an action runs.
///
/// # Errors
///
/// There is no such action, or it does not repeat.
pub fn set_repeat(
    scene: &GestureScene<'_>,
    action: usize,
    repeat: StageRepeat,
) -> Result<String, GestureRefusal> {
    let element = scene.element(action)?;
    let Some(row) = element.row.attribute("repeat") else {
        return refused(format!("<{}> does not repeat", element.row.name));
    };
    let value = match repeat {
        StageRepeat::Fill => "fill".to_owned(),
        StageRepeat::Times(times) => number_text(times.to_f64()),
    };
    if !row.value.accepts(&value, scene.script.rate()) {
        return refused("It has to play more often than 0 times");
    }
    change(scene, action, "repeat", (value != row.default).then_some(value))
}

fn change(
    scene: &GestureScene<'_>,
    action: usize,
    name: &str,
    value: Option<String>,
) -> Result<String, GestureRefusal> {
    let element = scene.script.actions()[action].element;
    let draft = ScriptDraft::of(scene.script).with(&[(element, name, value)])?;
    mixed(scene, draft, &ActionOrigins::same(scene))?.finish()
}
