//! Drawing the things of a scene that have no surface: cameras, lights and marks; and boxes around selected things.

use super::component::{ControlFrame, GraphicComponent};
use crate::appearance::Appearance;
use crate::cast::{LightKind, PosedScene};
use crate::gizmo::{GizmoRole, GizmoShape};
use dragonfly_anim::bounds::AxisBox;
use dragonfly_anim::stage::{StageCamera, StagePath, StagePlan};
use glam::{Quat, Vec3};
use std::f32::consts::TAU;
use std::sync::Arc;

/// The things of a scene that are selected, and the one under the pointer, by their ids.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ThingAppearance {
    /// The selected things.
    pub selected: Arc<[Arc<str>]>,
    /// The thing under the pointer.
    pub hovered: Option<Arc<str>>,
}

impl Appearance for ThingAppearance {}

/// Length of the drawing of a camera or a light, meters.
const SIZE: f32 = 0.4;
/// Radius of a mark on the ground, meters.
const MARK: f32 = 0.25;
/// Number of sides of a circle.
const ROUND: usize = 16;
/// Half the size of the mark at the distance that is in focus, meters.
const FOCUS: f32 = 0.12;
/// Radius of the drawing of an effect, meters, and the number of drops below it.
const EFFECT: f32 = 0.18;
const DROPS: usize = 4;
/// Most pieces in which a path is drawn that is under the pointer.
const PIECES: usize = 200;
/// Half the size of the box around a thing of which nothing is drawn, meters.
const HALF: f32 = 0.25;

/// Draws the things of a scene.
#[derive(Default)]
pub(super) struct CastGraphic {
    /// The things of a plan that are selected, by their positions.
    selected: Option<SelectedThings>,
}

struct SelectedThings {
    plan: Arc<StagePlan>,
    ids: Arc<[Arc<str>]>,
    is_selected: Vec<bool>,
}

impl CastGraphic {
    /// Returns which things are selected. Allocates nothing while the plan and the selection stay the same.
    fn selected(&mut self, plan: &Arc<StagePlan>, ids: &Arc<[Arc<str>]>) -> &[bool] {
        let is_same = |known: &SelectedThings| Arc::ptr_eq(&known.plan, plan) && Arc::ptr_eq(&known.ids, ids);
        let known = self.selected.take().filter(is_same).unwrap_or_else(|| {
            let mut is_selected = vec![false; plan.things().len()];
            for thing in ids.iter().filter_map(|id| plan.thing_called(id)) {
                is_selected[thing] = true;
            }
            SelectedThings { plan: Arc::clone(plan), ids: Arc::clone(ids), is_selected }
        });
        &self.selected.insert(known).is_selected
    }
}

impl GraphicComponent for CastGraphic {
    fn present(&mut self, frame: &ControlFrame<'_>, shape: &mut GizmoShape) {
        let Some(cast) = frame.cast else { return };
        let marked = frame.appearances.get::<ThingAppearance>();
        let is_selected = marked.map_or(&[][..], |marked| self.selected(cast.plan(), &marked.selected));
        let role_of = |thing: usize, id: &str| {
            if is_selected.get(thing).copied().unwrap_or(false) {
                Some(GizmoRole::Selected)
            } else if marked?.hovered.as_deref() == Some(id) {
                Some(GizmoRole::Hover)
            } else {
                None
            }
        };
        for (thing, planned) in cast.plan().things().iter().enumerate() {
            let role = role_of(thing, &planned.id);
            // The shape of the camera through which the scene is seen would be all over the image.
            if let Some(own) = eye_at(cast, thing, frame.camera.eye()) {
                if frame.look.helpers && !cast.is_hidden(thing) {
                    add_focus(&own, role.unwrap_or(GizmoRole::View), shape);
                }
                continue;
            }
            if frame.look.helpers && !cast.is_hidden(thing) {
                draw(cast, thing, role.unwrap_or(GizmoRole::View), shape);
            }
            if let (Some(path), Some(GizmoRole::Hover)) = (&planned.path, role) {
                add_path(path, shape);
            }
            if let Some(role) = role.filter(|_| cast.has_place(thing)) {
                let around = cast.box_of(thing);
                let middle = cast.middle_of(thing);
                let around = if around.is_empty() { cube(middle) } else { around };
                add_box(&around, role, shape);
            }
        }
    }
}

/// Returns a camera of the scene if it is where the scene is seen from.
fn eye_at(cast: &PosedScene, thing: usize, eye: Vec3) -> Option<StageCamera> {
    let is_camera = cast.plan().things()[thing].kind == "camera";
    let camera = is_camera.then(|| cast.plan().camera_of(thing, cast.state())).flatten();
    camera.filter(|camera| camera.position.distance(eye) < SIZE * 0.1)
}

fn cube(middle: Vec3) -> AxisBox {
    AxisBox { min: middle - HALF, max: middle + HALF }
}

/// Draws a thing that has no surface.
fn draw(cast: &PosedScene, thing: usize, role: GizmoRole, shape: &mut GizmoShape) {
    let planned = &cast.plan().things()[thing];
    let place = &cast.state().things[thing].transform;
    match planned.kind {
        "camera" => {
            if let Some(camera) = cast.plan().camera_of(thing, cast.state()) {
                let is_seen = cast.state().camera.is_some_and(|seen| seen.thing == thing);
                let half = Vec3::new(18.0, 18.0 / cast.aspect(), -camera.lens) / camera.lens.max(1.0) * SIZE;
                add_camera(
                    camera.position,
                    camera.rotation,
                    half,
                    role,
                    if is_seen { 1.0 } else { 0.5 },
                    shape,
                );
                add_focus(&camera, role, shape);
            }
        }
        "effect" => {
            let weight = cast.state().things[thing].effect.map_or(0.0, |effect| effect.weight);
            add_effect(place.translation, role, 0.5 + 0.5 * weight, shape);
        }
        "light" => {
            if let Some(light) = cast.lights().iter().find(|light| light.thing == thing) {
                add_circle(light.position, light.direction.any_orthonormal_pair(), SIZE * 0.4, role, shape);
                if light.kind != LightKind::Point {
                    shape.add_line(light.position, light.position + light.direction * SIZE * 2.0, role, 1.0);
                }
            }
        }
        "mark" => {
            let ahead = place.rotation * Vec3::Z;
            add_circle(place.translation, (Vec3::X, Vec3::Z), MARK, role, shape);
            shape.add_line(place.translation, place.translation + ahead * MARK * 2.0, role, 1.0);
        }
        // Roles and props; paths are drawn with the lines.
        _ => {}
    }
}

fn add_camera(at: Vec3, rotation: Quat, half: Vec3, role: GizmoRole, opacity: f32, shape: &mut GizmoShape) {
    let corner = |x: f32, y: f32| at + rotation * (half * Vec3::new(x, y, 1.0));
    let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    for (index, &from) in corners.iter().enumerate() {
        shape.add_line(at, from, role, opacity);
        shape.add_line(from, corners[(index + 1) % corners.len()], role, opacity);
    }
    // A roof that shows which side is up.
    let [left, top, right] = [(-0.5, 1.0), (0.0, 1.6), (0.5, 1.0)].map(|(x, y)| corner(x, y));
    shape.add_line(left, top, role, opacity);
    shape.add_line(top, right, role, opacity);
}

/// Adds a frame with a cross at the distance that is in focus; nothing for a camera for which everything is.
fn add_focus(camera: &StageCamera, role: GizmoRole, shape: &mut GizmoShape) {
    let Some(distance) = camera.focus.filter(|distance| distance.is_finite()) else { return };
    let middle = camera.position + camera.rotation * Vec3::NEG_Z * distance;
    let [right, up] = [Vec3::X, Vec3::Y].map(|axis| camera.rotation * axis * FOCUS);
    let corners = [middle - right - up, middle + right - up, middle + right + up, middle - right + up];
    for (index, &from) in corners.iter().enumerate() {
        shape.add_line(from, corners[(index + 1) % corners.len()], role, 0.8);
    }
    shape.add_line(middle - right, middle + right, role, 0.8);
    shape.add_line(middle - up, middle + up, role, 0.8);
}

/// Adds a ring with drops below it.
fn add_effect(at: Vec3, role: GizmoRole, opacity: f32, shape: &mut GizmoShape) {
    for side in 0..ROUND {
        let point = |side: usize| {
            let (sin, cos) = (side as f32 / ROUND as f32 * TAU).sin_cos();
            at + Vec3::new(cos, 0.0, sin) * EFFECT
        };
        shape.add_line(point(side), point(side + 1), role, opacity);
    }
    for drop in 0..DROPS {
        let (sin, cos) = (drop as f32 / DROPS as f32 * TAU).sin_cos();
        let from = at + Vec3::new(cos, -0.6, sin) * EFFECT * 0.7;
        shape.add_line(from, from - Vec3::Y * EFFECT * 0.8, role, opacity);
    }
}

/// Adds a path that is under the pointer.
fn add_path(path: &StagePath, shape: &mut GizmoShape) {
    let pieces = ((path.length() / 0.1).ceil().max(1.0) as usize).min(PIECES);
    let at = |piece: usize| path.at(path.length() * piece as f64 / pieces as f64).position.as_vec3();
    for piece in 0..pieces {
        shape.add_line(at(piece), at(piece + 1), GizmoRole::Hover, 1.0);
    }
}

fn add_circle(at: Vec3, (right, up): (Vec3, Vec3), radius: f32, role: GizmoRole, shape: &mut GizmoShape) {
    let point = |side: usize| {
        let (sin, cos) = (side as f32 / ROUND as f32 * TAU).sin_cos();
        at + (right * cos + up * sin) * radius
    };
    for side in 0..ROUND {
        shape.add_line(point(side), point(side + 1), role, 1.0);
    }
}

/// Adds the twelve edges of a box.
fn add_box(around: &AxisBox, role: GizmoRole, shape: &mut GizmoShape) {
    let corner = |number: usize| {
        let pick = |bit: usize, low: f32, high: f32| if number >> bit & 1 == 0 { low } else { high };
        Vec3::new(
            pick(0, around.min.x, around.max.x),
            pick(1, around.min.y, around.max.y),
            pick(2, around.min.z, around.max.z),
        )
    };
    for number in 0..8 {
        for bit in (0..3).filter(|bit| number >> bit & 1 == 0) {
            shape.add_line(corner(number), corner(number | 1 << bit), role, 0.9);
        }
    }
}
