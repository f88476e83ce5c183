//! New actions: shots and clips.

use super::draft::ScriptDraft;
use super::mixes::{ActionOrigins, mixed};
use super::scene::{GestureRefusal, GestureScene, NO_PLACE, refused};
use crate::stage::script::ScriptElement;
use crate::stage::splice::{ElementPlace, NewElement, TextSplices, insert};
use crate::stage::table;
use crate::stage::time::StageTime;
use crate::stage::time_text::{readable, time_text};

/// A place for a new action, and the time from which its `begin` counts.
pub(super) struct ActionPlace {
    pub(super) place: ElementPlace,
    pub(super) base: StageTime,
}

impl ActionPlace {
    /// Returns the replacements that add an action here, so that it begins at `at`.
    pub(super) fn added(
        &self,
        scene: &GestureScene<'_>,
        action: NewElement,
        at: StageTime,
    ) -> Result<TextSplices, GestureRefusal> {
        let action = match at == self.base {
            true => action,
            false => {
                let rate = scene.script.rate();
                action.with("begin", time_text(readable(at - self.base, rate), rate, ""))
            }
        };
        match insert(scene.script.tree(), self.place, &action) {
            Some(splices) => Ok(splices),
            None => refused(NO_PLACE),
        }
    }
}

/// Cuts to a camera at `at`: a new shot, or another camera for the shot that begins then.
///
/// # Errors
///
/// There is no such camera, or it is seen at that time already.
pub fn cut_to(scene: &GestureScene<'_>, camera: &str, at: StageTime) -> Result<String, GestureRefusal> {
    if kind_of(scene, camera) != Some("camera") {
        return refused(format!("\"{camera}\" is no camera of the cast"));
    }
    let at = at.max(StageTime::ZERO);
    let begin = |action: usize| scene.times(action).begin;
    let mut shots: Vec<usize> = (0..scene.script.actions().len())
        .filter(|&action| scene.script.element(action).row.name == "shot")
        .collect();
    shots.sort_by_key(|&shot| (begin(shot), shot));
    let now = shots.iter().rev().find(|&&shot| begin(shot) <= at).copied();
    let draft = ScriptDraft::of(scene.script);
    if now.is_some_and(|shot| scene.script.element(shot).value("who") == Some(camera)) {
        return refused(format!("\"{camera}\" is seen at that time already"));
    }
    if let Some(shot) = now.filter(|&shot| begin(shot) == at) {
        let element = scene.script.actions()[shot].element;
        return draft.with(&[(element, "who", Some(camera.to_owned()))])?.finish();
    }
    let near = now.or(shots.first().copied());
    let ActionPlace { place, base } = place_in_par(scene, near);
    let shot = NewElement::new("shot").with("who", camera);
    let shot =
        shot.with("begin", time_text(readable(at - base, scene.script.rate()), scene.script.rate(), ""));
    draft.then(|tree| insert(tree, place, &shot))?.finish()
}

/// Adds a take to a role at `at`: at the end of its `seq` where its last clip is in one, otherwise in a `par`.
///
/// # Errors
///
/// There is no such thing, or it plays no takes.
pub fn add_clip(
    scene: &GestureScene<'_>,
    who: &str,
    take: &str,
    at: StageTime,
) -> Result<String, GestureRefusal> {
    check_who(scene, who, "play", "play takes")?;
    add_action(scene, who, NewElement::new("play").with("who", who).with("take", take), at)
}

/// Adds a `move` of a thing along a path from `at`, with this take; its place in the script is that of [`add_clip`]. Without a take, what is no role moves at
/// a meter per second and keeps its direction.
///
/// # Errors
///
/// There is no such thing or path, or the thing does not move.
pub fn follow_path(
    scene: &GestureScene<'_>,
    who: &str,
    path: &str,
    take: Option<&str>,
    at: StageTime,
) -> Result<String, GestureRefusal> {
    check_who(scene, who, "move", "follow a path")?;
    if kind_of(scene, path) != Some("path") {
        return refused(format!("\"{path}\" is no path of the cast"));
    }
    let step = NewElement::new("move").with("who", who).with("path", path);
    let step = match (take, kind_of(scene, who)) {
        (Some(take), _) => step.with("take", take),
        (None, Some("role")) => step,
        // Without a stride it needs a speed, and without legs it need not face its way.
        (None, _) => step.with("speed", "1").with("turn", "keep"),
    };
    add_action(scene, who, step, at)
}

/// Returns the kind of a thing of the cast.
pub(super) fn kind_of(scene: &GestureScene<'_>, id: &str) -> Option<&'static str> {
    let thing = scene.plan.thing_called(id)?;
    scene.plan.things().get(thing).map(|thing| thing.kind)
}

/// Refuses a thing that does no action of this name, which do `what`.
pub(super) fn check_who(
    scene: &GestureScene<'_>,
    who: &str,
    action: &str,
    what: &str,
) -> Result<(), GestureRefusal> {
    let kinds = table::element(action).map_or(&[][..], |row| row.who);
    match kind_of(scene, who) {
        Some(kind) if kinds.contains(&kind) => Ok(()),
        Some(kind) => {
            let plural: Vec<String> = kinds.iter().map(|kind| format!("{kind}s")).collect();
            let kinds = match &plural[..] {
                [first @ .., last] if !first.is_empty() => format!("{} and {last}", first.join(", ")),
                _ => plural.concat(),
            };
            refused(format!("\"{who}\" is a {kind}; only {kinds} {what}"))
        }
        None => refused(format!("No thing of the cast has the id \"{who}\"")),
    }
}

/// Adds an action of a thing at `at`: at the end of its `seq` where its last clip is in one, otherwise in a `par`.
pub(super) fn add_action(
    scene: &GestureScene<'_>,
    who: &str,
    mut action: NewElement,
    at: StageTime,
) -> Result<String, GestureRefusal> {
    let at = at.max(StageTime::ZERO);
    let own = |&action: &usize| scene.script.element(action).value("who") == Some(who);
    let last =
        (1..scene.script.actions().len()).filter(own).max_by_key(|&action| (scene.times(action).end, action));
    let actions = scene.script.actions();
    let in_seq = last.filter(|&last| scene.script.element(last).is_own()).filter(|&last| {
        let is_last = actions[last].parent.is_some_and(|parent| {
            scene.script.is_seq(parent) && actions[parent].children.last() == Some(&last)
        });
        is_last && !actions[last].passive && scene.times(last).end <= at
    });
    let ActionPlace { place, base } = match in_seq {
        Some(last) => {
            ActionPlace { place: ElementPlace::After(actions[last].element), base: scene.times(last).end }
        }
        None => place_in_par(scene, last),
    };
    if at != base {
        let begin = time_text(readable(at - base, scene.script.rate()), scene.script.rate(), "");
        action = action.with("begin", begin);
    }
    let draft = ScriptDraft::of(scene.script).then(|tree| insert(tree, place, &action))?;
    mixed(scene, draft, &ActionOrigins::same(scene).with_new(place_index(scene, place)))?.finish()
}

/// Returns the position among the actions of a new one at a place.
pub(super) fn place_index(scene: &GestureScene<'_>, place: ElementPlace) -> usize {
    let (ElementPlace::First(near) | ElementPlace::After(near)) = place;
    let near = scene.script.actions().iter().position(|other| other.element == near);
    match (near, place) {
        (Some(near), ElementPlace::First(_)) => near + 1,
        (Some(near), ElementPlace::After(_)) => scene.script.branch(near).end,
        // After the cast.
        (None, _) => 1,
    }
}

/// Returns the place after the action `near`, or after the `seq` around it, in a `par`; at the end of the script without one.
pub(super) fn place_in_par(scene: &GestureScene<'_>, near: Option<usize>) -> ActionPlace {
    let actions = scene.script.actions();
    let last = actions[0].children.last().copied();
    // A scene whose actions are all in one `par` gets new ones in there.
    let only =
        last.filter(|&last| actions[0].children.len() == 1 && scene.script.element(last).row.name == "par");
    let near = near.or_else(|| only.and_then(|only| actions[only].children.last().copied())).or(last);
    // Not in an included file.
    let Some(mut near) = near.map(|near| scene.script.action_in_text(near)) else {
        let is_cast = |element: &ScriptElement| element.is_own() && element.row.name == "cast";
        let cast = scene.script.tree().elements().iter().position(is_cast);
        return ActionPlace {
            place: cast.map_or(ElementPlace::First(0), ElementPlace::After),
            base: StageTime::ZERO,
        };
    };
    while let Some(parent) = actions[near].parent.filter(|&parent| scene.script.is_seq(parent)) {
        near = parent;
    }
    // Not between an action and the one that this calls `prev`.
    while let Some(next) = scene.script.next_sibling(near).filter(|&next| scene.script.refers_to_prev(next)) {
        near = next;
    }
    let parent = actions[near].parent.unwrap_or(0);
    ActionPlace { place: ElementPlace::After(actions[near].element), base: scene.times(parent).begin }
}
