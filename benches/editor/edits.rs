//! Cost of edits in a take of 200 bones × 10 minutes × 120 keys per second: 43 million keys.

use dragonfly_anim::data::{AnimationData, Bone, Channel, Interpolation, Skeleton, Take, Track, Transform};
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::{
    BonePose, BoneRef, DuplicateKeys, Edit, KeySet, MoveKeys, Property, RippleKeys, ScaleKeys, SetPose,
    TakeRef,
};
use dragonfly_document::history::{Edited, Gesture};
use dragonfly_document::{Cancel, Source, load_model};
use dragonfly_kit::counting;
use dragonfly_kit::figures::FigureBench;
use glam::{Mat4, Quat, Vec3};
use std::sync::Arc;
use std::time::Instant;

const BONES: u32 = 200;
const RATE: usize = 120;
const SECONDS: usize = 600;

/// Runs `work` a few times. Keeps the times, and the allocations of the last run.
fn measure(bench: &mut FigureBench, task: &str, variant: &str, times: usize, mut work: impl FnMut(usize)) {
    if !bench.wants(task) {
        return;
    }
    let mut milliseconds = Vec::new();
    let mut last = counting::Count::default();
    for run in 0..times {
        let begin = Instant::now();
        (last, ()) = counting::count(|| work(run));
        milliseconds.push(begin.elapsed().as_secs_f64() * 1e3);
    }
    bench.times(task, variant, &milliseconds);
    bench.value(task, variant, "allocations", "count", last.allocations as f64);
    bench.value(task, variant, "allocated", "bytes", last.bytes as f64);
}

fn model(shared: bool) -> AnimationData {
    model_of(BONES, RATE * SECONDS, shared)
}

/// Returns the model. With `shared`, all channels share a column of times, as in files that sample
/// all bones at the same times.
fn model_of(bone_count: u32, keys: usize, shared: bool) -> AnimationData {
    let bones = (0..bone_count).map(|bone| Bone {
        name: format!("bone {bone}"),
        parent: bone.checked_sub(1),
        rest: Transform::IDENTITY,
        rest_matrix: None,
        offset: Mat4::IDENTITY,
        node: None,
    });
    let column = || -> Arc<[f32]> { (0..keys).map(|key| key as f32 / RATE as f32).collect() };
    let times = column();
    // The values do not matter, so all channels share them.
    let translation: Arc<[Vec3]> = (0..keys).map(|key| Vec3::splat(key as f32 * 1e-4)).collect();
    let rotation: Arc<[Quat]> = (0..keys).map(|key| Quat::from_rotation_y(key as f32 * 1e-4)).collect();
    let tracks = (0..bone_count).map(|bone| {
        let own = || if shared { Arc::clone(&times) } else { column() };
        let linear = Interpolation::Linear;
        Track {
            bone,
            translation: Channel::new(own(), Arc::clone(&translation), linear),
            rotation: Channel::new(own(), Arc::clone(&rotation), linear),
            scale: Channel::new(own(), Arc::clone(&translation), linear),
        }
    });
    let length = (keys - 1) as f32 / RATE as f32;
    let take = Take { name: "long".to_owned(), length, tracks: tracks.collect(), ..Take::default() };
    AnimationData { skeleton: Arc::new(Skeleton { bones: bones.collect() }), takes: vec![Arc::new(take)] }
}

fn take() -> TakeRef {
    TakeRef::Index(0)
}

/// Returns the last 500 keys of each of 200 channels: a set for each channel, which lists the times
/// of its keys.
fn chosen() -> Vec<KeySet> {
    let last = RATE * SECONDS;
    let set = |bone| KeySet {
        bones: vec![BoneRef::Index(bone)],
        properties: vec![Property::Rotation],
        at: Some((last - 500..last).map(|key| key as f32 / RATE as f32).collect()),
        ..KeySet::default()
    };
    (0..BONES).map(set).collect()
}

/// Returns the same keys, each as a set of its own.
fn one_by_one() -> Vec<KeySet> {
    let alone = |set: KeySet| {
        let times = set.at.clone().unwrap_or_default();
        times.into_iter().map(move |time| KeySet { at: Some(vec![time]), ..set.clone() })
    };
    chosen().into_iter().flat_map(alone).collect()
}

/// Number of bones and of keys of each channel: rigs whose keys are all dragged.
const RIGS: [(u32, usize); 3] = [(67, 100), (67, 300), (167, 200)];

/// Measures drags of all keys of a rig: the limit up to which the panels show an edit before the document answers follows from
/// these.
fn of_a_rig(bench: &mut FigureBench) {
    for (bones, keys) in RIGS {
        let data = model_of(bones, keys, true);
        let task = format!("rig/{} keys of {bones} bones", bones as usize * 3 * keys);
        let all = || vec![KeySet::default()];
        let mut drag = |what: &str, edit: &dyn Fn(f32) -> Edit| {
            let mut edited = Edited::new(ModelAdapter::new(&data));
            measure(bench, &task, what, 15, |run| {
                edited.apply(edit(run as f32), Some(Gesture(1))).expect("all keys can be moved");
            });
        };
        drag("move", &|run| {
            Edit::MoveKeys(MoveKeys { take: take(), keys: all(), shapes: Vec::new(), by: 0.01 + run * 0.25 })
        });
        drag("scale", &|run| {
            Edit::ScaleKeys(ScaleKeys {
                take: take(),
                keys: all(),
                shapes: Vec::new(),
                about: 0.0,
                factor: 0.9 + run * 0.02,
            })
        });
        drag("duplicate", &|run| {
            Edit::DuplicateKeys(DuplicateKeys {
                take: take(),
                keys: all(),
                shapes: Vec::new(),
                by: 0.003 + run * 0.25,
            })
        });
        drag("ripple", &|run| {
            Edit::RippleKeys(RippleKeys { take: take(), from: 0.0, by: 0.01 + run * 0.25 })
        });
    }
}

/// Measures every case.
pub(crate) fn run(bench: &mut FigureBench) {
    let (same, apart) = (model(true), model(false));
    for (name, data) in [("one column of times", &same), ("a column of times each", &apart)] {
        let mut edited = Edited::new(ModelAdapter::new(data));
        let keys = chosen();
        measure(bench, "drag_100_000_keys", name, 9, |run| {
            let by = 0.01 + run as f32 * 0.25;
            let edit = Edit::MoveKeys(MoveKeys { take: take(), keys: keys.clone(), shapes: Vec::new(), by });
            edited.apply(edit, Some(Gesture(1))).expect("keys at the end move freely");
        });
        let mut edited = Edited::new(ModelAdapter::new(data));
        measure(bench, "move_100_000_keys_among_others", name, 5, |run| {
            let by = -10.0 - run as f32;
            let edit = Edit::MoveKeys(MoveKeys { take: take(), keys: keys.clone(), shapes: Vec::new(), by });
            edited.apply(edit, Some(Gesture(1))).expect("keys move among others");
        });
    }
    of_a_rig(bench);
    let mut edited = Edited::new(ModelAdapter::new(&same));
    let keys = one_by_one();
    measure(bench, "drag_100_000_keys", "named one by one", 5, |run| {
        let edit = Edit::MoveKeys(MoveKeys {
            take: take(),
            keys: keys.clone(),
            shapes: Vec::new(),
            by: 0.01 + run as f32 * 0.25,
        });
        edited.apply(edit, Some(Gesture(1))).expect("keys at the end move freely");
    });
    // The whole take is larger than what can be saved, so that a new key would be refused.
    let half = model_of(BONES, RATE * SECONDS / 2, true);
    for (name, time) in [("at a key", 200.0), ("between keys", 200.004)] {
        let mut edited = Edited::new(ModelAdapter::new(&half));
        let mut shown = Vec::new();
        measure(bench, "drag_a_pose", name, 200, |run| {
            let rotation = Some(Quat::from_rotation_x(run as f32 * 0.01).to_array());
            let pose = BonePose { bone: BoneRef::Index(7), translation: None, rotation, scale: None };
            let edit = Edit::SetPose(SetPose { take: take(), time, poses: vec![pose], unstep: false });
            edited.apply(edit, Some(Gesture(1))).expect("a pose can be set");
            // Two old versions stay in memory: those that the panels and the viewport still show.
            if shown.len() == 2 {
                shown.remove(0);
            }
            shown.push(edited.adapter().slots()[0].clone());
        });
    }
    measure(bench, "start_the_history", "one column of times", 9, |_| {
        drop(Edited::new(ModelAdapter::new(&same)));
    });
    measure(bench, "open", "the built-in model", 400, |_| {
        let model = load_model(&Source::BuiltIn, &mut |_| {}, &Cancel::default());
        drop(model.expect("part of the program"));
    });
}
