//! Levels with a fused multiply-add give the same bits, however wide their registers are.

use crate::compressed::{load, random_take};
use crate::doors::data;
use crate::support::bone;
use dragonfly_anim::compressed::{CompressedTake, CompressionSettings, Exactness, compress};
use dragonfly_anim::data::Skeleton;
use dragonfly_anim::fast::Pose;
use dragonfly_anim::fast::simd::SimdLevel;
use dragonfly_kit::random::{Random, seed};
use glam::Vec3;

/// Compares the poses of a take at random times, at all levels but the portable one.
fn assert_same(take: &CompressedTake, random: &mut Random, what: &str) {
    let levels = SimdLevel::all().into_iter().filter(|&level| level != SimdLevel::PORTABLE);
    let takes: Vec<CompressedTake> = levels.map(|level| take.clone().with_level(level)).collect();
    for _ in 0..60 {
        let time = random.between(-0.1, take.length() + 0.1);
        let poses = takes.iter().map(|take| {
            let mut pose = Pose::new(take.bones());
            take.sample(time, &mut pose);
            pose
        });
        let poses: Vec<Pose> = poses.collect();
        assert!(poses.windows(2).all(|pair| pair[0] == pair[1]), "{what}, {time} s");
    }
}

#[test]
fn registers_of_sixteen_numbers_decode_the_same_bits_as_those_of_eight() {
    let seed = seed(61);
    let mut random = Random::new(seed);
    let mut compared = 0;
    for round in 0..40 {
        let bones = 1 + random.below(90);
        let bones = (0..bones as u32)
            .map(|number| bone("bone", number.checked_sub(1 + number % 3), Vec3::X * 0.1))
            .collect();
        let skeleton = Skeleton { bones };
        let keys = random.choice(&[1, 2, 40, 130]);
        let take = random_take(&mut random, skeleton.len(), keys);
        // A small tolerance needs numbers that are too wide for one word.
        let everywhere = Exactness { tolerance: random.choice(&[0.05, 0.001, 1e-4]), shell: 0.1 };
        let settings = CompressionSettings { everywhere, ..CompressionSettings::default() };
        // Some chains of bones are too long for the smallest one.
        let Ok((take, _)) = compress(&take, &skeleton, &settings) else { continue };
        compared += 1;
        assert_same(&take, &mut random, &format!("seed {seed}, round {round}"));
    }
    assert!(compared > 20, "{compared}");
}

#[test]
fn the_takes_of_the_bench_rig_decode_to_the_same_bits_at_every_width() {
    let seed = seed(62);
    let mut random = Random::new(seed);
    let model = load(data().join("bench/pab.glb"));
    for take in &model.animation.takes {
        for everywhere in [Exactness::FINE, Exactness::COARSE] {
            let settings = CompressionSettings { everywhere, ..CompressionSettings::default() };
            let compressed = compress(take, &model.animation.skeleton, &settings).unwrap().0;
            assert_same(&compressed, &mut random, &format!("seed {seed}, {}", take.name));
        }
    }
}
