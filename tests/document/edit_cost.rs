//! Costs of edits: memory and time in proportion to the keys that they touch.

use dragonfly_anim::data::{AnimationData, Bone, Channel, Interpolation, Skeleton, Take, Track, Transform};
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::{BonePose, BoneRef, Edit, KeySet, MoveKeys, Property, SetPose, TakeRef};
use dragonfly_document::history::{Edited, Gesture};
use dragonfly_kit::counting;
use dragonfly_kit::document::made_take::pose;
use glam::{Mat4, Quat, Vec3};
use std::sync::Arc;
use std::time::Instant;

/// Returns a take with `bones` bones and `keys` keys in each of their channels, which share one column of times.
fn model(bones: u32, keys: usize) -> AnimationData {
    let bone = |bone: u32| Bone {
        name: format!("bone {bone}"),
        parent: bone.checked_sub(1),
        rest: Transform::IDENTITY,
        rest_matrix: None,
        offset: Mat4::IDENTITY,
        node: None,
    };
    let times: Arc<[f32]> = (0..keys).map(|key| key as f32 / 120.0).collect();
    let linear = Interpolation::Linear;
    let track = |bone| Track {
        bone,
        translation: Channel::new(Arc::clone(&times), vec![Vec3::ONE; keys], linear),
        rotation: Channel::new(Arc::clone(&times), vec![Quat::IDENTITY; keys], linear),
        scale: Channel::new(Arc::clone(&times), vec![Vec3::ONE; keys], linear),
    };
    let length = (keys - 1) as f32 / 120.0;
    let take = Take { length, tracks: (0..bones).map(track).collect(), ..Take::default() };
    AnimationData {
        skeleton: Arc::new(Skeleton { bones: (0..bones).map(bone).collect() }),
        takes: vec![Arc::new(take)],
    }
}

fn turned(bone: u32, by: f32) -> BonePose {
    let rotation = Some(Quat::from_rotation_x(by).to_array());
    BonePose { bone: BoneRef::Index(bone), rotation, ..pose("") }
}

#[test]
fn an_unedited_document_needs_almost_no_memory_of_its_own() {
    let (original, data) = counting::peak(|| model(50, 2000));
    let (more, edited) = counting::peak(|| Edited::new(ModelAdapter::new(&data)));
    assert!(more * 5 < original, "{more} bytes beside {original}");
    assert_eq!(edited.adapter().slots().len(), 1);
}

#[test]
fn the_memory_of_an_edit_is_proportional_to_the_keys_it_touches() {
    let kept = |bones: u32| {
        let data = model(bones, 2000);
        let mut edited = Edited::new(ModelAdapter::new(&data));
        let (peak, ()) = counting::peak(|| {
            let edit = Edit::SetPose(SetPose {
                take: TakeRef::Index(0),
                time: 1.0,
                poses: vec![turned(3, 0.5)],
                unstep: true,
            });
            edited.apply(edit, None).unwrap();
        });
        peak
    };
    // A column of rotations, and the table of columns: 128 bytes per bone.
    let (few, many) = (kept(10), kept(500));
    assert!(few < 3 * 2000 * 16, "{few}");
    assert!(many - few < 500 * 1000, "{few} with 10 bones, {many} with 500");
}

#[test]
fn a_mouse_move_in_a_drag_allocates_a_constant_amount() {
    let bytes = |bones: u32, keys: usize, time: f32| {
        let data = model(bones, keys);
        let mut edited = Edited::new(ModelAdapter::new(&data));
        let mut shown = Vec::new();
        let mut most = 0;
        for step in 0..40 {
            let poses = vec![turned(3, step as f32 * 0.01), turned(4, step as f32 * 0.02)];
            let edit = Edit::SetPose(SetPose { take: TakeRef::Index(0), time, poses, unstep: true });
            let (count, done) = counting::count(|| edited.apply(edit, Some(Gesture(1))));
            done.unwrap();
            // The first moves also allocate memory for the versions that are shown at the same time.
            if step >= 8 {
                most = most.max(count.bytes);
            }
            // The panels and the viewport each show one state.
            if shown.len() == 2 {
                shown.remove(0);
            }
            shown.push(Arc::clone(&edited.adapter().slots()[0]));
        }
        most
    };
    for time in [0.5, 0.503] {
        let small = bytes(10, 100, time);
        assert_eq!(small, bytes(300, 100, time), "more bones");
        assert_eq!(small, bytes(10, 20_000, time), "more keys");
        assert!(small < 2000, "{small} bytes a move");
    }
}

#[test]
fn an_edit_of_all_bones_allocates_in_proportion_to_their_number() {
    let bytes = |bones: u32| {
        let mut edited = Edited::new(ModelAdapter::new(&model(bones, 10)));
        let edit = Edit::MoveKeys(MoveKeys {
            take: TakeRef::Index(0),
            keys: vec![KeySet::default()],
            shapes: Vec::new(),
            by: 0.5,
        });
        let (count, done) = counting::count(|| edited.apply(edit, Some(Gesture(1))));
        done.unwrap();
        count.bytes
    };
    let (few, many) = (bytes(100), bytes(400));
    assert!(
        many < few * 5,
        "{few} bytes with 100 bones, {many} with 400: the take is copied for each channel"
    );
}

#[test]
fn moving_a_hundred_thousand_keys_causes_no_visible_delay() {
    let data = model(200, 1500);
    let mut edited = Edited::new(ModelAdapter::new(&data));
    let set = |bone| KeySet {
        bones: vec![BoneRef::Index(bone)],
        properties: vec![Property::Rotation],
        at: Some((1000..1500).map(|key| key as f32 / 120.0).collect()),
        ..KeySet::default()
    };
    let keys: Vec<KeySet> = (0..200).map(set).collect();
    let quickest = (0..5)
        .map(|step| {
            let by = 0.01 + step as f32 * 0.1;
            let edit = Edit::MoveKeys(MoveKeys {
                take: TakeRef::Index(0),
                keys: keys.clone(),
                shapes: Vec::new(),
                by,
            });
            let begin = Instant::now();
            edited.apply(edit, Some(Gesture(1))).unwrap();
            begin.elapsed()
        })
        .min()
        .unwrap();
    assert_eq!(edited.adapter().check(), Ok(()));
    let track = &edited.adapter().slots()[0].result.tracks[7];
    assert!((track.rotation.times[1000] - (1000.0 / 120.0 + 0.41)).abs() < 1e-4);
    assert_eq!(track.translation.times[1000], 1000.0 / 120.0);
    assert!(quickest.as_millis() < 250, "{quickest:?}: seconds once, milliseconds now");
}
