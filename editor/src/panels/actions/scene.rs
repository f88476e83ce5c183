//! Scenes: selection, the newest text, things of the cast.

use super::{playback, scene_lines};
use crate::panels::commands::{self, Command, Id};
use crate::panels::request::Effect;
use crate::panels::scene::{NewThing, SceneBase, SceneRequest, ScriptChange, new_thing_text};
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::stage::gesture::GestureRefusal;
use dragonfly_document::bones::Choice;
use std::path::{Component, Path};
use std::sync::Arc;

/// Commands for models and the ones with the same meaning, and the same keys, while a scene is open.
const COUNTERPARTS: &[(Id, Id)] = &[
    (Id::DeleteKeys, Id::SceneDelete),
    (Id::DuplicateKeys, Id::SceneDuplicate),
    (Id::RenameTake, Id::SceneRename),
    (Id::KeysEarlier, Id::ClipEarlier),
    (Id::KeysLater, Id::ClipLater),
    (Id::FitKeys, Id::FitScene),
    (Id::SplitTake, Id::CutHere),
];

/// Returns the command that is run in place of another one while a scene is open.
pub(in crate::panels) fn counterpart(workspace: &Workspace, command: &'static Command) -> &'static Command {
    if workspace.read().scene().is_none() {
        return command;
    }
    let other = COUNTERPARTS.iter().find(|(own, _)| *own == command.id).map(|(_, other)| *other);
    other.map_or(command, commands::get)
}

/// Executes a request about the scene.
pub(in crate::panels) fn perform(workspace: &mut Workspace, request: SceneRequest) -> Option<Effect> {
    match request {
        SceneRequest::Text(change) => return change_text(workspace, &change),
        SceneRequest::Typed(change) => {
            let effect = change_text(workspace, &change);
            workspace.scene.set_typing(change.gesture);
            return effect;
        }
        SceneRequest::SelectThings(things, choice) => {
            workspace.scene.select_things(&things, choice);
            if choice == Choice::Replace {
                workspace.scene.select_action(None);
            }
        }
        SceneRequest::SelectAction(action) => workspace.scene.select_action(action),
        SceneRequest::Cursor(at) => workspace.scene.select_at(at),
        SceneRequest::Hide(things, hide) => workspace.scene.hide(things, hide),
        SceneRequest::Lock(things, lock) => workspace.scene.lock(things, lock),
        SceneRequest::Rename(thing) => workspace.scene.rename(thing),
        SceneRequest::Ripple(ripple) => workspace.scene.set_ripple(ripple),
        SceneRequest::Window(window) => workspace.scene.set_window(window),
        SceneRequest::Refused(reason) => workspace.say(MessageSeverity::Info, reason),
        SceneRequest::EditModel(thing) => edit_model(workspace, &thing),
        SceneRequest::Line(request) => return scene_lines::perform(workspace, request),
    }
    None
}

fn change_text(workspace: &mut Workspace, change: &ScriptChange) -> Option<Effect> {
    let scene = Arc::clone(workspace.model.view()?.scene.as_ref()?);
    match workspace.scene.change(&scene, change) {
        Ok(change) => change.map(Effect::Change),
        Err(reason) => {
            workspace.say(MessageSeverity::Info, reason);
            None
        }
    }
}

/// Makes a gesture on the scene as it is now a step of the history.
pub(super) fn gesture(
    workspace: &mut Workspace,
    label: &'static str,
    act: impl FnOnce(&SceneBase) -> Result<String, GestureRefusal>,
) -> Option<Effect> {
    let scene = Arc::clone(workspace.model.view()?.scene.as_ref()?);
    let base = SceneBase::of(&scene, workspace.scene.text(&scene));
    match base.and_then(|base| Ok((act(&base)?, Arc::clone(base.text())))) {
        Ok((text, from)) => change_text(workspace, &ScriptChange { from, text, label, gesture: None }),
        Err(refusal) => {
            workspace.say(MessageSeverity::Info, refusal.to_string());
            None
        }
    }
}

/// Adds a thing to the cast and selects it.
pub(in crate::panels) fn add(workspace: &mut Workspace, thing: &NewThing) -> Option<Effect> {
    let mut added = None;
    let effect = gesture(workspace, thing.label(), |base| {
        let (text, id) = new_thing_text(base.text(), thing)?;
        added = Some(id);
        Ok(text)
    });
    if let Some(id) = added {
        workspace.scene.await_thing(id);
    }
    effect
}

/// Adds a model file to the cast. It has to be below the folder of the script.
pub(super) fn add_model(
    workspace: &mut Workspace,
    path: &Path,
    thing: impl FnOnce(String) -> NewThing,
) -> Option<Effect> {
    let folder = workspace.read().model_folder()?;
    match relative(&folder, path) {
        Some(model) => add(workspace, &thing(model)),
        None => {
            let text = format!(
                "{} is not in the folder of the scene: copy it to {} or below first",
                path.file_name().unwrap_or_default().display(),
                folder.display()
            );
            workspace.say(MessageSeverity::Warning, text);
            None
        }
    }
}

/// Returns a path relative to a folder that contains it, with `/`.
fn relative(folder: &Path, path: &Path) -> Option<String> {
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let (folder, path) = (absolute(folder), absolute(path));
    let rest = path.strip_prefix(&folder).ok()?;
    let parts: Option<Vec<&str>> = rest
        .components()
        .map(|part| match part {
            Component::Normal(name) => name.to_str(),
            Component::Prefix(_) | Component::RootDir | Component::CurDir | Component::ParentDir => None,
        })
        .collect();
    parts.map(|parts| parts.join("/")).filter(|parts| !parts.is_empty())
}

/// Starts to rename the active thing.
pub(in crate::panels) fn rename(workspace: &mut Workspace) {
    let thing = workspace.scene.things().last().cloned();
    workspace.scene.rename(thing);
}

/// Switches whether what follows in a sequence moves along.
pub(in crate::panels) fn toggle_ripple(workspace: &mut Workspace) {
    let ripple = !workspace.scene.ripple();
    workspace.scene.set_ripple(ripple);
}

/// Shows all of the scene in its timeline.
pub(in crate::panels) fn fit(workspace: &mut Workspace) {
    workspace.scene.set_window(None);
}

/// Asks for the takes and bones of the model of a thing.
fn edit_model(workspace: &mut Workspace, thing: &str) {
    workspace.scene.edit_model(thing.into());
    let text = format!("Takes and bones of {thing} are edited in its own file: File ▸ Open");
    workspace.say(MessageSeverity::Info, text);
}

/// Shows a scene that was just opened: from its start, paused.
pub(super) fn opened(workspace: &mut Workspace) {
    follow(workspace, 0);
    if let Some(bounds) = workspace.read().scene_bounds() {
        workspace.player.show(Some(0), Some(bounds));
    }
}

/// Adapts to a newer view of the scene.
pub(super) fn follow(workspace: &mut Workspace, answered: u64) {
    let Some(view) = workspace.model.view() else { return };
    let scene = view.scene.clone();
    workspace.scene.update(scene.as_deref(), answered);
    let Some(script) = scene.as_ref().and_then(|scene| scene.script.as_ref()) else { return };
    let rate = script.rate().per_second().round() as u32;
    if workspace.frame_rate.get() != rate {
        workspace.frame_rate.choose(rate);
    }
    // The models may have come after the script.
    if workspace.player.take().is_none()
        && let Some(bounds) = workspace.read().scene_bounds()
    {
        let time = workspace.player.time();
        workspace.player.show(Some(0), Some(bounds));
        playback::seek(workspace, time);
    }
}
