//! Draws the gizmo at the selected bones in the pose of the frame, so that it never lags behind them. During a drag it
//! draws the shape computed by the tool, which knows where the drag began.

use super::{Frame, GraphicComponent};
use crate::gizmo::{GizmoPlacement, GizmoShape, GizmoView, PosedSkeleton};
use crate::message::{Appearance, GizmoLook};
use glam::Vec2;

/// See the module.
#[derive(Default)]
pub(super) struct GizmoGraphic {
    look: Option<GizmoLook>,
    drag: Option<GizmoShape>,
    placement: GizmoPlacement,
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
        let skeleton = &model.loaded().model.animation.skeleton;
        let pose = PosedSkeleton { skeleton, poses: model.poses(), to_root: model.to_root() };
        self.placement.select(&settings, tool, &pose, &look.selected, None);
        let view = GizmoView::of_pixels(frame.camera, pixels, look.pixels_per_point);
        if let Some(layout) = self.placement.layout(settings.space, view) {
            shape.waiting(&layout, tool, hovered);
        }
    }
}
