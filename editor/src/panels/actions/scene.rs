//! Scenes: selection, the newest text, things of the cast.

use super::scene_text::{change_project, change_text};
use super::{playback, scene_around, scene_camera, scene_files, scene_lines, scene_view};
use crate::panels::commands::{self, Command, Id};
use crate::panels::request::{Effect, FileAction};
use crate::panels::scene::SceneRequest;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_document::DocumentMessage;
use dragonfly_document::bones::Choice;
use dragonfly_picture::ThroughCamera;

/// Returns the command that is run in place of another one: those of scenes while a scene is open, and the pose line in place of lines of a project
/// while a model is.
pub(in crate::panels) fn counterpart(workspace: &Workspace, command: &'static Command) -> &'static Command {
    if workspace.read().scene().is_none() {
        return if command.id == Id::ToolLine { commands::get(Id::PoseLine) } else { command };
    }
    commands::counterpart::in_scenes(command.id).map_or(command, commands::get)
}

/// Executes a request about the scene.
pub(in crate::panels) fn perform(workspace: &mut Workspace, request: SceneRequest) -> Option<Effect> {
    match request {
        SceneRequest::Text(change) => return change_text(workspace, &change),
        SceneRequest::AddActions(change) => {
            let effect = change_text(workspace, &change);
            if effect.is_some() {
                workspace.scene.await_actions(change.text.into());
            }
            return effect;
        }
        SceneRequest::Typed(change) => {
            let effect = change_text(workspace, &change);
            workspace.scene.set_typing(change.gesture);
            return effect;
        }
        SceneRequest::TypedProject(change) => {
            let effect = change_project(workspace, &change);
            workspace.scene.set_typing(change.gesture);
            return effect;
        }
        SceneRequest::ShowScript(name) => {
            return Some(Effect::File(FileAction::Send(DocumentMessage::ShowScript(name.into()))));
        }
        SceneRequest::SelectThings(things, choice) => {
            workspace.stage.forget_click();
            workspace.scene.select_things(&things, choice);
            if choice == Choice::Replace {
                workspace.scene.select_action(None);
            }
        }
        SceneRequest::SelectAction(action) => workspace.scene.select_action(action),
        SceneRequest::SelectActions(actions, choice) => workspace.scene.select_actions(&actions, choice),
        SceneRequest::Cursor(at) => workspace.scene.select_at(at),
        SceneRequest::Hide(things, hide) => set_hidden(workspace, things, hide),
        SceneRequest::Lock(things, lock) => set_locked(workspace, things, lock),
        SceneRequest::Rename(thing) => rename_thing(workspace, thing),
        SceneRequest::Window(window) => workspace.scene.set_window(window),
        SceneRequest::Refused(reason) => workspace.say(MessageSeverity::Info, reason),
        SceneRequest::Line(request) => return scene_lines::perform(workspace, request),
        SceneRequest::Through(through) => scene_camera::look_through(workspace, through),
        SceneRequest::ThroughSecond(through) => scene_camera::look_through_in_second(workspace, through),
        SceneRequest::EditModel(thing) => return edit_model(workspace, &thing),
        SceneRequest::Settle(edits, choice) => {
            let message = DocumentMessage::DecideAllOutdated(vec![edits], choice);
            return Some(Effect::File(FileAction::Send(message)));
        }
        SceneRequest::Find(missing) => return scene_files::find(workspace, missing),
    }
    None
}

/// Starts to rename the selected line, or the active thing.
pub(in crate::panels) fn rename(workspace: &mut Workspace) {
    match workspace.scene.lines().selected().map(Box::from) {
        Some(line) => workspace.scene.lines_mut().rename(Some(line)),
        None => {
            let thing = workspace.scene.things().last().cloned();
            rename_thing(workspace, thing);
        }
    }
}

/// Starts to rename a thing, unless it is locked, or ends it.
fn rename_thing(workspace: &mut Workspace, thing: Option<Box<str>>) {
    match workspace.scene.lock_refusal(thing.as_slice()) {
        Some(reason) => workspace.say(MessageSeverity::Info, reason),
        None => workspace.scene.rename(thing),
    }
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

/// Opens the takes and bones of the model of a thing; the scene waits.
pub(in crate::panels) fn edit_model(workspace: &mut Workspace, thing: &str) -> Option<Effect> {
    let view = workspace.model.view()?;
    let script = view.scene.as_ref()?.script.as_ref()?;
    let element = &script.tree().elements()[script.thing_element(thing)?];
    let Some(model) = element.value("model").map(str::to_owned) else {
        let text = format!("A {} has no model with takes and bones", element.row.name);
        workspace.say(MessageSeverity::Info, text);
        return None;
    };
    scene_around::enter(workspace, thing);
    Some(Effect::File(FileAction::Send(DocumentMessage::EditModel(model))))
}

/// Shows the scene again, whose model is edited now.
pub(in crate::panels) fn show_scene(workspace: &mut Workspace) -> Option<Effect> {
    if !is_waiting(workspace) {
        workspace.say(MessageSeverity::Info, "No model of a scene is being edited");
        return None;
    }
    Some(Effect::File(FileAction::Send(DocumentMessage::ShowScene)))
}

/// Returns whether a scene waits while its model is shown.
pub(super) fn is_waiting(workspace: &Workspace) -> bool {
    workspace.model.view().is_some_and(|view| view.waiting_scene.is_some())
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
    let awaited = workspace.scene.awaited().to_vec();
    let renamed = workspace.scene.update(scene.as_deref(), answered);
    if let ThroughCamera::Of(camera) = workspace.camera.through()
        && let Some(new) = renamed.new_name(camera)
    {
        let new = ThroughCamera::Of(new.into());
        workspace.camera.set_through(new);
    }
    if let ThroughCamera::Of(camera) = workspace.camera.other_through()
        && let Some(new) = renamed.new_name(camera)
    {
        let new = ThroughCamera::Of(new.into());
        workspace.camera.set_other_through(new);
    }
    let Some(script) = scene.as_ref().and_then(|scene| scene.script.as_ref()) else { return };
    let rate = script.rate().per_second().round() as u32;
    if workspace.frame_rate.get() != rate {
        workspace.frame_rate.choose(rate);
    }
    scene_view::frame_once(workspace);
    if !awaited.is_empty() && workspace.scene.awaited().is_empty() {
        scene_view::bring_into_view(workspace, &awaited);
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

/// Hides things or shows them: a step of undo, though none of the document.
fn set_hidden(workspace: &mut Workspace, things: Vec<Box<str>>, hide: bool) {
    let done = workspace.model.view().map_or(0, |view| view.history.done);
    workspace.scene.hide(things, hide, done);
}

/// Locks things or unlocks them: a step of undo, though none of the document.
fn set_locked(workspace: &mut Workspace, things: Vec<Box<str>>, lock: bool) {
    let done = workspace.model.view().map_or(0, |view| view.history.done);
    workspace.scene.lock(things, lock, done);
}

/// Hides the selected things, or all others.
pub(in crate::panels) fn hide(workspace: &mut Workspace, others: bool) {
    let hidden = match others {
        false => workspace.scene.things().to_vec(),
        true => {
            let all = things(workspace);
            all.into_iter().filter(|id| !workspace.scene.is_selected(id)).collect()
        }
    };
    set_hidden(workspace, hidden, true);
}

/// Shows all hidden things, and selects them.
pub(in crate::panels) fn show_all(workspace: &mut Workspace) {
    let hidden: Vec<Box<str>> = workspace.scene.hidden().map(Box::from).collect();
    if hidden.is_empty() {
        return workspace.say(MessageSeverity::Info, "Nothing is hidden");
    }
    set_hidden(workspace, hidden.clone(), false);
    workspace.scene.select_things(&hidden, Choice::Replace);
}

/// Locks the selected things; if all of them are locked, unlocks them.
pub(in crate::panels) fn toggle_lock(workspace: &mut Workspace) {
    let things = workspace.scene.things().to_vec();
    let lock = !things.iter().all(|id| workspace.scene.is_locked(id));
    set_locked(workspace, things, lock);
}

/// Returns the ids of all things of the scene.
fn things(workspace: &Workspace) -> Vec<Box<str>> {
    let script = workspace.model.view().and_then(|view| view.scene.as_ref()?.script.clone());
    let ids = script.iter().flat_map(|script| script.things().filter_map(|thing| thing.value("id")));
    ids.map(Box::from).collect()
}
