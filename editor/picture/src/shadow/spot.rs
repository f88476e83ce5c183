//! The map of a spot light: what it shines on, in perspective.

use super::frame::{SPOT_SIDE, ShadowMap};
use crate::cast::SceneLight;
use glam::{Mat4, Vec3, Vec4};

/// Half the width of a map at a distance of 1: somewhat more than the tangent of the angle at which spot lights are dark, `SPOT_OUTSIDE` in
/// `shaders/common/studio.wgsl`.
const HALF: f32 = 0.6;

/// Distance of the near plane, meters: what is nearer is part of the lamp.
const NEAR: f32 = 0.05;

/// Returns the map of a spot light. Its far plane is at infinity.
pub(super) fn map(light: &SceneLight) -> ShadowMap {
    let (right, up) = light.direction.any_orthonormal_pair();
    let row = |axis: Vec3| axis.extend(-axis.dot(light.position));
    let rows = Mat4::from_cols(
        row(right) / HALF,
        row(up) / HALF,
        // Reversed: the depth is 1 at the near plane, and 0 at infinity.
        Vec4::W * NEAR,
        row(light.direction),
    );
    ShadowMap { clip_from_world: rows.transpose(), texel: 2.0 * HALF / SPOT_SIDE as f32 }
}
