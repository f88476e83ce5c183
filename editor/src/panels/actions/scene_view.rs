//! The scene in the viewport: framing, and selecting what is under the pointer.

use crate::panels::workspace::Workspace;
use dragonfly_anim::bounds::AxisBox;
use dragonfly_anim::data::Transform;
use dragonfly_anim::stage::PlannedThing;
use dragonfly_document::bones::Choice;
use dragonfly_document::{LoadedModel, SceneModel, SceneView};
use dragonfly_picture::ThroughCamera;
use dragonfly_picture::gizmo::GizmoView;
use dragonfly_picture::placeholder_box;
use egui::Pos2;
use glam::{DVec2, Vec2, Vec3};
use std::sync::Arc;

/// Half the size of the space that is framed around a thing of which nothing is drawn, meters.
const AROUND: f32 = 0.5;

/// Frames the scene when all of its models were read, once after it was opened.
pub(super) fn frame_once(workspace: &mut Workspace) {
    let Some(scene) = workspace.model.view().and_then(|view| view.scene.as_deref()) else { return };
    let is_complete =
        scene.plan.is_some() && scene.models.values().all(|model| !matches!(model, SceneModel::Loading));
    if workspace.stage.frames_now(is_complete)
        && let Some(around) = framed_box(workspace, |_| true)
    {
        workspace.camera.frame_free(around.min, around.max);
    }
}

/// Frames all things at the time shown. Returns whether a scene is open.
pub(super) fn frame_all(workspace: &mut Workspace) -> bool {
    frame(workspace, |_| true)
}

/// Frames the selected things at the time shown, or all where none is selected. Returns whether a scene is open.
pub(super) fn frame_selected(workspace: &mut Workspace) -> bool {
    let selected = workspace.scene.things().to_vec();
    let is_framed = |id: &str| selected.is_empty() || selected.iter().any(|own| **own == *id);
    frame(workspace, is_framed)
}

/// Frames things that were added, if the middle of the space around them is out of sight. A view through a camera of the scene stays.
pub(super) fn bring_into_view(workspace: &mut Workspace, added: &[Box<str>]) {
    if *workspace.camera.through() != ThroughCamera::Free {
        return;
    }
    let Some(around) = framed_box(workspace, |id| added.iter().any(|own| **own == *id)) else { return };
    let shown = workspace.camera.viewport();
    let view = GizmoView::new(workspace.camera.camera(), Vec2::new(shown.width(), shown.height()));
    let middle = (around.min + around.max) / 2.0;
    let is_seen = view
        .to_screen(middle.as_dvec3())
        .is_some_and(|at| at.cmpge(DVec2::ZERO).all() && at.cmple(view.size).all());
    if !is_seen {
        workspace.camera.frame(around.min, around.max);
    }
}

fn frame(workspace: &mut Workspace, is_framed: impl Fn(&str) -> bool) -> bool {
    if workspace.read().scene().is_none() {
        return false;
    }
    if let Some(around) = framed_box(workspace, is_framed) {
        workspace.camera.frame(around.min, around.max);
    }
    true
}

/// Returns the box around things at the time shown: around what is drawn of them at rest, or around their places where nothing is. `None`
/// without a plan and without things.
fn framed_box(workspace: &mut Workspace, is_framed: impl Fn(&str) -> bool) -> Option<AxisBox> {
    let scene = workspace.model.view()?.scene.clone()?;
    let plan = scene.plan.as_ref()?;
    let time = workspace.read().scene_time();
    let hidden = &workspace.scene;
    let shown = workspace.stage.things_at(plan, time);
    let (mut drawn, mut places) = (AxisBox::EMPTY, AxisBox::EMPTY);
    for (planned, state) in plan.things().iter().zip(&shown.things).filter(|(own, _)| is_framed(&own.id)) {
        let mut near = |point: Vec3| {
            places = places.union(AxisBox { min: point - AROUND, max: point + AROUND });
        };
        match &planned.path {
            Some(path) => {
                let shares = [0.0, 0.25, 0.5, 0.75, 1.0].into_iter();
                shares.for_each(|share| near(path.at(path.length() * share).position.as_vec3()));
            }
            None => near(state.transform.translation),
        }
        if let Some(own) =
            box_of(&scene, planned, &state.transform).filter(|_| !hidden.is_hidden(&planned.id))
        {
            drawn = drawn.union(own);
        }
    }
    let found = if drawn.is_empty() { places } else { drawn };
    (!found.is_empty()).then_some(found)
}

/// Returns the box around what is drawn of a thing at a place; `None` for things without a surface.
pub(super) fn box_of(scene: &SceneView, thing: &PlannedThing, place: &Transform) -> Option<AxisBox> {
    if !matches!(thing.kind, "role" | "prop") {
        return None;
    }
    let (own, scale) = match model_of(scene, &thing.id) {
        Some(loaded) => (AxisBox { min: loaded.bounds.min, max: loaded.bounds.max }, place.scale),
        None => (placeholder_box(thing.kind == "role"), Vec3::ONE),
    };
    Some(own.moved(&Transform { scale, ..*place }.to_matrix()))
}

/// Returns the model of the thing called `id`; `None` for things without one, and while it is missing.
fn model_of<'a>(scene: &'a SceneView, id: &str) -> Option<&'a LoadedModel> {
    let script = scene.script.as_ref()?;
    let element = &script.tree().elements()[script.thing_element(id)?];
    match scene.models.get(element.value("model")?)? {
        SceneModel::Loaded(loaded) => Some(loaded),
        SceneModel::Loading | SceneModel::Missing(_) => None,
    }
}

/// Selects one of the things under a click, which come from the graphics thread, the nearest first. A click at the same place means the
/// next one. Locked things are left out.
pub(in crate::panels) fn picked(workspace: &mut Workspace, at: Pos2, things: &[Arc<str>], choice: Choice) {
    let things = unlocked(workspace, things);
    if things.is_empty() && workspace.tools.clicked_handle() {
        return;
    }
    let thing = match choice {
        Choice::Replace => workspace.stage.clicked(at, &things),
        Choice::Add | Choice::Toggle => {
            workspace.stage.forget_click();
            things.first().cloned()
        }
    };
    let things: Vec<Box<str>> = thing.iter().map(|thing| Box::from(&**thing)).collect();
    select(workspace, &things, choice);
}

/// Changes the selection by the things in a box or lasso. Locked things are left out.
pub(in crate::panels) fn caught(workspace: &mut Workspace, things: &[Arc<str>], choice: Choice) {
    workspace.stage.forget_click();
    let things = unlocked(workspace, things);
    let things: Vec<Box<str>> = things.iter().map(|thing| Box::from(&**thing)).collect();
    select(workspace, &things, choice);
}

/// Sets the thing under the pointer. Locked things are not highlighted. Returns whether it changed.
pub(in crate::panels) fn point(workspace: &mut Workspace, thing: Option<Arc<str>>) -> bool {
    let over = workspace.bones.pointer().is_some();
    let thing = thing.filter(|thing| over && !workspace.scene.is_locked(thing));
    workspace.stage.hover(thing)
}

fn select(workspace: &mut Workspace, things: &[Box<str>], choice: Choice) {
    workspace.scene.select_things(things, choice);
    if choice == Choice::Replace {
        workspace.scene.select_action(None);
    }
}

fn unlocked(workspace: &Workspace, things: &[Arc<str>]) -> Vec<Arc<str>> {
    things.iter().filter(|thing| !workspace.scene.is_locked(thing)).cloned().collect()
}
