//! Works on the bones of one character.

use super::{Form, Ready};
use crate::case::Case;
use crate::inputs::{ADDED, BLENDS, WEIGHTS, how, limb, mask_weights};
use crate::play::ways;
use dragonfly_anim::fast::simd::SimdLevel;
use dragonfly_anim::fast::{
    FastTwoBone, LaneMask, PoseLayer, add, blend, difference, final_poses, sample, to_root, two_bone,
};
use std::hint::black_box;

pub(super) fn sampling<F: Form>(ready: &'static Ready, level: SimdLevel) -> Vec<Case> {
    let subject = ready.subject;
    let mut cases = Vec::new();
    for (index, take) in subject.short_and_long() {
        let group = format!("sample/{}/{}", subject.name, take.name);
        for (way, times) in ways(take) {
            let units = subject.bones() * times.len();
            let case = Case::new(F::way(level), format!("{group}/{way}"), units, "bone", move || {
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

pub(super) fn matrices(ready: &'static Ready, level: SimdLevel) -> [Case; 2] {
    let name = ready.subject.name;
    [
        Case::new(level.name(), format!("to_root/{name}"), ready.rig.bones(), "bone", move || {
            let (pose, mut to) = (ready.pose(0, 0.4), ready.roots());
            move || {
                to_root(level, &ready.rig, pose.blocks(), &mut to);
                black_box(&to);
            }
        }),
        Case::new(level.name(), format!("final/{name}"), ready.binding.joints(), "joint", move || {
            let (roots, mut to) = (ready.roots(), ready.finals());
            move || {
                final_poses(level, &ready.binding, &roots, &mut to);
                black_box(&to);
            }
        }),
    ]
}

pub(super) fn blending(ready: &'static Ready, level: SimdLevel) -> [Case; 4] {
    let subject = ready.subject;
    BLENDS.map(|(count, is_masked)| {
        let row = format!("blend/{}/{count}/{}", subject.name, how(is_masked));
        Case::new(level.name(), row, subject.bones(), "bone", move || {
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

/// A difference between two takes added to a third: wholly, and in part.
pub(super) fn additive(ready: &'static Ready, level: SimdLevel) -> [Case; 2] {
    ADDED.map(|(how, weight)| {
        let row = format!("additive/{}/{how}", ready.subject.name);
        Case::new(level.name(), row, ready.rig.bones(), "bone", move || {
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

pub(super) fn reaching(ready: &'static Ready, level: SimdLevel) -> Case {
    Case::new(level.name(), format!("two_bone/{}", ready.subject.name), 1, "solve", move || {
        let given = limb(ready.subject);
        let limb = FastTwoBone { pole: given.pole, ..FastTwoBone::new(given.root, given.middle, given.end) };
        let (roots, mut pose) = (ready.roots(), ready.pose(0, 0.4));
        move || {
            black_box(two_bone(&limb, black_box(given.target), &roots, &mut pose));
        }
    })
}
