//! Drawing the motion path: a line from frame to frame, a dot at each frame and a larger one at each key.

use super::component::{ControlFrame, GraphicComponent};
use crate::appearance::Appearance;
use crate::gizmo::{GizmoRole, GizmoShape, GizmoView};
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// Half the size of a dot at a frame and at a key, points.
const FRAME: f32 = 1.8;
const KEY: f32 = 4.5;

/// A motion path: times in seconds, and the positions of the joint, scene space.
#[derive(Clone, Debug, PartialEq)]
pub struct PathLook {
    /// Position at each frame.
    pub points: Vec<(f32, Vec3)>,
    /// Position at each key.
    pub keys: Vec<(f32, Vec3)>,
}

/// The motion path of the selected bone.
#[derive(Clone, Debug, Default)]
pub struct PathAppearance {
    /// The path; `None` hides it.
    pub path: Option<Arc<PathLook>>,
    /// Time of the key under the pointer.
    pub hovered: Option<f32>,
}

/// Paths are compared by identity, which costs the same for any length.
impl PartialEq for PathAppearance {
    fn eq(&self, other: &Self) -> bool {
        let pointers = [&self.path, &other.path].map(|path| path.as_ref().map(Arc::as_ptr));
        pointers[0] == pointers[1] && self.hovered == other.hovered
    }
}

impl Appearance for PathAppearance {}

/// Draws the motion path.
#[derive(Default)]
pub(super) struct PathGraphic;

impl GraphicComponent for PathGraphic {
    fn present(&mut self, frame: &ControlFrame<'_>, shape: &mut GizmoShape) {
        let Some(PathAppearance { path: Some(path), hovered }) = frame.appearances.get() else { return };
        let [_, _, width, height] = frame.look.viewport;
        let pixels = Vec2::new(width as f32, height as f32);
        let view = GizmoView::of_pixels(frame.camera, pixels, frame.look.pixels_per_point);
        let now = frame.model.at().1;
        let role = |time: f32| if time < now { GizmoRole::Past } else { GizmoRole::Future };
        for pair in path.points.windows(2) {
            shape.add_line(pair[0].1, pair[1].1, role(pair[1].0), 0.55);
        }
        let (right, up) = (frame.camera.right(), frame.camera.up());
        let mut dot = |time: f32, at: Vec3, radius: f32, opacity: f32| {
            let Some(unit) = view.units_per_point(at.as_dvec3()) else { return };
            let reach = radius * unit as f32;
            let role = if *hovered == Some(time) { GizmoRole::Hover } else { role(time) };
            shape.add_diamond(at, right * reach, up * reach, role, opacity);
        };
        path.points.iter().for_each(|&(time, at)| dot(time, at, FRAME, 0.8));
        path.keys.iter().for_each(|&(time, at)| dot(time, at, KEY, 1.0));
    }
}
