//! The eye: an orbit around a target.

use glam::Vec3;

/// Perspective or parallel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Projection {
    /// Far things are smaller.
    #[default]
    Perspective,
    /// Parallel lines stay parallel.
    Orthographic,
}

/// Looks at `target` from `distance`; scene space, Y up, +Z towards the viewer at yaw 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Scene space.
    pub target: Vec3,
    /// Scene units, more than zero.
    pub distance: f32,
    /// Radians about Y; 0 looks along -Z (front view), positive moves the eye to the right.
    pub yaw: f32,
    /// Radians; positive looks from above.
    pub pitch: f32,
    /// Radians, the vertical field of view.
    pub field_of_view: f32,
    /// Perspective or parallel.
    pub projection: Projection,
}
