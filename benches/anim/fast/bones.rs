//! Tasks on the bones of one character.

use super::{FastInputs, TakeForm};
use crate::case::BenchCase;
use crate::inputs::{ADDED, BLENDS, WEIGHTS, how, limb, mask_weights};
use crate::play::orders;
use dragonfly_anim::fast::simd::SimdLevel;
use dragonfly_anim::fast::{
    FastTwoBone, LaneMask, PoseLayer, add, blend, difference, final_poses, sample, to_root, two_bone,
};
use std::hint::black_box;

pub(super) fn sampling<F: TakeForm>(ready: &'static FastInputs, level: SimdLevel) -> Vec<BenchCase> {
    let subject = ready.subject;
    let mut cases = Vec::new();
    for (index, take) in subject.short_and_long() {
        let group = format!("sample/{}/{}", subject.name, take.name);
        for (order, times) in orders(take) {
            let units = subject.bones() * times.len();
            let case =
                BenchCase::new(F::variant(level), format!("{group}/{order}"), units, "bone", move || {
                    let (take, mut pose) = (&F::takes(ready)[index], ready.rig.rest().clone());
                    move || {
                        for &time in &times {
                            sample(level, take, time, pose.blocks_mut());
                            black_box(&pose);
                        }
                    }
                });
            cases.push(case.among(&group));
        }
    }
    cases
}

pub(super) fn matrices(ready: &'static FastInputs, level: SimdLevel) -> [BenchCase; 2] {
    let name = ready.subject.name;
    [
        BenchCase::new(level.name(), format!("to_root/{name}"), ready.rig.bones(), "bone", move || {
            let (pose, mut to) = (ready.pose(0, 0.4), ready.roots());
            move || {
                to_root(level, &ready.rig, pose.blocks(), &mut to);
                black_box(&to);
            }
        }),
        BenchCase::new(level.name(), format!("final/{name}"), ready.binding.joints(), "joint", move || {
            let (roots, mut to) = (ready.roots(), ready.finals());
            move || {
                final_poses(level, &ready.binding, &roots, &mut to);
                black_box(&to);
            }
        }),
    ]
}

pub(super) fn blending(ready: &'static FastInputs, level: SimdLevel) -> [BenchCase; 4] {
    let subject = ready.subject;
    BLENDS.map(|(count, is_masked)| {
        let task = format!("blend/{}/{count}/{}", subject.name, how(is_masked));
        BenchCase::new(level.name(), task, subject.bones(), "bone", move || {
            let poses = [0, 1, 2, 3].map(|take| ready.pose(take, 0.3));
            let mask = LaneMask::new(mask_weights(subject));
            let (base, mut out) = (ready.rig.rest(), poses[0].clone());
            move || {
                let layer = |at: usize| PoseLayer {
                    pose: poses[at].blocks(),
                    weight: WEIGHTS[at],
                    mask: is_masked.then_some(&mask),
                };
                let layers = [0, 1, 2, 3].map(layer);
                blend(level, base.blocks(), &layers[..count], out.blocks_mut());
                black_box(&out);
            }
        })
    })
}

/// Returns the cases that add the difference between two takes to a third, with weight 1 and less.
pub(super) fn additive(ready: &'static FastInputs, level: SimdLevel) -> [BenchCase; 2] {
    ADDED.map(|(how, weight)| {
        let task = format!("additive/{}/{how}", ready.subject.name);
        BenchCase::new(level.name(), task, ready.rig.bones(), "bone", move || {
            let [one, two, three] = [0, 1, 2].map(|take| ready.pose(take, 0.3));
            let mut more = three.clone();
            difference(level, two.blocks(), one.blocks(), more.blocks_mut());
            let mut out = three.clone();
            move || {
                add(level, three.blocks(), more.blocks(), weight, None, out.blocks_mut());
                black_box(&out);
            }
        })
    })
}

pub(super) fn reaching(ready: &'static FastInputs, level: SimdLevel) -> BenchCase {
    BenchCase::new(level.name(), format!("two_bone/{}", ready.subject.name), 1, "solve", move || {
        let given = limb(ready.subject);
        let limb = FastTwoBone { pole: given.pole, ..FastTwoBone::new(given.root, given.middle, given.end) };
        let (roots, mut pose) = (ready.roots(), ready.pose(0, 0.4));
        move || {
            black_box(two_bone(&limb, black_box(given.target), &roots, &mut pose));
        }
    })
}
