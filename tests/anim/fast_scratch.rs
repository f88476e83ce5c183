//! The memory that characters use one after the other changes no result: not what it keeps of a take, nor of a crowd.

use crate::fast_path::made;
use dragonfly_anim::data::{AnimationData, Skin};
use dragonfly_anim::fast::simd::{Simd, SimdLevel};
use dragonfly_anim::fast::{
    KeyedTake, LaneMask, Matrix34, Playable, Playing, Pose, PoseBlock, Rig, Scratch, SkinBinding, StillPose,
    matrix, pose_character, pose_crowd,
};
use dragonfly_kit::random::{Random, seed};
use glam::{Mat4, Vec3};
use std::sync::Arc;

/// Returns a skin with two joints at every third bone.
fn skin(bones: usize) -> Skin {
    let joints: Vec<u32> =
        (0..bones as u32).filter(|bone| bone % 3 == 0).flat_map(|bone| [bone; 2]).collect();
    let offsets = (0..joints.len()).map(|at| Mat4::from_translation(Vec3::splat(at as f32))).collect();
    Skin { name: String::new(), offsets, bones: joints }
}

/// Some takes of one skeleton, with few keys so that much of each does not move.
struct Takes {
    rig: Rig,
    binding: SkinBinding,
    takes: Vec<KeyedTake>,
    mask: LaneMask,
}

impl Takes {
    fn new(bones: usize, is_sheared: bool, random: &mut Random) -> Self {
        let mut animation = made(bones, random);
        if is_sheared {
            let shear =
                Mat4::from_cols_array(&[1., 0., 0., 0., 0.5, 1., 0., 0., 0., 0., 1., 0., 1., 2., 3., 1.]);
            Arc::make_mut(&mut animation.skeleton).bones[bones / 2].rest_matrix = Some(shear);
        }
        keep_some(&mut animation, random);
        let rig = Rig::new(&animation.skeleton);
        Self {
            binding: SkinBinding::new(&rig, &skin(bones)),
            takes: animation.takes.iter().map(|take| KeyedTake::new(&animation.skeleton, take)).collect(),
            mask: LaneMask::new((0..bones).map(|_| random.unit())),
            rig,
        }
    }

    /// Returns the layers of a character: mostly one take alone.
    fn layers(&self, random: &mut Random) -> Vec<Playing<'_, KeyedTake>> {
        let count = random.choice(&[0, 1, 1, 1, 1, 2, 3]);
        let layer = |random: &mut Random| {
            let take = &self.takes[random.below(self.takes.len())];
            let mut layer = Playing::new(take, random.between(-0.2, 1.0));
            if count > 1 || random.below(9) == 0 {
                layer.weight = random.unit();
                layer.mask = (random.below(2) == 0).then_some(&self.mask);
            }
            layer
        };
        (0..count).map(|_| layer(random)).collect()
    }
}

/// Removes all channels of two of three bones, so that whole blocks do not move.
fn keep_some(animation: &mut AnimationData, random: &mut Random) {
    for take in &mut animation.takes {
        let from = random.below(12) as u32;
        Arc::make_mut(take).tracks.retain(|track| (track.bone + from) % 24 < 8);
    }
}

fn bits(matrices: &[Matrix34]) -> Vec<u32> {
    matrices.as_flattened().iter().map(|number| number.to_bits()).collect()
}

#[test]
fn a_scratch_that_played_other_takes_gives_the_bits_of_a_new_one() {
    let seed = seed(1123);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    for (bones, is_sheared) in [(5, false), (40, false), (61, true), (300, false)] {
        let takes = Takes::new(bones, is_sheared, &mut random);
        let (rig, binding) = (&takes.rig, &takes.binding);
        let mut used = Scratch::new(rig);
        for call in 0..200 {
            let level = random.choice(&SimdLevel::all());
            let characters: Vec<Vec<Playing<KeyedTake>>> =
                (0..random.choice(&[1, 1, 16, 37])).map(|_| takes.layers(&mut random)).collect();
            let mut out = vec![matrix::IDENTITY; binding.joints() * characters.len()];
            let mut expected = out.clone();
            if let [one] = characters.as_slice() {
                pose_character(level, rig, binding, one, &mut used, &mut out);
            } else {
                pose_crowd(level, rig, binding, characters.iter().map(Vec::as_slice), &mut used, &mut out);
            }
            for (one, expected) in characters.iter().zip(expected.chunks_mut(binding.joints())) {
                let mut new = Scratch::new(rig);
                pose_character(level, rig, binding, one, &mut new, expected);
                if characters.len() == 1 {
                    assert_eq!(used.pose(), new.pose(), "call {call}, {bones} bones, {}", level.name());
                }
            }
            assert!(bits(&out) == bits(&expected), "call {call}, {bones} bones, {}", level.name());
        }
    }
}

#[test]
fn blocks_that_a_take_does_not_have_get_the_rest_pose_whatever_was_played_before() {
    let mut random = Random::new(9);
    let (long, short) = (made(40, &mut random), made(8, &mut random));
    let rig = Rig::new(&long.skeleton);
    let binding = SkinBinding::new(&rig, &skin(40));
    let (long, short) =
        (KeyedTake::new(&long.skeleton, &long.takes[0]), KeyedTake::new(&short.skeleton, &short.takes[0]));
    for level in SimdLevel::all() {
        let mut scratch = Scratch::new(&rig);
        for take in [&long, &short] {
            let mut out = vec![matrix::IDENTITY; binding.joints()];
            pose_character(level, &rig, &binding, &[Playing::new(take, 0.1)], &mut scratch, &mut out);
        }
        assert_eq!(scratch.pose().blocks()[1..], rig.rest().blocks()[1..], "{}", level.name());
        assert_ne!(scratch.pose().blocks()[0], rig.rest().blocks()[0], "the take has these bones");
    }
}

/// A take made outside of the library: every second bone is lifted with time, the others do not move.
struct Lifted {
    bones: usize,
    still: Arc<StillPose>,
}

impl Lifted {
    fn new(rig: &Rig) -> Self {
        Self { bones: rig.bones(), still: Arc::new(StillPose::new(rig.rest(), |bone| bone % 2 == 0)) }
    }
}

impl Playable for Lifted {
    fn bones(&self) -> usize {
        self.bones
    }

    fn start(&self) -> f32 {
        0.0
    }

    fn length(&self) -> f32 {
        10.0
    }

    fn still(&self) -> &Arc<StillPose> {
        &self.still
    }

    #[inline(always)]
    fn sample_moving_with<S: Simd>(&self, time: f32, out: &mut [PoseBlock]) {
        for block in out.iter_mut().take(self.bones.div_ceil(8)) {
            for lane in [0, 2, 4, 6] {
                block.translation[1][lane] = time;
            }
        }
    }
}

#[test]
fn a_take_made_outside_of_the_library_plays_with_its_part_that_does_not_move() {
    let mut random = Random::new(3);
    let animation = made(20, &mut random);
    let rig = Rig::new(&animation.skeleton);
    let binding = SkinBinding::new(&rig, &skin(20));
    let take = Lifted::new(&rig);
    let mut scratch = Scratch::new(&rig);
    for time in [4.0, 1.0, 7.0] {
        let mut expected: Pose = rig.rest().clone();
        for bone in (0..20).step_by(2) {
            let rest = expected.get(bone).unwrap();
            expected.set(
                bone,
                dragonfly_anim::data::Transform {
                    translation: Vec3::new(rest.translation.x, time, rest.translation.z),
                    ..rest
                },
            );
        }
        for level in SimdLevel::all() {
            let mut out = vec![matrix::IDENTITY; binding.joints()];
            pose_character(level, &rig, &binding, &[Playing::new(&take, time)], &mut scratch, &mut out);
            for bone in 0..20 {
                assert_eq!(scratch.pose().get(bone), expected.get(bone), "{} bone {bone}", level.name());
            }
        }
    }
}
