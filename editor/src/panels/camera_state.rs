//! The camera and the rectangle of the viewport.

use dragonfly_picture::camera::Camera;
use egui::Rect;
use glam::Vec3;

/// The camera and the viewport that it looks into.
#[derive(Debug)]
pub(super) struct CameraState {
    camera: Camera,
    /// The viewport, points.
    viewport: Rect,
    /// Toolbars and cards over the viewport, points.
    shields: Vec<Rect>,
}

impl Default for CameraState {
    fn default() -> Self {
        Self {
            camera: Camera::default(),
            viewport: Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(800.0, 600.0)),
            shields: Vec::new(),
        }
    }
}

impl CameraState {
    /// Returns the camera.
    pub(super) fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Returns the camera for a command that moves it.
    pub(super) fn camera_mut(&mut self) -> &mut Camera {
        &mut self.camera
    }

    /// Replaces the camera.
    pub(super) fn set_camera(&mut self, camera: Camera) {
        self.camera = camera;
    }

    /// Returns the rectangle of the viewport, points.
    pub(super) fn viewport(&self) -> Rect {
        self.viewport
    }

    /// Returns the rectangles over the viewport, points.
    pub(super) fn shields(&self) -> &[Rect] {
        &self.shields
    }

    /// Sets the rectangle of the viewport. Returns whether it changed.
    pub(super) fn set_viewport(&mut self, viewport: Rect) -> bool {
        std::mem::replace(&mut self.viewport, viewport) != viewport
    }

    /// Sets the rectangles over the viewport. Returns whether they changed.
    pub(super) fn set_shields(&mut self, shields: Vec<Rect>) -> bool {
        let changed = self.shields != shields;
        self.shields = shields;
        changed
    }

    /// Returns width over height of the viewport.
    pub(super) fn aspect(&self) -> f32 {
        (self.viewport.width() / self.viewport.height().max(1.0)).max(0.01)
    }

    /// Moves the camera so that a box fills the viewport.
    pub(super) fn frame(&mut self, min: Vec3, max: Vec3) {
        let aspect = self.aspect();
        self.camera.frame_box(min, max, aspect);
    }
}
