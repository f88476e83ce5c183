//! The begin of an action, written so that it begins at another time.

use super::draft::AttributeChange;
use super::scene::GestureScene;
use crate::stage::moment::MomentText;
use crate::stage::script::ActionMoment;
use crate::stage::time::StageTime;
use crate::stage::time_text::{moment_text, readable};

/// Returns the change of an attribute `begin` or `end` that moves it by `by`. A reference to another action stays one. A begin of zero
/// after the usual one is not written. Where the new time is no whole number of milliseconds or frames, it is up to a millisecond earlier.
pub(super) fn moved_moment<'a>(
    scene: &GestureScene<'_>,
    action: usize,
    name: &'a str,
    by: StageTime,
) -> AttributeChange<'a> {
    let (own, element) = (&scene.script.actions()[action], scene.script.element(action));
    let old = element.attribute(name).map_or("", |attribute| &*attribute.value);
    let rate = scene.script.rate();
    let value = match MomentText::parse(old, rate) {
        Some(MomentText::Of { action, point, offset }) => {
            Some(MomentText::Of { action, point, offset: readable(offset + by, rate) })
        }
        Some(MomentText::Offset(offset)) => Some(MomentText::Offset(readable(offset + by, rate))),
        None => Some(MomentText::Offset(readable(by, rate))),
    };
    let value = value.filter(|moment| name != "begin" || *moment != MomentText::Offset(StageTime::ZERO));
    (own.element, name, value.map(|moment| moment_text(&moment, rate, old)))
}

/// Returns whether an action begins at its usual time, or a time after it.
pub(super) fn is_usual(scene: &GestureScene<'_>, action: usize) -> bool {
    match scene.script.actions()[action].begin {
        None | Some(ActionMoment::Offset(_)) => true,
        Some(ActionMoment::Begin(..) | ActionMoment::End(..) | ActionMoment::Point(..)) => false,
    }
}

/// Returns the change that keeps the action after `action` in a `seq` where it is, while the end of `action` moves by `by`; `None` where none
/// is needed.
pub(super) fn kept_follower(
    scene: &GestureScene<'_>,
    action: usize,
    by: StageTime,
) -> Option<AttributeChange<'static>> {
    let next = scene.next_in_seq(action).filter(|&next| is_usual(scene, next))?;
    (by != StageTime::ZERO && !scene.script.actions()[action].passive)
        .then(|| moved_moment(scene, next, "begin", -by))
}
