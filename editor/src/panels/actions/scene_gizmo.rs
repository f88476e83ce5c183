//! The gizmo of the selected things of a scene: a drag becomes a new text of the script.

use super::scene_camera::distance_of_look;
use super::scene_ground::heights_on_ground;
use crate::panels::request::Effect;
use crate::panels::scene::{SceneBase, ScriptChange};
use crate::panels::status::MessageSeverity;
use crate::panels::tool_state::PlacedGizmo;
use crate::panels::workspace::Workspace;
use dragonfly_anim::data::{Bone, BoneIndex, Skeleton, Transform};
use dragonfly_anim::stage::StageScene;
use dragonfly_anim::stage::gesture::{GestureRefusal, face_splices, place_splices, set_on_thing};
use dragonfly_anim::stage::splice::TextSplices;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::SceneView;
use dragonfly_document::history::Gesture;
use dragonfly_picture::gizmo::{PosedSkeleton, Tool};
use glam::{Mat4, Quat, Vec3};
use std::collections::BTreeMap;
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
    if placement.tool.is_some() {
        bones.extend(
            things.filter(|&thing| plan.things()[thing].path.is_none()).map(|thing| thing as BoneIndex),
        );
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
    let places: Vec<Transform> =
        workspace.stage.things_at(plan, time).things.iter().map(|thing| thing.transform).collect();
    let to_root: Vec<Mat4> = places.iter().map(|place| place.to_matrix()).collect();
    let bone = |place: &Transform| Bone { rest: *place, ..Bone::root("") };
    let skeleton = Skeleton { bones: places.iter().map(bone).collect() };
    let pose = PosedSkeleton { skeleton: &skeleton, poses: &places, to_root: &to_root };
    workspace.tools.place_gizmo(pose, placement, !refused);
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
    let moment = BaseMoment { base: &base, things: workspace.stage.base_things(&base.plan, time), time };
    let gizmo = &workspace.tools.controls().gizmo().gizmo;
    let mut parts = Vec::new();
    for (drag, before) in gizmo.drag().bones.iter().zip(gizmo.before()) {
        let (thing, mut now) = (drag.bone as usize, drag.to_parent);
        let height = heights.as_ref().and_then(|heights| heights.get(&thing).copied());
        now.translation.y = height.unwrap_or(now.translation.y);
        moment.moved(thing, gizmo.tool, [now, before.to_parent], &mut parts)?;
    }
    let label = match gizmo.tool {
        Tool::Move => "Move thing",
        Tool::Rotate => "Turn thing",
        Tool::Scale => "Scale thing",
    };
    spliced(workspace, &base, parts, label, gesture)
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
    label: &'static str,
    gesture: Gesture,
) -> Result<Option<ScriptChange>, GestureRefusal> {
    let splices = joined(parts)?;
    if !workspace.stage.is_new(&splices) {
        return Ok(None);
    }
    base.spliced(&splices, label, Some(gesture)).map(Some)
}

/// The scene at the start of a drag, with its things at the time shown.
pub(super) struct BaseMoment<'a> {
    pub(super) base: &'a SceneBase,
    pub(super) things: &'a StageScene,
    pub(super) time: StageTime,
}

impl BaseMoment<'_> {
    /// Adds the replacements that put a thing where the gizmo put it: now, and before.
    fn moved(
        &self,
        thing: usize,
        tool: Tool,
        [now, before]: [Transform; 2],
        parts: &mut Vec<TextSplices>,
    ) -> Result<(), GestureRefusal> {
        let planned = self.base.plan.things().get(thing);
        let planned = planned.ok_or_else(|| GestureRefusal("The thing is gone".to_owned()))?;
        let is_turned = tool == Tool::Rotate && planned.kind != "camera";
        let facing = is_turned.then(|| facing(now.rotation));
        let is_moved = tool == Tool::Move || now.translation != before.translation;
        match facing {
            _ if is_moved => parts.push(self.placed(thing, now.translation, facing)?),
            Some(facing) => {
                parts.push(face_splices(&self.base.scene(), &planned.id, self.time, facing)?);
            }
            None => {}
        }
        match tool {
            Tool::Rotate if !is_turned => {
                let ahead = now.rotation * before.rotation.inverse() * self.direction_of_camera(thing);
                let distance = distance_of_look(self.base, &planned.id, before.translation);
                parts.push(self.looking(&planned.id, now.translation + ahead * distance)?);
            }
            Tool::Scale => parts.push(self.scaled(&planned.id, now.scale / before.scale)?),
            Tool::Move | Tool::Rotate => {}
        }
        Ok(())
    }

    /// Returns the replacements that put a thing at `position`, with another direction where there is one, degrees. Refused where something carries it, and
    /// where it follows a path.
    pub(super) fn placed(
        &self,
        thing: usize,
        position: Vec3,
        facing: Option<f64>,
    ) -> Result<TextSplices, GestureRefusal> {
        let (script, plan) = (&self.base.script, &self.base.plan);
        let id = &plan.things()[thing].id;
        let own = plan.placement(thing, self.time).unwrap_or_default().position.as_vec3();
        let shown = self.things.things.get(thing).map_or(own, |thing| thing.transform.translation);
        if shown.distance(own) > CARRIED {
            return Err(GestureRefusal(format!("Something holds {id} at this time: move what holds it")));
        }
        let follows = (1..script.actions().len()).find(|&action| {
            let element = script.element(action);
            element.row.name == "move"
                && element.value("who") == Some(id)
                && element.value("path").is_some()
                && plan.schedule().times().get(action).is_some_and(|times| times.begin <= self.time)
        });
        if let Some(path) = follows.and_then(|action| script.element(action).value("path")) {
            return Err(GestureRefusal(format!("{id} follows the path {path} at this time: move the path")));
        }
        place_splices(&self.base.scene(), id, self.time, rounded(position), facing)
    }

    /// Returns the replacements with which a camera of the cast looks at a point.
    pub(super) fn looking(&self, id: &str, look: Vec3) -> Result<TextSplices, GestureRefusal> {
        let value = rounded(look).to_array().map(|number| number.to_string()).join(" ");
        self.set(id, "look", &value)
    }

    /// Returns the replacements that give a role or a prop another size.
    fn scaled(&self, id: &str, by: Vec3) -> Result<TextSplices, GestureRefusal> {
        let script = &self.base.script;
        let element = script.thing_element(id).map(|element| &script.tree().elements()[element]);
        let has_scale = element.is_some_and(|element| element.row.attribute("scale").is_some());
        if !has_scale {
            return Err(GestureRefusal(format!("{id} has no size of its own")));
        }
        // The axis that changed most.
        let by = by.to_array().into_iter().max_by(|a, b| (a - 1.0).abs().total_cmp(&(b - 1.0).abs()));
        let written =
            element.and_then(|element| element.value("scale")).and_then(|scale| scale.parse::<f64>().ok());
        let scale = (written.unwrap_or(1.0) * f64::from(by.unwrap_or(1.0)) * 1e5).round() / 1e5;
        if !(scale.is_finite() && scale > 0.0) {
            return Err(GestureRefusal("The size has to be greater than zero".to_owned()));
        }
        self.set(id, "scale", &scale.to_string())
    }

    fn set(&self, id: &str, attribute: &str, value: &str) -> Result<TextSplices, GestureRefusal> {
        let script = &self.base.script;
        let splices =
            script.thing_element(id).and_then(|own| set_on_thing(script, own, attribute, Some(value)));
        splices.ok_or_else(|| GestureRefusal(format!("{attribute} of {id} cannot be written here")))
    }

    /// Returns the direction in which a camera looks.
    fn direction_of_camera(&self, thing: usize) -> Vec3 {
        let camera = self.base.plan.camera_of(thing, self.things);
        camera.map_or(Vec3::NEG_Z, |camera| camera.rotation * Vec3::NEG_Z)
    }
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
