//! Input of the viewport: events reach the tools as they happen, and the resulting effects are passed on at once.

use super::{
    locks, playback, scene_camera, scene_focus, scene_gizmo, scene_lines, scene_path_points, scene_picks,
    scene_points, second_view, tools,
};
use crate::control::path_point::PathKey;
use crate::control::{Button, InputEvent, Key, ToolOutcome, ViewportOutcome};
use crate::panels::request::Effect;
use crate::panels::tool_drag::Alone;
use crate::panels::workspace::Workspace;
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::Edit;
use dragonfly_document::posing;
use egui::{Pos2, pos2};
use glam::Vec2;
use std::sync::Arc;
use std::time::Instant;

/// Gives an event to the tools of the viewport; effects for the program around the panels are added to `effects`.
/// Returns whether a tool took it.
///
/// Allocates nothing that grows with the model.
pub(in crate::panels) fn input(
    workspace: &mut Workspace,
    event: InputEvent,
    effects: &mut Vec<Effect>,
) -> bool {
    if event == InputEvent::KeyDown(Key::Escape) && workspace.stage.focused_camera().is_some() {
        workspace.stage.focus(None);
        return true;
    }
    if let InputEvent::MouseMove(at) = event {
        second_view::follow_pointer(workspace, at, effects);
    }
    let pressed = event == InputEvent::MouseDown(Button::Left);
    if pressed && workspace.player.is_playing() && workspace.tools.controls().over_handle() {
        // Playback must not move a handle that is being dragged.
        workspace.player.set_now(Instant::now());
        playback::pause(workspace);
        tools::sync_gizmo(workspace);
    }
    if pressed && scene_path_points::is_add(workspace) && scene_path_points::add(workspace, effects) {
        return true;
    }
    scene_lines::follow_surface(workspace, event);
    let taken = workspace.tools.input(event, workspace.camera.camera());
    if taken && matches!(event, InputEvent::MouseDown(_)) {
        // The viewport was used last, so the copy command copies the pose.
        workspace.keys.lose_focus();
    }
    take_answers(workspace, effects);
    // A drag may end in the other view.
    if let (InputEvent::MouseUp(_), Some(at)) = (event, workspace.tools.controls().pointer()) {
        second_view::follow_pointer(workspace, at, effects);
    }
    taken
}

/// Carries out what the tools ask for.
fn take_answers(workspace: &mut Workspace, effects: &mut Vec<Effect>) {
    workspace.camera.set_camera(workspace.tools.camera());
    effects.extend(scene_camera::follow_view(workspace).into_iter().map(Effect::Change));
    let corner = workspace.camera.viewport().min;
    let outcome = workspace.tools.controls_mut().picture_mut().take_outcome();
    match outcome {
        Some(ViewportOutcome::Pick(at, choice)) => {
            workspace.tools.set_clicked_handle(false);
            pick(workspace, corner + egui::vec2(at.x, at.y), choice, effects);
        }
        Some(ViewportOutcome::Catch(region, choice)) => effects.push(Effect::Catch(region, choice)),
        None => {}
    }
    while let Some(outcome) = workspace.tools.controls_mut().take_outcome() {
        take_tool_outcome(workspace, outcome, effects);
    }
}

/// Sets the focus of a camera to what was clicked, where one waits for that; otherwise selects it.
fn pick(workspace: &mut Workspace, at: Pos2, choice: Choice, effects: &mut Vec<Effect>) {
    match workspace.stage.focused_camera().is_some() {
        true => effects.extend(scene_focus::pick(workspace, at, choice)),
        false if scene_picks::pick(workspace, at, choice) => {}
        false => effects.push(Effect::Pick(at, choice)),
    }
}

/// Carries out what a tool asks for.
fn take_tool_outcome(workspace: &mut Workspace, outcome: ToolOutcome, effects: &mut Vec<Effect>) {
    match outcome {
        ToolOutcome::Click(mouse) => {
            workspace.tools.set_clicked_handle(true);
            pick(workspace, pos2(mouse.at.x, mouse.at.y), Choice::from(mouse.modifiers), effects);
        }
        ToolOutcome::Refused => tools::say_refused(workspace),
        ToolOutcome::Poses if workspace.read().scene().is_some() => scene_gizmo::send(workspace, effects),
        ToolOutcome::Poses => send_poses(workspace, effects),
        ToolOutcome::MoveKey(key) => {
            if let Some(edit) = path_edit(workspace, key) {
                send(workspace, edit, effects);
            }
        }
        ToolOutcome::SelectPoint(point) => {
            workspace.scene.lines_mut().select_point(point.owner, point.index);
        }
        ToolOutcome::MovePoint(point) => scene_points::send(workspace, &point, effects),
        ToolOutcome::Line(answer) => effects.extend(scene_lines::answered(workspace, answer)),
        ToolOutcome::Edit(edit) => send(workspace, edit, effects),
        ToolOutcome::Done => end_drag(workspace, false, effects),
        ToolOutcome::Cancelled => end_drag(workspace, true, effects),
    }
}

/// Sends the poses of the gizmo.
fn send_poses(workspace: &mut Workspace, effects: &mut Vec<Effect>) {
    tools::begin_following(workspace);
    // A press that changes nothing yet is no edit.
    let idle = workspace.tools.controls().gizmo().gizmo.is_identity();
    if !idle || workspace.tools.drag().gesture().is_some() {
        let poses = workspace.tools.dragged_poses();
        if let Some(edit) = workspace.read().pose_edit(poses) {
            send(workspace, edit, effects);
        }
    }
}

/// Sends an edit of the drag, unless it edits a locked bone.
fn send(workspace: &mut Workspace, edit: Edit, effects: &mut Vec<Effect>) {
    let gesture = workspace.tools.drag().gesture().unwrap_or_else(|| workspace.dragging.new_gesture());
    workspace.tools.drag_mut().begin(gesture);
    let effect = locks::unlocked(workspace, Effect::Change(Change::Edit(edit, Some(gesture))));
    effects.extend(effect);
}

fn end_drag(workspace: &mut Workspace, cancel: bool, effects: &mut Vec<Effect>) {
    scene_gizmo::end(workspace);
    if let Some(gesture) = workspace.tools.drag_mut().end() {
        let end = if cancel { Change::Cancel } else { Change::Release };
        effects.push(Effect::Change(end(gesture)));
    }
}

/// Notes the poses at the time of a key, at the start of a drag of the motion path.
fn begin_following_path(workspace: &mut Workspace, time: f32) {
    if !workspace.tools.drag().is_undecided() {
        return;
    }
    let panels = workspace.read();
    let (follow, fixed, mode) = (panels.bones_follow(), panels.fixed_bones(), panels.ik);
    let hold = workspace.model.view().filter(|_| follow).map(|view| {
        let poses = workspace.tools.path_mut().posed().update(view, workspace.player.take(), time).poses();
        let skeleton = Arc::clone(&view.loaded.model.animation.skeleton);
        posing::PoseDragState::new(skeleton, poses, workspace.bones.pins(), mode, None).with_fixed(&fixed)
    });
    workspace.tools.drag_mut().follow(hold);
}

/// Returns the edit that moves the joint of the active bone to a key of the motion path. As with the gizmo, the bones above
/// follow with IK on, and pinned bones stay where they are at that time; without either the bone moves alone.
fn path_edit(workspace: &mut Workspace, key: PathKey) -> Option<Edit> {
    let (bone, take) = (workspace.bones.active()?, workspace.read().take_ref()?);
    begin_following_path(workspace, key.time);
    let poses = match workspace.tools.drag_mut().poses_of_path(bone, key.place) {
        Ok(poses) => poses?,
        Err(Alone) => {
            let shown = workspace.player.take();
            vec![workspace.tools.path_mut().pose_at(workspace.model.view()?, shown, bone, key)?]
        }
    };
    Some(workspace.read().edit_of(take, key.time, poses))
}

/// Returns a position in points as the tools take it.
pub(super) fn place(at: egui::Pos2) -> Vec2 {
    Vec2::new(at.x, at.y)
}
