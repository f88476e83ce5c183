//! The fast path agrees with the open path, at every SIMD level of the machine.

use crate::doors::{TestFolder, data, model_files};
use crate::support::{animation_data, bone, take};
use dragonfly_anim::animation::{final_poses as open_finals, to_root as open_to_root};
use dragonfly_anim::data::{
    AnimationData, Channel, Interpolation, ModelData, Skeleton, Skin, Take, Track, Transform,
};
use dragonfly_anim::fast::matrix::mat4;
use dragonfly_anim::fast::simd::SimdLevel;
use dragonfly_anim::fast::{
    KeyedTake, Pose, Rig, RootPoses, SkinBinding, final_poses, matrix, sample, to_root,
};
use dragonfly_anim::format::{ReadOptions, read};
use dragonfly_anim::sample::sample_take;
use dragonfly_kit::random::{Random, seed};
use glam::{Mat4, Quat, Vec3};
use std::path::Path;

/// Allowed difference, relative to the largest number of the same vector, or to 1 if that is smaller.
const RELATIVE: f32 = 1e-5;

/// The largest difference found, in units of the allowed one.
#[derive(Default)]
pub(crate) struct Worst {
    pub(crate) off: f32,
    pub(crate) numbers: usize,
    place: String,
}

impl Worst {
    pub(crate) fn compare(
        &mut self,
        got: &[f32],
        expected: &[f32],
        largest: f32,
        place: impl Fn() -> String,
    ) {
        assert_eq!(got.len(), expected.len());
        for (got, expected) in got.iter().zip(expected) {
            let off = (got - expected).abs() / (RELATIVE * largest.max(1.0));
            assert!(off.is_finite(), "{}: {got} instead of {expected}", place());
            self.numbers += 1;
            if off > self.off {
                (self.off, self.place) = (off, format!("{}: {got} instead of {expected}", place()));
            }
        }
    }

    #[track_caller]
    pub(crate) fn assert(&self, what: &str) {
        println!("{what}: {} numbers, worst {:.3} of the allowed difference", self.numbers, self.off);
        assert!(self.off <= 1.0, "{what}: {:.2} times the allowed difference: {}", self.off, self.place);
    }
}

fn largest<'a>(numbers: impl IntoIterator<Item = &'a f32>) -> f32 {
    numbers.into_iter().copied().map(f32::abs).fold(0.0, f32::max)
}

/// Returns the numbers of a pose; the rotation with the sign that is nearer to `like`.
fn numbers(pose: Transform, like: Transform) -> [f32; 10] {
    let turned = if pose.rotation.dot(like.rotation) < 0.0 { -pose.rotation } else { pose.rotation };
    let mut numbers = [0.0; 10];
    numbers[..4].copy_from_slice(&turned.to_array());
    numbers[4..7].copy_from_slice(&pose.translation.to_array());
    numbers[7..].copy_from_slice(&pose.scale.to_array());
    numbers
}

pub(crate) fn compare_poses(got: &Pose, expected: &[Transform], worst: &mut Worst, place: &str) {
    assert_eq!(got.bones(), expected.len());
    for (bone, &expected) in expected.iter().enumerate() {
        let (got, expected) = (numbers(got.get(bone).unwrap(), expected), numbers(expected, expected));
        for (what, part) in [("rotation", 0..4), ("translation", 4..7), ("scale", 7..10)] {
            let (got, expected) = (&got[part.clone()], &expected[part]);
            worst.compare(got, expected, largest(expected), || format!("{place} bone {bone} {what}"));
        }
    }
}

fn compare_matrices<'a>(
    got: impl ExactSizeIterator<Item = &'a [f32; 12]>,
    expected: &[Mat4],
    largest: f32,
    worst: &mut Worst,
    place: &str,
) {
    assert_eq!(got.len(), expected.len());
    for (at, (got, expected)) in got.zip(expected).enumerate() {
        worst.compare(&mat4(got).to_cols_array(), &expected.to_cols_array(), largest, || {
            format!("{place} matrix {at}")
        });
    }
}

/// Returns every key time, and times between, before and after.
fn times(take: &Take) -> Vec<f32> {
    let mut keys: Vec<f32> = take.tracks.iter().flat_map(Track::key_times).collect();
    keys.sort_by(f32::total_cmp);
    keys.dedup();
    let step = keys.len() / 60 + 1;
    let mut times: Vec<f32> = keys.iter().copied().step_by(step).collect();
    times.extend(keys.windows(2).step_by(step).map(|pair| pair[0] + (pair[1] - pair[0]) * 0.37));
    times.extend([take.start - 1.0, take.end() + 1.0, f32::NAN, f32::INFINITY]);
    times
}

/// Samples every take at many times, on both paths.
fn compare_model(animation: &AnimationData, skins: &[Skin]) -> Worst {
    let skeleton: &Skeleton = &animation.skeleton;
    let mut worst = Worst::default();
    let rig = Rig::new(skeleton);
    let bindings: Vec<SkinBinding> = skins.iter().map(|skin| SkinBinding::new(&rig, skin)).collect();
    let (mut pose, mut roots) = (Pose::new(skeleton.len()), RootPoses::new(&rig));
    let mut open = vec![Transform::IDENTITY; skeleton.len()];
    let mut open_roots = vec![Mat4::IDENTITY; skeleton.len()];
    for (index, take) in animation.takes.iter().enumerate() {
        let keyed = KeyedTake::new(skeleton, take);
        for (time, level) in times(take).into_iter().flat_map(|time| SimdLevel::all().map_with(time)) {
            let place = format!("{} take {index} at {time}", level.name());
            sample_take(Some(take), skeleton, time, &mut open);
            sample(level, &keyed, time, pose.blocks_mut());
            compare_poses(&pose, &open, &mut worst, &place);
            open_to_root(skeleton, &open, &mut open_roots);
            to_root(level, &rig, pose.blocks(), &mut roots);
            let size = largest(open_roots.iter().flat_map(|matrix| matrix.as_ref()));
            compare_matrices(roots.matrices(), &open_roots, size, &mut worst, &place);
            for (skin, binding) in skins.iter().zip(&bindings) {
                let mut expected = vec![Mat4::IDENTITY; skin.bones.len()];
                let mut finals = vec![matrix::IDENTITY; skin.bones.len()];
                open_finals(skin, &open_roots, &mut expected);
                final_poses(level, binding, &roots, &mut finals);
                // The error of a product is proportional to its factors.
                let size = size * largest(skin.offsets.iter().flat_map(|matrix| matrix.as_ref())).max(1.0);
                compare_matrices(finals.iter(), &expected, size, &mut worst, &place);
            }
        }
    }
    worst
}

/// Pairs a time with every level.
trait MapWith {
    fn map_with(self, time: f32) -> Vec<(f32, SimdLevel)>;
}

impl MapWith for Vec<SimdLevel> {
    fn map_with(self, time: f32) -> Vec<(f32, SimdLevel)> {
        self.into_iter().map(|level| (time, level)).collect()
    }
}

pub(crate) fn load(path: &Path) -> ModelData {
    let bytes = std::fs::read(path).unwrap();
    let name = path.file_name().unwrap().to_str().unwrap();
    read(name, &bytes, &TestFolder(path.parent().unwrap().to_owned()), &ReadOptions::default()).unwrap().model
}

#[test]
fn a_real_fox_moves_the_same_on_both_paths() {
    let fox = load(&data().join("gltf/Fox.glb"));
    compare_model(&fox.animation, &fox.skins).assert("Fox");
}

#[test]
fn a_real_rig_of_67_bones_moves_the_same_on_both_paths() {
    let model = load(&data().join("bench/pab.glb"));
    compare_model(&model.animation, &model.skins).assert("pab");
}

#[test]
fn every_model_of_the_test_data_moves_the_same_on_both_paths() {
    let mut seen = 0;
    for path in model_files() {
        let name = path.display().to_string();
        let model = load(&path);
        compare_model(&model.animation, &model.skins).assert(&name);
        seen += 1;
    }
    assert!(seen >= 40, "{seen}");
}

/// A skeleton of `bones` animated bones, each with its own keys and kind of channel.
pub(crate) fn made(bones: usize, random: &mut Random) -> AnimationData {
    let vector =
        |random: &mut Random, size: f32| Vec3::from_array([(); 3].map(|()| random.between(-1.0, 1.0))) * size;
    let rotation = |random: &mut Random, angle: f32| {
        let axis = vector(random, 1.0).normalize_or(Vec3::X);
        Quat::from_axis_angle(axis, random.between(0.0, angle))
    };
    let mut list = Vec::new();
    for index in 0..bones {
        let parent = (index > 0 && random.below(9) > 0).then(|| random.below(index) as u32);
        let mut bone = bone(&format!("bone {index}"), parent, vector(random, 1.0));
        bone.rest.rotation = rotation(random, 3.0);
        bone.offset = Mat4::from_rotation_translation(rotation(random, 3.0), vector(random, 1.0));
        list.push(bone);
    }
    let kinds = [
        Interpolation::Linear,
        Interpolation::Linear,
        Interpolation::Linear,
        Interpolation::Step,
        Interpolation::Closest,
        Interpolation::CubicSpline,
    ];
    let together: Vec<f32> = (0..12).map(|key| key as f32 / 30.0).collect();
    let takes = (0..3).map(|number| {
        // In the second take every bone has its own times; the third rotates far from key to key.
        let own = number == 1;
        let angle = if number == 2 { 3.1 } else { 0.4 };
        let times = |random: &mut Random| {
            if !own {
                return together.clone();
            }
            let mut times: Vec<f32> = (0..random.below(9)).map(|_| random.between(-1.0, 2.0)).collect();
            times.sort_by(f32::total_cmp);
            times.dedup();
            times
        };
        let tracks = (0..bones).map(|index| {
            let kind = if number == 0 { Interpolation::Linear } else { random.choice(&kinds) };
            let each = if kind == Interpolation::CubicSpline { 3 } else { 1 };
            let (turns, moves, grows) = (times(random), times(random), times(random));
            let mut now = rotation(random, 3.0);
            let turned: Vec<Quat> = (0..turns.len() * each)
                .map(|_| {
                    now = rotation(random, angle) * now;
                    now
                })
                .collect();
            let moved: Vec<Vec3> = (0..moves.len() * each).map(|_| vector(random, 1.0)).collect();
            let grown: Vec<Vec3> = (0..grows.len() * each).map(|_| Vec3::ONE + vector(random, 0.1)).collect();
            Track {
                bone: index as u32,
                translation: if random.below(2) == 0 {
                    Channel::default()
                } else {
                    Channel::new(moves, moved, kind)
                },
                rotation: Channel::new(turns, turned, kind),
                scale: if random.below(3) > 0 {
                    Channel::default()
                } else {
                    Channel::new(grows, grown, kind)
                },
            }
        });
        take(tracks.collect())
    });
    let takes = takes.collect();
    animation_data(list, takes)
}

#[test]
fn skeletons_of_any_size_move_the_same_on_both_paths() {
    let seed = seed(11);
    println!("DRAGONFLY_SEED={seed}");
    let mut random = Random::new(seed);
    for bones in [0, 1, 2, 7, 8, 9, 15, 16, 17, 67] {
        let animation = made(bones, &mut random);
        let skin = Skin {
            name: String::new(),
            // In another order than the bones, and one joint of a missing bone.
            bones: (0..bones as u32).rev().chain([99]).collect(),
            offsets: animation.skeleton.bones.iter().rev().map(|bone| bone.offset).collect(),
        };
        compare_model(&animation, &[skin]).assert(&format!("{bones} bones"));
    }
}

#[test]
fn a_rig_of_67_joints_agrees_with_exact_poses_on_the_fast_path() {
    let model = load(&data().join("bench/pab.glb"));
    let golden = std::fs::read(data().join("bench/pab.golden.json")).unwrap();
    let golden: serde_json::Value = serde_json::from_slice(&golden).unwrap();
    let skeleton = &model.animation.skeleton;
    let node = |value: &serde_json::Value| value.as_u64().unwrap() as u32;
    let bone_of = |node: u32| skeleton.bones.iter().position(|bone| bone.node == Some(node)).unwrap();
    let bones: Vec<usize> =
        golden["joints"].as_array().unwrap().iter().map(|value| bone_of(node(value))).collect();
    let rig = Rig::new(skeleton);
    let (mut pose, mut roots) = (Pose::new(skeleton.len()), RootPoses::new(&rig));
    let mut worst = Worst::default();
    for clip in golden["clips"].as_array().unwrap() {
        let name = clip["name"].as_str().unwrap();
        let take = model.animation.takes.iter().find(|take| take.name == name).unwrap();
        let keyed = KeyedTake::new(skeleton, take);
        for (expected, level) in clip["poses"]
            .as_array()
            .unwrap()
            .iter()
            .flat_map(|pose| SimdLevel::all().into_iter().map(move |level| (pose, level)))
        {
            let time = expected["t"].as_f64().unwrap() as f32;
            sample(level, &keyed, time, pose.blocks_mut());
            to_root(level, &rig, pose.blocks(), &mut roots);
            for (&bone, rows) in bones.iter().zip(expected["global"].as_array().unwrap()) {
                let rows: Vec<f32> =
                    rows.as_array().unwrap().iter().map(|number| number.as_f64().unwrap() as f32).collect();
                let place = || format!("{} {name} at {time} bone {bone}", level.name());
                worst.compare(roots.get(bone), &rows, largest(&rows), place);
            }
        }
    }
    worst.assert("exact poses");
    assert!(worst.numbers > 10_000);
}
