//! The halves of a clip that is split: the part of the take that each of them plays, and whether the first one is released.

use super::scene::{GestureRefusal, GestureScene, refused};
use super::trim::text;
use crate::stage::script::StageRepeat;
use crate::stage::time::{Decimal, StageTime};
use crate::stage::time_text::decimal_text;

/// A change of an attribute of a half: the name, and the new value; `None` removes it.
pub(super) type HalfChange = (&'static str, Option<String>);

/// The attributes in which the halves differ from the whole, apart from begins and ends.
pub(super) struct ClipHalves {
    pub(super) first: Vec<HalfChange>,
    pub(super) second: Vec<HalfChange>,
    /// The end of the first half, where the second one begins.
    pub(super) end: StageTime,
    /// Whether the first half needs a `dur` for that.
    pub(super) has_dur: bool,
}

impl ClipHalves {
    /// Returns the halves of an action without a take of its own.
    pub(super) fn without_take(at: StageTime) -> Self {
        Self { first: Vec::new(), second: Vec::new(), end: at, has_dur: true }
    }

    /// Returns the halves of a play. One that plays its part once ends with another part; one that repeats has a `dur`, and its second half continues in
    /// the middle of a repetition.
    pub(super) fn of_play(
        scene: &GestureScene<'_>,
        action: usize,
        at: StageTime,
    ) -> Result<Self, GestureRefusal> {
        let (own, element) = (&scene.script.actions()[action], scene.script.element(action));
        let who = element.value("who").and_then(|who| scene.plan.thing_called(who));
        let moment = who.and_then(|who| scene.plan.play_moment(who, action, at));
        let (Some(moment), Some(take)) = (moment, scene.take(element).map(|take| take.length())) else {
            return refused("The take is not known");
        };
        let time = |name: &str| scene.script.time(element, name).map(|time| time.min(take));
        let (from, to) = (time("from").unwrap_or_default(), time("to").unwrap_or(take));
        let to = to.max(from);
        let speed = scene.script.speed(action);
        let written = |name: &str| Some(text(scene, element, name, moment.time));
        let plays_once =
            own.repeat == StageRepeat::Times(Decimal::ONE) && element.attribute("start").is_none();
        let mut halves = Self::without_take(at);
        if moment.is_over {
            // It holds the end of the last repetition.
            halves.second.push(("from", written("from").filter(|_| moment.time > StageTime::ZERO)));
            halves.second.push(("to", written("to").filter(|_| moment.time != take)));
            halves.second.extend([("start", None), ("repeat", None)]);
        } else if plays_once {
            // Backwards it plays the end of its part first.
            let [of_first, of_second] = if speed.is_negative() { ["from", "to"] } else { ["to", "from"] };
            halves.second.push((of_second, written(of_second)));
            if own.dur.is_none() && own.end.is_none() {
                halves.first.push((of_first, written(of_first)));
                let played = if speed.is_negative() { to - moment.time } else { moment.time - from };
                halves.end = scene.times(action).begin + played.over(speed);
                halves.has_dur = false;
            }
        } else {
            let usual = if speed.is_negative() { to } else { from };
            halves.second.push(("start", written("start").filter(|_| moment.time != usual)));
            if let StageRepeat::Times(times) = own.repeat {
                let left = decimal_text(times.to_f64() - moment.loops as f64, 9);
                halves.second.push(("repeat", (left != "1").then_some(left)));
            }
        }
        Ok(halves)
    }
}

/// The release of the first half.
pub(super) struct ReleasedHalf {
    /// Whether the whole is released at its end.
    pub(super) is_whole_released: bool,
    /// The `fill` that the first half needs; `None` if it keeps its own.
    pub(super) fill: Option<&'static str>,
}

impl ReleasedHalf {
    /// Returns whether the first half of an action has to be released: it must not be seen any more if the second one is, or if that is released.
    pub(super) fn of(scene: &GestureScene<'_>, action: usize) -> Self {
        let (script, element) = (scene.script, scene.script.element(action));
        let fade_out = script.time(element, "fade-out").unwrap_or_default();
        let is_layer = element.value("layer").is_some() || element.value("bones").is_some();
        let releases = element.row.name != "play" || is_layer;
        let is_whole_released = script.is_released(element, fade_out, releases);
        let weight = element.value("weight").and_then(Decimal::parse).map_or(1.0, Decimal::to_f64);
        let is_needed = releases || is_whole_released || weight < 1.0;
        let is_already = script.is_released(element, StageTime::ZERO, releases);
        Self { is_whole_released, fill: (is_needed && !is_already).then_some("release") }
    }
}
