//! Clips of one lane that are at the same time: where the later one mixes with the one before it, and where it cuts.

use crate::stage::schedule::ActionTimes;
use crate::stage::script::{ScriptElement, StageScript};
use crate::stage::time::{MILLISECOND, StageTime};
use std::collections::HashMap;

/// How a clip takes over from the one before it in its lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takeover {
    /// The one before it is over.
    After,
    /// The one before it is still on, and is cut off.
    Cut,
    /// The one before it is still on; both are mixed up to this time.
    Mix(StageTime),
}

/// A clip that begins while the one before it in its lane is still on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::stage) struct ClipOverlap {
    /// The action.
    pub(in crate::stage) action: usize,
    /// The end of the one before it.
    pub(in crate::stage) until: StageTime,
    /// Whether it ends no later than the one before it does.
    is_inside: bool,
}

impl ClipOverlap {
    /// Returns the duration that a mix of both has; zero where one is inside of the other.
    pub(in crate::stage) fn mix(&self, times: &[ActionTimes]) -> StageTime {
        if self.is_inside { StageTime::ZERO } else { self.until - times[self.action].begin }
    }
}

/// Returns whether two times are the same up to the precision with which scripts are written.
pub(in crate::stage) fn is_same(one: StageTime, other: StageTime) -> bool {
    (one - other).ticks().abs() <= 2 * MILLISECOND.ticks()
}

/// Returns whether an element decides over the whole body of its thing, or over its place.
pub(super) fn is_main(element: &ScriptElement) -> bool {
    match element.row.name {
        "shot" | "move" | "run" => true,
        "play" => element.value("layer").is_none() && element.value("bones").is_none(),
        _ => false,
    }
}

/// Returns the clips that begin while the one before them is still on, for each action that has one, in the lanes of all things.
///
/// The one before a clip is the last one that began earlier and decides over the same: a take over the pose, a way without a take over the
/// place only.
pub(in crate::stage) fn overlaps(script: &StageScript, times: &[ActionTimes]) -> Vec<ClipOverlap> {
    let is_clip = |&action: &usize| {
        let element = script.element(action);
        matches!(element.row.name, "play" | "move") && is_main(element)
    };
    let mut clips: Vec<usize> = (1..script.actions().len().min(times.len())).filter(is_clip).collect();
    clips.sort_by_key(|&action| (times[action].begin, action));
    // For each thing, and whether it is about the pose, the end of the last clip.
    let mut before: HashMap<(&str, bool), StageTime> = HashMap::new();
    let mut found = Vec::new();
    for action in clips {
        let (element, own) = (script.element(action), times[action]);
        let poses = element.value("take").is_some();
        let name = element.value("who").unwrap_or_default();
        let last = before.get(&(name, poses)).copied();
        if let Some(until) = last.filter(|&last| last > own.begin + MILLISECOND) {
            let is_inside = own.stop <= until || own.stop <= own.begin + MILLISECOND;
            found.push(ClipOverlap { action, until: until.min(own.stop), is_inside });
        }
        before.insert((name, poses), own.stop);
    }
    found
}

/// Returns how each action takes over, where that is not [`Takeover::After`].
pub(super) fn takeovers(script: &StageScript, times: &[ActionTimes]) -> HashMap<usize, Takeover> {
    let of = |overlap: ClipOverlap| {
        let begin = times[overlap.action].begin;
        let fade = script.time(script.element(overlap.action), "fade-in").unwrap_or_default();
        let takeover = match fade > StageTime::ZERO {
            true => Takeover::Mix((begin + fade).min(overlap.until)),
            false => Takeover::Cut,
        };
        (overlap.action, takeover)
    };
    overlaps(script, times).into_iter().map(of).collect()
}
