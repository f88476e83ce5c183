//! Clips that begin later or end earlier, with the rest of them where it was.

use super::begin::{MovedMoment, kept_follower, moved_moment};
use super::draft::{AttributeChange, ScriptDraft};
use super::mixes::{ActionOrigins, mixed};
use super::scene::{Followers, GestureRefusal, GestureScene, NO_LENGTH, SHORTEST, refused};
use crate::stage::script::{ScriptElement, StageRepeat};
use crate::stage::time::{Decimal, StageTime, TICKS_PER_SECOND};
use crate::stage::time_text::{decimal_text, time_text};

/// Distance from the pointer up to which the end of a clip that repeats is written with fewer decimals: a tenth of a millisecond.
const NEAR_END: StageTime = StageTime::from_ticks(TICKS_PER_SECOND / 10_000);

/// Moves the start of an action to `to`, with its end where it is.
///
/// A take loses its start, or gets more of it; one that plays backwards loses its end. One that plays more than once begins with its start at
/// the new time, and plays less or more often. It mixes with the clip before it for as long as they overlap.
///
/// # Errors
///
/// There is no such action, it would have no length, the take has nothing before its start, it repeats and is no play, or it is a sound without
/// an end, which plays from its own start.
pub fn trim_start(scene: &GestureScene<'_>, action: usize, to: StageTime) -> Result<String, GestureRefusal> {
    let element = scene.element(action)?;
    let (own, times) = (&scene.script.actions()[action], scene.times(action));
    let to = to.max(StageTime::ZERO);
    if own.children.is_empty() && times.stop > times.begin && times.stop - to < SHORTEST {
        return refused(NO_LENGTH);
    }
    let is_play = element.row.name == "play";
    if !is_play && own.repeat == StageRepeat::Fill {
        return refused("It repeats: trim its end, or move it");
    }
    if element.row.name == "sound" && own.dur.is_none() && own.end.is_none() {
        return refused("A sound plays from its start: move it, or trim its end");
    }
    // The rest depends on the start as it is written.
    let MovedMoment { change, by } = moved_moment(scene, action, "begin", to - times.begin);
    let mut changes = vec![change];
    if let Some(dur) = own.dur {
        let rest = (dur - by).max(StageTime::ZERO);
        changes.push((own.element, "dur", Some(text(scene, element, "dur", rest))));
    }
    if is_play && repeats(scene, action) {
        changes.extend(fewer_repetitions(scene, action, by));
    } else if is_play {
        changes.push(trimmed_take(scene, action, by)?);
    } else if own.dur.is_none() && own.end.is_none() && !own.passive && own.children.is_empty() {
        // An action whose duration is that of its way would end later.
        let length = times.end - times.begin - by;
        if element.row.attribute("dur").is_some() && times.end > times.begin {
            changes.push((own.element, "dur", Some(text(scene, element, "dur", length))));
        }
    }
    let draft = ScriptDraft::of(scene.script).with(&changes)?;
    mixed(scene, draft, &ActionOrigins::same(scene))?.finish()
}

/// Returns the change by which what begins `by` later repeats as much less often that its end stays; `None` where that stays anyway.
fn fewer_repetitions(
    scene: &GestureScene<'_>,
    action: usize,
    by: StageTime,
) -> Option<AttributeChange<'static>> {
    let (own, times) = (&scene.script.actions()[action], scene.times(action));
    let has_end = own.repeat == StageRepeat::Fill || own.dur.is_some() || own.end.is_some() || own.passive;
    if has_end || times.once <= StageTime::ZERO {
        return None;
    }
    let skipped = scene.script.skipped(action, times.once);
    let (repetitions, _) = repeated(times.once, times.stop - times.begin - by + skipped);
    Some((own.element, "repeat", (repetitions != "1").then_some(repetitions)))
}

/// Returns the change of the part of a take whose play begins `by` later.
fn trimmed_take(
    scene: &GestureScene<'_>,
    action: usize,
    by: StageTime,
) -> Result<AttributeChange<'static>, GestureRefusal> {
    let element = scene.script.element(action);
    let speed = scene.script.speed(action);
    let length = scene.take(element).map(|take| take.length());
    let (name, time) = if speed.is_negative() {
        let Some(end) = scene.script.time(element, "to").or(length) else {
            return refused("The take is not known");
        };
        ("to", end + by.times(speed))
    } else {
        ("from", scene.script.time(element, "from").unwrap_or_default() + by.times(speed))
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
/// gets a `dur`. The clip after it mixes with it for as long as they overlap.
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
        return refused(NO_LENGTH);
    }
    let by = to - times.end;
    // With the time by which the end moves as it is written.
    let (mut changes, by) = if by == StageTime::ZERO {
        (Vec::new(), by)
    } else if own.end.is_some() {
        let MovedMoment { change, by } = moved_moment(scene, action, "end", by);
        (vec![change], by)
    } else if own.dur.is_none() && element.row.name == "play" && !own.passive {
        let (change, written) = played_for(scene, action, length);
        (vec![change], times.begin + written - times.end)
    } else {
        (vec![(own.element, "dur", Some(text(scene, element, "dur", length)))], by)
    };
    if followers == Followers::Stay {
        changes.extend(kept_follower(scene, action, by));
    }
    let draft = ScriptDraft::of(scene.script).with(&changes)?;
    mixed(scene, draft, &ActionOrigins::same(scene))?.finish()
}

/// Returns the change with which a play lasts for `length`, and how long it then lasts.
fn played_for(
    scene: &GestureScene<'_>,
    action: usize,
    length: StageTime,
) -> (AttributeChange<'static>, StageTime) {
    let (own, element) = (&scene.script.actions()[action], scene.script.element(action));
    let once = scene.times(action).once;
    let speed = scene.script.speed(action);
    let take = scene.take(element).map(|take| take.length());
    let (from, to) = (
        scene.script.time(element, "from").unwrap_or_default(),
        scene.script.time(element, "to").or(take).unwrap_or_default(),
    );
    let plays_once = !repeats(scene, action);
    // The part of the take that `length` needs, on the clock of the take.
    let part = length.times(speed);
    let part = if part < StageTime::ZERO { -part } else { part };
    if let Some(take) = take.filter(|_| plays_once) {
        if speed.is_negative() && part <= to {
            let start = to - part;
            let value = (start > StageTime::ZERO).then(|| text(scene, element, "from", start));
            return ((own.element, "from", value), length);
        }
        if !speed.is_negative() && from + part <= take {
            let end = from + part;
            let value = (end < take).then(|| text(scene, element, "to", end));
            return ((own.element, "to", value), length);
        }
    }
    if once <= StageTime::ZERO {
        return ((own.element, "dur", Some(text(scene, element, "dur", length))), length);
    }
    let skipped = scene.script.skipped(action, once);
    let (times, written) = repeated(once, length + skipped);
    ((own.element, "repeat", (times != "1").then_some(times)), written - skipped)
}

/// Returns whether a play repeats its part of the take, or begins in the middle of it.
fn repeats(scene: &GestureScene<'_>, action: usize) -> bool {
    scene.script.actions()[action].repeat != StageRepeat::Times(Decimal::ONE)
        || scene.script.element(action).attribute("start").is_some()
}

/// Returns how often something that takes `once` is repeated to last for `length`, with as few decimals as bring it within a tenth of a
/// millisecond, and how long it then lasts.
fn repeated(once: StageTime, length: StageTime) -> (String, StageTime) {
    let exact = length.ticks() as f64 / once.ticks() as f64;
    let written = |decimals: usize| {
        let text = decimal_text(exact, decimals);
        let lasts = Decimal::parse(&text).map_or(StageTime::ZERO, |times| once.times(times));
        (text, lasts)
    };
    let is_near = |lasts: StageTime| (lasts - length).ticks().abs() <= NEAR_END.ticks();
    (0..9).map(written).find(|(_, lasts)| is_near(*lasts)).unwrap_or_else(|| written(9))
}

/// Returns a time as the value of an attribute, in the unit that it has there.
pub(super) fn text(scene: &GestureScene<'_>, element: &ScriptElement, name: &str, time: StageTime) -> String {
    let old = element.attribute(name).map_or("", |attribute| &*attribute.value);
    time_text(time, scene.script.rate(), old)
}
