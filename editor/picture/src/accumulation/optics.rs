//! Camera and lens of a sub-frame.

use crate::camera::Camera;
use dragonfly_anim::stage::StageCamera;
use glam::{Mat4, Vec2, Vec3, Vec4};

/// Nearest distance on which a lens can focus, meters.
const NEAREST_FOCUS: f32 = 1e-3;

/// A point of a thin lens: the camera is moved there, and its image is sheared so that what is in focus stays where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LensShift {
    /// Distance from the middle of the lens, meters, to the right and up.
    offset: Vec2,
    /// Distance of what is in focus, meters.
    focus: f32,
}

impl LensShift {
    /// Returns a point of the lens of `camera`, given within a circle of radius 1; `None` for a camera that has everything in focus. The
    /// diameter of the opening is the focal length divided by the f-number.
    pub(crate) fn new(camera: &StageCamera, point: Vec2) -> Option<Self> {
        let focus = camera.focus.filter(|focus| focus.is_finite())?.max(NEAREST_FOCUS);
        let radius = camera.lens * 0.001 / (2.0 * camera.aperture);
        (radius.is_finite() && radius > 0.0).then_some(Self { offset: point * radius, focus })
    }

    /// Matrix from the view space of the middle of the lens to that of this point.
    pub(crate) fn shear(&self) -> Mat4 {
        let Vec2 { x, y } = self.offset;
        Mat4::from_cols(
            Vec4::X,
            Vec4::Y,
            // At the distance of the focus, where z is negative, this cancels the translation.
            Vec4::new(-x / self.focus, -y / self.focus, 1.0, 0.0),
            Vec4::new(-x, -y, 0.0, 1.0),
        )
    }

    /// Offset of the point from the middle of the lens of `camera`, scene space.
    pub(crate) fn in_scene(&self, camera: &Camera) -> Vec3 {
        camera.right() * self.offset.x + camera.up() * self.offset.y
    }
}

/// Returns the matrix in clip space that moves an image of `size` pixels by `pixels`, to the right and down.
pub(crate) fn moved_image(pixels: Vec2, size: Vec2) -> Mat4 {
    let part = pixels / size.max(Vec2::ONE) * 2.0;
    Mat4::from_translation(Vec3::new(part.x, -part.y, 0.0))
}
