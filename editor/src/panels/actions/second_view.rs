//! Two views of a scene side by side: the one under the pointer is the active one, whose camera moves and in which clicks select.

use super::{framing, scene_camera};
use crate::control::InputEvent;
use crate::panels::request::Effect;
use crate::panels::workspace::Workspace;
use dragonfly_document::Change;

/// Makes the view active into which the pointer goes, unless something is dragged.
pub(super) fn follow_pointer(workspace: &mut Workspace, event: InputEvent, effects: &mut Vec<Effect>) {
    let InputEvent::MouseMove(at) = event else { return };
    let controls = workspace.tools.controls();
    let is_there = workspace.camera.second().is_some_and(|rect| rect.contains(egui::pos2(at.x, at.y)));
    if !is_there || controls.is_busy() || controls.is_modal() {
        return;
    }
    // A movement of the camera by the wheel ends with its view.
    if let Some(gesture) = workspace.stage.camera_drag() {
        if workspace.dragging.open() == Some(gesture) {
            effects.push(Effect::Change(Change::Release(gesture)));
        }
        workspace.stage.end_camera();
    }
    let second = !workspace.camera.is_second_active();
    workspace.camera.activate(second);
    scene_camera::update(workspace);
    framing::place_tools(workspace);
}
