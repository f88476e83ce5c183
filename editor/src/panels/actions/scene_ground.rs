//! Things on the ground: while they are moved, by a command, and where a file is dropped.

use super::scene_gizmo::joined;
use super::scene_moves::BaseMoment;
use super::scene_probe::{pointer, ray_at};
use super::scene_text::step;
use crate::panels::request::Effect;
use crate::panels::scene::{ChangedThings, no_drop_text};
use crate::panels::workspace::Workspace;
use dragonfly_anim::stage::gesture::GestureRefusal;
use dragonfly_anim::stage::{PlannedThing, StagePlan};
use dragonfly_document::SceneView;
use dragonfly_document::edit::ScriptLabel;
use dragonfly_picture::PosedScene;
use egui::Pos2;
use glam::{DVec3, Vec3};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Least sine of the angle at which the ground is seen: nearer to the horizon, the pointer reaches too far.
const LEAST_SLOPE: f64 = 0.01;

/// Farthest place for what is dropped, in distances of the camera from the point that it looks at.
const FARTHEST: f64 = 20.0;

/// Switches whether things that are moved stay on the ground.
pub(in crate::panels) fn toggle(workspace: &mut Workspace) {
    workspace.settings.tools.ground ^= true;
}

/// Moves the selected things up or down so that they are on the ground.
pub(in crate::panels) fn drop_selected(workspace: &mut Workspace) -> Option<Effect> {
    let time = workspace.read().scene_time();
    let scene = workspace.model.view()?.scene.clone()?;
    let selected = workspace.scene.things().iter().filter(|id| !workspace.scene.is_locked(id)).cloned();
    let selected: Vec<Box<str>> = selected.collect();
    let things = selected.iter().filter_map(|id| scene.plan.as_ref()?.thing_called(id));
    let heights = heights_on_ground(&scene, things, time.seconds());
    step(workspace, |base| {
        let mut state = base.plan.new_scene();
        base.plan.scene_at(time, &mut state);
        let things = selected.iter().filter_map(|id| base.plan.thing_called(id));
        let standing: Vec<(usize, f32)> =
            things.filter_map(|thing| Some((thing, *heights.get(&thing)?))).collect();
        if standing.is_empty() {
            return Err(GestureRefusal(
                "Nothing that is selected can stand: choose roles, props or marks".to_owned(),
            ));
        }
        let moment = BaseMoment { base, things: &state, time, is_keyed: false };
        let placed = |(thing, height): (usize, f32)| {
            let place = state.things[thing].transform.translation;
            moment.placed(thing, on_ground(&base.plan, thing, place, height), None)
        };
        let parts: Result<Vec<_>, GestureRefusal> = standing.into_iter().map(placed).collect();
        base.spliced(&joined(parts?)?, ScriptLabel::DropToGround, None, ChangedThings::Things(&selected))
    })
}

/// Returns the place of a thing of a plan on the ground under or over `place`, nearest to its height: that of the ground props of the cast, else of the plane.
/// `height` is how much higher than the ground its place is. For ground props it is always the plane.
pub(super) fn on_ground(plan: &StagePlan, thing: usize, place: Vec3, height: f32) -> Vec3 {
    let is_ground = plan.things().get(thing).is_some_and(PlannedThing::is_ground);
    let ground = if is_ground { None } else { plan.ground_at(place.as_dvec3()) };
    place.with_y(ground.unwrap_or(plan.ground_plane()) as f32 + height)
}

/// Returns how much higher than the ground the places of these things of a plan are while they are on it, meters, by their positions in it: a prop with its lowest point at this time, a role
/// or a mark with its place. None for things in the air, and for paths.
pub(super) fn heights_on_ground(
    scene: &SceneView,
    things: impl IntoIterator<Item = usize>,
    seconds: f64,
) -> BTreeMap<usize, f32> {
    let Some(plan) = &scene.plan else { return BTreeMap::new() };
    let known = things.into_iter().filter_map(|thing| Some((thing, plan.things().get(thing)?.kind)));
    let known: BTreeMap<usize, &str> = known.collect();
    let props: BTreeSet<usize> =
        known.iter().filter(|(_, kind)| **kind == "prop").map(|(thing, _)| *thing).collect();
    let posed = posed_alone(scene, plan, &props, seconds);
    let height_of_prop = |thing: usize| {
        let posed = posed.as_ref()?;
        let (around, place) = (posed.box_of(thing), posed.state().things.get(thing)?.transform.translation.y);
        Some(if around.is_empty() { 0.0 } else { place - around.min.y })
    };
    let height = |(thing, kind): (usize, &str)| match kind {
        "role" | "mark" => Some((thing, 0.0)),
        "prop" => Some((thing, height_of_prop(thing)?)),
        // Cameras, lights and effects are in the air; paths have no place.
        _ => None,
    };
    known.into_iter().filter_map(height).collect()
}

/// Poses these things of a scene and leaves all others out; `None` without one of them, so that nothing is computed then.
fn posed_alone(
    scene: &SceneView,
    plan: &StagePlan,
    things: &BTreeSet<usize>,
    seconds: f64,
) -> Option<PosedScene> {
    if things.is_empty() {
        return None;
    }
    let others = plan.things().iter().enumerate().filter(|(thing, _)| !things.contains(thing));
    let hidden: Vec<Arc<str>> = others.map(|(_, thing)| Arc::from(&*thing.id)).collect();
    let mut posed = PosedScene::new(scene, &hidden, None)?;
    posed.pose(seconds);
    Some(posed)
}

/// Returns the place on the ground under the pointer, or under the middle of the viewport while the pointer is elsewhere; `None` where there is no ground near.
pub(super) fn pointed(workspace: &Workspace) -> Option<DVec3> {
    ground_at(workspace, pointer(workspace).unwrap_or(workspace.camera.viewport().center()))
}

/// Returns the place on the ground at a position of the window, points; `None` outside of the viewport and where there is no ground near.
pub(super) fn ground_at(workspace: &Workspace, at: Pos2) -> Option<DVec3> {
    any_ground_at(workspace, at).filter(|place| is_near(workspace, *place))
}

/// Returns why nothing is dropped at a position of the window, points; `None` outside of the viewport and where there is ground near.
pub(super) fn no_drop(workspace: &Workspace, at: Pos2) -> Option<&'static str> {
    if !workspace.camera.viewport().contains(at) {
        return None;
    }
    let projection = workspace.camera.camera().projection;
    match any_ground_at(workspace, at) {
        Some(place) if is_near(workspace, place) => None,
        found => Some(no_drop_text(found.is_some(), projection)),
    }
}

/// Returns the place on the ground at a position of the window, however far away it is.
fn any_ground_at(workspace: &Workspace, at: Pos2) -> Option<DVec3> {
    let (origin, direction) = ray_at(workspace, at)?;
    let ground = workspace.read().scene().map_or(0.0, SceneView::ground);
    let along = (ground - origin.y) / direction.y;
    let place = (origin + direction * along).with_y(ground);
    (direction.y.abs() > LEAST_SLOPE && along > 0.0 && place.is_finite()).then_some(place)
}

fn is_near(workspace: &Workspace, place: DVec3) -> bool {
    let camera = workspace.camera.camera();
    place.distance(camera.target.as_dvec3()) < FARTHEST * f64::from(camera.distance)
}
