//! The same take and time give the same bits, on any number of threads.

use crate::support::{animation_data, bone};
use dragonfly_anim::animation::Animation;
use dragonfly_anim::data::{AnimationData, Bone, Channel, Interpolation, Take, Track};
use dragonfly_kit::random::Random;
use glam::{Quat, Vec3};

/// Returns 40 bones; each channel has its own keys, and all interpolations occur.
fn model() -> AnimationData {
    let mut random = Random::new(11);
    let interpolations =
        [Interpolation::Step, Interpolation::Linear, Interpolation::CubicSpline, Interpolation::Closest];
    let bones: Vec<Bone> =
        (0..40).map(|index: u32| bone("", index.checked_sub(1).map(|last| last / 2), Vec3::Y)).collect();
    let tracks = (0..40)
        .map(|index| {
            let interpolation = interpolations[index % 4];
            let parts = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
            let mut number = || random.between(-1.0, 1.0);
            let mut vectors = |count: usize| -> Vec<Vec3> {
                (0..count).map(|_| Vec3::new(number(), number(), number())).collect()
            };
            let keys = 5 + index;
            let times: Vec<f32> = (0..keys).map(|key| key as f32 / keys as f32 * 2.0).collect();
            let turns: Vec<Quat> = vectors(keys * parts).into_iter().map(Quat::from_scaled_axis).collect();
            Track {
                bone: index as u32,
                translation: Channel::new(times.clone(), vectors(keys * parts), interpolation),
                rotation: Channel::new(times.clone(), turns, interpolation),
                scale: Channel::new(times, vectors(keys * parts), interpolation),
            }
        })
        .collect();
    animation_data(bones, vec![Take { length: 2.0, tracks, ..Take::default() }])
}

/// Returns the FNV-1a hash of the bits of 1,000 sampled poses, in the order of time; `threads` share the work.
fn hash(data: &AnimationData, threads: usize) -> u64 {
    const POSES: usize = 1_000;
    let mut bits: Vec<Vec<u32>> = vec![Vec::new(); POSES];
    std::thread::scope(|scope| {
        for (part, poses) in bits.chunks_mut(POSES.div_ceil(threads)).enumerate() {
            scope.spawn(move || {
                let mut animation = Animation::new(data.clone());
                let first = part * POSES.div_ceil(threads);
                for (index, pose) in poses.iter_mut().enumerate() {
                    let time = (first + index) as f32 * 0.002;
                    let matrices = animation.to_root_bone_poses(Some(0), time);
                    *pose =
                        matrices.iter().flat_map(|matrix| matrix.to_cols_array()).map(f32::to_bits).collect();
                }
            });
        }
    });
    bits.iter().flatten().fold(0xCBF2_9CE4_8422_2325, |hash, &bits| {
        (hash ^ u64::from(bits)).wrapping_mul(0x0000_0100_0000_01B3)
    })
}

#[test]
fn a_thousand_poses_have_the_same_bits_on_one_to_eight_threads() {
    let data = model();
    let alone = hash(&data, 1);
    for threads in 1..=8 {
        assert_eq!(hash(&data, threads), alone, "{threads} threads");
    }
    // A change of a single bit changes the hash.
    let mut changed = data.clone();
    let mut take = (*changed.takes[0]).clone();
    let mut values = take.tracks[39].translation.values.to_vec();
    values[0].x = values[0].x.next_up();
    take.tracks[39].translation.values = values.into();
    changed.takes[0] = std::sync::Arc::new(take);
    assert_ne!(hash(&changed, 3), alone);
}
