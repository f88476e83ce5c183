//! Drawing lines: those of a project, the one that is being drawn, and the paths of a scene with arrows, seconds, footprints, and points to drag.

use super::component::{ControlFrame, GraphicComponent};
use crate::appearance::Appearance;
use crate::cast::PosedScene;
use crate::gizmo::{GizmoRole, GizmoShape, GizmoView, LineInk};
use dragonfly_anim::stage::line::DrawnLine;
use dragonfly_anim::stage::time::StageTime;
use glam::{Mat4, Vec2, Vec3};
use std::sync::Arc;

/// Length of the strokes of an arrow along its path and to its side, meters.
const ARROW: f32 = 0.12;
/// Half the length of a tick across its path, meters.
const TICK: f32 = 0.16;
/// Half the size of a footprint, meters.
const PRINT: f32 = 0.05;
/// Half the size of a point that can be dragged, and of one that gives a curve its direction, points of the screen.
const POINT: f32 = 5.0;
const ARM: f32 = 3.5;

/// A line as it is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct LineLook {
    /// Points along it, meters; of a line that moves with a thing, relative to that.
    pub points: Arc<[Vec3]>,
    /// Color, sRGB from 0 to 255, and width in points.
    pub ink: LineInk,
    /// Opacity, 0 to 1.
    pub opacity: f32,
    /// The times from and to which it is shown, seconds.
    pub shown: [Option<f64>; 2],
    /// The thing, or the thing and bone, that it moves with, such as `anna.Head`.
    pub of: Option<Box<str>>,
    /// Places and directions of arrows on it.
    pub arrows: Arc<[[Vec3; 2]]>,
    /// Places and directions at each second of the one that follows it.
    pub ticks: Arc<[[Vec3; 2]]>,
    /// Places where a foot lands.
    pub dots: Arc<[Vec3]>,
}

/// A point of a line that can be dragged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineHandle {
    /// Its position, scene space.
    pub place: Vec3,
    /// For a point that gives a curve its direction: the point of the line that it belongs to.
    pub arm: Option<Vec3>,
    /// Whether it is under the pointer or dragged.
    pub is_marked: bool,
}

impl LineLook {
    /// Returns the look of a line of a project; its width grows by `wider` points.
    pub fn of_line(line: &DrawnLine, wider: f32) -> Self {
        Self {
            points: line.samples().points().iter().map(|point| point.as_vec3()).collect(),
            ink: LineInk::new(line.color, line.width + wider),
            opacity: 1.0,
            shown: line.shown.map(|time| time.map(StageTime::seconds)),
            of: line.of.clone().filter(|of| !of.is_empty()),
            arrows: Arc::default(),
            ticks: Arc::default(),
            dots: Arc::default(),
        }
    }
}

/// The lines to draw. Images and movies without a window show those that are set for them.
#[derive(Clone, Debug, Default)]
pub struct LineAppearance {
    /// The lines.
    pub lines: Arc<[LineLook]>,
    /// Points of the line that is being drawn, scene space.
    pub draft: Vec<Vec3>,
    /// Color and width of the line that is being drawn.
    pub draft_ink: LineInk,
    /// The points that can be dragged.
    pub handles: Vec<LineHandle>,
}

/// Lists are compared by identity, which costs the same for any length.
impl PartialEq for LineAppearance {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.lines.as_ptr(), other.lines.as_ptr())
            && self.lines.len() == other.lines.len()
            && (self.draft_ink, &self.draft, &self.handles) == (other.draft_ink, &other.draft, &other.handles)
    }
}

impl Appearance for LineAppearance {}

/// Draws the lines.
#[derive(Default)]
pub(super) struct LinesGraphic;

impl GraphicComponent for LinesGraphic {
    fn present(&mut self, frame: &ControlFrame<'_>, shape: &mut GizmoShape) {
        let Some(look) = frame.appearances.get::<LineAppearance>() else { return };
        for pair in look.draft.windows(2) {
            shape.add_inked_line(pair[0], pair[1], look.draft_ink, 1.0);
        }
        let Some(cast) = frame.cast else { return };
        let now = cast.state().time.seconds();
        for line in look.lines.iter().filter(|line| is_shown(line, now)) {
            let place = match line.of.as_deref().map(|of| place_of(cast, of)) {
                None => Mat4::IDENTITY,
                Some(Some(place)) => place,
                // The thing is not there.
                Some(None) => continue,
            };
            draw(line, place, shape);
        }
        draw_handles(frame, &look.handles, shape);
    }
}

/// Draws the points that can be dragged, of the same size at any distance.
fn draw_handles(frame: &ControlFrame<'_>, handles: &[LineHandle], shape: &mut GizmoShape) {
    let [_, _, width, height] = frame.look.viewport;
    let pixels = Vec2::new(width as f32, height as f32);
    let view = GizmoView::of_pixels(frame.camera, pixels, frame.look.pixels_per_point);
    let (right, up) = (frame.camera.right(), frame.camera.up());
    for handle in handles {
        let Some(unit) = view.units_per_point(handle.place.as_dvec3()) else { continue };
        let role = if handle.is_marked { GizmoRole::Hover } else { GizmoRole::Selected };
        if let Some(arm) = handle.arm {
            shape.add_line(arm, handle.place, role, 0.6);
        }
        let reach = if handle.arm.is_some() { ARM } else { POINT } * unit as f32;
        shape.add_diamond(handle.place, right * reach, up * reach, role, 1.0);
    }
}

fn is_shown(line: &LineLook, now: f64) -> bool {
    line.shown[0].is_none_or(|from| now >= from) && line.shown[1].is_none_or(|to| now < to)
}

/// Returns the place of a thing, or of a bone of it, without its scale, so that lengths stay meters.
fn place_of(cast: &PosedScene, of: &str) -> Option<Mat4> {
    let place = cast.plan().place_of_name(of, cast.state())?;
    Some(Mat4::from_rotation_translation(place.rotation.as_quat(), place.position.as_vec3()))
}

fn draw(line: &LineLook, place: Mat4, shape: &mut GizmoShape) {
    let mut add = |from: Vec3, to: Vec3| {
        let [from, to] = [from, to].map(|point| place.transform_point3(point));
        shape.add_inked_line(from, to, line.ink, line.opacity);
    };
    line.points.windows(2).for_each(|pair| add(pair[0], pair[1]));
    for &[at, along] in line.arrows.iter() {
        let side = along.cross(Vec3::Y).normalize_or(Vec3::X);
        add(at, at + (side - along) * ARROW);
        add(at, at - (side + along) * ARROW);
    }
    for &[at, along] in line.ticks.iter() {
        let side = along.cross(Vec3::Y).normalize_or(Vec3::X) * TICK;
        add(at - side, at + side);
    }
    for &at in line.dots.iter() {
        let [x, z] = [Vec3::X, Vec3::Z].map(|axis| axis * PRINT);
        let corners = [at + x, at + z, at - x, at - z];
        (0..4).for_each(|corner| add(corners[corner], corners[(corner + 1) % 4]));
    }
}
