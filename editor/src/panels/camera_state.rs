//! The camera and the rectangle of the viewport.

use dragonfly_picture::ThroughCamera;
use dragonfly_picture::camera::Camera;
use egui::Rect;
use glam::Vec3;

/// The camera and the viewport that it looks into.
#[derive(Debug)]
pub(super) struct CameraState {
    /// The free camera, which the user moves.
    camera: Camera,
    /// The camera of a scene through which the viewport looks.
    through: ThroughCamera,
    /// The view of that camera at the time shown; `None` for the free one.
    seen: Option<Camera>,
    /// Whether moving the view moves the camera of the scene.
    is_attached: bool,
    /// The view that the user gave an attached camera since the last call of [`Self::take_moved`].
    moved: Option<Camera>,
    /// The viewport, points.
    viewport: Rect,
    /// The rectangle of the other one of two views of a scene, points; `None` while there is one view. Viewport and cameras are those of the active view.
    second: Option<Rect>,
    /// The view that is not active; `None` while it was never shown.
    other: Option<OtherView>,
    /// Whether the active one of two views is the second one.
    is_second_active: bool,
    /// Toolbars and cards over the viewport, points.
    shields: Vec<Rect>,
}

/// The view of a scene that is not active.
#[derive(Clone, Debug)]
pub(super) struct OtherView {
    camera: Camera,
    through: ThroughCamera,
    is_attached: bool,
}

impl Default for CameraState {
    fn default() -> Self {
        Self {
            camera: Camera::default(),
            through: ThroughCamera::Free,
            seen: None,
            is_attached: false,
            moved: None,
            viewport: Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(800.0, 600.0)),
            second: None,
            other: None,
            is_second_active: false,
            shields: Vec::new(),
        }
    }
}

impl CameraState {
    /// Returns the camera of the viewport: the free one, or the one of a scene.
    pub(super) fn camera(&self) -> &Camera {
        self.seen.as_ref().unwrap_or(&self.camera)
    }

    /// Returns the free camera, whatever the viewport looks through.
    pub(super) fn free(&self) -> &Camera {
        &self.camera
    }

    /// Sets the free camera, whatever the viewport looks through.
    pub(super) fn set_free(&mut self, camera: Camera) {
        self.camera = camera;
    }

    /// Returns the free camera for a command that moves it. It continues where the camera of a scene was.
    pub(super) fn camera_mut(&mut self) -> &mut Camera {
        self.leave();
        &mut self.camera
    }

    /// Moves the camera. A camera of a scene is left, unless it is attached to the view.
    pub(super) fn set_camera(&mut self, camera: Camera) {
        if *self.camera() == camera {
            return;
        }
        if self.is_attached && self.seen.is_some() {
            (self.seen, self.moved) = (Some(camera), Some(camera));
            return;
        }
        let lens = self.seen.map(|seen| seen.field_of_view);
        self.leave();
        match lens {
            Some(lens) => self.camera = freed(Camera { field_of_view: lens, ..camera }),
            None => self.camera = camera,
        }
    }

    /// Returns the camera of a scene through which the viewport looks.
    pub(super) fn through(&self) -> &ThroughCamera {
        &self.through
    }

    /// Looks through a camera of a scene, or through the free one, which is where it was.
    pub(super) fn set_through(&mut self, through: ThroughCamera) {
        (self.through, self.seen, self.moved) = (through, None, None);
    }

    /// Returns whether moving the view moves the camera of the scene.
    pub(super) fn is_attached(&self) -> bool {
        self.is_attached
    }

    /// Sets whether moving the view moves the camera of the scene.
    pub(super) fn attach(&mut self, is_attached: bool) {
        self.is_attached = is_attached;
    }

    /// Sets what the camera of the scene sees now.
    pub(super) fn set_seen(&mut self, seen: Option<Camera>) {
        self.seen = seen;
    }

    /// Returns the view that the user gave an attached camera since the last call.
    pub(super) fn take_moved(&mut self) -> Option<Camera> {
        self.moved.take()
    }

    /// Leaves the camera of a scene: the free one continues where it is.
    fn leave(&mut self) {
        if let Some(seen) = self.seen.take() {
            self.camera = freed(seen);
        }
        (self.through, self.moved) = (ThroughCamera::Free, None);
    }

    /// Returns the rectangle of the viewport, points.
    pub(super) fn viewport(&self) -> Rect {
        self.viewport
    }

    /// Returns the rectangle of the other one of two views of a scene, points; `None` while there is one view.
    pub(super) fn second(&self) -> Option<Rect> {
        self.second
    }

    /// Sets the rectangle of the other view. A new one looks through the camera of the shot, and the first one is the active one where there is one view.
    pub(super) fn set_second(&mut self, second: Option<Rect>) {
        if second.is_none() {
            self.activate(false);
            self.other = None;
        } else if self.other.is_none() {
            let camera = *self.camera();
            self.other = Some(OtherView { camera, through: ThroughCamera::Shot, is_attached: false });
        }
        self.second = second;
    }

    /// Returns the view that is not active; `None` while it was never shown.
    pub(super) fn other(&self) -> Option<&OtherView> {
        self.other.as_ref()
    }

    /// Sets what the view looks at that is not active; `None` lets it look through the camera of the shot the next time it is shown.
    pub(super) fn set_other(&mut self, other: Option<OtherView>) {
        self.other = other;
    }

    /// Returns whether the active one of two views is the second one.
    pub(super) fn is_second_active(&self) -> bool {
        self.is_second_active
    }

    /// Makes the first or the second view the active one, with its camera. Returns whether it was the other one.
    pub(super) fn activate(&mut self, second: bool) -> bool {
        let Self { camera, through, is_attached, other: Some(other), viewport, second: place, .. } = self
        else {
            return false;
        };
        if self.is_second_active == second {
            return false;
        }
        self.is_second_active = second;
        std::mem::swap(camera, &mut other.camera);
        std::mem::swap(through, &mut other.through);
        std::mem::swap(is_attached, &mut other.is_attached);
        if let Some(rect) = place {
            std::mem::swap(viewport, rect);
        }
        (self.seen, self.moved) = (None, None);
        true
    }

    /// Returns the free camera of the view that is not active.
    pub(super) fn other_camera(&self) -> &Camera {
        self.other.as_ref().map_or(&self.camera, |other| &other.camera)
    }

    /// Returns the camera of a scene through which the view looks that is not active.
    pub(super) fn other_through(&self) -> &ThroughCamera {
        self.other.as_ref().map_or(&ThroughCamera::Shot, |other| &other.through)
    }

    /// Sets the camera of a scene through which the view looks that is not active.
    pub(super) fn set_other_through(&mut self, through: ThroughCamera) {
        if let Some(other) = &mut self.other {
            other.through = through;
        }
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

    /// Moves the camera so that a box fills the viewport. A camera of a scene is left.
    pub(super) fn frame(&mut self, min: Vec3, max: Vec3) {
        let aspect = self.aspect();
        self.camera_mut().frame_box(min, max, aspect);
    }

    /// Moves the free camera so that a box fills the viewport, whatever the viewport looks through.
    pub(super) fn frame_free(&mut self, min: Vec3, max: Vec3) {
        let aspect = self.aspect();
        self.camera.frame_box(min, max, aspect);
    }
}

/// Returns the free camera that shows what a camera of a scene sees: upright, with the usual lens, from a distance at which the target has
/// the same size.
fn freed(seen: Camera) -> Camera {
    let field_of_view = Camera::default().field_of_view;
    let ratio = (seen.field_of_view / 2.0).tan() / (field_of_view / 2.0).tan();
    let mut camera = Camera { roll: 0.0, field_of_view, ..seen };
    camera.dolly(ratio);
    camera
}
