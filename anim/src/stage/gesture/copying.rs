//! Clips as a text of the clipboard.

use super::draft::{AttributeChange, ScriptDraft};
use super::insert::{ActionPlace, place_in_par, place_index};
use super::mixes::{ActionOrigins, mixed};
use super::other_lane::fits_onto;
use super::removal::duplicate_clip;
use super::scene::{GestureRefusal, GestureScene, NO_PLACE, refused};
use super::several::outermost;
use crate::stage::script::{MomentText, ScriptElement, ScriptTree};
use crate::stage::splice::{
    ElementPlace, TextSplices, insert_text, remove_attribute, set_attribute, written_element,
};
use crate::stage::table::ElementGroup;
use crate::stage::time::{StageRate, StageTime, parse_time};
use crate::stage::time_text::{moment_text, readable, time_text};
use std::collections::BTreeSet;

/// Start of a text of copied clips: that of a script without a cast.
const HEAD: &str = "<script version=\"1\"";

/// Returns copies of actions as the text of a small script, in which each begins as long after the first one as in the scene. Copies have no
/// ids, and no times that refer to other actions.
///
/// # Errors
///
/// There is no such action, none is given, or one of them contains others.
pub fn copied_clips(scene: &GestureScene<'_>, actions: &[usize]) -> Result<String, GestureRefusal> {
    let actions = outermost(scene, actions)?;
    let first = actions.iter().map(|&action| scene.times(action).begin).min().unwrap_or_default();
    let rate = scene.script.rate();
    let mut changes: Vec<AttributeChange<'_>> = Vec::new();
    for &action in &actions {
        let (own, times) = (&scene.script.actions()[action], scene.times(action));
        let element = scene.script.element(action);
        if element.row.group != ElementGroup::Action {
            return refused("Only actions are copied, not what contains them");
        }
        let written = |time: StageTime| Some(time_text(readable(time, rate), rate, ""));
        changes.push((own.element, "id", None));
        changes.push((own.element, "begin", written(times.begin - first)));
        // Its own length where another action decided it.
        changes.push((own.element, "end", None));
        let ends_with_others =
            own.passive && element.row.name != "shot" && own.dur.is_none() && times.stop > times.begin;
        if own.end.is_some() || ends_with_others {
            changes.push((own.element, "dur", written(times.stop - times.begin)));
        }
    }
    let draft = ScriptDraft::of(scene.script).with(&changes)?;
    let mut text = format!("{HEAD} fps=\"{rate}\">\n");
    for action in actions {
        let clip = written_element(draft.tree(), scene.script.actions()[action].element);
        text += &format!("  {}\n", clip.unwrap_or_default());
    }
    text.push_str("</script>\n");
    Ok(text)
}

/// Returns whether a text is one that [`copied_clips`] returns.
pub fn is_copied_clips(text: &str) -> bool {
    text.starts_with(HEAD)
}

/// Returns the things that get clips where copied ones are pasted, by their ids; shots belong to none. `onto` is as for [`paste_clips`].
///
/// # Errors
///
/// The text is none of clips.
pub fn things_of_pasted(copied: &str, onto: Option<&str>) -> Result<Vec<Box<str>>, GestureRefusal> {
    let copied = ScriptTree::read(copied)?;
    let clips: Vec<&ScriptElement> = copied.elements().iter().filter(|element| is_clip(element)).collect();
    let onto = onto.filter(|_| are_of_one(clips.iter().copied()));
    let whose = clips.iter().filter(|clip| clip.row.name != "shot").filter_map(|clip| clip.value("who"));
    let whose: BTreeSet<&str> = whose.map(|who| onto.unwrap_or(who)).collect();
    Ok(whose.into_iter().map(Box::from).collect())
}

/// Returns whether an element of a text of clips is one of them.
fn is_clip(element: &ScriptElement) -> bool {
    element.parent == Some(0) && element.row.group == ElementGroup::Action
}

/// Returns whether clips are of one thing: those of several ones stay with theirs.
fn are_of_one<'a>(clips: impl Iterator<Item = &'a ScriptElement>) -> bool {
    let mut from: Vec<&str> = clips.filter_map(|clip| clip.value("who")).collect();
    from.dedup();
    from.len() <= 1
}

/// Inserts copied clips, the first of them at `at`; all of them for the thing `onto`, or each for the one that it was copied from.
///
/// # Errors
///
/// The text contains no clips, a thing is not in the cast or does no such action, a model lacks a take or a bone that a clip names, or what
/// a clip refers to is missing. Then nothing is inserted.
pub fn paste_clips(
    scene: &GestureScene<'_>,
    copied: &str,
    at: StageTime,
    onto: Option<&str>,
) -> Result<String, GestureRefusal> {
    let copied = ScriptTree::read(copied)?;
    let rate = scene.script.rate();
    let from_rate = copied.elements()[0].value("fps").and_then(StageRate::parse).unwrap_or_default();
    let at = at.max(StageTime::ZERO);
    let clips: Vec<usize> =
        (0..copied.elements().len()).filter(|&element| is_clip(&copied.elements()[element])).collect();
    if clips.is_empty() {
        return refused("The clipboard contains no actions");
    }
    let onto = onto.filter(|_| are_of_one(clips.iter().map(|&clip| &copied.elements()[clip])));
    let mut origins = ActionOrigins::same(scene);
    let mut parts: Vec<(usize, ElementPlace, String)> = Vec::new();
    for clip in clips.into_iter().rev() {
        let element = &copied.elements()[clip];
        let who = element.value("who").map(|who| onto.filter(|_| element.row.name != "shot").unwrap_or(who));
        if let Some(who) = who {
            fits_onto(scene, element, who)?;
        }
        let own = |&action: &usize| match who {
            Some(who) => scene.script.element(action).value("who") == Some(who),
            None => scene.script.element(action).row.name == element.row.name,
        };
        let near = (1..scene.script.actions().len()).rfind(own);
        let ActionPlace { place, base } = place_in_par(scene, near);
        let offset = element.value("begin").and_then(|begin| parse_time(begin, from_rate));
        let begin = readable(at + offset.unwrap_or_default() - base, rate);
        let text = adapted(&copied, clip, who, &time_text(begin, rate, ""), [from_rate, rate])?;
        let (ElementPlace::First(near) | ElementPlace::After(near)) = place;
        let range = scene.script.tree().elements().get(near).map(|element| element.range.clone());
        let at =
            range.map_or(0, |range| if place == ElementPlace::First(near) { range.start } else { range.end });
        parts.push((at, place, text));
    }
    // From the end of the text to its start, so that the elements before a new one keep their numbers.
    parts.sort_by_key(|(at, ..)| std::cmp::Reverse(*at));
    let mut draft = ScriptDraft::of(scene.script);
    for (_, place, text) in parts {
        origins = origins.with_new(place_index(scene, place));
        draft = draft.then(|tree| insert_text(tree, place, &text))?;
    }
    mixed(scene, draft, &origins)?.finish()
}

/// Inserts copies of actions after the last of them ends, each as long after the first one as now. One action gets its copy after itself, as by
/// [`duplicate_clip`].
///
/// # Errors
///
/// As [`copied_clips`] and [`paste_clips`]; of one action as [`duplicate_clip`].
pub fn duplicate_clips(scene: &GestureScene<'_>, actions: &[usize]) -> Result<String, GestureRefusal> {
    let actions = outermost(scene, actions)?;
    if let [action] = actions[..] {
        return duplicate_clip(scene, action);
    }
    let last = actions.iter().map(|&action| scene.times(action).stop).max().unwrap_or_default();
    paste_clips(scene, &copied_clips(scene, &actions)?, last, None)
}

/// Returns the text of a copied element with another thing and begin, and with times in frames of the second rate instead of the first.
fn adapted(
    copied: &ScriptTree,
    clip: usize,
    who: Option<&str>,
    begin: &str,
    rates: [StageRate; 2],
) -> Result<String, GestureRefusal> {
    let mut parts = vec![
        set_attribute(copied, clip, "begin", begin),
        // The ids of a text from somewhere else may be taken.
        remove_attribute(copied, clip, "id"),
    ];
    parts.extend(who.map(|who| set_attribute(copied, clip, "who", who)));
    parts.extend(converted(copied, clip, rates));
    let splices = parts.into_iter().collect::<Option<Vec<TextSplices>>>().and_then(TextSplices::joined);
    let Some(splices) = splices else { return refused(NO_PLACE) };
    let tree = ScriptTree::read(splices.apply(copied.text()))?;
    written_element(&tree, clip).map_or_else(|| refused(NO_PLACE), Ok)
}

/// Returns the changes of the times in a copied element, except its begin, that are written in frames of the first rate: to frames of the second one, or to
/// seconds.
fn converted(copied: &ScriptTree, clip: usize, [from, to]: [StageRate; 2]) -> Vec<Option<TextSplices>> {
    if from == to {
        return Vec::new();
    }
    let whole = copied.elements()[clip].range.clone();
    let inside = copied.elements().iter().enumerate().skip(clip);
    let inside = inside.take_while(|(_, element)| element.range.start < whole.end);
    let mut changes = Vec::new();
    for (at, element) in inside {
        for attribute in &element.attributes {
            let (name, old) = (attribute.row.name, &*attribute.value);
            if !attribute.row.value.has_frames() || !old.ends_with('f') || (at == clip && name == "begin") {
                continue;
            }
            if let Some(moment) = MomentText::parse(old, from) {
                changes.push(set_attribute(copied, at, name, &moment_text(&moment, to, old)));
            }
        }
    }
    changes
}
