//! The fast path, at every level of the machine.

use crate::case::Case;
use crate::model::Subject;
use crate::open::FRAMES;
use dragonfly_anim::data::Take;
use dragonfly_anim::fast::matrix::transform_point;
use dragonfly_anim::fast::simd::Level;
use dragonfly_anim::fast::{
    Binding, KeyedTake, LaneMask, Playing, Pose, PoseLayer, Rig, RootPoses, Scratch, SkinnedVertices,
    TwoBone, add, blend, difference, final_poses, matrix, pose_character, pose_crowd, sample, skin_vertices,
    to_root, two_bone,
};
use dragonfly_anim::sample::loop_time;
use dragonfly_kit::random::Random;
use glam::Vec3;
use std::hint::black_box;
use std::sync::Arc;

/// Orders in which a take's times come: forward and backward at 60 Hz, and at random.
pub(crate) fn ways(take: &Take) -> [(&'static str, Vec<f32>); 3] {
    let at = |frame: usize| loop_time(take.start + frame as f32 / 60.0, take.start, take.length);
    let mut random = Random::new(7);
    let forward: Vec<f32> = (0..FRAMES).map(at).collect();
    let backward = forward.iter().rev().copied().collect();
    let anywhere = (0..256).map(|_| take.start + random.unit() * take.length).collect();
    [("forward", forward), ("backward", backward), ("random", anywhere)]
}

/// A subject brought to the layout of the fast path.
pub(crate) struct Ready {
    pub(crate) rig: Rig,
    pub(crate) binding: Binding,
    pub(crate) takes: Vec<KeyedTake>,
}

impl Ready {
    pub(crate) fn new(subject: &Subject) -> Arc<Self> {
        let animation = &subject.model.animation;
        let rig = Rig::new(&animation.skeleton);
        let binding = Binding::new(&rig, subject.skin());
        let takes = animation.takes.iter().map(|take| KeyedTake::new(&animation.skeleton, take)).collect();
        Arc::new(Self { rig, binding, takes })
    }

    /// The pose of take `take`, a part `part` of its length in.
    pub(crate) fn pose(&self, subject: &Subject, take: usize, part: f32) -> Pose {
        let mut pose = self.rig.rest().clone();
        let times = &subject.model.animation.takes[take % self.takes.len()];
        let time = times.start + times.length * part;
        sample(Level::best(), &self.takes[take % self.takes.len()], time, pose.blocks_mut());
        pose
    }
}

pub(crate) fn cases(subject: &Subject) -> Vec<Case> {
    let ready = Ready::new(subject);
    Level::all().into_iter().flat_map(|level| at_level(subject, &ready, level)).collect()
}

fn at_level(subject: &Subject, ready: &Arc<Ready>, level: Level) -> Vec<Case> {
    let mut cases = sampling(subject, ready, level);
    cases.extend(matrices(subject, ready, level));
    cases.extend(blending(subject, ready, level));
    cases.extend(additive(subject, ready, level));
    cases.push(limb(subject, ready, level));
    cases.extend(skinning(subject, ready, level));
    cases.push(one_character(subject, ready, level));
    cases.push(one_blended_character(subject, ready, level));
    cases.extend([100, 1_000].map(|count| crowd(subject, ready, level, count)));
    cases
}

fn sampling(subject: &Subject, ready: &Arc<Ready>, level: Level) -> Vec<Case> {
    let mut cases = Vec::new();
    for (index, take) in subject.short_and_long() {
        for (way, times) in ways(take) {
            let (ready, mut pose) = (Arc::clone(ready), ready.rig.rest().clone());
            let name = format!("{}/sample/{}/{}/{way}", level.name(), subject.name, take.name);
            cases.push(Case::new(name, subject.bones() * times.len(), "bone", move || {
                for &time in &times {
                    sample(level, &ready.takes[index], time, pose.blocks_mut());
                    black_box(&pose);
                }
            }));
        }
    }
    cases
}

fn matrices(subject: &Subject, ready: &Arc<Ready>, level: Level) -> [Case; 2] {
    let pose = ready.pose(subject, 0, 0.4);
    let mut roots = RootPoses::new(&ready.rig);
    to_root(level, &ready.rig, pose.blocks(), &mut roots);
    let mut finals = vec![matrix::IDENTITY; ready.binding.joints()];
    let (first, second, mut to) = (Arc::clone(ready), Arc::clone(ready), roots.clone());
    let (name, path) = (subject.name, level.name());
    [
        Case::new(format!("{path}/to_root/{name}"), subject.bones(), "bone", move || {
            to_root(level, &first.rig, pose.blocks(), &mut to);
            black_box(&to);
        }),
        Case::new(format!("{path}/final/{name}"), finals.len(), "joint", move || {
            final_poses(level, &second.binding, &roots, &mut finals);
            black_box(&finals);
        }),
    ]
}

fn blending(subject: &Subject, ready: &Arc<Ready>, level: Level) -> Vec<Case> {
    let poses: Arc<Vec<Pose>> = Arc::new((0..4).map(|take| ready.pose(subject, take, 0.3)).collect());
    let mask = Arc::new(LaneMask::new((0..subject.bones()).map(|bone| (bone % 4) as f32 / 3.0)));
    let mut cases = Vec::new();
    for (count, masked) in [(2, false), (4, false), (2, true), (4, true)] {
        let (ready, poses, mask) = (Arc::clone(ready), Arc::clone(&poses), Arc::clone(&mask));
        let mut out = ready.rig.rest().clone();
        let how = if masked { "masked" } else { "whole" };
        let name = format!("{}/blend/{}/{count}/{how}", level.name(), subject.name);
        cases.push(Case::new(name, subject.bones(), "bone", move || {
            let layer = |at: usize| PoseLayer {
                pose: poses[at].blocks(),
                weight: [0.4, 0.3, 0.2, 0.1][at],
                mask: masked.then_some(&mask),
            };
            let layers = [0, 1, 2, 3].map(layer);
            blend(level, ready.rig.rest().blocks(), &layers[..count], out.blocks_mut());
            black_box(&out);
        }));
    }
    cases
}

/// A difference between two takes added to a third: wholly, and in part.
fn additive(subject: &Subject, ready: &Arc<Ready>, level: Level) -> Vec<Case> {
    let [one, two, three] = [0, 1, 2].map(|take| ready.pose(subject, take, 0.3));
    let mut more = three.clone();
    difference(level, two.blocks(), one.blocks(), more.blocks_mut());
    let mut cases = Vec::new();
    for (how, weight) in [("whole", 1.0), ("part", 0.6)] {
        let (more, three, mut out) = (more.clone(), three.clone(), three.clone());
        let name = format!("{}/additive/{}/{how}", level.name(), subject.name);
        cases.push(Case::new(name, subject.bones(), "bone", move || {
            add(level, three.blocks(), more.blocks(), weight, None, out.blocks_mut());
            black_box(&out);
        }));
    }
    cases
}

/// The deepest bone, its parent and its grandparent reach for a point beside it, with a pole.
fn limb(subject: &Subject, ready: &Arc<Ready>, level: Level) -> Case {
    let mut pose = ready.pose(subject, 0, 0.4);
    let mut roots = RootPoses::new(&ready.rig);
    to_root(level, &ready.rig, pose.blocks(), &mut roots);
    let of = |bone: usize| ready.rig.parent(bone);
    let long = |&bone: &usize| {
        let chain = of(bone).and_then(|middle| Some((middle, of(middle)?)));
        chain.is_some_and(|(middle, root)| {
            let [a, b, c] = [root, middle, bone].map(|at| transform_point(roots.get(at), Vec3::ZERO));
            (b - a).length() > 1e-3 && (c - b).length() > 1e-3
        })
    };
    let end = (0..subject.bones()).rev().find(long).expect("a limb of three bones");
    let middle = of(end).unwrap_or_default();
    let root = of(middle).unwrap_or_default();
    let place = |bone: usize| transform_point(roots.get(bone), Vec3::ZERO);
    let target = place(end).lerp(place(root), 0.3);
    let limb =
        TwoBone { pole: Vec3::new(0.2, 1.0, 0.3), ..TwoBone::new(root as u32, middle as u32, end as u32) };
    Case::new(format!("{}/two_bone/{}", level.name(), subject.name), 1, "solve", move || {
        black_box(two_bone(&limb, black_box(target), &roots, &mut pose));
    })
}

/// With the strongest 1, 2 and 4 influences of each vertex.
fn skinning(subject: &Subject, ready: &Arc<Ready>, level: Level) -> Vec<Case> {
    let mut roots = RootPoses::new(&ready.rig);
    to_root(level, &ready.rig, ready.pose(subject, 0, 0.4).blocks(), &mut roots);
    let mut finals = vec![matrix::IDENTITY; ready.binding.joints()];
    final_poses(level, &ready.binding, &roots, &mut finals);
    let mut cases = Vec::new();
    for most in [1, 2, 4] {
        let mut primitive = subject.primitive().clone();
        let each = primitive.vertices.influences_per_vertex.max(1);
        for vertex in primitive.vertices.influences.chunks_mut(each) {
            for (at, influence) in vertex.iter_mut().enumerate() {
                // No zero among the first: all of them are to be computed.
                influence.weight = if at < most { 1.0 / most as f32 } else { 0.0 };
            }
        }
        let (vertices, finals) = (SkinnedVertices::new(&primitive), finals.clone());
        let (mut positions, mut normals) = (vec![[0.0; 3]; vertices.len()], vec![[0.0; 3]; vertices.len()]);
        let name = format!("{}/skin/{}/{most}", level.name(), subject.name);
        cases.push(Case::new(name, vertices.len(), "vertex", move || {
            skin_vertices(level, &vertices, &finals, &mut positions, &mut normals);
            black_box((&positions, &normals));
        }));
    }
    cases
}

fn one_character(subject: &Subject, ready: &Arc<Ready>, level: Level) -> Case {
    let (ready, mut scratch) = (Arc::clone(ready), Scratch::new(&ready.rig));
    let mut finals = vec![matrix::IDENTITY; ready.binding.joints()];
    let (_, times) = ways(&subject.model.animation.takes[0])[0].clone();
    Case::new(format!("{}/pipeline/{}/1", level.name(), subject.name), FRAMES, "character", move || {
        for &time in &times {
            let layers = [Playing::new(&ready.takes[0], time)];
            pose_character(level, &ready.rig, &ready.binding, &layers, &mut scratch, &mut finals);
            black_box(&finals);
        }
    })
}

fn one_blended_character(subject: &Subject, ready: &Arc<Ready>, level: Level) -> Case {
    let (ready, mut scratch) = (Arc::clone(ready), Scratch::new(&ready.rig));
    let mut finals = vec![matrix::IDENTITY; ready.binding.joints()];
    let (_, times) = ways(&subject.model.animation.takes[0])[0].clone();
    let second = 1 % ready.takes.len();
    Case::new(
        format!("{}/pipeline/{}/1_of_2_takes", level.name(), subject.name),
        FRAMES,
        "character",
        move || {
            for &time in &times {
                let half = |take: usize| Playing { weight: 0.5, ..Playing::new(&ready.takes[take], time) };
                let layers = [half(0), half(second)];
                pose_character(level, &ready.rig, &ready.binding, &layers, &mut scratch, &mut finals);
                black_box(&finals);
            }
        },
    )
}

/// Who plays what in a crowd: a take, its time, and how fast it goes. The longest take is left out, as for the sketch.
pub(crate) fn cast(subject: &Subject, count: usize) -> Vec<(usize, f32, f32)> {
    let mut random = Random::new(3);
    let takes = &subject.model.animation.takes;
    let kinds = takes.len().clamp(1, 3);
    (0..count)
        .map(|index| (index % kinds, random.unit() * takes[index % kinds].length, random.between(0.8, 1.2)))
        .collect()
}

fn crowd(subject: &Subject, ready: &Arc<Ready>, level: Level, count: usize) -> Case {
    let (ready, mut scratch) = (Arc::clone(ready), Scratch::new(&ready.rig));
    let mut finals = vec![matrix::IDENTITY; ready.binding.joints() * count];
    let mut cast = cast(subject, count);
    let lengths: Vec<f32> = subject.model.animation.takes.iter().map(|take| take.length).collect();
    let name = format!("{}/pipeline/{}/{count}", level.name(), subject.name);
    // The takes live as long as the closure that plays them, which a list of references to them cannot say.
    let ready: &'static Ready = Box::leak(Box::new(Ready {
        rig: ready.rig.clone(),
        binding: ready.binding.clone(),
        takes: ready.takes.clone(),
    }));
    let mut playing: Vec<[Playing<'static, KeyedTake>; 1]> =
        cast.iter().map(|&(take, time, _)| [Playing::new(&ready.takes[take], time)]).collect();
    Case::new(name, count, "character", move || {
        for ((take, time, speed), playing) in cast.iter_mut().zip(&mut playing) {
            *time += *speed / 60.0;
            if *time >= lengths[*take] {
                *time -= lengths[*take];
            }
            playing[0].time = *time;
        }
        let characters = playing.iter().map(|layers| layers.as_slice());
        pose_crowd(level, &ready.rig, &ready.binding, characters, &mut scratch, &mut finals);
        black_box(&finals);
    })
}
