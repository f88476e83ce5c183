//! Things of a scene put, turned and scaled, as replacements in its script.

use crate::panels::scene::SceneBase;
use dragonfly_anim::data::Transform;
use dragonfly_anim::stage::gesture::{
    GestureRefusal, HeldGrip, face_splices, facing_and_tilt, grip_splices, in_scene_texts, key_place_splices,
    path_points_splices, place_splices, set_on_thing, written_points,
};
use dragonfly_anim::stage::script::ScriptElement;
use dragonfly_anim::stage::splice::TextSplices;
use dragonfly_anim::stage::table::{element, vector};
use dragonfly_anim::stage::time::StageTime;
use dragonfly_anim::stage::{RigidPlace, StageScene, ThingHold};
use dragonfly_picture::gizmo::Tool;
use glam::{DVec3, Quat, Vec3};

/// The scene at the start of a drag, with its things at the time shown.
pub(super) struct BaseMoment<'a> {
    pub(super) base: &'a SceneBase,
    pub(super) things: &'a StageScene,
    pub(super) time: StageTime,
    /// Whether a thing that the gizmo puts elsewhere is there from this time on, and before where it was.
    pub(super) is_keyed: bool,
}

impl BaseMoment<'_> {
    /// Adds the replacements that put a thing where the gizmo put it: now, and before.
    pub(super) fn moved(
        &self,
        thing: usize,
        tool: Tool,
        [now, before]: [Transform; 2],
        parts: &mut Vec<TextSplices>,
    ) -> Result<(), GestureRefusal> {
        let planned = self.base.plan.things().get(thing);
        let planned = planned.ok_or_else(|| GestureRefusal("The thing is gone".to_owned()))?;
        if planned.path.is_some() {
            parts.push(self.path_moved(&planned.id, [now, before])?);
            return Ok(());
        }
        let is_moved = tool == Tool::Move || now.translation != before.translation;
        match self.base.plan.hold_of(thing, self.things) {
            Some(ThingHold::Attached { action, holder, is_arriving, .. })
                if is_moved || tool == Tool::Rotate =>
            {
                if is_arriving {
                    let text = format!(
                        "{} is on its way to what holds it: go to the end of its fade-in",
                        planned.id
                    );
                    return Err(GestureRefusal(text));
                }
                parts.push(self.held(action, &holder, &now, tool)?);
            }
            Some(ThingHold::Attached { .. }) => {}
            Some(ThingHold::Detached(_)) | None => self.put(thing, tool, [now, before], is_moved, parts)?,
        }
        if tool == Tool::Scale {
            parts.push(self.scaled(&planned.id, now.scale / before.scale)?);
        }
        Ok(())
    }

    /// Adds the replacements for a thing that nothing holds.
    fn put(
        &self,
        thing: usize,
        tool: Tool,
        [now, before]: [Transform; 2],
        is_moved: bool,
        parts: &mut Vec<TextSplices>,
    ) -> Result<(), GestureRefusal> {
        let planned = &self.base.plan.things()[thing];
        let position = is_moved.then_some(now.translation);
        let facing = match (tool, planned.kind) {
            (Tool::Rotate, "camera") => {
                if let Some(target) = tracked(self.base, &planned.id) {
                    let text = format!("{} looks at {target}: remove its `look` to turn it", planned.id);
                    return Err(GestureRefusal(text));
                }
                let ahead = now.rotation * before.rotation.inverse() * self.direction_of_camera(thing);
                let distance = distance_of_look(self.base, &planned.id, before.translation);
                parts.push(self.looking(&planned.id, now.translation + ahead * distance)?);
                None
            }
            (Tool::Rotate, "light") => {
                parts.push(self.shining(&planned.id, before.rotation.inverse() * now.rotation)?);
                None
            }
            (Tool::Rotate, "prop") => {
                let (facing, tilt) = facing_and_tilt(now.rotation.as_dquat());
                parts.extend(self.tilted(&planned.id, tilt)?);
                Some(facing)
            }
            (Tool::Rotate, _) => Some(facing(now.rotation)),
            (Tool::Move | Tool::Scale, _) => None,
        };
        let is_movable = element("place").is_some_and(|row| row.who.contains(&planned.kind));
        match (position, facing) {
            (None, None) => {}
            (position, facing) if self.is_keyed && is_movable => {
                let (scene, position) = (self.base.scene(), position.map(rounded));
                parts.push(key_place_splices(&scene, &planned.id, self.time, position, facing)?);
            }
            (Some(position), facing) => parts.push(self.placed(thing, position, facing)?),
            (None, Some(facing)) => {
                parts.push(face_splices(&self.base.scene(), &planned.id, self.time, facing)?);
            }
        }
        Ok(())
    }

    /// Returns the replacements after which the `attach` that is `action` holds its thing where the gizmo put it.
    fn held(
        &self,
        action: usize,
        holder: &RigidPlace,
        now: &Transform,
        tool: Tool,
    ) -> Result<TextSplices, GestureRefusal> {
        let place = RigidPlace {
            position: now.translation.as_dvec3(),
            rotation: now.rotation.as_dquat().normalize(),
        };
        let mut grip = HeldGrip::keeping(holder, &place);
        if tool == Tool::Move {
            let written = self.base.script.element(action).value("turn").and_then(vector);
            grip.turn = written.unwrap_or_default();
        }
        grip_splices(&self.base.scene(), action, &grip)
    }

    /// Returns the replacements that put a thing at `position`, with another direction where there is one, degrees. Refused where something holds it, and
    /// where it follows a path.
    pub(super) fn placed(
        &self,
        thing: usize,
        position: Vec3,
        facing: Option<f64>,
    ) -> Result<TextSplices, GestureRefusal> {
        let (script, plan) = (&self.base.script, &self.base.plan);
        let id = &plan.things()[thing].id;
        match plan.hold_of(thing, self.things) {
            Some(ThingHold::Attached { .. }) => {
                let text = format!("Something holds {id} at this time: detach it, or move what holds it");
                return Err(GestureRefusal(text));
            }
            Some(ThingHold::Detached(_)) => {
                let text = format!(
                    "{id} was detached before this time: go to the start to move it there, or switch Auto-key on to put it elsewhere from here on"
                );
                return Err(GestureRefusal(text));
            }
            None => {}
        }
        let follows = (1..script.actions().len()).find(|&action| {
            let element = script.element(action);
            element.row.name == "move"
                && element.value("who") == Some(id)
                && plan.schedule().times().get(action).is_some_and(|times| times.begin <= self.time)
        });
        if let Some(action) = follows.map(|action| script.element(action)) {
            let way = match (action.value("path"), action.value("to")) {
                (Some(path), _) => format!("the path {path}"),
                (None, to) => format!("its way to {}", to.unwrap_or_default()),
            };
            let target = if action.value("path").is_some() { "the path" } else { "where it goes" };
            let text = match plan.motion_in_progress(thing, self.time) {
                Some(_) => format!("{id} follows {way} at this time: move {target}"),
                None => format!(
                    "{id} is where {way} has led it: move {target}, or switch Auto-key on to put it elsewhere from here on"
                ),
            };
            return Err(GestureRefusal(text));
        }
        place_splices(&self.base.scene(), id, self.time, rounded(position), facing)
    }

    /// Returns the replacements that move, turn or scale all points of a path.
    fn path_moved(&self, id: &str, [now, before]: [Transform; 2]) -> Result<TextSplices, GestureRefusal> {
        let points = written_points(&self.base.script, id).unwrap_or_default();
        let turn = (now.rotation * before.rotation.inverse()).as_dquat().normalize();
        let scale = (now.scale / before.scale).as_dvec3();
        let [from, to] = [before, now].map(|place| place.translation.as_dvec3());
        let put = |point: DVec3| {
            let own = point - from;
            // Not turned, its numbers stay as they are on the axes along which nothing moves.
            if turn.xyz().length() < 1e-7 { own * scale + to } else { turn * (own * scale) + to }
        };
        let points: Vec<DVec3> = points.into_iter().map(put).collect();
        path_points_splices(&self.base.script, id, &points)
    }

    /// Returns the replacements with which a camera of the cast looks at a point.
    pub(super) fn looking(&self, id: &str, look: Vec3) -> Result<TextSplices, GestureRefusal> {
        let value = rounded(look).to_array().map(|number| number.to_string()).join(" ");
        self.set(id, "look", &value)
    }

    /// Returns the replacements with which a sun or a spot shines in another direction, turned in its own space.
    fn shining(&self, id: &str, turn: Quat) -> Result<TextSplices, GestureRefusal> {
        let element = self.element(id);
        if element.and_then(|own| own.value("kind")) == Some("point") {
            let text = format!("{id} shines in all directions: a point light is not turned");
            return Err(GestureRefusal(text));
        }
        let now = element.and_then(|own| own.value("direction")).and_then(vector);
        let now = now.filter(|now| *now != DVec3::ZERO).unwrap_or(DVec3::NEG_Y);
        let turned = (turn.as_dquat().normalize() * now * 1e4).round() / 1e4 + 0.0;
        self.set(id, "direction", &turned.to_array().map(|number| number.to_string()).join(" "))
    }

    /// Returns the replacements that pitch and roll a prop, degrees; `None` where it has these angles already.
    fn tilted(&self, id: &str, tilt: [f64; 2]) -> Result<Option<TextSplices>, GestureRefusal> {
        let written = self.element(id).and_then(|own| own.value("tilt")).unwrap_or_default();
        let mut numbers = written.split_ascii_whitespace().map(|number| number.parse::<f64>().unwrap_or(0.0));
        let before = [numbers.next().unwrap_or(0.0), numbers.next().unwrap_or(0.0)];
        if before.iter().zip(tilt).all(|(before, now)| (before - now).abs() < 0.015) {
            return Ok(None);
        }
        self.set(id, "tilt", &tilt.map(|angle| angle.to_string()).join(" ")).map(Some)
    }

    /// Returns the replacements that give a role or a prop another size.
    fn scaled(&self, id: &str, by: Vec3) -> Result<TextSplices, GestureRefusal> {
        let element = self.element(id);
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

    fn element(&self, id: &str) -> Option<&ScriptElement> {
        let script = &self.base.script;
        script.thing_element(id).map(|element| &script.tree().elements()[element])
    }

    fn set(&self, id: &str, attribute: &str, value: &str) -> Result<TextSplices, GestureRefusal> {
        let script = &self.base.script;
        if let Some(element) = script.thing_element(id) {
            in_scene_texts(script.tree(), element)?;
        }
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
fn rounded(position: Vec3) -> DVec3 {
    // Adding zero makes a zero of a negative one.
    (position.as_dvec3() * 1000.0).round() / 1000.0 + 0.0
}

/// Returns the thing or bone that a camera of the cast keeps in its view; `None` for one that looks at a point or straight ahead.
pub(super) fn tracked(base: &SceneBase, id: &str) -> Option<Box<str>> {
    let element = base.script.thing_element(id).map(|element| &base.script.tree().elements()[element])?;
    let look = element.attribute("look").map(|attribute| &*attribute.value)?;
    (!look.is_empty() && vector(look).is_none()).then(|| look.into())
}

/// Returns the distance from a camera to the point that it looks at, meters; 3 where the script names a thing instead of a point.
pub(super) fn distance_of_look(base: &SceneBase, id: &str, position: Vec3) -> f32 {
    let element = base.script.thing_element(id).map(|element| &base.script.tree().elements()[element]);
    let point = element.and_then(|element| element.value("look")).and_then(vector);
    point.map_or(3.0, |point| point.as_vec3().distance(position).max(0.1))
}
