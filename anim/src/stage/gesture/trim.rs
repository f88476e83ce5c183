//! Clips that begin later or end earlier, with the rest of them where it was.

use super::begin::{kept_follower, moved_moment};
use super::draft::{AttributeChange, ScriptDraft};
use super::scene::{Followers, GestureRefusal, GestureScene, refused};
use crate::stage::script::{ScriptElement, StageRepeat};
use crate::stage::time::{Decimal, StageTime};
use crate::stage::time_text::{number_text, time_text};

/// Shortest duration of a trimmed clip: a 240th of a second.
const SHORTEST: StageTime = StageTime::from_ticks(crate::stage::time::TICKS_PER_SECOND / 240);

/// Moves the start of an action to `to`, with its end where it is.
///
/// A take loses its start, or gets more of it; one that plays backwards loses its end. A take that plays more than once has no single start
/// to trim.
///
/// # Errors
///
/// There is no such action, it would have no length, the take has nothing before its start, or it repeats.
pub fn trim_start(scene: &GestureScene<'_>, action: usize, to: StageTime) -> Result<String, GestureRefusal> {
    let element = scene.element(action)?;
    let (own, times) = (&scene.script.actions()[action], scene.times(action));
    let to = to.max(StageTime::ZERO);
    let by = to - times.begin;
    if own.children.is_empty() && times.stop > times.begin && times.stop - to < SHORTEST {
        return refused("It would have no length");
    }
    let mut changes = vec![moved_moment(scene, action, "begin", by)];
    if let Some(dur) = own.dur {
        changes.push((
            own.element,
            "dur",
            Some(text(scene, element, "dur", (dur - by).max(StageTime::ZERO))),
        ));
    }
    if element.row.name == "play" && own.repeat != StageRepeat::Fill {
        if own.repeat != StageRepeat::Times(Decimal::ONE) {
            return refused("It plays more than once: trim its end, or let it play once");
        }
        changes.push(trimmed_take(scene, action, by)?);
    } else if own.dur.is_none() && own.end.is_none() && !own.passive && own.children.is_empty() {
        // An action whose duration is that of its way would end later.
        let length = times.end - to;
        if element.row.attribute("dur").is_some() && times.end > times.begin {
            changes.push((own.element, "dur", Some(text(scene, element, "dur", length))));
        }
    }
    ScriptDraft::of(scene.script.tree()).with(&changes)?.finish()
}

/// Returns the change of the part of a take whose play begins `by` later.
fn trimmed_take(
    scene: &GestureScene<'_>,
    action: usize,
    by: StageTime,
) -> Result<AttributeChange<'static>, GestureRefusal> {
    let element = scene.script.element(action);
    let speed = speed_of(element);
    let length = scene.take(element).map(|take| take.length());
    let (name, time) = if speed.is_negative() {
        let Some(end) = scene.time_of(element, "to").or(length) else {
            return refused("The take is not known");
        };
        ("to", end + by.times(speed))
    } else {
        ("from", scene.time_of(element, "from").unwrap_or_default() + by.times(speed))
    };
    if time < StageTime::ZERO || length.is_some_and(|length| time > length) {
        return refused("The take has nothing more there");
    }
    let element_index = scene.script.actions()[action].element;
    let is_default = (name == "from" && time == StageTime::ZERO) || (name == "to" && Some(time) == length);
    Ok((element_index, name, (!is_default).then(|| text(scene, element, name, time))))
}

/// Moves the end of an action to `to`.
///
/// A take ends earlier, or later up to its own end; beyond that it repeats. An `end` stays one and keeps its reference; everything else
/// gets a `dur`.
///
/// # Errors
///
/// There is no such action, it is a shot, which ends where the next one begins, or it would have no length.
pub fn trim_end(
    scene: &GestureScene<'_>,
    action: usize,
    to: StageTime,
    followers: Followers,
) -> Result<String, GestureRefusal> {
    let element = scene.element(action)?;
    let (own, times) = (&scene.script.actions()[action], scene.times(action));
    if element.row.name == "shot" && own.passive {
        return refused("A shot ends where the next one begins");
    }
    let length = to - times.begin;
    if length < SHORTEST {
        return refused("It would have no length");
    }
    let by = to - times.end;
    let mut changes = if by == StageTime::ZERO {
        Vec::new()
    } else if own.end.is_some() {
        vec![moved_moment(scene, action, "end", by)]
    } else if own.dur.is_none() && element.row.name == "play" && !own.passive {
        played_for(scene, action, length)
    } else {
        vec![(own.element, "dur", Some(text(scene, element, "dur", length)))]
    };
    if followers == Followers::Stay {
        changes.extend(kept_follower(scene, action, by));
    }
    ScriptDraft::of(scene.script.tree()).with(&changes)?.finish()
}

/// Returns the changes with which a play lasts for `length`.
fn played_for(scene: &GestureScene<'_>, action: usize, length: StageTime) -> Vec<AttributeChange<'static>> {
    let (own, element) = (&scene.script.actions()[action], scene.script.element(action));
    let once = scene.times(action).once;
    let speed = speed_of(element);
    let take = scene.take(element).map(|take| take.length());
    let (from, to) = (
        scene.time_of(element, "from").unwrap_or_default(),
        scene.time_of(element, "to").or(take).unwrap_or_default(),
    );
    let plays_once = own.repeat == StageRepeat::Times(Decimal::ONE);
    // The part of the take that `length` needs, on the clock of the take.
    let part = length.times(speed);
    let part = if part < StageTime::ZERO { -part } else { part };
    if let Some(take) = take.filter(|_| plays_once) {
        if speed.is_negative() && part <= to {
            let start = to - part;
            let value = (start > StageTime::ZERO).then(|| text(scene, element, "from", start));
            return vec![(own.element, "from", value)];
        }
        if !speed.is_negative() && from + part <= take {
            let end = from + part;
            let value = (end < take).then(|| text(scene, element, "to", end));
            return vec![(own.element, "to", value)];
        }
    }
    if once <= StageTime::ZERO {
        return vec![(own.element, "dur", Some(text(scene, element, "dur", length)))];
    }
    let times = number_text(length.ticks() as f64 / once.ticks() as f64);
    vec![(own.element, "repeat", (times != "1").then_some(times))]
}

/// Returns the speed of an action.
pub(super) fn speed_of(element: &ScriptElement) -> Decimal {
    element.value("speed").and_then(Decimal::parse).unwrap_or(Decimal::ONE)
}

/// Returns a time as the value of an attribute, in the unit that it has there.
pub(super) fn text(scene: &GestureScene<'_>, element: &ScriptElement, name: &str, time: StageTime) -> String {
    let old = element.attribute(name).map_or("", |attribute| &*attribute.value);
    time_text(time, scene.script.rate(), old)
}
