//! Tests of what each edit does.

use dragonfly_anim::data::{Interpolation, Take, Transform};
use dragonfly_anim::sample::sample_take;
use dragonfly_document::PoseChange;
use dragonfly_document::adapter::{EditError, ModelAdapter};
use dragonfly_document::edit::{
    AddKeys, BonePose, DeleteKeys, DeleteTake, Edit, KeyInterpolation, KeySet, MoveKeys, NewKey, OffsetPose,
    Property, ResetPose, ResetTo, RetimeTake, ReverseTake, RippleKeys, ScaleKeys, SetInterpolation, SetPose,
    SetTangents, SnapKeys, SplitTake, TakeRef, TrimTake,
};
use dragonfly_document::history::{Edited, Gesture};
use dragonfly_kit::document::made_take::{animation, bone, model, pose, walk};
use dragonfly_kit::random::Random;
use glam::{Quat, Vec3};
use std::sync::Arc;

fn set(time: f32, pose: BonePose) -> Edit {
    Edit::SetPose(SetPose { take: walk(), time, poses: vec![pose], unstep: false })
}

fn sampled(model: &ModelAdapter, take: &Take, time: f32) -> Vec<Transform> {
    let mut poses = vec![Transform::IDENTITY; model.skeleton().len()];
    sample_take(Some(take), model.skeleton(), time, &mut poses);
    poses
}

/// Returns the largest difference between the numbers of two poses; q and -q count as the same rotation.
fn apart(a: &[Transform], b: &[Transform]) -> f32 {
    let of = |(a, b): (&Transform, &Transform)| {
        let turn = (a.rotation - b.rotation).length().min((a.rotation + b.rotation).length());
        turn.max((a.translation - b.translation).length()).max((a.scale - b.scale).length())
    };
    a.iter().zip(b).map(of).fold(0.0, f32::max)
}

#[test]
fn an_unedited_document_shares_all_memory_with_the_loaded_model() {
    let animation = animation(&mut Random::new(1));
    let model = ModelAdapter::new(&animation);
    for (slot, take) in model.slots().iter().zip(&animation.takes) {
        assert!(Arc::ptr_eq(&slot.original, take) && Arc::ptr_eq(&slot.result, take));
    }
    assert_eq!(model.check(), Ok(()));
}

#[test]
fn setting_a_value_changes_the_result_and_not_the_original() {
    let mut model = model(2);
    let before = Arc::clone(&model.slots()[0].original);
    let turn = Quat::from_rotation_y(0.7);
    let wanted = BonePose {
        translation: Some([1.0, 2.0, 3.0]),
        rotation: Some(turn.to_array()),
        scale: Some([2.0, 0.5, 1.0]),
        ..pose("root")
    };
    model.apply(&set(0.25, wanted)).unwrap();
    model.check().unwrap();
    let slot = &model.slots()[0];
    let track = &slot.result.tracks[0];
    assert_eq!(track.translation.values[2], Vec3::new(1.0, 2.0, 3.0));
    assert!((track.rotation.values[2] - turn).length() < 1e-6);
    // The change is a factor, and no factor gives exactly this number; the nearest one differs in the last
    // bit.
    assert!((track.scale.values[2] - Vec3::new(2.0, 0.5, 1.0)).abs().max_element() < 2e-7);
    assert_eq!(*slot.original, *before);
    assert_eq!(slot.changes(0, Property::Translation).len(), 1);
    // Untouched data is shared memory.
    assert!(Arc::ptr_eq(&track.translation.times, &before.tracks[0].translation.times));
    assert!(Arc::ptr_eq(&slot.result.tracks[1].rotation.values, &before.tracks[1].rotation.values));
}

/// Returns an edit that poses the bone `name` in the take that does not move; `time` is in seconds, `x` in meters.
fn stands(name: &str, time: f32, x: f32, unstep: bool) -> Edit {
    let wanted = BonePose { translation: Some([x, 0.0, 0.0]), ..pose(name) };
    Edit::SetPose(SetPose { take: TakeRef::Name("stand".to_owned()), time, poses: vec![wanted], unstep })
}

#[test]
fn a_pose_on_a_constant_step_channel_is_interpolated() {
    let mut model = model(40);
    let between = |model: &ModelAdapter, bone: usize| {
        let slot = &model.slots()[2];
        let [at, middle] = [0.0, 0.25].map(|time| sampled(model, &slot.result, time)[bone].translation);
        (at, middle)
    };
    let before = between(&model, 1).0;
    model.apply(&stands("hip", 0.5, 9.0, true)).unwrap();
    model.check().unwrap();
    let (at, middle) = between(&model, 1);
    assert_eq!(at, before);
    assert!((middle - (before + Vec3::new(9.0, 0.0, 0.0)) * 0.5).length() < 1e-5, "{middle}");
    // Only the channel that got a pose is changed, and only if the edit requests it.
    let track = &model.slots()[2].result.tracks[1];
    assert_eq!(track.rotation.interpolation, Interpolation::Step);
    model.apply(&stands("root", 0.5, 9.0, false)).unwrap();
    let (at, middle) = between(&model, 0);
    assert_eq!(at, middle);
}

#[test]
fn deliberate_step_keys_stay_step_keys() {
    // A step channel whose two keys differ, because an edit has set one of them.
    let mut model = model(41);
    model.apply(&stands("hip", 0.5, 9.0, false)).unwrap();
    model.apply(&stands("hip", 0.7, 3.0, true)).unwrap();
    assert_eq!(model.slots()[2].result.tracks[1].translation.interpolation, Interpolation::Step);
    // A step channel with more than two keys, even if they are equal.
    let hand = BonePose { translation: Some([1.0; 3]), ..pose("hand.L") };
    model
        .apply(&Edit::SetPose(SetPose { take: walk(), time: 0.3, poses: vec![hand], unstep: true }))
        .unwrap();
    assert_eq!(model.slots()[0].result.tracks[2].translation.interpolation, Interpolation::Step);
}

#[test]
fn the_change_is_the_sum_of_offsets_and_the_product_of_rotations_and_scales() {
    let mut model = model(3);
    let wanted = BonePose {
        translation: Some([0.5, 0.0, 0.0]),
        rotation: Some(Quat::from_rotation_x(0.3).to_array()),
        scale: Some([2.0, 1.0, 1.0]),
        ..pose("hand.L")
    };
    model
        .apply(&Edit::OffsetPose(OffsetPose { take: walk(), time: 0.5, poses: vec![wanted], unstep: false }))
        .unwrap();
    model.check().unwrap();
    let slot = &model.slots()[0];
    let translation = slot.change(2, Property::Translation, 4);
    assert!((translation[0] - 0.5).abs() < 1e-6 && translation[1].abs() < 1e-6, "{translation:?}");
    let turn = Quat::from_array(slot.change(2, Property::Rotation, 4));
    assert!(turn.angle_between(Quat::from_rotation_x(0.3)) < 1e-3, "{turn}");
    let scale = slot.change(2, Property::Scale, 4);
    assert!((scale[0] - 2.0).abs() < 1e-6, "{scale:?}");
    assert_eq!(slot.change(2, Property::Translation, 3), [0.0; 4]);
}

#[test]
fn setting_the_current_value_changes_nothing_and_reset_restores_the_original() {
    let mut model = model(4);
    let value = model.slots()[0].original.tracks[0].translation.values[0];
    model.apply(&set(0.0, BonePose { translation: Some(value.to_array()), ..pose("root") })).unwrap();
    assert!(Arc::ptr_eq(&model.slots()[0].original, &model.slots()[0].result));
    model.apply(&set(0.0, BonePose { translation: Some([9.0, 9.0, 9.0]), ..pose("root") })).unwrap();
    let (bones, properties) = (vec![bone("root")], Vec::new());
    let reset = |to| {
        Edit::ResetPose(ResetPose {
            take: walk(),
            time: 0.0,
            bones: bones.clone(),
            properties: Vec::clone(&properties),
            to,
        })
    };
    model.apply(&reset(ResetTo::Original)).unwrap();
    assert!(Arc::ptr_eq(&model.slots()[0].original, &model.slots()[0].result));
    model.apply(&reset(ResetTo::Rest)).unwrap();
    model.check().unwrap();
    assert_eq!(model.slots()[0].result.tracks[0].translation.values[0], Vec3::Y);
}

#[test]
fn a_new_key_is_an_exact_copy_of_its_predecessor_in_original_change_and_result() {
    let mut model = model(5);
    model.apply(&set(0.25, BonePose { translation: Some([5.0, 6.0, 7.0]), ..pose("root") })).unwrap();
    let add = Edit::AddKeys(AddKeys {
        take: walk(),
        time: 0.3,
        bones: vec![bone("root")],
        properties: vec![Property::Translation],
        value: NewKey::Predecessor,
        keyed_only: false,
    });
    model.apply(&add).unwrap();
    model.check().unwrap();
    let slot = &model.slots()[0];
    let [original, result] = [&slot.original, &slot.result].map(|take| &take.tracks[0].translation);
    assert_eq!((original.times.len(), original.times[3]), (10, 0.3));
    assert_eq!(original.values[3], original.values[2]);
    assert_eq!(result.values[3], Vec3::new(5.0, 6.0, 7.0));
    assert_eq!(slot.change(0, Property::Translation, 3), slot.change(0, Property::Translation, 2));
    assert_eq!(model.apply(&add).unwrap_err(), EditError::Nothing("there are keys at that time"));
}

#[test]
fn keys_added_on_the_curve_do_not_change_the_motion() {
    let mut model = model(6);
    model.apply(&set(0.5, BonePose { translation: Some([1.0, 1.0, 1.0]), ..pose("hip") })).unwrap();
    let before = Arc::clone(&model.slots()[0].result);
    let add = |time| {
        Edit::AddKeys(AddKeys {
            take: walk(),
            time,
            bones: Vec::new(),
            properties: Vec::new(),
            value: NewKey::Current,
            keyed_only: false,
        })
    };
    for time in [0.05, 0.33, 0.45, 0.97] {
        model.apply(&add(time)).unwrap();
    }
    model.check().unwrap();
    for step in 0..=100 {
        let time = step as f32 * 0.01;
        let (old, new) = (sampled(&model, &before, time), sampled(&model, &model.slots()[0].result, time));
        // The spline of a rotation is normalized between its keys, so a new key changes the curve slightly.
        let bound = if (old[1].rotation - new[1].rotation).length() > 2e-5 { 0.05 } else { 2e-5 };
        assert!(apart(&old, &new) < bound, "{time}: {}", apart(&old, &new));
    }
}

#[test]
fn channels_that_share_key_times_still_share_them_after_edits() {
    let mut model = model(7);
    model
        .apply(&Edit::AddKeys(AddKeys {
            take: walk(),
            time: 0.2,
            bones: vec![bone("root"), bone("hip")],
            properties: Vec::new(),
            value: NewKey::Current,
            keyed_only: false,
        }))
        .unwrap();
    let tracks = &model.slots()[0].original.tracks;
    assert!(Arc::ptr_eq(&tracks[0].translation.times, &tracks[1].scale.times));
    model.apply(&Edit::RetimeTake(RetimeTake { take: walk(), start: None, length: Some(2.0) })).unwrap();
    let tracks = &model.slots()[0].original.tracks;
    assert!(Arc::ptr_eq(&tracks[0].translation.times, &tracks[1].scale.times));
}

#[test]
fn moved_keys_overwrite_keys_at_the_same_time() {
    let mut model = model(8);
    let values = model.slots()[0].original.tracks[0].translation.values.clone();
    let keys = vec![KeySet { bones: vec![bone("root")], at: Some(vec![0.25]), ..KeySet::default() }];
    model.apply(&Edit::MoveKeys(MoveKeys { take: walk(), keys, shapes: Vec::new(), by: 0.25 })).unwrap();
    model.check().unwrap();
    let channel = &model.slots()[0].original.tracks[0].translation;
    assert_eq!(&channel.times[..4], [0.0, 0.125, 0.375, 0.5]);
    assert_eq!(channel.values[3], values[2]);
    assert_eq!(channel.len(), 8);
}

#[test]
fn the_last_key_of_a_take_and_the_last_take_cannot_be_deleted() {
    let mut model = model(9);
    let all =
        Edit::DeleteKeys(DeleteKeys { take: walk(), keys: vec![KeySet::default()], shapes: Vec::new() });
    assert_eq!(model.apply(&all).unwrap_err(), EditError::LastKey);
    for name in ["walk", "stand"] {
        model.apply(&Edit::DeleteTake(DeleteTake { take: TakeRef::Name(name.to_owned()) })).unwrap();
    }
    let last = Edit::DeleteTake(DeleteTake { take: TakeRef::Index(0) });
    assert_eq!(model.apply(&last).unwrap_err(), EditError::LastTake);
}

#[test]
fn inserting_time_and_removing_it_restores_the_take() {
    let mut model = model(10);
    let before = Arc::clone(&model.slots()[0].result);
    model.apply(&Edit::RippleKeys(RippleKeys { take: walk(), from: 0.5, by: 0.25 })).unwrap();
    model.check().unwrap();
    assert_eq!(model.slots()[0].result.end(), 1.25);
    assert_eq!(model.slots()[0].result.morphs[0].times[4], 0.75);
    model.apply(&Edit::RippleKeys(RippleKeys { take: walk(), from: 0.75, by: -0.25 })).unwrap();
    model.check().unwrap();
    let after = &model.slots()[0].result;
    for (old, new) in before.tracks.iter().zip(&after.tracks) {
        assert_eq!(old.rotation.values, new.rotation.values);
    }
}

#[test]
fn trimming_a_take_to_one_time_keeps_the_pose_at_that_time() {
    let mut model = model(12);
    let before = Arc::clone(&model.slots()[0].result);
    let trim = Edit::TrimTake(TrimTake { take: walk(), from: 0.3, to: 0.3, to_start: false });
    model.apply(&trim).unwrap();
    model.check().unwrap();
    let after = &model.slots()[0].result;
    assert_eq!((after.start, after.length), (0.3, 0.0));
    assert!(apart(&sampled(&model, &before, 0.3), &sampled(&model, after, 0.3)) < 1e-5);
}

#[test]
fn a_trimmed_range_can_move_to_the_start_of_the_take() {
    let mut model = model(13);
    let before = Arc::clone(&model.slots()[0].result);
    model.apply(&Edit::TrimTake(TrimTake { take: walk(), from: 0.3, to: 0.8, to_start: true })).unwrap();
    model.check().unwrap();
    let after = &model.slots()[0].result;
    assert_eq!(after.start, before.start);
    assert!((after.length - 0.5).abs() < 1e-6);
    for time in [0.0, 0.2, 0.5] {
        assert!(apart(&sampled(&model, &before, time + 0.3), &sampled(&model, after, time)) < 1e-4, "{time}");
    }
}

#[test]
fn reversing_a_take_plays_it_backwards_and_reversing_twice_restores_it() {
    let mut model = model(11);
    let before = Arc::clone(&model.slots()[0].result);
    let reverse = Edit::ReverseTake(ReverseTake { take: walk() });
    model.apply(&reverse).unwrap();
    model.check().unwrap();
    let once = Arc::clone(&model.slots()[0].result);
    for step in 0..=40 {
        let time = step as f32 * 0.025;
        let (old, new) = (sampled(&model, &before, 1.0 - time), sampled(&model, &once, time));
        for linear_or_cubic in [0, 1, 3] {
            let apart =
                apart(&old[linear_or_cubic..=linear_or_cubic], &new[linear_or_cubic..=linear_or_cubic]);
            assert!(apart < 2e-4, "{time} {linear_or_cubic}: {apart}");
        }
    }
    model.apply(&reverse).unwrap();
    let twice = &model.slots()[0].result;
    for (old, new) in before.tracks.iter().zip(&twice.tracks) {
        assert_eq!(old.translation.values, new.translation.values);
    }
    assert_eq!(before.morphs[0].weights, twice.morphs[0].weights);
}

#[test]
fn the_two_parts_of_a_split_take_play_the_motion_of_the_whole() {
    let mut model = model(12);
    let before = Arc::clone(&model.slots()[0].result);
    model.apply(&Edit::SplitTake(SplitTake { take: walk(), time: 0.44, name: "end".to_owned() })).unwrap();
    model.check().unwrap();
    let [first, second] = [0, 1].map(|take| Arc::clone(&model.slots()[take].result));
    assert_eq!((second.name.as_str(), second.start), ("end", 0.0));
    assert!((first.end() - 0.44).abs() < 1e-6 && (second.end() - 0.56).abs() < 1e-6);
    for step in 0..=44 {
        let time = step as f32 * 0.01;
        assert!(
            apart(&sampled(&model, &before, time)[..1], &sampled(&model, &first, time)[..1]) < 1e-5,
            "{time}"
        );
        let later = 0.44 + time;
        assert!(
            apart(&sampled(&model, &before, later)[..1], &sampled(&model, &second, time)[..1]) < 1e-5,
            "{later}"
        );
    }
}

#[test]
fn converting_a_channel_to_a_spline_and_back_restores_it() {
    let mut model = model(13);
    model
        .apply(&set(0.5, BonePose { rotation: Some(Quat::from_rotation_z(1.0).to_array()), ..pose("root") }))
        .unwrap();
    let before = Arc::clone(&model.slots()[0].result);
    let to = |interpolation| {
        Edit::SetInterpolation(SetInterpolation {
            take: walk(),
            bones: vec![bone("root")],
            properties: Vec::new(),
            interpolation,
        })
    };
    model.apply(&to(KeyInterpolation::CubicSpline)).unwrap();
    model.check().unwrap();
    let spline = Arc::clone(&model.slots()[0].result);
    assert_eq!(spline.tracks[0].rotation.interpolation, Interpolation::CubicSpline);
    for key in 0..9 {
        let time = key as f32 * 0.125;
        assert!(apart(&sampled(&model, &before, time), &sampled(&model, &spline, time)) < 1e-6, "{time}");
    }
    let tangents = Edit::SetTangents(SetTangents {
        take: walk(),
        time: 0.25,
        bone: bone("root"),
        property: Property::Translation,
        arrive: Some(vec![1.0, 2.0, 3.0]),
        leave: None,
    });
    model.apply(&tangents).unwrap();
    model.check().unwrap();
    assert_eq!(model.slots()[0].result.tracks[0].translation.values[6], Vec3::new(1.0, 2.0, 3.0));
    model.apply(&to(KeyInterpolation::Linear)).unwrap();
    model.check().unwrap();
    assert_eq!(model.slots()[0].result.tracks[0].rotation.values, before.tracks[0].rotation.values);
}

#[test]
fn invalid_numbers_and_missing_targets_are_refused_and_nothing_changes() {
    let mut model = model(14);
    let before = Arc::clone(&model.slots()[0]);
    let translation = |x| BonePose { translation: Some([x, 0.0, 0.0]), ..pose("root") };
    let wrong = [
        set(f32::NAN, translation(0.0)),
        set(-1.0, translation(0.0)),
        set(0.1, translation(f32::INFINITY)),
        set(0.1, translation(1e30)),
        set(0.1, pose("root")),
        set(0.1, BonePose { rotation: Some([0.0; 4]), ..pose("root") }),
        set(0.1, pose("nobody")),
        Edit::SetPose(SetPose {
            take: TakeRef::Index(7),
            time: 0.0,
            poses: vec![translation(0.0)],
            unstep: false,
        }),
        Edit::MoveKeys(MoveKeys {
            take: walk(),
            keys: vec![KeySet::default()],
            shapes: Vec::new(),
            by: -0.5,
        }),
        Edit::MoveKeys(MoveKeys { take: walk(), keys: Vec::new(), shapes: Vec::new(), by: 0.5 }),
        Edit::ScaleKeys(ScaleKeys {
            take: walk(),
            keys: vec![KeySet::default()],
            shapes: Vec::new(),
            about: 0.0,
            factor: 0.0,
        }),
        Edit::SnapKeys(SnapKeys {
            take: walk(),
            keys: vec![KeySet::default()],
            shapes: Vec::new(),
            rate: 0.0,
        }),
        Edit::SplitTake(SplitTake { take: walk(), time: 1.0, name: String::new() }),
        Edit::TrimTake(TrimTake { take: walk(), from: 0.5, to: 0.25, to_start: false }),
        Edit::RetimeTake(RetimeTake { take: walk(), start: None, length: Some(1e-9) }),
        Edit::RetimeTake(RetimeTake { take: walk(), start: Some(-1.0), length: None }),
    ];
    for edit in wrong {
        let error = model.apply(&edit).expect_err(&format!("{edit:?}"));
        assert!(!error.to_string().is_empty());
        assert!(Arc::ptr_eq(&model.slots()[0], &before), "{edit:?} changed something");
    }
}

#[test]
fn the_amount_of_a_step_is_the_difference_that_it_makes_also_while_it_is_dragged() {
    let mut edited = Edited::new(model(3));
    let set = |degrees: f32| {
        let turn = Quat::from_rotation_z(degrees.to_radians()).to_array();
        let json = format!(
            r#"{{"edit":"set","take":0,"time":0.5,"poses":[{{"bone":0,"rotation":[{},{},{},{}]}}]}}"#,
            turn[0], turn[1], turn[2], turn[3]
        );
        serde_json::from_str::<Edit>(&json).expect("an edit")
    };
    let amount = |edited: &Edited| {
        let (steps, done) = edited.steps();
        let amount = steps[done - 1].amount.expect("a step with an amount");
        assert_eq!(amount.time, Some(0.5));
        match amount.change {
            Some(PoseChange::Rotation(by)) => by.to_scaled_axis().z.to_degrees(),
            other => panic!("{other:?}"),
        }
    };
    edited.apply(set(10.0), None).unwrap();
    // A drag to 40° in three moves, measured from its start.
    for degrees in [15.0, 30.0, 40.0] {
        edited.apply(set(degrees), Some(Gesture(7))).unwrap();
        assert!((amount(&edited) - (degrees - 10.0)).abs() < 1e-3, "{degrees}: {}", amount(&edited));
    }
    assert!(edited.undo());
    assert!(
        (edited.steps().0[1].amount.unwrap().time.unwrap() - 0.5).abs() < 1e-6,
        "undone, it keeps its text"
    );
}
