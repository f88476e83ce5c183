//! The gizmo of the selected things of a scene: a drag becomes a new text of the script.

use super::scene_camera::distance_of_look;
use crate::panels::request::Effect;
use crate::panels::scene::{SceneBase, ScriptChange};
use crate::panels::status::MessageSeverity;
use crate::panels::tool_state::PlacedGizmo;
use crate::panels::workspace::Workspace;
use dragonfly_anim::data::{Bone, BoneIndex, Skeleton, Transform};
use dragonfly_anim::stage::gesture::{GestureRefusal, GestureScene, face_thing, place_thing};
use dragonfly_anim::stage::script::StageScript;
use dragonfly_anim::stage::splice::set_attribute;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::SceneView;
use dragonfly_picture::gizmo::{PosedSkeleton, Tool};
use glam::{Mat4, Quat, Vec3};
use std::sync::Arc;

/// Distance between the place of a thing and the one that its own motions give it, above which something else carries it, meters.
const CARRIED: f32 = 1e-3;

/// Places the gizmo at the selected things, at the time shown. Does nothing if nothing changed; a drag keeps its place.
pub(super) fn sync(workspace: &mut Workspace, placement: PlacedGizmo) {
    let Some(scene) = workspace.model.view().and_then(|view| view.scene.clone()) else { return };
    let Some(plan) = &scene.plan else { return };
    let time = workspace.read().scene_time();
    let mut bones = placement.bones;
    bones.clear();
    let selected = workspace.scene.things().iter().filter(|id| !workspace.scene.is_hidden(id));
    let things = selected.filter_map(|id| plan.thing_called(id));
    bones.extend(things.filter(|&thing| plan.things()[thing].path.is_none()).map(|thing| thing as BoneIndex));
    let active = bones.last().copied();
    let refused = refusal(workspace, &scene).is_some();
    let placement = PlacedGizmo { take: None, bones, active, refused, ..placement };
    if !workspace.tools.is_placed_elsewhere(&placement) {
        return workspace.tools.reuse(placement);
    }
    let places: Vec<Transform> =
        workspace.stage.things_at(plan, time).things.iter().map(|thing| thing.transform).collect();
    let to_root: Vec<Mat4> = places.iter().map(|place| place.to_matrix()).collect();
    let bone = |place: &Transform| Bone { rest: *place, ..Bone::root("") };
    let skeleton = Skeleton { bones: places.iter().map(bone).collect() };
    let pose = PosedSkeleton { skeleton: &skeleton, poses: &places, to_root: &to_root };
    workspace.tools.place_gizmo(pose, placement, !refused);
}

/// Returns why the selected things cannot be moved; `None` if they can.
fn refusal(workspace: &Workspace, scene: &SceneView) -> Option<GestureRefusal> {
    let locked = workspace.scene.things().iter().find(|id| workspace.scene.is_locked(id));
    match locked {
        Some(id) => Some(GestureRefusal(format!("{id} is locked"))),
        None => SceneBase::of(scene, workspace.scene.text(scene)).err(),
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
    match text(workspace) {
        Ok(change) => {
            if let Some(gesture) = change.gesture {
                workspace.tools.drag_mut().begin(gesture);
            }
            effects.extend(super::scene_text::change_text(workspace, &change));
        }
        Err(refusal) => workspace.say(MessageSeverity::Warning, refusal.to_string()),
    }
}

/// Ends the drag.
pub(super) fn end(workspace: &mut Workspace) {
    workspace.stage.set_base(None);
}

fn text(workspace: &mut Workspace) -> Result<ScriptChange, GestureRefusal> {
    let scene = workspace.read().scene().cloned();
    let scene = scene.ok_or_else(|| GestureRefusal("No scene is open".to_owned()))?;
    let base = match workspace.stage.base() {
        Some(base) => base.clone(),
        None => SceneBase::of(&scene, workspace.scene.text(&scene))?,
    };
    workspace.stage.set_base(Some(base.clone()));
    let gesture = workspace.tools.drag().gesture().unwrap_or_else(|| workspace.dragging.new_gesture());
    let time = workspace.read().scene_time();
    let gizmo = &workspace.tools.controls().gizmo().gizmo;
    let tool = gizmo.tool;
    let moved: Vec<(usize, Transform, Transform)> = gizmo
        .drag()
        .bones
        .iter()
        .zip(gizmo.before())
        .map(|(drag, before)| (drag.bone as usize, drag.to_parent, before.to_parent))
        .collect();
    let mut script = Arc::clone(&base.script);
    for (thing, now, before) in moved {
        let text = thing_text(&base, &script, (thing, time), tool, [now, before])?;
        if *text != **script.tree().text() {
            script = Arc::new(reread(&script, text)?);
        }
    }
    let label = match tool {
        Tool::Move => "Move thing",
        Tool::Rotate => "Turn thing",
        Tool::Scale => "Scale thing",
    };
    let text = script.tree().text().to_string();
    Ok(ScriptChange { from: Arc::clone(base.text()), text, label, gesture: Some(gesture) })
}

/// Returns the text in which a thing is where the gizmo put it: now, and before.
fn thing_text(
    base: &SceneBase,
    script: &StageScript,
    (thing, time): (usize, StageTime),
    tool: Tool,
    [now, before]: [Transform; 2],
) -> Result<String, GestureRefusal> {
    let planned = base.plan.things().get(thing);
    let planned = planned.ok_or_else(|| GestureRefusal("The thing is gone".to_owned()))?;
    let mut text = script.tree().text().to_string();
    if tool == Tool::Move || now.translation != before.translation {
        text = place_text(base, script, thing, time, now.translation)?;
    }
    let turned = read_if_new(script, text)?;
    let script = turned.as_ref().unwrap_or(script);
    match tool {
        Tool::Move => Ok(script.tree().text().to_string()),
        Tool::Rotate if planned.kind == "camera" => {
            let ahead = now.rotation * before.rotation.inverse() * direction_of_camera(base, thing, time);
            let look = now.translation + ahead * distance_of_look(base, &planned.id, before.translation);
            look_text(script, script.tree().text(), &planned.id, look)
        }
        Tool::Rotate => {
            let scene = GestureScene { script, plan: &base.plan };
            face_thing(&scene, &planned.id, time, facing(now.rotation))
        }
        Tool::Scale => scale_text(script, &planned.id, now.scale / before.scale),
    }
}

/// Returns the text in which a thing is at `position`. Refused where something carries it, and where it follows a path.
pub(super) fn place_text(
    base: &SceneBase,
    script: &StageScript,
    thing: usize,
    time: StageTime,
    position: Vec3,
) -> Result<String, GestureRefusal> {
    let id = &base.plan.things()[thing].id;
    let mut state = base.plan.new_scene();
    base.plan.scene_at(time, &mut state);
    let own = base.plan.placement(thing, time).unwrap_or_default().position.as_vec3();
    if state.things[thing].transform.translation.distance(own) > CARRIED {
        return Err(GestureRefusal(format!("Something holds {id} at this time: move what holds it")));
    }
    let follows = (1..base.script.actions().len()).find(|&action| {
        let element = base.script.element(action);
        element.row.name == "move"
            && element.value("who") == Some(id)
            && element.value("path").is_some()
            && base.plan.schedule().times().get(action).is_some_and(|times| times.begin <= time)
    });
    if let Some(path) = follows.and_then(|action| base.script.element(action).value("path")) {
        return Err(GestureRefusal(format!("{id} follows the path {path} at this time: move the path")));
    }
    let scene = GestureScene { script, plan: &base.plan };
    place_thing(&scene, id, time, rounded(position))
}

/// Returns the text in which a camera of the cast looks at a point; `script` is the one from which `text` was made.
pub(super) fn look_text(
    script: &StageScript,
    text: &str,
    id: &str,
    look: Vec3,
) -> Result<String, GestureRefusal> {
    let script = reread(script, text.to_owned())?;
    let value = rounded(look).to_array().map(|number| number.to_string()).join(" ");
    set(&script, id, "look", &value)
}

/// Returns the text in which a role or a prop has another size.
fn scale_text(script: &StageScript, id: &str, by: Vec3) -> Result<String, GestureRefusal> {
    let element = script.things().find(|element| element.value("id") == Some(id));
    let has_scale = element.is_some_and(|element| element.row.attribute("scale").is_some());
    if !has_scale {
        return Err(GestureRefusal(format!("{id} has no size of its own")));
    }
    // The axis that changed most.
    let by =
        by.to_array().into_iter().max_by(|a, b| (a - 1.0).abs().total_cmp(&(b - 1.0).abs())).unwrap_or(1.0);
    let written =
        element.and_then(|element| element.value("scale")).and_then(|scale| scale.parse::<f64>().ok());
    let scale = (written.unwrap_or(1.0) * f64::from(by) * 1e5).round() / 1e5;
    if !(scale.is_finite() && scale > 0.0) {
        return Err(GestureRefusal("The size has to be greater than zero".to_owned()));
    }
    set(script, id, "scale", &scale.to_string())
}

fn set(script: &StageScript, id: &str, attribute: &str, value: &str) -> Result<String, GestureRefusal> {
    let tree = script.tree();
    let is_own = |element: &&dragonfly_anim::stage::script::ScriptElement| element.value("id") == Some(id);
    let element = script.things().find(is_own).map(|own| own.range.start);
    let element = tree.elements().iter().position(|own| Some(own.range.start) == element);
    let splices = element.and_then(|element| set_attribute(tree, element, attribute, value));
    let splices =
        splices.ok_or_else(|| GestureRefusal(format!("{attribute} of {id} cannot be written here")))?;
    Ok(splices.apply(tree.text()))
}

/// Returns the script of a new text, with the project of the old one.
fn reread(script: &StageScript, text: String) -> Result<StageScript, GestureRefusal> {
    script
        .reread(text)
        .map_err(|errors| GestureRefusal(errors.first().map_or(String::new(), |error| error.text())))
}

fn read_if_new(script: &StageScript, text: String) -> Result<Option<StageScript>, GestureRefusal> {
    if *text == **script.tree().text() { Ok(None) } else { reread(script, text).map(Some) }
}

/// Returns the direction in which a camera looks.
fn direction_of_camera(base: &SceneBase, thing: usize, time: StageTime) -> Vec3 {
    let mut state = base.plan.new_scene();
    base.plan.scene_at(time, &mut state);
    base.plan.camera_of(thing, &state).map_or(Vec3::NEG_Z, |camera| camera.rotation * Vec3::NEG_Z)
}

/// Returns the direction of a rotation about the vertical, degrees, to a hundredth: 0 looks along +z, 90 along +x.
fn facing(rotation: Quat) -> f64 {
    let ahead = rotation * Vec3::Z;
    let degrees = f64::from(ahead.x).atan2(f64::from(ahead.z)).to_degrees();
    (degrees * 100.0).round() / 100.0
}

/// Returns a position to a millimeter.
fn rounded(position: Vec3) -> glam::DVec3 {
    // Adding zero makes a zero of a negative one.
    (position.as_dvec3() * 1000.0).round() / 1000.0 + 0.0
}
