//! Looking through the cameras of a scene, and moving them by orbiting.

use super::scene_gizmo::{look_text, place_text};
use crate::panels::request::Effect;
use crate::panels::scene::{SceneBase, ScriptChange};
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::bounds::Sphere;
use dragonfly_anim::stage::StageCamera;
use dragonfly_anim::stage::gesture::GestureRefusal;
use dragonfly_document::Change;
use dragonfly_picture::camera::Camera;
use dragonfly_picture::{ThroughCamera, viewport_camera};
use glam::Vec3;
use std::sync::Arc;

/// Looks through a camera of the scene, or through the free one. Refused where the cast has no camera.
pub(in crate::panels) fn look_through(workspace: &mut Workspace, through: ThroughCamera) {
    workspace.camera.set_through(through);
    update(workspace);
    let is_free = *workspace.camera.through() == ThroughCamera::Free;
    if !is_free && seen(workspace).is_none() {
        workspace.camera.set_through(ThroughCamera::Free);
        workspace
            .say(MessageSeverity::Info, "The scene has no camera; \"Add camera\" in the menu Scene adds one");
    }
}

/// Switches between the camera of the shot and the free one.
pub(in crate::panels) fn toggle_shot(workspace: &mut Workspace) {
    let through = match workspace.camera.through() {
        ThroughCamera::Free => ThroughCamera::Shot,
        ThroughCamera::Shot | ThroughCamera::Of(_) => ThroughCamera::Free,
    };
    look_through(workspace, through);
}

/// Looks through the selected camera.
pub(in crate::panels) fn through_selected(workspace: &mut Workspace) {
    let Some(scene) = workspace.read().scene().and_then(|scene| scene.plan.clone()) else { return };
    let mut things = workspace.scene.things().iter().rev().map(|id| &**id);
    let is_camera =
        |id: &&str| scene.thing_called(id).is_some_and(|thing| scene.things()[thing].kind == "camera");
    match things.find(is_camera).map(Arc::from) {
        Some(id) => look_through(workspace, ThroughCamera::Of(id)),
        None => workspace.say(MessageSeverity::Info, "No camera is selected"),
    }
}

/// Switches whether moving the view moves the camera through which it looks.
pub(in crate::panels) fn toggle_attached(workspace: &mut Workspace) {
    let attached = !workspace.camera.is_attached();
    workspace.camera.attach(attached);
}

/// Computes what the camera sees through which the viewport looks. During a drag of that camera it is where the pointer put it.
pub(super) fn update(workspace: &mut Workspace) {
    if workspace.stage.camera_drag().is_some() {
        return;
    }
    let camera = seen(workspace)
        .map(|(seen, image)| viewport_camera(&seen, image, workspace.camera.aspect(), &Sphere::default()));
    if camera.is_none() && *workspace.camera.through() != ThroughCamera::Free {
        // The camera was deleted or renamed.
        workspace.camera.set_through(ThroughCamera::Free);
    }
    workspace.camera.set_seen(camera);
}

/// Returns the camera of the scene through which the viewport looks, and the ratio of width to height of the image; `None` for the free one.
fn seen(workspace: &mut Workspace) -> Option<(StageCamera, f32)> {
    let through = workspace.camera.through().clone();
    if through == ThroughCamera::Free {
        return None;
    }
    let (plan, time) = (workspace.read().scene()?.plan.clone()?, workspace.read().scene_time());
    let [width, height] = workspace.read().scene()?.script.as_ref()?.size();
    let things = workspace.stage.things_at(&plan, time);
    let camera = match &through {
        ThroughCamera::Free => None,
        ThroughCamera::Shot => things.camera,
        ThroughCamera::Of(id) => plan.camera_of(plan.thing_called(id)?, things),
    };
    Some((camera?, width.max(1) as f32 / height.max(1) as f32))
}

/// Moves the camera of the scene after the view that the user gave it, and ends the step when the mouse is released.
pub(super) fn follow_view(workspace: &mut Workspace, effects: &mut Vec<Effect>) {
    let is_dragged = workspace.tools.controls().picture().moves_camera();
    if let Some(moved) = workspace.camera.take_moved() {
        if is_dragged && workspace.stage.camera_drag().is_none() {
            workspace.stage.set_camera_drag(Some(workspace.dragging.new_gesture()));
        }
        match moved_text(workspace, &moved) {
            Ok(change) => effects.extend(super::scene_text::change_text(workspace, &change)),
            Err(refusal) => {
                workspace.stage.set_camera_drag(None);
                workspace.camera.attach(false);
                workspace.say(MessageSeverity::Warning, refusal.to_string());
                update(workspace);
            }
        }
    }
    if !is_dragged && let Some(gesture) = workspace.stage.camera_drag() {
        workspace.stage.set_camera_drag(None);
        workspace.stage.set_base(None);
        effects.push(Effect::Change(Change::Release(gesture)));
    }
}

/// Returns the text in which the camera of the scene sees what `moved` does.
fn moved_text(workspace: &mut Workspace, moved: &Camera) -> Result<ScriptChange, GestureRefusal> {
    let refused = |reason: &str| GestureRefusal(reason.to_owned());
    let scene = workspace.read().scene().cloned().ok_or_else(|| refused("No scene is open"))?;
    let gesture = workspace.stage.camera_drag();
    let base = match workspace.stage.base().filter(|_| gesture.is_some()) {
        Some(base) => base.clone(),
        None => SceneBase::of(&scene, workspace.scene.text(&scene))?,
    };
    if gesture.is_some() {
        workspace.stage.set_base(Some(base.clone()));
    }
    let time = workspace.read().scene_time();
    let now = workspace.stage.things_at(&base.plan, time);
    let thing = match workspace.camera.through() {
        ThroughCamera::Free => None,
        ThroughCamera::Shot => now.camera.map(|camera| camera.thing),
        ThroughCamera::Of(id) => base.plan.thing_called(id),
    };
    let thing = thing.ok_or_else(|| refused("The scene has no such camera"))?;
    let id = &base.plan.things()[thing].id;
    if workspace.scene.is_locked(id) {
        return Err(GestureRefusal(format!("{id} is locked")));
    }
    let eye = moved.eye();
    let text = place_text(&base, &base.script, thing, time, eye)?;
    let ahead = -moved.back() * distance_of_look(&base, id, now.things[thing].transform.translation);
    let text = look_text(&base.script, &text, id, eye + ahead)?;
    Ok(ScriptChange { from: Arc::clone(base.text()), text, label: "Move camera", gesture })
}

/// Returns the distance from a camera to the point that it looks at, meters; 3 where the script names a thing instead of a point.
pub(super) fn distance_of_look(base: &SceneBase, id: &str, position: Vec3) -> f32 {
    let element = base.script.things().find(|element| element.value("id") == Some(id));
    let look = element.and_then(|element| element.value("look"));
    let numbers: Option<Vec<f32>> =
        look.map(|look| look.split_whitespace().map_while(|number| number.parse().ok()).collect());
    match numbers.as_deref() {
        Some(&[x, y, z]) => Vec3::new(x, y, z).distance(position).max(0.1),
        _ => 3.0,
    }
}
