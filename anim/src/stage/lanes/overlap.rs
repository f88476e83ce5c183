//! Clips of one lane that are at the same time: where the later one mixes with the one before it, and where it cuts.
//!
//! ```text
//! │ before ╳ clip         │    partly: both are mixed for as long as both are on
//! │ before ╳ clip ╳ before│    inside: it fades in over the one before it, and gives the pose back to it
//! ```

use crate::stage::schedule::ActionTimes;
use crate::stage::script::{ScriptElement, StageScript};
use crate::stage::time::{MILLISECOND, StageTime, TICKS_PER_SECOND};
use std::collections::HashMap;

/// Duration of each fade of a clip inside of another one: a quarter of a second, or half of the clip where that is shorter.
const INSIDE: StageTime = StageTime::from_ticks(TICKS_PER_SECOND / 4);

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

/// How a clip takes over from the one before it, and gives back to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ClipTakeover {
    pub(super) takeover: Takeover,
    /// The time from which it is mixed with the one before it again, up to its end; `None` if that one is not seen after it.
    pub(super) hand_back: Option<StageTime>,
}

/// The fades with which a clip mixes with the one before it for as long as gestures make it do so.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::stage) struct ClipMix {
    pub(in crate::stage) fade_in: StageTime,
    pub(in crate::stage) fade_out: StageTime,
}

/// A clip that begins while the one before it in its lane is still on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::stage) struct ClipOverlap {
    /// The end of the one before it, or its own end if that is earlier.
    until: StageTime,
    /// Whether the one before it is still on after it.
    is_inside: bool,
    /// The fades that it gets.
    pub(in crate::stage) mix: ClipMix,
}

impl ClipOverlap {
    /// Creates the overlap of a clip with the one before it.
    fn new(element: &ScriptElement, own: ActionTimes, earlier: &BegunClip) -> Self {
        let (length, before) = (own.stop - own.begin, earlier.stop);
        let is_inside = before > own.stop && !is_same(before, own.stop);
        let fade = INSIDE.min(StageTime::from_ticks(length.ticks() / 2));
        // If both begin at once, nothing of the other one is seen before.
        let fade_in = if is_same(earlier.begin, own.begin) { StageTime::ZERO } else { fade };
        let mix = match own.stop <= before {
            // Its length may not be known yet.
            _ if length <= MILLISECOND => ClipMix::default(),
            false => ClipMix { fade_in: before - own.begin, fade_out: StageTime::ZERO },
            // A way without a take is about the place, which is not given back.
            true if element.value("take").is_none() => ClipMix::default(),
            true if is_inside && element.value("fill") != Some("hold") => ClipMix { fade_in, fade_out: fade },
            true => ClipMix { fade_in, fade_out: StageTime::ZERO },
        };
        Self { until: before.min(own.stop), is_inside, mix }
    }
}

/// A clip that began earlier in a lane.
struct BegunClip {
    begin: StageTime,
    stop: StageTime,
    is_released: bool,
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

/// Calls `visit` with each clip of the lanes of all things, in the order of their begins, and with its overlap with the one before it. It returns
/// whether the clip is released at its end, so that it gives the thing back to the one before it.
///
/// The one before a clip is the last one that began earlier and decides over the same: a take over the pose, a way without a take over the
/// place only. A clip that is over and released decides over nothing.
pub(in crate::stage) fn visit_clips(
    script: &StageScript,
    times: &[ActionTimes],
    mut visit: impl FnMut(usize, Option<ClipOverlap>) -> bool,
) {
    let is_clip = |&action: &usize| {
        let element = script.element(action);
        matches!(element.row.name, "play" | "move") && is_main(element)
    };
    let mut clips: Vec<usize> = (1..script.actions().len().min(times.len())).filter(is_clip).collect();
    clips.sort_by_key(|&action| (times[action].begin, action));
    // For each thing, and whether it is about the pose, the clips that may still decide, the last one at the end.
    let mut before: HashMap<(&str, bool), Vec<BegunClip>> = HashMap::new();
    for action in clips {
        let (element, own) = (script.element(action), times[action]);
        let poses = element.value("take").is_some();
        let begun = before.entry((element.value("who").unwrap_or_default(), poses)).or_default();
        // One that ends as this one begins is the one before it.
        let is_gone = |clip: &BegunClip| clip.is_released && clip.stop + MILLISECOND < own.begin;
        while begun.last().is_some_and(is_gone) {
            begun.pop();
        }
        let last = begun.last().filter(|last| last.stop > own.begin + MILLISECOND);
        let is_released = visit(action, last.map(|last| ClipOverlap::new(element, own, last)));
        if !is_released {
            // It is held after its end, over all that began earlier.
            begun.clear();
        }
        begun.push(BegunClip { begin: own.begin, stop: own.stop, is_released });
    }
}

/// Returns how each action takes over, where that is not [`Takeover::After`].
pub(super) fn takeovers(script: &StageScript, times: &[ActionTimes]) -> HashMap<usize, ClipTakeover> {
    let mut found = HashMap::new();
    visit_clips(script, times, |action, overlap| {
        let (element, own) = (script.element(action), times[action]);
        let fade = |name: &str| script.time(element, name).unwrap_or_default();
        let (fade_in, fade_out) = (fade("fade-in"), fade("fade-out"));
        let is_released = script.is_released(element, fade_out, false);
        if let Some(overlap) = overlap {
            let takeover = match fade_in > StageTime::ZERO {
                true => Takeover::Mix((own.begin + fade_in).min(overlap.until)),
                false => Takeover::Cut,
            };
            let hand_back = (overlap.is_inside && is_released).then(|| (own.stop - fade_out).max(own.begin));
            found.insert(action, ClipTakeover { takeover, hand_back });
        }
        is_released
    });
    found
}
