//! Picking a bone by clicking the skin that it moves.

use crate::camera;
use dragonfly_anim::data::BoneIndex;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::hit::{HitPose, HitSettings, Ray};
use dragonfly_document::bones::HiddenBones;
use glam::Vec3;

/// Largest number of layers of skin to look through.
const LAYERS: usize = 16;
/// Offset of the next ray behind a hit, relative to its distance: enough to pass the triangle that was hit and its
/// neighbors at a shared edge.
const STEP: f32 = 1e-4;

/// A point on the skin and the bone with the largest influence there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkinHit {
    /// Index of the bone.
    pub bone: BoneIndex,
    /// Position, scene space.
    pub position: Vec3,
    /// Distance from the start of the line of sight, scene units.
    pub distance: f32,
}

/// Finds the bones of the skin under the pointer, nearest first and each once, up to sixteen layers deep. Ignores
/// hidden bones and surfaces that no bone moves.
///
/// `pose` is refitted to the pose of `evaluator`. Allocates as `out` grows.
pub fn pick_skin(
    pose: &mut HitPose,
    evaluator: &Evaluator,
    ray: &camera::CameraRay,
    hidden: &HiddenBones,
    out: &mut Vec<SkinHit>,
) {
    out.clear();
    let mut begin = 0.0;
    for _ in 0..LAYERS {
        let from = Ray { origin: ray.origin + ray.direction * begin, direction: ray.direction };
        let Some(hit) = pose.ray(evaluator, &from, &HitSettings::default()) else { return };
        let distance = begin + hit.distance;
        if let Some(bone) = hit.bone.filter(|&bone| !hidden.is_hidden(bone))
            && out.iter().all(|found| found.bone != bone)
        {
            out.push(SkinHit { bone, position: hit.position, distance });
        }
        let further = distance + distance.abs() * STEP;
        // At this distance f32 is too coarse to continue.
        if !(further > begin && further.is_finite()) {
            return;
        }
        begin = further;
    }
}
