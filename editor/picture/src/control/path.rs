//! The motion path as it is drawn: a line from frame to frame, a dot a frame, a larger one a key.

use super::{Frame, GraphicComponent};
use crate::gizmo::{GizmoRole, GizmoShape, GizmoView};
use crate::message::{Appearance, PathLook};
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// Half of a dot at a frame and at a key, points.
const FRAME: f32 = 1.8;
const KEY: f32 = 4.5;

/// See the module.
#[derive(Default)]
pub(super) struct PathGraphic {
    look: Option<Arc<PathLook>>,
    hovered: Option<f32>,
}

impl GraphicComponent for PathGraphic {
    fn receive(&mut self, appearance: &Appearance) -> bool {
        let Appearance::Path(look, hovered) = appearance else { return false };
        (self.look, self.hovered) = (look.clone(), *hovered);
        true
    }

    fn present(&mut self, frame: &Frame<'_>, shape: &mut GizmoShape) {
        let Some(path) = &self.look else { return };
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
            let role = if self.hovered == Some(time) { GizmoRole::Hover } else { role(time) };
            shape.add_diamond(at, right * reach, up * reach, role, opacity);
        };
        path.points.iter().for_each(|&(time, at)| dot(time, at, FRAME, 0.8));
        path.keys.iter().for_each(|&(time, at)| dot(time, at, KEY, 1.0));
    }
}
