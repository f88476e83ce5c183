//! The gizmo of the selected things of a scene: a drag becomes a new text of the script.

use super::scene_ground::{heights_on_ground, on_ground};
use super::scene_moves::BaseMoment;
use crate::panels::request::Effect;
use crate::panels::scene::{ChangedThings, SceneBase, ScriptChange};
use crate::panels::status::MessageSeverity;
use crate::panels::tool_state::PlacedGizmo;
use crate::panels::workspace::Workspace;
use dragonfly_anim::data::{BoneIndex, Skeleton};
use dragonfly_anim::stage::gesture::{GestureRefusal, written_points};
use dragonfly_anim::stage::splice::TextSplices;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::SceneView;
use dragonfly_document::edit::ScriptLabel;
use dragonfly_document::history::Gesture;
use dragonfly_picture::gizmo::{PosedSkeleton, Tool};
use glam::{DVec3, Vec3};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Places the gizmo at the selected things, at the time shown. Does nothing if nothing changed; a drag keeps its place.
pub(super) fn sync(workspace: &mut Workspace, placement: PlacedGizmo) {
    let Some(scene) = workspace.model.view().and_then(|view| view.scene.clone()) else { return };
    let Some(plan) = &scene.plan else { return };
    let time = workspace.read().scene_time();
    let mut bones = placement.bones;
    bones.clear();
    // Locked things stay where they are while others are moved.
    let shows_locked = all_are_locked(workspace);
    let is_shown =
        |id: &str| !workspace.scene.is_hidden(id) && (shows_locked || !workspace.scene.is_locked(id));
    let selected = workspace.scene.things().iter().filter(|id| is_shown(id));
    let things = selected.filter_map(|id| plan.thing_called(id));
    if placement.tool.is_some() {
        let has_gizmo = |&thing: &usize| {
            plan.things()[thing].path.is_none() || middle_of_path(&scene, &plan.things()[thing].id).is_some()
        };
        bones.extend(things.filter(has_gizmo).map(|thing| thing as BoneIndex));
    }
    let active = bones.last().copied();
    let refused = refusal(workspace, &scene).is_some();
    let is_idle = bones.is_empty() || placement.tool.is_none();
    let placement = PlacedGizmo { take: None, bones, active, refused, ..placement };
    if is_idle {
        return put_away(workspace, placement);
    }
    if !workspace.tools.is_placed_elsewhere(&placement) {
        return workspace.tools.reuse(placement);
    }
    let mut poses = workspace.stage.take_poses();
    let shown = workspace.stage.things_at(plan, time);
    poses.resize(plan.things().len());
    for &bone in &placement.bones {
        let (planned, thing) = (&plan.things()[bone as usize], &shown.things[bone as usize]);
        let mut place = thing.transform;
        place.translation = middle_of_path(&scene, &planned.id).unwrap_or(place.translation);
        poses.set(bone as usize, place);
    }
    workspace.tools.place_gizmo(poses.posed(), placement, !refused);
    workspace.stage.keep_poses(poses);
}

/// Returns the middle of the points of a path, at which its gizmo is; `None` for other things, and for a path along a line.
fn middle_of_path(scene: &SceneView, id: &str) -> Option<Vec3> {
    let points = written_points(scene.script.as_ref()?, id)?;
    Some((points.iter().sum::<DVec3>() / points.len().max(1) as f64).as_vec3())
}

/// Shows no gizmo. It is the same at each time, so that nothing is computed while a scene plays.
fn put_away(workspace: &mut Workspace, placement: PlacedGizmo) {
    let placement = PlacedGizmo { generation: 0, time: 0.0, ..placement };
    if !workspace.tools.is_placed_elsewhere(&placement) {
        return workspace.tools.reuse(placement);
    }
    let skeleton = Skeleton { bones: Vec::new() };
    let pose = PosedSkeleton { skeleton: &skeleton, poses: &[], to_root: &[] };
    let placement = PlacedGizmo { bones: Vec::new(), active: None, ..placement };
    workspace.tools.place_gizmo(pose, placement, false);
}

/// Returns why the selected things cannot be moved; `None` if they can.
fn refusal(workspace: &Workspace, scene: &SceneView) -> Option<GestureRefusal> {
    match workspace.scene.lock_refusal(workspace.scene.things()).filter(|_| all_are_locked(workspace)) {
        Some(reason) => Some(GestureRefusal(reason)),
        None => SceneBase::of(scene, workspace.scene.text(scene)).err(),
    }
}

/// Returns whether none of the selected things can be moved, because all are locked.
fn all_are_locked(workspace: &Workspace) -> bool {
    workspace.scene.things().iter().all(|id| workspace.scene.is_locked(id))
}

/// Reports which of the selected things stay where they are while the others are moved.
fn say_what_stays(workspace: &mut Workspace, refused: &[GestureRefusal]) {
    let things = workspace.scene.things().iter().map(|id| &**id);
    let locked: Vec<&str> = things.filter(|id| workspace.scene.is_locked(id)).collect();
    let locked = match locked[..] {
        [] => None,
        [id] => Some(format!("{id} is locked and stays")),
        _ => Some(format!("{} things are locked and stay", locked.len())),
    };
    let refused = refused.iter().map(|refusal| format!("{refusal}; it stays"));
    for text in locked.into_iter().chain(refused).collect::<Vec<String>>() {
        workspace.say(MessageSeverity::Info, text);
    }
}

/// Reports why the selected things cannot be moved.
pub(super) fn say_refused(workspace: &mut Workspace) {
    let scene = workspace.read().scene().cloned();
    if let Some(refusal) = scene.and_then(|scene| refusal(workspace, &scene)) {
        workspace.say(MessageSeverity::Info, refusal.to_string());
    }
}

/// Sends the text that the drag of the gizmo makes now.
pub(super) fn send(workspace: &mut Workspace, effects: &mut Vec<Effect>) {
    let is_idle = workspace.tools.controls().gizmo().gizmo.is_identity();
    if is_idle && workspace.tools.drag().gesture().is_none() {
        return;
    }
    match change(workspace) {
        Ok(Some(change)) => {
            if let Some(gesture) = change.gesture {
                workspace.tools.drag_mut().begin(gesture);
            }
            effects.extend(super::scene_text::change_text(workspace, &change));
        }
        Ok(None) => {}
        Err(refusal) => workspace.say(MessageSeverity::Warning, refusal.to_string()),
    }
}

/// Ends the drag.
pub(super) fn end(workspace: &mut Workspace) {
    workspace.stage.end_drag();
}

/// Returns the state at the start of the drag; at its first movement, that is the newest one.
pub(super) fn gesture_base(
    workspace: &mut Workspace,
    scene: &SceneView,
) -> Result<SceneBase, GestureRefusal> {
    if let Some(base) = workspace.stage.base() {
        return Ok(base.clone());
    }
    let base = SceneBase::of(scene, workspace.scene.text(scene))?;
    workspace.stage.set_base(Some(base.clone()));
    Ok(base)
}

/// Returns the change that the drag makes now; `None` where it is the same as before.
fn change(workspace: &mut Workspace) -> Result<Option<ScriptChange>, GestureRefusal> {
    let scene = workspace.read().scene().cloned();
    let scene = scene.ok_or_else(|| GestureRefusal("No scene is open".to_owned()))?;
    let base = gesture_base(workspace, &scene)?;
    let gesture = workspace.tools.drag().gesture().unwrap_or_else(|| workspace.dragging.new_gesture());
    let time = workspace.read().scene_time();
    let heights = kept_heights(workspace, &scene, time);
    let is_keyed = workspace.settings.auto_key && time > StageTime::ZERO;
    let things = workspace.stage.base_things(&base.plan, time);
    let moment = BaseMoment { base: &base, things, time, is_keyed };
    let gizmo = &workspace.tools.controls().gizmo().gizmo;
    let (mut parts, mut moved, mut refused) = (Vec::new(), Vec::<Box<str>>::new(), Vec::new());
    for (drag, before) in gizmo.drag().bones.iter().zip(gizmo.before()) {
        let (thing, mut now) = (drag.bone as usize, drag.to_parent);
        let height = heights.as_ref().and_then(|heights| heights.get(&thing).copied());
        if let Some(height) = height {
            now.translation = on_ground(&base.plan, thing, now.translation, height);
        }
        let mut own = Vec::new();
        match moment.moved(thing, gizmo.tool, [now, before.to_parent], &mut own) {
            Ok(()) => {
                parts.extend(own);
                moved.extend(base.plan.things().get(thing).map(|planned| planned.id.clone()));
            }
            Err(refusal) => refused.push(refusal),
        }
    }
    let label = match gizmo.tool {
        Tool::Move => ScriptLabel::MoveThing,
        Tool::Rotate => ScriptLabel::TurnThing,
        Tool::Scale => ScriptLabel::ScaleThing,
    };
    if moved.is_empty()
        && let Some(refusal) = refused.first()
    {
        return Err(refusal.clone());
    }
    let is_first = workspace.tools.drag().gesture().is_none();
    let change = spliced(workspace, &base, parts, (label, ChangedThings::Things(&moved)), gesture)?;
    if is_first && change.is_some() {
        say_what_stays(workspace, &refused);
    }
    Ok(change)
}

/// Returns the heights at which things stay while they are moved on the ground; `None` while they may leave it.
fn kept_heights(
    workspace: &mut Workspace,
    scene: &SceneView,
    time: StageTime,
) -> Option<Arc<BTreeMap<usize, f32>>> {
    let gizmo = &workspace.tools.controls().gizmo().gizmo;
    if gizmo.tool != Tool::Move || !workspace.settings.tools.ground {
        return None;
    }
    if workspace.stage.heights().is_none() {
        let things = gizmo.drag().bones.iter().map(|drag| drag.bone as usize);
        let heights = heights_on_ground(scene, things, time.seconds());
        workspace.stage.set_heights(Arc::new(heights));
    }
    workspace.stage.heights().cloned()
}

/// Returns the replacements together.
///
/// # Errors
///
/// Two of them are at the same place.
pub(super) fn joined(parts: Vec<TextSplices>) -> Result<TextSplices, GestureRefusal> {
    TextSplices::joined(parts).ok_or_else(|| GestureRefusal("This cannot be written here".to_owned()))
}

/// Returns the change of the base by all of these replacements; `None` where they are the same as before.
pub(super) fn spliced(
    workspace: &mut Workspace,
    base: &SceneBase,
    parts: Vec<TextSplices>,
    (label, things): (ScriptLabel, ChangedThings<'_>),
    gesture: Gesture,
) -> Result<Option<ScriptChange>, GestureRefusal> {
    let splices = joined(parts)?;
    if !workspace.stage.is_new(&splices) {
        return Ok(None);
    }
    base.spliced(&splices, label, Some(gesture), things).map(Some)
}
