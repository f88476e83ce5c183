//! Finds the surface of a scene at a position of the viewport.

use crate::panels::workspace::Workspace;
use dragonfly_picture::camera::CameraRay;
use dragonfly_picture::gizmo::GizmoView;
use egui::Pos2;
use glam::{DVec3, Vec2};
use std::sync::Arc;

/// Distance from a surface towards the viewer at which lines are drawn on it, meters.
const ABOVE: f64 = 0.002;

/// A place on the surface of a thing.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PointedSurface {
    /// Id of the thing.
    pub(super) thing: Box<str>,
    /// Whether it is a role.
    pub(super) is_role: bool,
    /// Name of the bone with the most influence there; `None` for things without bones.
    pub(super) bone: Option<Box<str>>,
    /// A little in front of the surface, scene space.
    pub(super) place: DVec3,
}

impl PointedSurface {
    /// Returns the name of the bone as scripts have it, such as `anna.Head`; that of the thing where it has no bones.
    pub(super) fn name(&self) -> String {
        match &self.bone {
            Some(bone) => format!("{}.{bone}", self.thing),
            None => self.thing.to_string(),
        }
    }
}

/// Returns what surface is at a position of the window, points. Hidden things and those with the ids `without` are left out.
pub(super) fn surface_at(
    workspace: &mut Workspace,
    at: Pos2,
    without: &[Box<str>],
) -> Option<PointedSurface> {
    let scene = workspace.model.view()?.scene.clone()?;
    let time = workspace.read().scene_time();
    let hidden = workspace.scene.hidden().chain(without.iter().map(|id| &**id)).map(Arc::from);
    let mut hidden: Vec<Arc<str>> = hidden.collect();
    hidden.sort_unstable();
    hidden.dedup();
    let (origin, direction) = ray_at(workspace, at)?;
    let ray = CameraRay { origin: origin.as_vec3(), direction: direction.as_vec3() };
    let hit = workspace.probe.hit(&scene, &hidden, time, &ray)?;
    let planned = scene.plan.as_ref()?.things().get(hit.thing)?;
    let skeleton = planned.model.as_ref().map(|model| model.skeleton());
    let bone = hit.bone.and_then(|bone| skeleton?.bones.get(bone as usize)).map(|bone| &*bone.name);
    Some(PointedSurface {
        thing: planned.id.clone(),
        is_role: planned.kind == "role",
        bone: bone.filter(|name| !name.is_empty()).map(Into::into),
        place: origin + direction * (f64::from(hit.distance) - ABOVE).max(0.0),
    })
}

/// Returns the line of sight through a position of the window: where it starts, and its direction. `None` outside of the viewport.
pub(super) fn ray_at(workspace: &Workspace, at: Pos2) -> Option<(DVec3, DVec3)> {
    let rect = workspace.camera.viewport();
    let (size, at) = (Vec2::new(rect.width(), rect.height()), rect.contains(at).then(|| at - rect.min)?);
    Some(GizmoView::new(workspace.camera.camera(), size).ray(Vec2::new(at.x, at.y).as_dvec2()))
}

/// Returns where the pointer is over the viewport, points of the window.
pub(super) fn pointer(workspace: &Workspace) -> Option<Pos2> {
    let at = workspace.tools.controls().pointer().map(|at| egui::pos2(at.x, at.y));
    at.filter(|at| workspace.camera.viewport().contains(*at))
}
