//! Levels with a fused multiply-add give the same bits, however wide their registers are.

use crate::compressed::random_take;
use crate::support::bone;
use dragonfly_anim::compressed::{CompressionSettings, Exactness, compress};
use dragonfly_anim::data::Skeleton;
use dragonfly_anim::fast::Pose;
use dragonfly_anim::fast::simd::SimdLevel;
use dragonfly_kit::random::{Random, seed};
use glam::Vec3;

#[test]
fn registers_of_sixteen_numbers_decode_the_same_bits_as_those_of_eight() {
    let seed = seed(61);
    let mut random = Random::new(seed);
    let levels: Vec<SimdLevel> =
        SimdLevel::all().into_iter().filter(|&level| level != SimdLevel::PORTABLE).collect();
    let mut compared = 0;
    for round in 0..40 {
        let bones = 1 + random.below(90);
        let skeleton: Skeleton = Skeleton {
            bones: (0..bones as u32)
                .map(|bone_index| bone("bone", bone_index.checked_sub(1 + bone_index % 3), Vec3::X * 0.1))
                .collect(),
        };
        let keys = random.choice(&[1, 2, 40, 130]);
        let take = random_take(&mut random, bones, keys);
        // A small tolerance needs numbers that are too wide for one word.
        let everywhere = Exactness { tolerance: random.choice(&[0.05, 0.001, 1e-4]), shell: 0.1 };
        let settings = CompressionSettings { everywhere, ..CompressionSettings::default() };
        // Some chains of bones are too long for the smallest one.
        let Ok((take, _)) = compress(&take, &skeleton, &settings) else { continue };
        compared += 1;
        for _ in 0..60 {
            let time = random.between(-0.1, take.length() + 0.1);
            let poses: Vec<Pose> = levels
                .iter()
                .map(|&level| {
                    let mut pose = Pose::new(bones);
                    take.clone().with_level(level).sample(time, &mut pose);
                    pose
                })
                .collect();
            for pose in &poses {
                assert_eq!(pose, &poses[0], "seed {seed}, round {round}, {time} s");
            }
        }
    }
    assert!(compared > 20, "{compared}");
}
