//! Inputs that all variants of a task share: poses, masks, a limb, influences.

use crate::model::BenchModel;
use dragonfly_anim::animation::{final_poses, to_root};
use dragonfly_anim::data::{Primitive, Transform};
use dragonfly_anim::sample::sample_take;
use glam::{Mat4, Vec3};

/// Returns the pose of take `take`, modulo the number of takes, at the fraction `part` of its length.
pub(crate) fn posed(subject: &BenchModel, take: usize, part: f32) -> Vec<Transform> {
    let animation = &subject.model.animation;
    let take = &animation.takes[take % animation.takes.len()];
    let mut poses = vec![Transform::IDENTITY; subject.bones()];
    sample_take(Some(take), &animation.skeleton, take.start + take.length * part, &mut poses);
    poses
}

/// Returns the to-root matrices of one pose, which all tasks on matrices use.
pub(crate) fn roots(subject: &BenchModel) -> Vec<Mat4> {
    let mut roots = vec![Mat4::IDENTITY; subject.bones()];
    to_root(&subject.model.animation.skeleton, &posed(subject, 0, 0.4), &mut roots);
    roots
}

/// Returns the final matrices of the pose of [`roots`].
pub(crate) fn finals(subject: &BenchModel) -> Vec<Mat4> {
    let mut finals = vec![Mat4::IDENTITY; subject.skin().bones.len()];
    final_poses(subject.skin(), &roots(subject), &mut finals);
    finals
}

/// Cases of blending: the number of layers, and whether they have masks.
pub(crate) const BLENDS: [(usize, bool); 4] = [(2, false), (4, false), (2, true), (4, true)];

/// Weights of the layers.
pub(crate) const WEIGHTS: [f32; 4] = [0.4, 0.3, 0.2, 0.1];

/// Returns the part of a case's name for blends with masks, or for those without.
pub(crate) fn how(is_masked: bool) -> &'static str {
    if is_masked { "masked" } else { "whole" }
}

/// Returns the weight of each bone in the masks: 0, 1/3, 2/3, 1, repeating.
pub(crate) fn mask_weights(subject: &BenchModel) -> impl Iterator<Item = f32> {
    (0..subject.bones()).map(|bone| (bone % 4) as f32 / 3.0)
}

/// Weights with which a difference is added, and their names.
pub(crate) const ADDED: [(&str, f32); 2] = [("whole", 1.0), ("part", 0.6)];

/// Three bones in a row, the target of the last one, and the direction in which the middle one bends.
pub(crate) struct BenchLimb {
    pub(crate) root: u32,
    pub(crate) middle: u32,
    pub(crate) end: u32,
    pub(crate) target: Vec3,
    pub(crate) pole: Vec3,
}

/// Returns a limb that ends in the last bone whose distances to its parent and grandparent in
/// [`roots`] are not zero. The target is nearer to the grandparent, so that the limb bends.
pub(crate) fn limb(subject: &BenchModel) -> BenchLimb {
    let roots = roots(subject);
    let bones = &subject.model.animation.skeleton.bones;
    let position = |bone: u32| roots[bone as usize].w_axis.truncate();
    let limb = |end: u32| {
        let middle = bones[end as usize].parent?;
        let root = bones[middle as usize].parent?;
        let apart = |a: u32, b: u32| position(a).distance(position(b)) > 1e-3;
        (apart(root, middle) && apart(middle, end)).then_some([root, middle, end])
    };
    let limb = (0..bones.len() as u32).rev().find_map(limb);
    let [root, middle, end] = limb.expect("a limb of three bones");
    BenchLimb {
        root,
        middle,
        end,
        target: position(end).lerp(position(root), 0.3),
        pole: Vec3::new(0.2, 1.0, 0.3),
    }
}

/// Numbers of influences per vertex.
pub(crate) const INFLUENCES: [usize; 3] = [1, 2, 4];

/// Returns the mesh with the strongest `most` influences of each vertex, all with the same weight.
pub(crate) fn primitive(subject: &BenchModel, most: usize) -> Primitive {
    let mut primitive = subject.primitive().clone();
    let each = primitive.vertices.influences_per_vertex.max(1);
    for vertex in primitive.vertices.influences.chunks_mut(each) {
        for (at, influence) in vertex.iter_mut().enumerate() {
            // None of the first `most` weights is zero, because a variant may skip influences without
            // weight.
            influence.weight = if at < most { 1.0 / most as f32 } else { 0.0 };
        }
    }
    primitive
}
