//! Two views of a scene side by side: the one under the pointer is the active one, whose camera moves and in which clicks select.

use super::{framing, scene_camera};
use crate::panels::request::Effect;
use crate::panels::workspace::Workspace;
use dragonfly_document::Change;
use glam::Vec2;

/// Makes the view active into which the pointer goes, unless something is dragged or a line has corners there. A box or lasso that waits for its drag
/// goes along.
pub(super) fn follow_pointer(workspace: &mut Workspace, at: Vec2, effects: &mut Vec<Effect>) {
    let controls = workspace.tools.controls();
    let is_there = workspace.camera.second().is_some_and(|rect| rect.contains(egui::pos2(at.x, at.y)));
    let is_held = controls.is_busy() || (controls.is_modal() && controls.picture().armed().is_none());
    if !is_there || is_held {
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
