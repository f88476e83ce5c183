//! The camera: framing the model or a part of it, and the rectangle of the viewport.

use crate::control::{Area, InputEvent};
use crate::panels::workspace::Workspace;
use dragonfly_anim::data::BoneIndex;
use dragonfly_anim::evaluator::Evaluator;
use egui::{Pos2, Rect};
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// Frames the model in its rest pose.
pub(super) fn frame_model(workspace: &mut Workspace) {
    if let Some(loaded) = workspace.model.loaded() {
        workspace.camera.frame(loaded.bounds.min, loaded.bounds.max);
    }
}

/// Frames the model in the pose at the time shown, which may be larger than the rest pose.
pub(in crate::panels) fn frame_shown(workspace: &mut Workspace) {
    let Some(view) = workspace.model.view() else { return };
    let (take, time) = (workspace.player.take(), workspace.player.time());
    let poses = workspace.posed.update(view, take, time).poses();
    let mut evaluator = Evaluator::new(Arc::clone(&view.loaded.model));
    evaluator.pose_with(None, 0.0, |own| {
        if own.len() == poses.len() {
            own.copy_from_slice(poses);
        }
    });
    let bounds = evaluator.bounds();
    workspace.camera.frame(bounds.min, bounds.max);
}

/// Frames the active bone and its children, or the model if no bone is selected.
pub(in crate::panels) fn frame_selected(workspace: &mut Workspace) {
    let (Some(view), Some(active)) = (workspace.model.view(), workspace.bones.active()) else {
        return frame_shown(workspace);
    };
    let skeleton = &view.loaded.model.animation.skeleton;
    let (take, time) = (workspace.player.take(), workspace.player.time());
    let to_root = workspace.posed.update(view, take, time).to_root();
    let at = |bone: BoneIndex| to_root.get(bone as usize).map(|matrix| matrix.w_axis.truncate());
    let Some(origin) = at(active).filter(|origin| origin.is_finite()) else { return };
    let (mut min, mut max) = (origin, origin);
    for point in skeleton.children(Some(active)).filter_map(at).filter(|point| point.is_finite()) {
        min = min.min(point);
        max = max.max(point);
    }
    // A bone without children has no size: a tenth of the model is shown around it.
    let margin = Vec3::splat((view.loaded.bounds.sphere.radius * 0.1).max(1e-4));
    workspace.camera.frame(min - margin, max + margin);
}

/// Zooms by the wheel, or by two fingers: points, positive is nearer.
pub(in crate::panels) fn wheel(workspace: &mut Workspace, by: f32) {
    workspace.tools.input(InputEvent::Wheel(Vec2::new(0.0, by)), workspace.camera.camera());
    workspace.camera.set_camera(workspace.tools.camera());
}

/// Sets the rectangle of the viewport.
pub(super) fn set_viewport(workspace: &mut Workspace, rect: Rect) {
    if workspace.camera.set_viewport(rect) {
        place_tools(workspace);
    }
}

/// Sets the rectangles of the toolbars over the viewport.
pub(super) fn set_shields(workspace: &mut Workspace, shields: Vec<Rect>) {
    if workspace.camera.set_shields(shields) {
        place_tools(workspace);
    }
}

fn place_tools(workspace: &mut Workspace) {
    let point = |at: Pos2| Vec2::new(at.x, at.y);
    let area = |rect: Rect| Area::new(point(rect.min), point(rect.max));
    let viewport = workspace.camera.viewport();
    let shields = workspace.camera.shields().iter().map(|rect| area(rect.intersect(viewport)));
    workspace.tools.place(area(viewport), shields, workspace.camera.camera());
}
