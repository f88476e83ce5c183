//! For any numbers and lists in a model, the evaluator returns finite numbers.

use crate::support::{animation_data, bone};
use dragonfly_anim::data::{
    Bone, Channel, Influence, Interpolation, Mesh, MeshInstance, ModelData, MorphTarget, MorphTrack,
    Primitive, Skin, Take, Track, Transform, Vertices,
};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::sample::{PlayMode, find_keys, keyframe_at, mix, sample_track};
use dragonfly_anim::skin::skin_tangents;
use dragonfly_kit::random::{Random, seed};
use glam::{Mat4, Quat, Vec3, Vec4};
use std::sync::Arc;

/// Numbers that break calculations.
const HOSTILE: [f32; 18] = [
    f32::NAN,
    -f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    0.0,
    -0.0,
    f32::MIN_POSITIVE,
    1e-45,
    -1e-45,
    1e-40,
    1e38,
    -1e38,
    f32::MAX,
    f32::MIN,
    1e-38,
    1e19,
    -1e20,
    1.0,
];

/// Random parts of a model; `hostile` is the chance that a number is one of [`HOSTILE`].
pub(crate) struct HostileModels {
    pub(crate) random: Random,
    pub(crate) hostile: f32,
}

impl HostileModels {
    fn number(&mut self) -> f32 {
        if self.random.unit() < self.hostile {
            self.random.choice(&HOSTILE)
        } else {
            self.random.between(-2.0, 2.0)
        }
    }

    fn numbers<const N: usize>(&mut self) -> [f32; N] {
        [(); N].map(|()| self.number())
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::from_array(self.numbers())
    }

    fn rotation(&mut self) -> Quat {
        Quat::from_array(self.numbers())
    }

    fn matrix(&mut self) -> Mat4 {
        let [x, y, z, w] = [(); 4].map(|()| self.vector());
        Mat4::from_cols(x.extend(0.0), y.extend(0.0), z.extend(0.0), w.extend(1.0))
    }

    /// Returns in most cases `right`, the correct number.
    fn count(&mut self, right: usize) -> usize {
        if self.random.unit() < 0.1 { self.random.below(right + 3) } else { right }
    }

    /// Returns in most cases an index into a list of length `len`.
    fn index(&mut self, len: usize) -> u32 {
        if self.random.unit() < 0.1 { u32::MAX - 1 } else { self.random.below(len) as u32 }
    }

    fn list<T>(&mut self, right: usize, mut make: impl FnMut(&mut Self) -> T) -> Vec<T> {
        (0..self.count(right)).map(|_| make(self)).collect()
    }

    fn times(&mut self, keys: usize) -> Vec<f32> {
        let mut times: Vec<f32> = (0..keys).map(|_| self.number()).collect();
        if self.random.unit() < 0.7 {
            times.sort_by(f32::total_cmp);
        }
        times
    }

    fn interpolation(&mut self) -> Interpolation {
        self.random.choice(&[
            Interpolation::Step,
            Interpolation::Linear,
            Interpolation::CubicSpline,
            Interpolation::Closest,
        ])
    }

    fn channel<T>(&mut self, make: impl FnMut(&mut Self) -> T) -> Channel<T> {
        let (keys, interpolation) = (self.random.below(5), self.interpolation());
        let parts = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let values = self.list(keys * parts, make);
        Channel { times: self.times(keys).into(), values: values.into(), interpolation }
    }

    fn track(&mut self) -> Track {
        Track {
            bone: self.index(4),
            translation: self.channel(Self::vector),
            rotation: self.channel(Self::rotation),
            scale: self.channel(Self::vector),
        }
    }

    fn bone(&mut self) -> Bone {
        let rest = Transform { translation: self.vector(), rotation: self.rotation(), scale: self.vector() };
        let parent = (self.random.unit() < 0.8).then(|| self.index(4));
        let rest_matrix = (self.random.unit() < 0.2).then(|| self.matrix());
        Bone { rest, rest_matrix, offset: self.matrix(), ..bone("", parent, Vec3::ZERO) }
    }

    fn primitive(&mut self) -> Primitive {
        let influences_per_vertex = self.random.choice(&[0, 4, 8]);
        let vertices = Vertices {
            positions: self.list(3, Self::vector),
            normals: self.list(3, Self::vector),
            tangents: self.list(3, |maker| Vec4::from_array(maker.numbers())),
            influences: self.list(3 * influences_per_vertex, |maker| Influence {
                joint: maker.index(4) as u16,
                weight: maker.number(),
            }),
            influences_per_vertex,
            ..Vertices::default()
        };
        let morph_targets = self.list(2, |maker| MorphTarget {
            positions: maker.list(3, Self::vector),
            normals: maker.list(3, Self::vector),
            tangents: maker.list(3, Self::vector),
            ..MorphTarget::default()
        });
        Primitive { vertices, morph_targets, ..Primitive::default() }
    }

    pub(crate) fn model(&mut self) -> ModelData {
        let bones = self.list(4, Self::bone);
        let take = Take {
            start: self.number(),
            length: self.number(),
            tracks: self.list(4, Self::track),
            morphs: self.list(1, |maker| {
                let keys = maker.random.below(4);
                MorphTrack {
                    instance: 0,
                    targets: maker.index(3),
                    times: maker.times(keys).into(),
                    weights: maker.list(keys * 2, Self::number).into(),
                    interpolation: maker.interpolation(),
                }
            }),
            ..Take::default()
        };
        ModelData {
            meshes: vec![Mesh { primitives: vec![self.primitive()], ..Mesh::default() }],
            instances: self.list(1, |maker| MeshInstance {
                mesh: maker.index(1),
                node: None,
                skin: (maker.random.unit() < 0.7).then(|| maker.index(1)),
                bone: (maker.random.unit() < 0.7).then(|| maker.index(4)),
                to_bone: maker.matrix(),
                morph_weights: maker.list(2, Self::number),
            }),
            skins: vec![Skin {
                name: String::new(),
                bones: self.list(4, |maker| maker.index(4)),
                offsets: self.list(4, Self::matrix),
            }],
            animation: animation_data(bones, vec![take]),
            ..ModelData::default()
        }
    }
}

/// Evaluates `model` at `time` completely; returns the name of the first result that is not finite.
fn not_finite(model: &Arc<ModelData>, evaluator: &mut Evaluator, time: f32) -> Option<&'static str> {
    let take = &model.animation.takes[0];
    let inside = [PlayMode::Clamp, PlayMode::Loop].map(|mode| mode.map(take, time));
    evaluator.pose(Some(0), time);
    let animation = evaluator.animation_mut();
    let poses = animation.poses().iter().all(Transform::is_finite);
    let finals = animation.final_bone_poses(Some(0), time).iter().all(|matrix| matrix.is_finite());
    let binds = animation.bind_bone_poses().iter().all(|matrix| matrix.is_finite());
    let keyframes = take.tracks.iter().zip(&model.animation.skeleton.bones).all(|(track, bone)| {
        let key = keyframe_at(track, bone, time);
        key.time.is_finite() && key.pose.is_finite()
    });
    let (mut normals, mut tangents) = ([Vec3::ZERO; 3], [Vec4::ZERO; 3]);
    evaluator.normals(0, 0, &mut normals);
    if let Some(movement) = evaluator.movement(0, 0) {
        let primitive = &evaluator.primitives(0)[0];
        skin_tangents(primitive, movement, evaluator.morph_weights(0), &mut tangents);
    }
    let bounds = evaluator.bounds();
    [
        ("time", inside.iter().all(|time| time.is_finite())),
        ("pose", poses),
        ("to root", evaluator.to_root().iter().all(|matrix| matrix.is_finite())),
        ("final pose", finals && evaluator.final_poses(0).iter().all(|matrix| matrix.is_finite())),
        ("bind pose", binds),
        ("key-frame", keyframes),
        ("morph weight", evaluator.morph_weights(0).iter().all(|weight| weight.is_finite())),
        ("position", evaluator.all_positions().iter().all(|position| position.is_finite())),
        ("normal", normals.iter().all(|normal| normal.is_finite())),
        ("tangent", tangents.iter().all(|tangent| tangent.is_finite())),
        ("box", bounds.min.is_finite() && bounds.max.is_finite() && bounds.center().is_finite()),
        ("sphere", bounds.sphere.center.is_finite() && bounds.sphere.radius.is_finite()),
    ]
    .into_iter()
    .find_map(|(name, finite)| (!finite).then_some(name))
}

#[test]
fn a_hundred_thousand_invalid_clips_give_finite_numbers_and_no_panic() {
    let first = seed(0x00C1_1950);
    // Each clip has its own seed, so that a failure can be reproduced alone.
    let clips = if std::env::var_os("DRAGONFLY_LONG").is_some() { 10_000_000 } else { 100_000_u64 };
    for round in 0..clips {
        let seed = first.wrapping_add(round);
        let hostile = [0.02, 0.2, 0.6][(round % 3) as usize];
        let tried = std::panic::catch_unwind(|| {
            let mut maker = HostileModels { random: Random::new(seed), hostile };
            let model = Arc::new(maker.model());
            let time = maker.number();
            not_finite(&model, &mut Evaluator::new(Arc::clone(&model)), time)
        });
        match tried {
            Ok(None) => {}
            Ok(Some(what)) => panic!("DRAGONFLY_SEED={seed}: a {what} is not finite"),
            Err(_) => panic!("DRAGONFLY_SEED={seed}: panicked"),
        }
    }
}

/// The plain formulas, without any handling of invalid numbers.
fn bare(track: &Track, rest: Transform, time: f32) -> Transform {
    fn channel<T: Copy>(channel: &Channel<T>, rest: T, time: f32, mix: impl Fn(T, T, f32) -> T) -> T {
        let Some(keys) = find_keys(&channel.times, time) else { return rest };
        if keys.mix == 0.0 {
            channel.values[keys.before]
        } else {
            mix(channel.values[keys.before], channel.values[keys.after], keys.mix)
        }
    }
    Transform {
        translation: channel(&track.translation, rest.translation, time, mix::lerp),
        rotation: channel(&track.rotation, rest.rotation, time, mix::slerp),
        scale: channel(&track.scale, rest.scale, time, mix::lerp),
    }
}

#[test]
fn handling_of_invalid_numbers_changes_no_bit_of_valid_ones() {
    let seed = seed(5);
    println!("DRAGONFLY_SEED={seed}");
    let mut maker = HostileModels { random: Random::new(seed), hostile: 0.0 };
    for _ in 0..2_000 {
        let keys = 1 + maker.random.below(6);
        let times: Vec<f32> = (0..keys).map(|key| key as f32 * 0.1).collect();
        let track = Track {
            bone: 0,
            translation: Channel::new(
                times.clone(),
                (0..keys).map(|_| maker.vector()).collect::<Vec<_>>(),
                Interpolation::Linear,
            ),
            rotation: Channel::new(
                times.clone(),
                (0..keys).map(|_| maker.rotation().normalize()).collect::<Vec<_>>(),
                Interpolation::Linear,
            ),
            scale: Channel::new(
                times,
                (0..keys).map(|_| maker.vector()).collect::<Vec<_>>(),
                Interpolation::Linear,
            ),
        };
        let mut resting = bone("", None, maker.vector());
        resting.rest.rotation = maker.rotation().normalize();
        let parent = maker.matrix();
        for step in -1..=7 {
            let time = step as f32 * 0.083;
            let expected = bare(&track, resting.rest, time);
            let got = sample_track(&track, &resting, time);
            assert_eq!(got, expected, "{time}");
            // The products are the same too.
            let offset = maker.matrix();
            assert_eq!(dragonfly_anim::animation::final_pose(parent, offset), parent * offset);
        }
    }
}
