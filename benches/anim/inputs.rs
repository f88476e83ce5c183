//! What everyone who does a work is given alike: poses, masks, a limb, influences.

use crate::model::Subject;
use dragonfly_anim::animation::{final_poses, to_root};
use dragonfly_anim::data::{Primitive, Transform};
use dragonfly_anim::sample::sample_take;
use glam::{Mat4, Vec3};

/// The pose of take `take`, counted round, a part `part` of its length in.
pub(crate) fn posed(subject: &Subject, take: usize, part: f32) -> Vec<Transform> {
    let animation = &subject.model.animation;
    let take = &animation.takes[take % animation.takes.len()];
    let mut poses = vec![Transform::IDENTITY; subject.bones()];
    sample_take(Some(take), &animation.skeleton, take.start + take.length * part, &mut poses);
    poses
}

/// The to-root matrices of some pose.
pub(crate) fn roots(subject: &Subject) -> Vec<Mat4> {
    let mut roots = vec![Mat4::IDENTITY; subject.bones()];
    to_root(&subject.model.animation.skeleton, &posed(subject, 0, 0.4), &mut roots);
    roots
}

/// The final matrices of the same pose.
pub(crate) fn finals(subject: &Subject) -> Vec<Mat4> {
    let mut finals = vec![Mat4::IDENTITY; subject.skin().bones.len()];
    final_poses(subject.skin(), &roots(subject), &mut finals);
    finals
}

/// What is blended: how many layers, and whether with masks.
pub(crate) const BLENDS: [(usize, bool); 4] = [(2, false), (4, false), (2, true), (4, true)];

/// The weights of the layers.
pub(crate) const WEIGHTS: [f32; 4] = [0.4, 0.3, 0.2, 0.1];

/// As a part of a name.
pub(crate) fn how(is_masked: bool) -> &'static str {
    if is_masked { "masked" } else { "whole" }
}

/// How much each bone takes part in masked layers: not at all, wholly, and between.
pub(crate) fn mask_weights(subject: &Subject) -> impl Iterator<Item = f32> {
    (0..subject.bones()).map(|bone| (bone % 4) as f32 / 3.0)
}

/// How much of a difference is added.
pub(crate) const ADDED: [(&str, f32); 2] = [("whole", 1.0), ("part", 0.6)];

/// Three bones in a row that reach for a point, with the direction that the middle one bends to.
pub(crate) struct Limb {
    pub(crate) root: u32,
    pub(crate) middle: u32,
    pub(crate) end: u32,
    pub(crate) target: Vec3,
    pub(crate) pole: Vec3,
}

/// The deepest bone, its parent and its grandparent, where they lie apart in [`roots`]; they reach for a point nearer to
/// the shoulder.
pub(crate) fn limb(subject: &Subject) -> Limb {
    let roots = roots(subject);
    let bones = &subject.model.animation.skeleton.bones;
    let place = |bone: u32| roots[bone as usize].w_axis.truncate();
    let limb = |end: u32| {
        let middle = bones[end as usize].parent?;
        let root = bones[middle as usize].parent?;
        let apart = |a: u32, b: u32| place(a).distance(place(b)) > 1e-3;
        (apart(root, middle) && apart(middle, end)).then_some([root, middle, end])
    };
    let limb = (0..bones.len() as u32).rev().find_map(limb);
    let [root, middle, end] = limb.expect("a limb of three bones");
    Limb { root, middle, end, target: place(end).lerp(place(root), 0.3), pole: Vec3::new(0.2, 1.0, 0.3) }
}

/// How many influences each vertex has.
pub(crate) const INFLUENCES: [usize; 3] = [1, 2, 4];

/// The mesh with the strongest `most` influences of each vertex, each of the same weight.
pub(crate) fn primitive(subject: &Subject, most: usize) -> Primitive {
    let mut primitive = subject.primitive().clone();
    let each = primitive.vertices.influences_per_vertex.max(1);
    for vertex in primitive.vertices.influences.chunks_mut(each) {
        for (at, influence) in vertex.iter_mut().enumerate() {
            // No zero among the first: all of them are to be computed.
            influence.weight = if at < most { 1.0 / most as f32 } else { 0.0 };
        }
    }
    primitive
}
