//! The contact shadow: a soft dark spot on the ground below every part of the model that is near it.
//!
//! A part is what one matrix moves most: the vertices of a bone, or a whole rigid mesh. Its box is found once; in a frame only
//! the boxes are moved, so a spot costs the same however many vertices there are.

use super::uniform::Affine;
use dragonfly_anim::bounds::AxisBox;
use dragonfly_anim::data::Primitive;
use glam::{Vec3, Vec4};

/// Height above the ground at which a part leaves no shadow, in radii of the model.
const REACH: f32 = 0.16;
/// Largest strength of a spot, 0..1.
const STRONGEST: f32 = 0.75;

/// Adds the vertices of a primitive to the boxes of the matrices that move them most; `first` is its first matrix, and
/// without influences it is the only one.
pub(super) fn add_boxes(boxes: &mut [AxisBox], primitive: &Primitive, first: usize, influences: usize) {
    let positions = &primitive.vertices.positions;
    if influences == 0 {
        if let Some(part) = boxes.get_mut(first) {
            positions.iter().for_each(|&point| part.add(point));
        }
        return;
    }
    for (&point, influences) in positions.iter().zip(primitive.vertices.influences.chunks(influences)) {
        let most = influences.iter().max_by(|a, b| a.weight.total_cmp(&b.weight));
        let joint = most.map_or(0, |influence| usize::from(influence.joint));
        if let Some(part) = boxes.get_mut(first + joint) {
            part.add(point);
        }
    }
}

/// The size that decides how far up parts leave a shadow, and the height of the ground.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShadowedGround {
    /// Radius of the model.
    pub(super) radius: f32,
    /// Height of the ground, scene space.
    pub(super) height: f32,
}

/// Adds the spots on the ground below a model, with the boxes of its parts and their matrices, to `spots`: center x and z, radius,
/// strength. The strongest replace those that are weaker. Allocates nothing.
pub(super) fn add_spots(spots: &mut [Vec4], boxes: &[AxisBox], matrices: &[Affine], ground: ShadowedGround) {
    let reach = (REACH * ground.radius).max(1e-6);
    for (part, matrix) in boxes.iter().zip(matrices) {
        let Some(spot) = spot(part, matrix, reach, ground.height) else { continue };
        let weakest = spots.iter_mut().min_by(|a, b| a.w.total_cmp(&b.w));
        if let Some(weakest) = weakest.filter(|weakest| weakest.w < spot.w) {
            *weakest = spot;
        }
    }
}

/// Returns the spot below a part; `None` if it is too high, below the ground, or empty.
fn spot(part: &AxisBox, matrix: &Affine, reach: f32, ground: f32) -> Option<Vec4> {
    let (center, half) = (part.center(), (part.max - part.min) * 0.5);
    let moved = |row: Vec4| (row.dot(center.extend(1.0)), row.truncate().abs().dot(half));
    let [x, mut y, z] = [matrix.x, matrix.y, matrix.z].map(moved);
    y.0 -= ground;
    let size = Vec3::new(x.1, y.1, z.1);
    if !size.is_finite() || size.cmplt(Vec3::ZERO).any() || y.0 + y.1 < 0.0 {
        return None;
    }
    let near = 1.0 - ((y.0 - y.1).max(0.0) / reach).min(1.0);
    let spread = (x.1 * z.1).sqrt().max(0.5 * x.1.max(z.1)) + 0.5 * reach;
    (near > 0.0).then(|| Vec4::new(x.0, z.0, spread * (2.0 - 0.4 * near), STRONGEST * near * near))
}
