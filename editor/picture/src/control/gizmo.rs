//! Draws the gizmo at the selected bones in the pose of the frame, so that it moves with them without delay. During a
//! drag it draws the shape computed by the tool, which depends on the start of the drag.

use super::component::{ControlFrame, GraphicComponent};
use crate::appearance::Appearance;
use crate::gizmo::{GizmoPlacement, GizmoSettings, GizmoShape, GizmoView, Handle, PosedSkeleton, Tool};
use glam::Vec2;

/// A gizmo that is not being dragged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GizmoLook {
    /// Transformation that it makes.
    pub tool: Tool,
    /// Its axes, pivot and snapping.
    pub settings: GizmoSettings,
    /// The handle under the pointer.
    pub hovered: Option<Handle>,
}

/// The gizmo at the selected bones; `None` hides it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GizmoAppearance(pub Option<GizmoLook>);

/// The shape of the gizmo while it is dragged; `None` when it is not.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GizmoDragAppearance(pub Option<GizmoShape>);

impl Appearance for GizmoAppearance {}

impl Appearance for GizmoDragAppearance {}

/// Draws the gizmo.
#[derive(Default)]
pub(super) struct GizmoGraphic {
    placement: GizmoPlacement,
}

impl GraphicComponent for GizmoGraphic {
    fn present(&mut self, frame: &ControlFrame<'_>, shape: &mut GizmoShape) {
        if let Some(GizmoDragAppearance(Some(drag))) = frame.appearances.get() {
            shape.extend(drag);
            return;
        }
        let Some(&GizmoAppearance(Some(gizmo))) = frame.appearances.get() else { return };
        let GizmoLook { tool, settings, hovered } = gizmo;
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
