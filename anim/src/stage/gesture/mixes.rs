//! Fades of clips that overlap the one before them: as long as the overlap.

use super::draft::{AttributeChange, ScriptDraft};
use super::scene::{GestureRefusal, GestureScene};
use super::trim::text;
use crate::stage::lanes::{is_same, overlaps};
use crate::stage::schedule::{ActionTimes, resolve};
use crate::stage::script::{ScriptElement, StageScript};
use crate::stage::time::StageTime;
use crate::stage::time_text::readable;
use std::collections::HashMap;

/// The actions of a script as they were before a gesture.
pub(super) struct ActionOrigins(Vec<Option<usize>>);

impl ActionOrigins {
    /// Returns the origins where no action was added, deleted or moved in the text.
    pub(super) fn same(scene: &GestureScene<'_>) -> Self {
        Self((0..scene.script.actions().len()).map(Some).collect())
    }

    /// Returns the origins where an action and those in it went to another place of the text: the first of them is now the action `new`.
    pub(super) fn moved(scene: &GestureScene<'_>, actions: std::ops::Range<usize>, new: usize) -> Self {
        let mut all = Self::same(scene).0;
        let moved: Vec<Option<usize>> = all.drain(actions).collect();
        let new = new.min(all.len());
        all.splice(new..new, moved);
        Self(all)
    }

    /// Returns these origins with a new action after the `before` first ones of the script before the gesture, and after new ones there.
    pub(super) fn with_new(mut self, before: usize) -> Self {
        let at = self.0.iter().position(|origin| origin.is_some_and(|origin| origin >= before));
        self.0.insert(at.unwrap_or(self.0.len()), None);
        self
    }
}

/// Returns an action and those in it.
pub(super) fn with_children(script: &StageScript, action: usize) -> std::ops::Range<usize> {
    let end = script.element(action).range.end;
    let inner = script.actions()[action..].iter();
    let count = inner.take_while(|inner| script.tree().elements()[inner.element].range.start < end).count();
    action..action + count
}

/// Gives the clips of the things `lanes` fades as long as their overlaps with the clips before them, where a gesture changed these overlaps.
/// A fade that was not as long as the overlap before stays.
pub(super) fn mixed<'a, 'b>(
    scene: &GestureScene<'_>,
    draft: ScriptDraft<'a>,
    origins: &ActionOrigins,
    lanes: impl IntoIterator<Item = &'b str>,
) -> Result<ScriptDraft<'a>, GestureRefusal> {
    let Some(script) = draft.read()? else { return Ok(draft) };
    let schedule = resolve(&script, &lengths_after(scene, &script, origins))?;
    let mut changes: Vec<AttributeChange<'_>> = Vec::new();
    let mut lanes: Vec<&str> = lanes.into_iter().collect();
    lanes.sort_unstable();
    lanes.dedup();
    for who in lanes {
        let old = mixes(scene.script, scene.schedule().times(), who);
        let new = mixes(&script, schedule.times(), who);
        for action in 1..script.actions().len() {
            let element = script.element(action);
            if element.value("who") != Some(who) || element.row.attribute("fade-in").is_none() {
                continue;
            }
            let origin = origins.0.get(action).copied().flatten();
            let before = origin.and_then(|origin| old.get(&origin)).copied().unwrap_or_default();
            let after = new.get(&action).copied().unwrap_or_default();
            let fade = script.time(element, "fade-in").unwrap_or_default();
            if is_same(before, after) || !is_same(fade, before) {
                continue;
            }
            let length = readable(after, script.rate());
            let value = (length > StageTime::ZERO).then(|| text(scene, element, "fade-in", length));
            changes.push((script.actions()[action].element, "fade-in", value));
        }
    }
    draft.with(&changes)
}

/// Returns for each clip that overlaps the one before it the duration of their mix.
fn mixes(script: &StageScript, times: &[ActionTimes], who: &str) -> HashMap<usize, StageTime> {
    overlaps(script, times, Some(who)).into_iter().map(|clip| (clip.action, clip.mix(times))).collect()
}

/// Returns the duration of one repetition of each action of a changed script: of a take by its own attributes, of others as it was.
fn lengths_after(scene: &GestureScene<'_>, script: &StageScript, origins: &ActionOrigins) -> Vec<StageTime> {
    let length = |action: usize| {
        let was = origins.0.get(action).copied().flatten().map(|origin| scene.times(origin).once);
        played(scene, script, action).or(was).unwrap_or_default()
    };
    (0..script.actions().len()).map(length).collect()
}

/// Returns the duration of one repetition of a take, as the plan computes it; `None` for other actions and while the model is missing.
fn played(scene: &GestureScene<'_>, script: &StageScript, action: usize) -> Option<StageTime> {
    let element: &ScriptElement = script.element(action);
    if element.row.name != "play" {
        return None;
    }
    let length = scene.take(element)?.length();
    let time = |name: &str| script.time(element, name).map(|time| time.min(length));
    let from = time("from").unwrap_or_default();
    Some((time("to").unwrap_or(length).max(from) - from).over(script.speed(action)))
}
