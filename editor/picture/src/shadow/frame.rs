//! The input of the shadows of a frame, and a map of them.

use crate::camera::Camera;
use crate::cast::SceneLight;
use crate::effects::EffectLook;
use dragonfly_anim::bounds::Sphere;
use glam::{Mat4, Vec2};

/// Largest number of maps of a sun. WGSL twin: `CASCADES` in `shaders/common/shadowed.wgsl`.
pub const CASCADES: usize = 3;

/// Largest number of spot lights that cast shadows. WGSL twin: `SPOT_SHADOWS` in `shaders/common/shadowed.wgsl`.
pub const SPOT_SHADOWS: usize = 4;

/// Texels at the border of a map that a filter must not reach. WGSL twin: `BORDER` in `shaders/common/shadowed.wgsl`.
pub(super) const BORDER: f32 = 4.0;

/// Side of the map of a spot light, texels.
pub(super) const SPOT_SIDE: u32 = 1024;

/// A map of depth as a lamp sees the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShadowMap {
    /// Matrix scene space → clip space of the map.
    pub clip_from_world: Mat4,
    /// Size of a texel in scene units; of a spot light at a distance of 1.
    pub texel: f32,
}

/// The input of the shadows of a frame.
pub(crate) struct ShadowedFrame<'a> {
    pub(crate) effects: EffectLook,
    /// The camera through which the frame is seen, and its ratio of width to height.
    pub(crate) camera: &'a Camera,
    pub(crate) aspect: f32,
    /// A sphere around everything that is drawn.
    pub(crate) drawn: Sphere,
    /// A sphere around everything that casts shadows.
    pub(crate) casters: Sphere,
    /// The lights of the scene; without any that is not dark, those of the studio shine.
    pub(crate) lights: &'a [SceneLight],
    /// The point of each light that is no point, within a circle of radius 1 around its middle: that of a sub-frame, otherwise the middle.
    pub(crate) light_point: Vec2,
    /// Side of each map of a sun, texels.
    pub(crate) side: u32,
}
