//! The begin and the end of an action, written so that they are at other times.

use super::draft::AttributeChange;
use super::scene::GestureScene;
use crate::stage::moment::MomentText;
use crate::stage::script::ActionMoment;
use crate::stage::time::StageTime;
use crate::stage::time_text::{moment_text, readable};

/// A `begin` or `end` at another time.
pub(super) struct MovedMoment<'a> {
    /// The change of the attribute.
    pub(super) change: AttributeChange<'a>,
    /// The time by which it moves as it is written.
    pub(super) by: StageTime,
}

/// Returns the change of an attribute `begin` or `end` that moves it by `by`. A reference to another action stays one. A begin of zero
/// after the usual one is not written. Where the new time is no whole number of milliseconds or frames, it is up to a millisecond earlier.
pub(super) fn moved_moment<'a>(
    scene: &GestureScene<'_>,
    action: usize,
    name: &'a str,
    by: StageTime,
) -> MovedMoment<'a> {
    let (own, element) = (&scene.script.actions()[action], scene.script.element(action));
    let old = element.attribute(name).map_or("", |attribute| &*attribute.value);
    let rate = scene.script.rate();
    let (moment, before, after) = match MomentText::parse(old, rate) {
        Some(MomentText::Of { action, point, offset: before }) => {
            let offset = readable(before + by, rate);
            (MomentText::Of { action, point, offset }, before, offset)
        }
        Some(MomentText::Offset(before)) => {
            let after = readable(before + by, rate);
            (MomentText::Offset(after), before, after)
        }
        None => {
            let after = readable(by, rate);
            (MomentText::Offset(after), StageTime::ZERO, after)
        }
    };
    let is_usual = name == "begin" && moment == MomentText::Offset(StageTime::ZERO);
    let value = (!is_usual).then(|| moment_text(&moment, rate, old));
    MovedMoment { change: (own.element, name, value), by: after - before }
}

/// Returns the change with which the end of an action stays where it is relative to a begin that moves by `by`: an end that is a time
/// counts from the usual begin, not from the own one. `None` where it has no such end.
pub(super) fn following_end(
    scene: &GestureScene<'_>,
    action: usize,
    by: StageTime,
) -> Option<AttributeChange<'static>> {
    match scene.script.actions()[action].end? {
        ActionMoment::Offset(_) => Some(moved_moment(scene, action, "end", by).change),
        ActionMoment::Begin(..) | ActionMoment::End(..) | ActionMoment::Point(..) => None,
    }
}

/// Returns the change that writes `begin` or `end` of a copy of an action as the time `at`, after `base`, its usual begin.
pub(super) fn written_out<'a>(
    scene: &GestureScene<'_>,
    copied: usize,
    element: usize,
    name: &'a str,
    [base, at]: [StageTime; 2],
) -> AttributeChange<'a> {
    let old = scene.script.element(copied).attribute(name).map_or("", |attribute| &*attribute.value);
    let rate = scene.script.rate();
    let after = MomentText::Offset(readable(at - base, rate));
    (element, name, Some(moment_text(&after, rate, old)))
}

/// Returns whether an action begins at its usual time, or a time after it.
pub(super) fn is_usual(scene: &GestureScene<'_>, action: usize) -> bool {
    match scene.script.actions()[action].begin {
        None | Some(ActionMoment::Offset(_)) => true,
        Some(ActionMoment::Begin(..) | ActionMoment::End(..) | ActionMoment::Point(..)) => false,
    }
}

/// Returns whether an action ends at a moment of another action.
pub(super) fn ends_with_another(scene: &GestureScene<'_>, action: usize) -> bool {
    match scene.script.actions()[action].end {
        None | Some(ActionMoment::Offset(_)) => false,
        Some(ActionMoment::Begin(..) | ActionMoment::End(..) | ActionMoment::Point(..)) => true,
    }
}

/// Returns the change that keeps the action after `action` in a `seq` where it is, while the end of `action` moves by `by`; `None` where none
/// is needed.
pub(super) fn kept_follower(
    scene: &GestureScene<'_>,
    action: usize,
    by: StageTime,
) -> Option<AttributeChange<'static>> {
    let next = scene.script.next_in_seq(action).filter(|&next| is_usual(scene, next))?;
    (by != StageTime::ZERO && !scene.script.actions()[action].passive)
        .then(|| moved_moment(scene, next, "begin", -by).change)
}

/// Returns the time at which an action begins without a `begin`.
pub(super) fn usual_begin(scene: &GestureScene<'_>, action: usize) -> StageTime {
    let parent = || scene.times(scene.script.actions()[action].parent.unwrap_or(0)).begin;
    scene.script.before_in_seq(action).map_or_else(parent, |before| scene.times(before).end)
}
