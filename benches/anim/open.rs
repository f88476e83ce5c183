//! The open path, one bone at a time.

use crate::case::BenchCase;
use crate::inputs::{
    ADDED, BLENDS, INFLUENCES, WEIGHTS, finals, how, limb, mask_weights, posed, primitive, roots,
};
use crate::model::BenchModel;
use crate::play::{CROWDS, FRAMES, crowd, forward, orders};
use dragonfly_anim::animation::{final_poses, to_root};
use dragonfly_anim::blend::{Layer, Mask, add, blend, difference};
use dragonfly_anim::data::{AnimationData, Transform};
use dragonfly_anim::ik::{Pole, TwoBone, two_bone};
use dragonfly_anim::sample::sample_take;
use dragonfly_anim::skin::{Movement, skin_normals, skin_positions};
use glam::{Mat4, Vec3};
use std::hint::black_box;

pub(crate) fn cases(subject: &'static BenchModel) -> Vec<BenchCase> {
    let mut cases = sampling(subject);
    cases.extend(matrices(subject));
    cases.extend(blending(subject));
    cases.extend(additive(subject));
    cases.push(reaching(subject));
    cases.extend(skinning(subject));
    cases.extend([one_character(subject), one_blended_character(subject)]);
    cases.extend(CROWDS.map(|count| of_many(subject, count)));
    cases
}

fn sampling(subject: &'static BenchModel) -> Vec<BenchCase> {
    let mut cases = Vec::new();
    for (_, take) in subject.short_and_long() {
        let group = format!("sample/{}/{}", subject.name, take.name);
        for (order, times) in orders(take) {
            let units = subject.bones() * times.len();
            let case = BenchCase::new("open", format!("{group}/{order}"), units, "bone", move || {
                let mut poses = vec![Transform::IDENTITY; subject.bones()];
                move || {
                    for &time in &times {
                        sample_take(Some(take), &subject.model.animation.skeleton, time, &mut poses);
                        black_box(&poses);
                    }
                }
            });
            cases.push(case.among(&group));
        }
    }
    cases
}

fn matrices(subject: &'static BenchModel) -> [BenchCase; 2] {
    let (name, joints) = (subject.name, subject.skin().bones.len());
    [
        BenchCase::new("open", format!("to_root/{name}"), subject.bones(), "bone", move || {
            let (poses, mut to) = (posed(subject, 0, 0.4), roots(subject));
            move || {
                to_root(&subject.model.animation.skeleton, &poses, &mut to);
                black_box(&to);
            }
        }),
        BenchCase::new("open", format!("final/{name}"), joints, "joint", move || {
            let (roots, mut to) = (roots(subject), finals(subject));
            move || {
                final_poses(subject.skin(), &roots, &mut to);
                black_box(&to);
            }
        }),
    ]
}

fn blending(subject: &'static BenchModel) -> [BenchCase; 4] {
    BLENDS.map(|(count, is_masked)| {
        let task = format!("blend/{}/{count}/{}", subject.name, how(is_masked));
        BenchCase::new("open", task, subject.bones(), "bone", move || {
            let poses = [0, 1, 2, 3].map(|take| posed(subject, take, 0.3));
            let mask = Mask::from_weights(mask_weights(subject));
            let (base, mut out) = (posed(subject, 0, 0.0), poses[0].clone());
            move || {
                let layer = |at: usize| {
                    let layer = Layer::new(&poses[at], WEIGHTS[at]);
                    if is_masked { layer.masked(&mask) } else { layer }
                };
                let layers = [0, 1, 2, 3].map(layer);
                blend(&base, &layers[..count], &mut out);
                black_box(&out);
            }
        })
    })
}

/// Returns the cases that add the difference between two takes to a third, with weight 1 and less.
fn additive(subject: &'static BenchModel) -> [BenchCase; 2] {
    ADDED.map(|(how, weight)| {
        let task = format!("additive/{}/{how}", subject.name);
        BenchCase::new("open", task, subject.bones(), "bone", move || {
            let [one, two, three] = [0, 1, 2].map(|take| posed(subject, take, 0.3));
            let mut more = three.clone();
            difference(&two, &one, &mut more);
            let mut out = three.clone();
            move || {
                add(&three, &more, weight, None, &mut out);
                black_box(&out);
            }
        })
    })
}

fn reaching(subject: &'static BenchModel) -> BenchCase {
    BenchCase::new("open", format!("two_bone/{}", subject.name), 1, "solve", move || {
        let (given, roots, mut poses) = (limb(subject), roots(subject), posed(subject, 0, 0.4));
        let limb = TwoBone {
            pole: Pole::Direction(given.pole),
            ..TwoBone::new(given.root, given.middle, given.end)
        };
        let unsolved = [limb.root, limb.middle].map(|bone| (bone as usize, poses[bone as usize]));
        move || {
            // The solver starts from the poses, so these must be the same in each call.
            for (bone, pose) in unsolved {
                poses[bone] = pose;
            }
            let skeleton = &subject.model.animation.skeleton;
            let _ = black_box(two_bone(skeleton, &roots, &limb, black_box(given.target), &mut poses));
        }
    })
}

fn skinning(subject: &'static BenchModel) -> [BenchCase; 3] {
    let count = subject.primitive().vertices.len();
    INFLUENCES.map(|most| {
        BenchCase::new("open", format!("skin/{}/{most}", subject.name), count, "vertex", move || {
            let (primitive, finals) = (primitive(subject, most), finals(subject));
            let (mut positions, mut normals) = (vec![Vec3::ZERO; count], vec![Vec3::ZERO; count]);
            move || {
                skin_positions(&primitive, Movement::Skin(&finals), &[], &mut positions);
                skin_normals(&primitive, Movement::Skin(&finals), &[], &mut normals);
                black_box((&positions, &normals));
            }
        })
    })
}

/// Buffers for one character between takes and final matrices.
struct OpenBuffers {
    poses: Vec<Transform>,
    others: Vec<Transform>,
    blended: Vec<Transform>,
    roots: Vec<Mat4>,
}

impl OpenBuffers {
    fn new(subject: &BenchModel) -> Self {
        let poses = posed(subject, 0, 0.0);
        Self { others: poses.clone(), blended: poses.clone(), poses, roots: roots(subject) }
    }

    fn character(&mut self, subject: &BenchModel, take: usize, time: f32, out: &mut [Mat4]) {
        let AnimationData { skeleton, takes } = &subject.model.animation;
        sample_take(Some(&takes[take]), skeleton, time, &mut self.poses);
        to_root(skeleton, &self.poses, &mut self.roots);
        final_poses(subject.skin(), &self.roots, out);
    }

    fn character_of_two(&mut self, subject: &BenchModel, takes: [usize; 2], time: f32, out: &mut [Mat4]) {
        let AnimationData { skeleton, takes: all } = &subject.model.animation;
        sample_take(Some(&all[takes[0]]), skeleton, time, &mut self.poses);
        sample_take(Some(&all[takes[1]]), skeleton, time, &mut self.others);
        let layers = [Layer::new(&self.poses, 0.5), Layer::new(&self.others, 0.5)];
        blend(&self.poses, &layers, &mut self.blended);
        to_root(skeleton, &self.blended, &mut self.roots);
        final_poses(subject.skin(), &self.roots, out);
    }
}

fn one_character(subject: &'static BenchModel) -> BenchCase {
    BenchCase::new("open", format!("pipeline/{}/1", subject.name), FRAMES, "character", move || {
        let times = forward(&subject.model.animation.takes[0]);
        let (mut buffers, mut out) = (OpenBuffers::new(subject), finals(subject));
        move || {
            for &time in &times {
                buffers.character(subject, 0, time, &mut out);
                black_box(&out);
            }
        }
    })
}

fn one_blended_character(subject: &'static BenchModel) -> BenchCase {
    BenchCase::new(
        "open",
        format!("pipeline/{}/1_of_2_takes", subject.name),
        FRAMES,
        "character",
        move || {
            let takes = &subject.model.animation.takes;
            let (times, both) = (forward(&takes[0]), [0, 1 % takes.len()]);
            let (mut buffers, mut out) = (OpenBuffers::new(subject), finals(subject));
            move || {
                for &time in &times {
                    buffers.character_of_two(subject, both, time, &mut out);
                    black_box(&out);
                }
            }
        },
    )
}

fn of_many(subject: &'static BenchModel, count: usize) -> BenchCase {
    let task = format!("pipeline/{}/{count}", subject.name);
    let case = BenchCase::new("open", task, count, "character", move || {
        let joints = subject.skin().bones.len();
        let (mut buffers, mut out) = (OpenBuffers::new(subject), vec![Mat4::IDENTITY; joints * count]);
        let mut crowd = crowd(subject, count);
        move || {
            for (member, out) in crowd.iter_mut().zip(out.chunks_mut(joints)) {
                member.step();
                buffers.character(subject, member.take, member.time, out);
            }
            black_box(&out);
        }
    });
    case.counted_once()
}
