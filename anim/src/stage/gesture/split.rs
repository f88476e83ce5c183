//! Clips split in two.
//!
//! ```text
//! <play take="Walk" repeat="3" fade-in="0.5" fade-out="0.5"/>
//!   ─► <play take="Walk" repeat="3" fade-in="0.5" fill="release" dur="1.25"/>
//!      <play take="Walk" repeat="2" start="0.25" fade-out="0.5"/>
//! ```
//!
//! Both halves together play what the clip played: the same part of the take at each time, with the same fades, and the thing is at the same place.
//! Everything else keeps its times. An action that has no such halves is refused.

use super::begin::usual_begin;
use super::draft::{AttributeChange, ScriptDraft};
use super::halves::{ClipHalves, HalfChange, ReleasedHalf};
use super::mixes::{ActionOrigins, lengths_after};
use super::scene::{GestureRefusal, GestureScene, SHORTEST, refused};
use super::several::outermost;
use super::split_check::{check_followers, check_kind, check_rivals};
use crate::stage::moment::MomentText;
use crate::stage::schedule::resolve;
use crate::stage::script::{ActionMoment, ScriptElement, StageScript};
use crate::stage::splice::{AttachedComments, TextSplices, delete, insert_half, unique_among};
use crate::stage::time::{StageTime, TICKS_PER_SECOND};
use crate::stage::time_text::{moment_text, readable, time_text};

/// Actions that were split.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SplitClips {
    /// The new text.
    pub text: String,
    /// The second halves, as actions of the new text.
    pub halves: Vec<usize>,
    /// Why some of the actions stay as they are; `None` if all that are on at that time are split.
    pub left: Option<GestureRefusal>,
}

/// Largest difference of a time that counts as none: what is rounded to ticks.
const NEAR: StageTime = StageTime::from_ticks(TICKS_PER_SECOND / 1_000_000);

/// An action that is split, with its two halves.
struct ClipCut {
    action: usize,
    first: Vec<HalfChange>,
    second: Vec<HalfChange>,
    /// The `at` elements that belong to the second half.
    parts: Vec<usize>,
    /// The id of the second half, if others refer to moments of it.
    id: Option<String>,
}

/// Splits actions at a time: those that are on then. The first half of each keeps its id and its fade at the start, the second one its fade at the end.
///
/// # Errors
///
/// There is no such action, none of them is on at that time, or none of them can be split there.
pub fn split_clips(
    scene: &GestureScene<'_>,
    actions: &[usize],
    at: StageTime,
) -> Result<SplitClips, GestureRefusal> {
    let at = readable(at, scene.script.rate());
    let mut cuts: Vec<ClipCut> = Vec::new();
    // Those of actions that are on then count first.
    let [mut refusals, mut others] = [(); 2].map(|()| Vec::<GestureRefusal>::new());
    for action in outermost(scene, actions)? {
        let times = scene.times(action);
        let is_on = times.begin + SHORTEST <= at && at + SHORTEST <= times.stop;
        match check_kind(scene, action) {
            Ok(()) if !is_on => {}
            Ok(()) => match cut(scene, action, at, &cuts) {
                Ok(cut) => cuts.push(cut),
                Err(refusal) => refusals.push(refusal),
            },
            Err(refusal) if is_on => refusals.push(refusal),
            Err(refusal) => others.push(refusal),
        }
    }
    if cuts.is_empty() {
        return Err(refusals
            .into_iter()
            .chain(others)
            .next()
            .unwrap_or_else(|| GestureRefusal("The playhead is not inside of what is selected".to_owned())));
    }
    let left = refusals.first().map(|first| {
        let count = refusals.len();
        let what = if count == 1 { "1 action is".to_owned() } else { format!("{count} actions are") };
        GestureRefusal(format!("{what} not split: {first}"))
    });
    let text = split_text(scene, &cuts)?;
    // Each half before it is one more action.
    let halves = cuts.iter().enumerate().map(|(before, cut)| scene.script.branch(cut.action).end + before);
    Ok(SplitClips { text, halves: halves.collect(), left })
}

/// Returns the halves of an action; `others` are split, too.
fn cut(
    scene: &GestureScene<'_>,
    action: usize,
    at: StageTime,
    others: &[ClipCut],
) -> Result<ClipCut, GestureRefusal> {
    let (own, element, times) =
        (&scene.script.actions()[action], scene.script.element(action), scene.times(action));
    let time = |name: &str| scene.script.time(element, name).unwrap_or_default();
    let release = ReleasedHalf::of(scene, action);
    let fades_out = release.is_whole_released && at > times.stop - time("fade-out");
    if at < times.begin + time("fade-in") || fades_out {
        return refused("It fades there: move the playhead out of the fade");
    }
    let ClipHalves { mut first, mut second, end, has_dur } = match element.row.name {
        "play" => ClipHalves::of_play(scene, action, at)?,
        _ => ClipHalves::without_take(at),
    };
    check_rivals(scene, action, end)?;
    check_followers(scene, action)?;
    first.push(("fade-out", None));
    first.extend(release.fill.map(|fill| ("fill", Some(fill.to_owned()))));
    second.push(("fade-in", None));
    let rate = scene.script.rate();
    let like = |name: &str| element.attribute(name).map_or("", |attribute| &*attribute.value);
    if has_dur {
        first.push(("end", None));
        first.push(("dur", Some(time_text(end - times.begin, rate, like("dur")))));
    }
    second.push(("begin", begin_of_half(scene, action, end)));
    let rest = |name: &'static str| (name, Some(time_text(times.end - end, rate, like(name))));
    match own.end {
        // The action before the second half is the first one.
        Some(_) if scene.script.names_prev(action, "end") => second.extend([("end", None), rest("dur")]),
        Some(ActionMoment::Offset(_)) if scene.script.is_in_seq(action) => second.push(rest("end")),
        None if own.dur.is_some() => second.push(rest("dur")),
        Some(_) | None => {}
    }
    let parts = parts_after(scene, action, end);
    let mut cut = ClipCut { action, first, second, parts, id: None };
    if references(scene, &cut).next().is_some() {
        let tree = scene.script.tree();
        let is_taken = |id: &str| {
            tree.elements().iter().any(|element| element.value("id") == Some(id))
                || others.iter().any(|other| other.id.as_deref() == Some(id))
        };
        cut.id = Some(unique_among(element.value("id").unwrap_or_default(), is_taken));
    }
    Ok(cut)
}

/// Returns the `begin` of the second half, which is at `at`; `None` if that is its usual one.
fn begin_of_half(scene: &GestureScene<'_>, action: usize, at: StageTime) -> Option<String> {
    // There it begins at the end of the first one.
    if scene.script.is_in_seq(action) {
        return None;
    }
    let (old, rate) = (scene.script.element(action).attribute("begin"), scene.script.rate());
    let old = old.map_or("", |attribute| &*attribute.value);
    let by = at - scene.times(action).begin;
    let moment = match MomentText::parse(old, rate) {
        // The action before it is the first half.
        Some(MomentText::Of { action: other, point, offset }) if other != "prev" => {
            MomentText::Of { action: other, point, offset: offset + by }
        }
        Some(MomentText::Of { .. } | MomentText::Offset(_)) | None => {
            MomentText::Offset(at - usual_begin(scene, action))
        }
    };
    (moment != MomentText::Offset(StageTime::ZERO)).then(|| moment_text(&moment, rate, old))
}

/// Returns the `at` elements of an action whose moments are not before `end`.
fn parts_after(scene: &GestureScene<'_>, action: usize, end: StageTime) -> Vec<usize> {
    let (element, times) = (scene.script.actions()[action].element, scene.times(action));
    let is_after = |part: &ScriptElement| {
        let time = scene.script.time(part, "time").unwrap_or_default();
        times.begin + scene.script.after_start(action, time, times.once) >= end
    };
    let elements = scene.script.tree().elements().iter().enumerate().skip(element + 1);
    let parts = elements.take_while(|(_, part)| part.parent == Some(element));
    parts.filter(|(_, part)| is_after(part)).map(|(index, _)| index).collect()
}

/// Returns the elements and attributes that refer to moments of the second half of an action.
fn references<'a>(
    scene: &'a GestureScene<'_>,
    cut: &'a ClipCut,
) -> impl Iterator<Item = (usize, &'static str)> + 'a {
    let tree = scene.script.tree();
    let id = scene.script.element(cut.action).value("id").unwrap_or_default();
    let is_of_half = move |moment: &str| {
        let Some(MomentText::Of { action, point, .. }) = MomentText::parse(moment, scene.script.rate())
        else {
            return false;
        };
        let has_point = |&part: &usize| tree.elements()[part].value("name") == Some(&*point);
        action == id && (point == "end" || cut.parts.iter().any(has_point))
    };
    let own = tree.elements().iter().enumerate().filter(|(_, element)| element.is_own());
    own.flat_map(|(index, element)| ["begin", "end"].map(|name| (index, name, element.attribute(name))))
        .filter(move |(.., attribute)| attribute.is_some_and(|attribute| is_of_half(&attribute.value)))
        .map(|(index, name, _)| (index, name))
}

/// Returns the text with the halves, if everything keeps its times.
fn split_text(scene: &GestureScene<'_>, cuts: &[ClipCut]) -> Result<String, GestureRefusal> {
    let script = scene.script;
    let element_of = |cut: &ClipCut| script.actions()[cut.action].element;
    let draft = ScriptDraft::of(script).then(|tree| {
        let half = |cut: &ClipCut| insert_half(tree, element_of(cut), cut.id.as_deref(), &cut.parts);
        let halves: Option<Vec<TextSplices>> = cuts.iter().map(half).collect();
        TextSplices::joined(halves?)
    })?;
    // Elements after a half have other numbers.
    let elements = script.tree().elements();
    let count = |cut: &ClipCut| {
        let end = elements[element_of(cut)].range.end;
        let inside = elements.iter().skip(element_of(cut)).take_while(|inner| inner.range.start < end);
        inside.count()
    };
    let moved = |element: usize| {
        let is_before = |cut: &&ClipCut| element_of(cut) + count(cut) <= element;
        element + cuts.iter().filter(is_before).map(|cut| 1 + cut.parts.len()).sum::<usize>()
    };
    let mut changes: Vec<AttributeChange<'_>> = Vec::new();
    let mut gone: Vec<usize> = Vec::new();
    for cut in cuts {
        let first = moved(element_of(cut));
        let second = first + count(cut);
        for (element, own) in [(first, &cut.first), (second, &cut.second)] {
            let row = elements[element_of(cut)].row;
            let has = |name: &str| row.attribute(name).is_some();
            let own = own.iter().filter(|(name, _)| has(name));
            changes.extend(own.map(|(name, value)| (element, *name, value.clone())));
        }
        for (element, name) in references(scene, cut) {
            let Some(id) = &cut.id else { continue };
            let value = elements[element].attribute(name).map_or("", |attribute| &*attribute.value);
            let Some((_, rest)) = value.split_once('.') else { continue };
            let element = if element == element_of(cut) { second } else { moved(element) };
            changes.push((element, name, Some(format!("{id}.{rest}"))));
        }
        gone.extend(cut.parts.iter().map(|&part| moved(part)));
    }
    let draft = draft.with(&changes)?.then(|tree| {
        let parts = gone.iter().map(|&part| delete(tree, part, AttachedComments::Stay));
        TextSplices::joined(parts.collect::<Option<Vec<TextSplices>>>()?)
    })?;
    let actions: Vec<usize> = cuts.iter().map(|cut| cut.action).collect();
    let Some(changed) = draft.read()? else { return draft.finish() };
    check_times(scene, &changed, &ActionOrigins::copied(scene, &actions).in_script(scene, &changed))?;
    draft.finish()
}

/// Refuses a script in which another action than those that were split has other times, or the halves of one are not on for as long as it was.
fn check_times(
    scene: &GestureScene<'_>,
    changed: &StageScript,
    origins: &[Option<usize>],
) -> Result<(), GestureRefusal> {
    let schedule = resolve(changed, &lengths_after(scene, changed, origins))?;
    let is_near = |one: StageTime, other: StageTime| (one - other).ticks().abs() <= NEAR.ticks();
    // A container has times only for what is in it and after it.
    let counts = |action: usize| action == 0 || changed.actions()[action].children.is_empty();
    for (action, times) in schedule.times().iter().enumerate().filter(|(action, _)| counts(*action)) {
        let Some(origin) = origins.get(action).copied().flatten() else { continue };
        let was = scene.times(origin);
        let is_origin = |other: usize| origins.get(other).copied().flatten() == Some(origin);
        // A second half begins where the first one ends.
        let first = action.checked_sub(1).filter(|&first| is_origin(first));
        let begin = first.map_or(was.begin, |first| schedule.times()[first].end);
        let keeps_begin = is_near(times.begin, begin);
        let keeps_end =
            is_origin(action + 1) || (is_near(times.end, was.end) && is_near(times.stop, was.stop));
        if !(keeps_begin && keeps_end) {
            let title = scene.script.tree().title(scene.script.actions()[origin].element);
            return refused(format!("{title} would begin or end at another time"));
        }
    }
    Ok(())
}
