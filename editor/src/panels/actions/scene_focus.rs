//! The focus of a camera, picked in the viewport.

use super::scene_ground;
use super::scene_probe::surface_at;
use super::scene_text::step;
use crate::panels::request::Effect;
use crate::panels::scene::ChangedThings;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::stage::gesture::{GestureRefusal, in_scene_texts, set_on_thing};
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::ScriptLabel;
use dragonfly_picture::ThroughCamera;
use egui::Pos2;
use glam::{DVec3, Vec3};

/// Begins to pick what is in focus of a camera: the one through which the viewport looks, otherwise the one that is selected. A second time ends it.
pub(in crate::panels) fn begin(workspace: &mut Workspace) {
    if workspace.stage.focused_camera().is_some() {
        return workspace.stage.focus(None);
    }
    match camera(workspace) {
        Some(id) => {
            let text = format!("Click what is in focus of {id}; with Shift its distance counts. Esc ends it");
            workspace.stage.focus(Some(id));
            workspace.say(MessageSeverity::Info, text);
        }
        None => workspace.say(MessageSeverity::Info, "Look through a camera, or select one first"),
    }
}

fn camera(workspace: &mut Workspace) -> Option<Box<str>> {
    let scene = workspace.model.view()?.scene.clone()?;
    let (plan, time) = (scene.plan.as_ref()?, workspace.read().scene_time());
    let is_camera =
        |id: &str| plan.thing_called(id).is_some_and(|thing| plan.things()[thing].kind == "camera");
    match workspace.camera.through().clone() {
        ThroughCamera::Free => workspace.scene.things().iter().rev().find(|id| is_camera(id)).cloned(),
        ThroughCamera::Shot => {
            let thing = workspace.stage.things_at(plan, time).camera?.thing;
            Some(plan.things().get(thing)?.id.clone())
        }
        ThroughCamera::Of(id) => Some(Box::from(&*id)).filter(|id| is_camera(id)),
    }
}

/// Sets the focus to what is at a position of the window: a bone of a role, otherwise the distance of the surface or the ground there.
pub(super) fn pick(workspace: &mut Workspace, at: Pos2, choice: Choice) -> Option<Effect> {
    let camera: Box<str> = workspace.stage.focused_camera()?.into();
    workspace.stage.focus(None);
    if workspace.scene.is_locked(&camera) {
        workspace.say(MessageSeverity::Info, format!("{camera} is locked"));
        return None;
    }
    let surface = surface_at(workspace, at, &[]);
    let place = match &surface {
        Some(surface) => Some(surface.place),
        None => scene_ground::ground_at(workspace, at),
    };
    let Some(place) = place else {
        workspace.say(MessageSeverity::Info, "Nothing is there: the focus stays as it is");
        return None;
    };
    let bone =
        surface.filter(|surface| surface.is_role && surface.bone.is_some() && choice == Choice::Replace);
    let time = workspace.read().scene_time();
    step(workspace, |base| {
        let refused = || GestureRefusal(format!("The focus of {camera} cannot be written here"));
        let mut state = base.plan.new_scene();
        base.plan.scene_at(time, &mut state);
        let thing = base.plan.thing_called(&camera).ok_or_else(refused)?;
        let seen = base.plan.camera_of(thing, &state).ok_or_else(refused)?;
        let ahead = (seen.rotation * Vec3::NEG_Z).as_dvec3();
        let focus = match &bone {
            Some(surface) => surface.name(),
            None => distance_text(place, seen.position.as_dvec3(), ahead),
        };
        let element = base.script.thing_element(&camera).ok_or_else(refused)?;
        in_scene_texts(base.script.tree(), element)?;
        let splices = set_on_thing(&base.script, element, "focus", Some(&focus)).ok_or_else(refused)?;
        base.spliced(&splices, ScriptLabel::Focus, None, ChangedThings::Thing(&camera))
    })
}

/// Returns the distance of a place along the line of sight of a camera, meters, to a centimeter.
fn distance_text(place: DVec3, camera: DVec3, ahead: DVec3) -> String {
    (((place - camera).dot(ahead).max(0.0) * 100.0).round() / 100.0).to_string()
}
