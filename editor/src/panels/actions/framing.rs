//! The camera: framing the model or a part of it, and the rectangle of the viewport.

use super::{scene_camera, scene_view};
use crate::control::{Area, InputEvent};
use crate::panels::request::Effect;
use crate::panels::workspace::Workspace;
use dragonfly_anim::data::BoneIndex;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_picture::camera::Camera;
use egui::{Pos2, Rect};
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// Frames a model that was just opened: in its rest pose or, without a surface, its largest tree of bones at the time shown.
pub(super) fn frame_model(workspace: &mut Workspace) {
    if let Some([min, max]) = figure_box(workspace) {
        workspace.camera.frame(min, max);
    } else if let Some(loaded) = workspace.model.loaded() {
        workspace.camera.frame(loaded.bounds.min, loaded.bounds.max);
    }
}

/// Returns the box around the largest tree of bones at the time shown; `None` for a model with a surface or without bones. A file of
/// motion often contains cameras and targets far from the figure, and a capture is often far from its rest pose.
fn figure_box(workspace: &mut Workspace) -> Option<[Vec3; 2]> {
    let view = workspace.model.view().filter(|view| view.loaded.model.instances.is_empty())?;
    let bones = &view.loaded.model.animation.skeleton.bones;
    let mut roots: Vec<usize> = Vec::with_capacity(bones.len());
    let mut counts = vec![0_usize; bones.len()];
    for (bone, own) in bones.iter().enumerate() {
        let parent = own.parent.and_then(|parent| roots.get(parent as usize));
        let root = parent.copied().unwrap_or(bone);
        roots.push(root);
        counts[root] += 1;
    }
    let (take, time) = (workspace.player.take(), workspace.player.time());
    let to_root = workspace.posed.update(view, take, time).to_root();
    let largest = *roots.iter().max_by_key(|&&root| (counts[root], std::cmp::Reverse(root)))?;
    let at = to_root.iter().zip(&roots).filter(|(_, root)| **root == largest);
    let places = at.map(|(matrix, _)| matrix.w_axis.truncate()).filter(|place| place.is_finite());
    let [min, max] = places.fold(None, |area: Option<[Vec3; 2]>, place| {
        Some(area.map_or([place; 2], |[min, max]| [min.min(place), max.max(place)]))
    })?;
    // The last bones of limbs have a length, too.
    let margin = Vec3::splat((0.05 * min.distance(max)).max(1e-4));
    Some([min - margin, max + margin])
}

/// Frames the model in the pose at the time shown, which may be larger than the rest pose.
pub(in crate::panels) fn frame_shown(workspace: &mut Workspace) {
    if scene_view::frame_all(workspace) {
        return;
    }
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
    if scene_view::frame_selected(workspace) {
        return;
    }
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
pub(in crate::panels) fn wheel(workspace: &mut Workspace, by: f32) -> Option<Effect> {
    workspace.tools.input(InputEvent::Wheel(Vec2::new(0.0, by)), workspace.camera.camera());
    move_camera(workspace, workspace.tools.camera())
}

/// Moves the camera of the viewport, or the one of the scene that is attached to it.
pub(super) fn move_camera(workspace: &mut Workspace, camera: Camera) -> Option<Effect> {
    workspace.camera.set_camera(camera);
    let mut changes = scene_camera::follow_view(workspace);
    match changes.len() {
        0 | 1 => changes.pop().map(Effect::Change),
        _ => Some(Effect::Changes(changes)),
    }
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

pub(super) fn place_tools(workspace: &mut Workspace) {
    let point = |at: Pos2| Vec2::new(at.x, at.y);
    let area = |rect: Rect| Area::new(point(rect.min), point(rect.max));
    let viewport = workspace.camera.viewport();
    // Those over the other one of two views are none of this one.
    let over = workspace.camera.shields().iter().filter(|rect| rect.intersects(viewport));
    let shields = over.map(|rect| area(rect.intersect(viewport)));
    workspace.tools.place(area(viewport), shields, workspace.camera.camera());
}
