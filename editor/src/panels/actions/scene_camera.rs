//! Looking through the cameras of a scene, and moving them by orbiting.

use super::scene_gizmo::spliced;
use super::scene_moves::{BaseMoment, distance_of_look, tracked};
use super::scene_text::text_change;
use crate::panels::scene::{ChangedThings, SceneBase, ScriptChange};
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::bounds::Sphere;
use dragonfly_anim::stage::StageCamera;
use dragonfly_anim::stage::gesture::GestureRefusal;
use dragonfly_anim::stage::table::vector;
use dragonfly_document::Change;
use dragonfly_document::edit::ScriptLabel;
use dragonfly_picture::camera::Camera;
use dragonfly_picture::{ThroughCamera, viewport_camera};
use glam::Vec3;
use std::sync::Arc;
use std::time::Instant;

/// Looks through a camera of the scene, or through the free one. Refused where the cast has no camera.
pub(in crate::panels) fn look_through(workspace: &mut Workspace, through: ThroughCamera) {
    workspace.stage.end_camera();
    workspace.camera.set_through(through);
    update(workspace);
    let is_free = *workspace.camera.through() == ThroughCamera::Free;
    if !is_free && seen(workspace).is_none() {
        workspace.camera.set_through(ThroughCamera::Free);
        workspace.say(
            MessageSeverity::Info,
            "The scene has no camera; \"Add camera\" in the menu Scene > Add adds one",
        );
    }
}

/// Looks through a camera of the scene, or through the free one, in the second of two views.
pub(in crate::panels) fn look_through_in_second(workspace: &mut Workspace, through: ThroughCamera) {
    match workspace.camera.is_second_active() {
        true => look_through(workspace, through),
        false => workspace.camera.set_other_through(through),
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
    let turning = workspace.stage.turn_left(workspace.player.now());
    if turning.is_some_and(|left| left.is_zero())
        && workspace.stage.camera_drag() != workspace.dragging.open()
    {
        // Nothing was written that has to be released.
        workspace.stage.end_camera();
    }
    if workspace.stage.camera_drag().is_some() {
        return;
    }
    let camera = seen(workspace).map(|(seen, image)| {
        // The view orbits about what the camera looks at.
        let center = target_of(workspace, &seen).unwrap_or_default();
        viewport_camera(&seen, image, workspace.camera.aspect(), &Sphere { center, radius: 0.0 })
    });
    if camera.is_none() && *workspace.camera.through() != ThroughCamera::Free {
        // The camera was deleted or renamed.
        workspace.camera.set_through(ThroughCamera::Free);
    }
    workspace.camera.set_seen(camera);
    if let ThroughCamera::Of(id) = workspace.camera.other_through()
        && let Some(plan) = workspace.read().scene().and_then(|scene| scene.plan.as_ref())
        && plan.thing_called(id).is_none()
    {
        workspace.camera.set_other_through(ThroughCamera::Free);
    }
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

/// Returns the point that the script lets a camera look at, at the time shown; `None` for one that looks straight ahead.
fn target_of(workspace: &mut Workspace, seen: &StageCamera) -> Option<Vec3> {
    let (scene, time) = (workspace.model.view()?.scene.clone()?, workspace.read().scene_time());
    let (script, plan) = (scene.script.as_ref()?, scene.plan.as_ref()?);
    let element = script.thing_element(&plan.things().get(seen.thing)?.id)?;
    let look = script.tree().elements()[element].value("look")?;
    if let Some(point) = vector(look) {
        return Some(point.as_vec3());
    }
    let things = workspace.stage.things_at(plan, time);
    Some(plan.place_of_name(look, things)?.position.as_vec3())
}

/// Moves the camera of the scene after the view that the user gave it, and ends the step when the mouse is released. The movements of a wheel, and
/// of a panel, are one step until there is a pause.
pub(super) fn follow_view(workspace: &mut Workspace) -> Vec<Change> {
    let mut changes = Vec::new();
    let is_dragged = workspace.tools.controls().picture().moves_camera();
    if let Some(moved) = workspace.camera.take_moved() {
        let turned = (!is_dragged).then(|| workspace.player.now());
        match moved_camera(workspace, &moved, turned) {
            Ok(change) => changes.extend(change.and_then(|change| text_change(workspace, &change))),
            Err(refusal) => {
                workspace.stage.end_camera();
                workspace.camera.attach(false);
                workspace.say(MessageSeverity::Warning, refusal.to_string());
                update(workspace);
            }
        }
    }
    if let Some(gesture) = workspace.stage.camera_drag()
        && !is_dragged
        && !workspace.stage.is_turning(Some(gesture))
    {
        workspace.stage.end_camera();
        changes.push(Change::Release(gesture));
    }
    changes
}

/// Returns the change after which the camera of the scene sees what `moved` does; `None` where that is written already, and while the document
/// has not answered an earlier change.
fn moved_camera(
    workspace: &mut Workspace,
    moved: &Camera,
    turned: Option<Instant>,
) -> Result<Option<ScriptChange>, GestureRefusal> {
    let refused = |reason: &str| GestureRefusal(reason.to_owned());
    let scene = workspace.read().scene().cloned().ok_or_else(|| refused("No scene is open"))?;
    let gesture = workspace.stage.camera_drag();
    let base = match workspace.stage.base().filter(|_| gesture.is_some()) {
        Some(base) => base.clone(),
        None if SceneBase::is_awaited(&scene, workspace.scene.text(&scene)) => return Ok(None),
        None => SceneBase::of(&scene, workspace.scene.text(&scene))?,
    };
    let gesture = gesture.unwrap_or_else(|| workspace.dragging.new_gesture());
    workspace.stage.move_camera(gesture, base.clone(), turned);
    let time = workspace.read().scene_time();
    let things = workspace.stage.base_things(&base.plan, time);
    let moment = BaseMoment { base: &base, things, time, is_keyed: false };
    let thing = match workspace.camera.through() {
        ThroughCamera::Free => None,
        ThroughCamera::Shot => moment.things.camera.map(|camera| camera.thing),
        ThroughCamera::Of(id) => base.plan.thing_called(id),
    };
    let thing = thing.ok_or_else(|| refused("The scene has no such camera"))?;
    let id = &base.plan.things()[thing].id;
    if workspace.scene.is_locked(id) {
        return Err(GestureRefusal(format!("{id} is locked")));
    }
    let (eye, before) = (moved.eye(), moment.things.things[thing].transform.translation);
    let mut parts = vec![moment.placed(thing, eye, None)?];
    if tracked(&base, id).is_none() {
        let look = eye - moved.back() * distance_of_look(&base, id, before);
        parts.push(moment.looking(id, look)?);
    }
    spliced(workspace, &base, parts, (ScriptLabel::MoveCamera, ChangedThings::Thing(id)), gesture)
}
