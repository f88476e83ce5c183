//! The scene in the viewport: framing, and selecting what is under the pointer.

use crate::panels::workspace::Workspace;
use dragonfly_anim::bounds::AxisBox;
use dragonfly_document::bones::Choice;
use dragonfly_document::{SceneModel, SceneView};
use dragonfly_picture::PosedScene;
use egui::Pos2;
use glam::Vec3;
use std::sync::Arc;

/// Half the size of the space that is framed around a thing of which nothing is drawn, meters.
const AROUND: f32 = 0.5;

/// Frames the scene when all of its models were read, once after it was opened.
pub(super) fn frame_once(workspace: &mut Workspace) {
    let Some(scene) = workspace.model.view().and_then(|view| view.scene.as_deref()) else { return };
    let is_complete =
        scene.plan.is_some() && scene.models.values().all(|model| !matches!(model, SceneModel::Loading));
    if workspace.stage.frames_now(is_complete) {
        frame(workspace, |_| true);
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

fn frame(workspace: &mut Workspace, is_framed: impl Fn(&str) -> bool) -> bool {
    let Some(scene) = workspace.model.view().and_then(|view| view.scene.clone()) else { return false };
    let hidden: Vec<Arc<str>> = workspace.scene.hidden().map(Arc::from).collect();
    let seconds = f64::from(workspace.player.time());
    if let Some(around) = box_of(&scene, &hidden, seconds, is_framed) {
        workspace.camera.frame(around.min, around.max);
    }
    true
}

/// Returns the box around things at a time: around what is drawn of them, or around their places where nothing is. `None` without a plan
/// and without things.
fn box_of(
    scene: &SceneView,
    hidden: &[Arc<str>],
    seconds: f64,
    is_framed: impl Fn(&str) -> bool,
) -> Option<AxisBox> {
    let mut posed = PosedScene::without(scene, hidden, None)?;
    posed.pose(seconds);
    let plan = Arc::clone(posed.plan());
    let things = || plan.things().iter().enumerate().filter(|(_, thing)| is_framed(&thing.id));
    let union = |around: AxisBox, other: AxisBox| around.union(other);
    let drawn = things().map(|(thing, _)| posed.box_of(thing)).filter(|own| !own.is_empty());
    let drawn = drawn.fold(AxisBox::EMPTY, union);
    if !drawn.is_empty() {
        return Some(drawn);
    }
    let points = things().flat_map(|(thing, planned)| match &planned.path {
        Some(path) => [0.0, 0.25, 0.5, 0.75, 1.0]
            .map(|share| path.at(path.length() * share).position.as_vec3())
            .to_vec(),
        None => vec![posed.middle_of(thing)],
    });
    let near = |point: Vec3| AxisBox { min: point - AROUND, max: point + AROUND };
    let places = points.map(near).fold(AxisBox::EMPTY, union);
    (!places.is_empty()).then_some(places)
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
