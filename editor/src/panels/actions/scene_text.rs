//! New texts of a scene's script.

use crate::panels::request::Effect;
use crate::panels::scene::{
    ChangedThings, NOT_DRAWN, NewThing, SceneBase, ScriptChange, with_new_sound, with_new_thing, with_run,
};
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::stage::gesture::GestureRefusal;
use dragonfly_document::edit::ScriptLabel;
use dragonfly_document::{Change, SceneView, listed_models};
use std::sync::Arc;

/// Sends a new text of the script.
pub(super) fn change_text(workspace: &mut Workspace, change: &ScriptChange) -> Option<Effect> {
    text_change(workspace, change).map(Effect::Change)
}

/// Returns the change of the document that makes a text that of the script.
pub(super) fn text_change(workspace: &mut Workspace, change: &ScriptChange) -> Option<Change> {
    let scene = Arc::clone(workspace.model.view()?.scene.as_ref()?);
    match workspace.scene.change(&scene, change) {
        Ok(change) => change,
        Err(reason) => {
            workspace.say(MessageSeverity::Info, reason);
            None
        }
    }
}

/// Sends a new text of the project.
pub(super) fn change_project(workspace: &mut Workspace, change: &ScriptChange) -> Option<Effect> {
    let scene = Arc::clone(workspace.model.view()?.scene.as_ref()?);
    match workspace.scene.change_project(&scene, change) {
        Ok(change) => change.map(Effect::Change),
        Err(reason) => {
            workspace.say(MessageSeverity::Info, reason);
            None
        }
    }
}

/// Makes a gesture on the scene as it is now a step of the history. It changes these things, none of which may be locked.
pub(super) fn gesture(
    workspace: &mut Workspace,
    label: ScriptLabel,
    things: ChangedThings<'_>,
    act: impl FnOnce(&SceneBase) -> Result<String, GestureRefusal>,
) -> Option<Effect> {
    step(workspace, |base| Ok(base.step(act(base)?, label, things)))
}

/// Makes a gesture that adds actions a step of the history, as [`gesture`] does, and selects them.
pub(super) fn addition(
    workspace: &mut Workspace,
    label: ScriptLabel,
    things: ChangedThings<'_>,
    act: impl FnOnce(&SceneBase) -> Result<String, GestureRefusal>,
) -> Option<Effect> {
    let mut text = None;
    let effect = step(workspace, |base| {
        let change = base.step(act(base)?, label, things);
        text = Some(Arc::from(&*change.text));
        Ok(change)
    });
    if let Some(text) = text.filter(|_| effect.is_some()) {
        workspace.scene.await_actions(text);
    }
    effect
}

/// Makes a change of the scene as it is now a step of the history: of its script, and of the project.
pub(super) fn step(
    workspace: &mut Workspace,
    act: impl FnOnce(&SceneBase) -> Result<ScriptChange, GestureRefusal>,
) -> Option<Effect> {
    match try_step(workspace, act) {
        Ok(effect) => effect,
        Err(refusal) => {
            workspace.say(MessageSeverity::Info, refusal.to_string());
            None
        }
    }
}

/// Makes a change of the scene as it is now a step of the history, as [`step`] does.
///
/// # Errors
///
/// The change is impossible. No message is added.
pub(super) fn try_step(
    workspace: &mut Workspace,
    act: impl FnOnce(&SceneBase) -> Result<ScriptChange, GestureRefusal>,
) -> Result<Option<Effect>, GestureRefusal> {
    let Some(scene) = workspace.model.view().and_then(|view| view.scene.clone()) else { return Ok(None) };
    let change = act(&SceneBase::of(&scene, workspace.scene.text(&scene))?)?;
    Ok(change_text(workspace, &change))
}

/// Adds a thing to the cast and selects it.
pub(in crate::panels) fn add(workspace: &mut Workspace, thing: &NewThing) -> Option<Effect> {
    add_all(workspace, std::slice::from_ref(thing), &[], &[])
}

/// Returns a change by which the project, if there is one, also lists the models of these files with their hashes.
/// A project whose text has errors gets them later: with the first edit of the model, or of the next one that is added.
pub(super) fn with_hashes(
    change: ScriptChange,
    base: &SceneBase,
    scene: &SceneView,
    hashes: &[(String, u64)],
) -> ScriptChange {
    let Some(project) = base.script.project().filter(|_| scene.project_errors.is_empty()) else {
        return change;
    };
    let models = hashes.iter().map(|(file, hash)| (file.as_str(), *hash));
    let listed = listed_models(project, models, change.label);
    ScriptChange { also: change.also.into_iter().chain(listed).collect(), ..change }
}

/// Adds things of one kind to the cast and sounds at the playhead in one step, and selects the things. A project lists their models with these hashes.
pub(super) fn add_all(
    workspace: &mut Workspace,
    things: &[NewThing],
    sounds: &[String],
    hashes: &[(String, u64)],
) -> Option<Effect> {
    let label = match (things, sounds) {
        ([], []) => return None,
        ([], _) => ScriptLabel::AddSound,
        ([thing, ..], []) => thing.label(),
        _ => ScriptLabel::AddFiles,
    };
    let scene = workspace.model.view()?.scene.clone()?;
    let at = workspace.read().scene_time();
    let mut added = Vec::new();
    let effect = step(workspace, |base| {
        let mut script = Arc::clone(&base.script);
        for thing in things {
            let (next, id) = with_new_thing(&script, thing)?;
            let next = if *thing == NewThing::Effect { with_run(&next, &id, at)? } else { next };
            script = Arc::new(next);
            added.push(id);
        }
        for sound in sounds {
            script = Arc::new(with_new_sound(&script, sound, at)?);
        }
        let text = script.tree().text().to_string();
        Ok(with_hashes(base.step(text, label, ChangedThings::None), base, &scene, hashes))
    });
    if effect.is_some() && !added.is_empty() {
        workspace.scene.await_things(added);
    }
    if effect.is_some() && things.contains(&NewThing::Effect) {
        workspace.say(MessageSeverity::Warning, NOT_DRAWN);
    }
    effect
}
