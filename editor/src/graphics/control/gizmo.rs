//! The gizmo as it is drawn: at the selected bones in the pose of the frame, so that it never lags behind them; while it is
//! dragged as the hand says, which knows where the drag began.

use super::{Frame, GraphicComponent};
use crate::control::gizmo::{Gizmo, GizmoShape, GizmoView};
use crate::graphics::message::{Appearance, GizmoLook};
use glam::Vec2;

/// See the module.
#[derive(Default)]
pub(super) struct GizmoGraphic {
    look: Option<GizmoLook>,
    drag: Option<GizmoShape>,
    gizmo: Gizmo,
}

impl GraphicComponent for GizmoGraphic {
    fn receive(&mut self, appearance: &Appearance) -> bool {
        match appearance {
            Appearance::Gizmo(look) => self.look = *look,
            Appearance::Drag(drag) => self.drag.clone_from(drag),
            _ => return false,
        }
        true
    }

    fn present(&mut self, frame: &Frame<'_>, shape: &mut GizmoShape) {
        if let Some(drag) = &self.drag {
            shape.extend(drag);
            return;
        }
        let Some(GizmoLook { tool, settings, hovered }) = self.look else { return };
        let (model, look) = (frame.model, frame.look);
        let [_, _, width, height] = look.viewport;
        let pixels = Vec2::new(width as f32, height as f32);
        (self.gizmo.tool, self.gizmo.settings) = (tool, settings);
        let skeleton = &model.loaded().model.animation.skeleton;
        self.gizmo.select(skeleton, model.poses(), model.to_root(), &look.selected, None);
        self.gizmo.look(GizmoView::of_pixels(frame.camera, pixels, look.pixels_per_point));
        self.gizmo.highlight(hovered);
        self.gizmo.present_into(shape);
    }
}
