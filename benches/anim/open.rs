//! The open path, one bone at a time.

use crate::case::Case;
use crate::model::Subject;
use dragonfly_anim::animation::{final_poses, to_root};
use dragonfly_anim::data::Transform;
use dragonfly_anim::sample::{loop_time, sample_take};
use dragonfly_anim::skin::{Movement, skin_normals, skin_positions};
use glam::{Mat4, Vec3};
use std::hint::black_box;
use std::sync::Arc;

/// Frames of a second of play at 60 Hz, and somewhat more.
pub(crate) const FRAMES: usize = 80;

pub(crate) fn cases(subject: &Subject) -> Vec<Case> {
    let mut cases = Vec::new();
    let name = subject.name;
    let bones = subject.bones();
    for (index, take) in subject.short_and_long() {
        for (way, times) in crate::fast::ways(take) {
            let (model, mut poses) = (Arc::clone(&subject.model), vec![Transform::IDENTITY; bones]);
            cases.push(Case::new(
                format!("open/sample/{name}/{}/{way}", take.name),
                bones * times.len(),
                "bone",
                move || {
                    let take = &model.animation.takes[index];
                    for &time in &times {
                        sample_take(Some(take), &model.animation.skeleton, time, &mut poses);
                        black_box(&poses);
                    }
                },
            ));
        }
    }
    let (model, poses) = (Arc::clone(&subject.model), posed(subject));
    let mut roots = vec![Mat4::IDENTITY; bones];
    cases.push(Case::new(format!("open/to_root/{name}"), bones, "bone", move || {
        to_root(&model.animation.skeleton, &poses, &mut roots);
        black_box(&roots);
    }));
    let (model, roots) = (Arc::clone(&subject.model), roots_of(subject));
    let mut finals = vec![Mat4::IDENTITY; subject.skin().bones.len()];
    cases.push(Case::new(format!("open/final/{name}"), finals.len(), "joint", move || {
        final_poses(&model.skins[0], &roots, &mut finals);
        black_box(&finals);
    }));
    cases.push(pipeline(subject));
    cases.push(skinning(subject));
    cases
}

fn posed(subject: &Subject) -> Vec<Transform> {
    let (_, take) = subject.short_and_long()[0];
    let mut poses = vec![Transform::IDENTITY; subject.bones()];
    sample_take(Some(take), &subject.model.animation.skeleton, take.start + take.length * 0.4, &mut poses);
    poses
}

fn roots_of(subject: &Subject) -> Vec<Mat4> {
    let mut roots = vec![Mat4::IDENTITY; subject.bones()];
    to_root(&subject.model.animation.skeleton, &posed(subject), &mut roots);
    roots
}

fn pipeline(subject: &Subject) -> Case {
    let model = Arc::clone(&subject.model);
    let mut poses = vec![Transform::IDENTITY; subject.bones()];
    let mut roots = vec![Mat4::IDENTITY; subject.bones()];
    let mut finals = vec![Mat4::IDENTITY; subject.skin().bones.len()];
    Case::new(format!("open/pipeline/{}/1", subject.name), FRAMES, "character", move || {
        let take = &model.animation.takes[0];
        for frame in 0..FRAMES {
            let time = loop_time(take.start + frame as f32 / 60.0, take.start, take.length);
            sample_take(Some(take), &model.animation.skeleton, time, &mut poses);
            to_root(&model.animation.skeleton, &poses, &mut roots);
            final_poses(&model.skins[0], &roots, &mut finals);
            black_box(&finals);
        }
    })
}

fn skinning(subject: &Subject) -> Case {
    let model = Arc::clone(&subject.model);
    let mut finals = vec![Mat4::IDENTITY; subject.skin().bones.len()];
    final_poses(subject.skin(), &roots_of(subject), &mut finals);
    let count = subject.primitive().vertices.len();
    let (mut positions, mut normals) = (vec![Vec3::ZERO; count], vec![Vec3::ZERO; count]);
    Case::new(format!("open/skin/{}/as_stored", subject.name), count, "vertex", move || {
        let primitive = &model.meshes[0].primitives[0];
        skin_positions(primitive, Movement::Skin(&finals), &[], &mut positions);
        skin_normals(primitive, Movement::Skin(&finals), &[], &mut normals);
        black_box((&positions, &normals));
    })
}
