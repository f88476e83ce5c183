//! Fades of clips that overlap the one before them: as long as the overlap, and at both ends of a clip inside of another one.

use super::draft::{AttributeChange, ScriptDraft};
use super::scene::{GestureRefusal, GestureScene};
use super::trim::text;
use crate::stage::lanes::{ClipMix, is_same, visit_clips};
use crate::stage::schedule::{ActionTimes, resolve};
use crate::stage::script::{ScriptElement, StageScript};
use crate::stage::time::{Decimal, StageTime};
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

    /// Returns the origins where `actions`, in the order of the text, went with everything in them to before the action `before`.
    pub(super) fn gathered(scene: &GestureScene<'_>, actions: &[usize], before: usize) -> Self {
        let mut all = Self::without(scene, actions).0;
        let at = all.iter().position(|origin| origin.is_some_and(|origin| origin >= before));
        let at = at.unwrap_or(all.len());
        all.splice(at..at, actions.iter().flat_map(|&action| scene.script.branch(action)).map(Some));
        Self(all)
    }

    /// Returns the origins where `actions` are deleted with everything in them.
    pub(super) fn without(scene: &GestureScene<'_>, actions: &[usize]) -> Self {
        let mut all = Self::same(scene).0;
        let branches: Vec<_> = actions.iter().map(|&action| scene.script.branch(action)).collect();
        all.retain(|origin| !origin.is_some_and(|at| branches.iter().any(|branch| branch.contains(&at))));
        Self(all)
    }

    /// Returns the origins where copies of actions, in the order of the text, are after them. What a copy was before is the original.
    pub(super) fn copied(scene: &GestureScene<'_>, actions: &[usize]) -> Self {
        let mut all = Self::same(scene).0;
        for &action in actions.iter().rev() {
            let branch = scene.script.branch(action);
            all.splice(branch.end..branch.end, branch.map(Some));
        }
        Self(all)
    }

    /// Returns for each action of the script after the gesture what it was before; `None` for a new one.
    pub(super) fn in_script(&self, scene: &GestureScene<'_>, script: &StageScript) -> Vec<Option<usize>> {
        let is_own =
            |origin: &&Option<usize>| origin.is_none_or(|origin| scene.script.element(origin).is_own());
        let mut own = self.0.iter().filter(is_own);
        let mut all: Vec<Option<usize>> = Vec::with_capacity(script.actions().len());
        for action in 0..script.actions().len() {
            all.push(match script.element(action).is_own() {
                true => own.next().copied().flatten(),
                // The actions of an included file come after the `include`, in their order.
                false => {
                    let include = script.action_in_text(action);
                    let was = all.get(include).copied().flatten();
                    let inner = was.map(|was| (scene.script.branch(was), was + action - include));
                    inner.filter(|(branch, at)| branch.contains(at)).map(|(_, at)| at)
                }
            });
        }
        all
    }

    /// Returns these origins with a new action after the `before` first ones of the script before the gesture, and after new ones there.
    pub(super) fn with_new(mut self, before: usize) -> Self {
        let at = self.0.iter().position(|origin| origin.is_some_and(|origin| origin >= before));
        self.0.insert(at.unwrap_or(self.0.len()), None);
        self
    }
}

/// Gives clips the fades of their overlaps with the clips before them, where a gesture changed these overlaps, in the lanes of all things. A fade that was not
/// that of the overlap before stays, and so does one of an included file.
pub(super) fn mixed<'a>(
    scene: &GestureScene<'_>,
    draft: ScriptDraft<'a>,
    origins: &ActionOrigins,
) -> Result<ScriptDraft<'a>, GestureRefusal> {
    let Some(script) = draft.read()? else { return Ok(draft) };
    let origins = origins.in_script(scene, &script);
    let schedule = resolve(&script, &lengths_after(scene, &script, &origins))?;
    let old = mixes(scene.script, scene.schedule().times());
    let mut changes: Vec<AttributeChange<'_>> = Vec::new();
    visit_clips(&script, schedule.times(), |action, overlap| {
        let element = script.element(action);
        let before = origins[action].and_then(|origin| old.get(&origin)).copied().unwrap_or_default();
        let after = overlap.map(|overlap| overlap.mix).unwrap_or_default();
        let fade = |name: &str| script.time(element, name).unwrap_or_default();
        let mut fade_out = fade("fade-out");
        for (name, before, after) in
            [("fade-in", before.fade_in, after.fade_in), ("fade-out", before.fade_out, after.fade_out)]
        {
            if !element.is_own() || is_same(before, after) || !is_same(fade(name), before) {
                continue;
            }
            let length = readable(after, script.rate());
            let value = (length > StageTime::ZERO).then(|| text(scene, element, name, length));
            changes.push((script.actions()[action].element, name, value));
            if name == "fade-out" {
                fade_out = length;
            }
        }
        script.is_released(element, fade_out, false)
    });
    draft.with(&changes)
}

/// Returns for each clip that overlaps the one before it the fades of their mix.
fn mixes(script: &StageScript, times: &[ActionTimes]) -> HashMap<usize, ClipMix> {
    let mut found = HashMap::new();
    visit_clips(script, times, |action, overlap| {
        found.extend(overlap.map(|overlap| (action, overlap.mix)));
        let element = script.element(action);
        script.is_released(element, script.time(element, "fade-out").unwrap_or_default(), false)
    });
    found
}

/// Returns the duration of one repetition of each action of a changed script: of a take and of a way by their own attributes, of others as it was.
pub(super) fn lengths_after(
    scene: &GestureScene<'_>,
    script: &StageScript,
    origins: &[Option<usize>],
) -> Vec<StageTime> {
    let length = |action: usize| {
        let origin = origins[action];
        let was = || origin.map(|origin| scene.times(origin).once);
        let gone = || gone(scene, script, action, origin?);
        played(scene, script, action).or_else(gone).or_else(was).unwrap_or_default()
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

/// Returns the duration of a way of the same length at another speed; `None` for other actions, and where one of the speeds is not written.
fn gone(scene: &GestureScene<'_>, script: &StageScript, action: usize, origin: usize) -> Option<StageTime> {
    let (old, new) = (scene.script.element(origin), script.element(action));
    if new.row.name != "move" {
        return None;
    }
    let speed = |element: &ScriptElement| Decimal::parse(&element.attribute("speed")?.value);
    Some(scene.times(origin).once.times(speed(old)?).over(speed(new)?))
}
