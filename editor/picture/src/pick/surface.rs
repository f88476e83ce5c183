//! Choosing a bone by clicking the skin that it moves.

use crate::camera;
use dragonfly_anim::data::BoneIndex;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::hit::{HitPose, HitSettings, Ray};
use dragonfly_document::bones::HiddenBones;
use glam::Vec3;

/// Layers of skin that are looked through.
const LAYERS: usize = 16;
/// How far behind a hit the next look begins, relative to its distance: past the triangle that was hit, and its neighbours
/// at a shared edge.
const STEP: f32 = 1e-4;

/// A place of the skin and the bone with the largest influence there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkinHit {
    /// Which bone.
    pub bone: BoneIndex,
    /// Scene space.
    pub position: Vec3,
    /// Scene units from where the line of sight begins.
    pub distance: f32,
}

/// The bones under the pointer by the skin, the nearest first and each once, as far as sixteen layers go. Hidden bones and
/// what no bone moves are looked through.
///
/// `pose` is refitted to the pose of `evaluator`. Allocates as `out` grows.
pub fn pick_skin(
    pose: &mut HitPose,
    evaluator: &Evaluator,
    ray: &camera::Ray,
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
        // Where the numbers are too coarse to go on, there is nothing behind.
        if !(further > begin && further.is_finite()) {
            return;
        }
        begin = further;
    }
}
