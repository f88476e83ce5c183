//! The edits of in-betweens: which keys they change, and that neutral settings change nothing.

use dragonfly_anim::data::{Channel, Take};
use dragonfly_anim::sample::sample_channel;
use dragonfly_document::adapter::{EditError, ModelAdapter};
use dragonfly_document::edit::{
    BlendKeys, BonePose, CurveFilter, Edit, FilterKeys, KeyInterpolation, KeySet, KeyTarget, NoiseKeys,
    Property, ResampleKeys, SetInterpolation, TakeRef,
};
use dragonfly_kit::document::made_take::{bone, model, pose, walk};
use glam::{Quat, Vec3};
use std::sync::Arc;

/// Returns the keys of a bone from one time to another.
fn keys(name: &str, from: f32, to: f32) -> Vec<KeySet> {
    vec![KeySet { bones: vec![bone(name)], from: Some(from), to: Some(to), ..KeySet::default() }]
}

fn blend(keys: Vec<KeySet>, toward: KeyTarget, factor: f32) -> Edit {
    Edit::BlendKeys(BlendKeys { take: walk(), keys, shapes: Vec::new(), toward, factor, hold: Vec::new() })
}

fn filter(keys: Vec<KeySet>, filter: CurveFilter) -> Edit {
    Edit::FilterKeys(FilterKeys {
        take: walk(),
        keys,
        shapes: Vec::new(),
        filter,
        rate: None,
        hold: Vec::new(),
    })
}

fn shown(model: &ModelAdapter) -> Arc<Take> {
    Arc::clone(&model.slots()[0].result)
}

fn values(channel: &Channel<Vec3>) -> Vec<Vec3> {
    (0..channel.len()).filter_map(|key| channel.value(key)).collect()
}

#[test]
fn neutral_settings_change_nothing() {
    let all = || vec![KeySet::default()];
    let shapes = || vec![[0.0, 1.0]];
    let noise = NoiseKeys {
        take: walk(),
        keys: all(),
        shapes: shapes(),
        translation: 0.0,
        rotation: 0.0,
        scale: 0.0,
        frequency: 3.0,
        seed: 1,
        hold: Vec::new(),
    };
    let blends = [
        KeyTarget::Between(0.3),
        KeyTarget::AwayFromLine,
        KeyTarget::Average,
        KeyTarget::Previous,
        KeyTarget::SlowStart,
        KeyTarget::Rest,
        KeyTarget::Pose(vec![BonePose { rotation: Some([1.0, 0.0, 0.0, 0.0]), ..pose("hip") }]),
        KeyTarget::OtherTake { take: TakeRef::Index(1), later: 0.0 },
        KeyTarget::Delayed(0.2),
    ];
    let blends = blends.map(|toward| {
        Edit::BlendKeys(BlendKeys {
            take: walk(),
            keys: all(),
            shapes: shapes(),
            toward,
            factor: 0.0,
            hold: Vec::new(),
        })
    });
    let filters =
        [CurveFilter::Gaussian(0.0), CurveFilter::Butterworth { cutoff: 1e4, order: 2 }].map(|filter| {
            Edit::FilterKeys(FilterKeys {
                take: walk(),
                keys: all(),
                shapes: shapes(),
                filter,
                rate: None,
                hold: Vec::new(),
            })
        });
    for edit in blends.into_iter().chain(filters).chain([Edit::NoiseKeys(noise)]) {
        let (before, mut after) = (model(5), model(5));
        after.apply(&edit).expect("a valid edit");
        let slot = &after.slots()[0];
        assert_eq!(slot.changed().count(), 0, "{edit:?}");
        assert_eq!(slot.result, before.slots()[0].result, "{edit:?}");
    }
}

#[test]
fn only_selected_keys_change() {
    let mut model = model(6);
    let before = shown(&model);
    model.apply(&blend(keys("root", 0.2, 0.4), KeyTarget::Between(0.5), 1.0)).expect("keys are there");
    let after = shown(&model);
    assert_eq!(after.tracks[1..], before.tracks[1..]);
    let (old, new) = (values(&before.tracks[0].translation), values(&after.tracks[0].translation));
    let middle = (old[1] + old[4]) * 0.5;
    for key in 0..9 {
        if key == 2 || key == 3 {
            assert!((new[key] - middle).length() < 1e-6, "{key}");
        } else {
            assert_eq!(new[key], old[key], "{key}");
        }
    }
    let turn = Quat::slerp(before.tracks[0].rotation.values[1], before.tracks[0].rotation.values[4], 0.5);
    assert!(after.tracks[0].rotation.values[2].dot(turn).abs() > 1.0 - 1e-6);
}

#[test]
fn tangents_that_make_a_spline_smooth_do_so_after_its_keys_were_blended() {
    let mut model = model(7);
    let smooth = |name: &str, interpolation| {
        Edit::SetInterpolation(SetInterpolation {
            take: walk(),
            bones: vec![bone(name)],
            properties: Vec::new(),
            interpolation,
        })
    };
    model.apply(&smooth("root", KeyInterpolation::CubicSpline)).expect("a channel");
    model.apply(&blend(keys("root", 0.0, 1.0), KeyTarget::Average, 1.0)).expect("keys are there");
    let blended = shown(&model);
    // The tangents that the spline of these values gets by itself.
    model.apply(&smooth("root", KeyInterpolation::Linear)).expect("a channel");
    model.apply(&smooth("root", KeyInterpolation::CubicSpline)).expect("a channel");
    let made = shown(&model);
    for at in 0..27 {
        let track = |take: &Take| (take.tracks[0].translation.values[at], take.tracks[0].rotation.values[at]);
        let ((translation, turn), (wanted, wanted_turn)) = (track(&blended), track(&made));
        assert!((translation - wanted).length() < 1e-4, "{at}: {translation} {wanted}");
        assert!((turn - wanted_turn).length() < 1e-4, "{at}: {turn} {wanted_turn}");
    }
}

#[test]
fn a_key_blended_to_a_pose_or_another_take_has_its_value() {
    let mut model = model(8);
    let turn = Quat::from_rotation_y(0.7);
    let wanted = BonePose { rotation: Some(turn.to_array()), ..pose("root") };
    let (before, keys) = (shown(&model), || keys("root", 0.2, 0.3));
    model.apply(&blend(keys(), KeyTarget::Pose(vec![wanted]), 1.0)).expect("keys are there");
    let after = shown(&model);
    assert!(after.tracks[0].rotation.values[2].dot(turn).abs() > 1.0 - 1e-6);
    assert_eq!(after.tracks[0].translation, before.tracks[0].translation);
    let toward = KeyTarget::OtherTake { take: TakeRef::Name("wave".to_owned()), later: 0.0 };
    model.apply(&blend(keys(), toward, 1.0)).expect("keys are there");
    let other = model.slots()[1].result.tracks[0].translation.values[0];
    assert!((shown(&model).tracks[0].translation.values[2] - other).length() < 1e-6);
}

#[test]
fn delayed_keys_have_the_values_of_earlier_times() {
    let mut model = model(9);
    let before = shown(&model);
    model.apply(&blend(keys("root", 0.2, 0.6), KeyTarget::Delayed(0.1), 1.0)).expect("keys are there");
    let after = shown(&model);
    let (old, new) = (&before.tracks[0].translation, &after.tracks[0].translation);
    for key in 2..=4 {
        let wanted = sample_channel(old, Vec3::ZERO, old.times[key] - 0.1);
        assert!((new.values[key] - wanted).length() < 1e-6, "{key}");
    }
}

#[test]
fn a_filter_smooths_the_selected_keys_by_the_whole_curve_and_keeps_the_others() {
    let mut model = model(10);
    let before = shown(&model);
    model.apply(&filter(keys("root", 0.2, 0.7), CurveFilter::Gaussian(0.125))).expect("keys are there");
    let after = shown(&model);
    // The difference of the differences from one key to the next: how rough the curve is.
    let rough = |take: &Take| -> f32 {
        let values = values(&take.tracks[0].translation);
        values[1..8].windows(3).map(|keys| (keys[0] - 2.0 * keys[1] + keys[2]).length()).sum()
    };
    assert!(rough(&after) < 0.7 * rough(&before), "{} {}", rough(&after), rough(&before));
    for key in [0, 1, 6, 7, 8] {
        assert_eq!(after.tracks[0].translation.values[key], before.tracks[0].translation.values[key]);
    }
    assert_eq!(after.tracks[0].translation.times, before.tracks[0].translation.times);
}

#[test]
fn weights_of_shapes_are_blended_where_their_keys_are_selected() {
    let mut model = model(11);
    let before = shown(&model);
    let edit = |toward, factor| {
        Edit::BlendKeys(BlendKeys {
            take: walk(),
            keys: Vec::new(),
            shapes: vec![[0.2, 0.3]],
            toward,
            factor,
            hold: Vec::new(),
        })
    };
    let undo = model.apply(&edit(KeyTarget::Between(0.5), 1.0)).expect("keys are there");
    let (old, new) = (&before.morphs[0].weights, &shown(&model).morphs[0].weights);
    for at in 0..18 {
        let wanted = if at / 2 == 2 { (old[at - 2] + old[at + 2]) / 2.0 } else { old[at] };
        assert!((new[at] - wanted).abs() < 1e-6, "{at}");
    }
    model.revert(undo);
    assert_eq!(shown(&model).morphs, before.morphs);
    model.apply(&edit(KeyTarget::Rest, 1.0)).expect("keys are there");
    assert_eq!(shown(&model).morphs[0].weights[4..6], [0.0, 0.0]);
    let none = Edit::BlendKeys(BlendKeys {
        take: walk(),
        keys: Vec::new(),
        shapes: vec![[5.0, 6.0]],
        toward: KeyTarget::Rest,
        factor: 1.0,
        hold: Vec::new(),
    });
    assert_eq!(model.apply(&none).err(), Some(EditError::Nothing("no key is selected")));
}

#[test]
fn the_same_seed_gives_the_same_noise_and_another_one_does_not() {
    let noisy = |seed| {
        let mut model = model(12);
        let edit = NoiseKeys {
            take: walk(),
            keys: vec![KeySet { properties: vec![Property::Rotation], ..KeySet::default() }],
            shapes: Vec::new(),
            translation: 1.0,
            rotation: 5.0,
            scale: 1.0,
            frequency: 4.0,
            seed,
            hold: Vec::new(),
        };
        model.apply(&Edit::NoiseKeys(edit)).expect("keys are there");
        shown(&model)
    };
    assert_eq!(noisy(1), noisy(1));
    assert_ne!(noisy(1), noisy(2));
    let before = shown(&model(12));
    for (old, new) in before.tracks.iter().zip(&noisy(1).tracks) {
        assert_eq!(old.translation, new.translation);
        for (old, new) in old.rotation.values.iter().zip(new.rotation.values.iter()) {
            // At most 5° about each of three axes.
            let half = old.dot(*new).abs().min(1.0).acos();
            assert!(2.0 * half <= (5.0_f32 * 1.74).to_radians() || old.length() < 0.5);
        }
    }
}

#[test]
fn resampled_keys_are_on_whole_frames_and_on_the_curve() {
    let mut model = model(13);
    let before = shown(&model);
    let edit = |rate, every| {
        Edit::ResampleKeys(ResampleKeys { take: walk(), keys: keys("hand.R", 0.0, 1.0), rate, every })
    };
    let undo = model.apply(&edit(20.0, 1)).expect("keys are there");
    let (old, new) = (&before.tracks[3].translation, &shown(&model).tracks[3].translation);
    let times: Vec<f32> = new.times.to_vec();
    assert_eq!(times.len(), 17, "{times:?}");
    for (key, time) in times.iter().enumerate() {
        assert!((time - 0.1 - key as f32 * 0.05).abs() < 1e-5, "{time}");
        assert!((new.values[key] - sample_channel(old, Vec3::ZERO, *time)).length() < 1e-5, "{time}");
    }
    model.revert(undo);
    assert_eq!(shown(&model), before);
    model.apply(&edit(20.0, 4)).expect("keys are there");
    let times = shown(&model).tracks[3].translation.times.to_vec();
    // Both ends stay, whether they are on such a frame or not.
    let wanted = [0.1, 0.2, 0.4, 0.6, 0.8, 0.9];
    assert_eq!(times.len(), wanted.len(), "{times:?}");
    assert!(times.iter().zip(wanted).all(|(time, wanted)| (time - wanted).abs() < 1e-6), "{times:?}");
}

#[test]
fn settings_out_of_range_are_refused() {
    let mut model = model(14);
    let before = shown(&model);
    let all = || vec![KeySet::default()];
    for edit in [
        blend(all(), KeyTarget::Rest, 11.0),
        blend(all(), KeyTarget::Rest, f32::NAN),
        blend(all(), KeyTarget::Between(f32::INFINITY), 0.5),
        blend(all(), KeyTarget::Delayed(f32::NAN), 0.5),
        blend(all(), KeyTarget::OtherTake { take: TakeRef::Index(9), later: 0.0 }, 0.5),
        blend(all(), KeyTarget::Pose(vec![BonePose { rotation: Some([0.0; 4]), ..pose("hip") }]), 0.5),
        filter(all(), CurveFilter::Gaussian(-0.1)),
        filter(all(), CurveFilter::Butterworth { cutoff: 0.0, order: 2 }),
        filter(all(), CurveFilter::Butterworth { cutoff: 1.0, order: 9 }),
        filter(all(), CurveFilter::Peaks { window: 2, threshold: 1.0 }),
        Edit::ResampleKeys(ResampleKeys { take: walk(), keys: all(), rate: 0.0, every: 1 }),
        Edit::ResampleKeys(ResampleKeys { take: walk(), keys: all(), rate: 30.0, every: 0 }),
    ] {
        assert!(model.apply(&edit).is_err(), "{edit:?}");
        assert_eq!(shown(&model), before);
    }
}

#[test]
fn a_filter_of_keys_far_apart_with_a_high_sample_rate_is_refused() {
    let mut model = model(15);
    let late = Edit::MoveKeys(dragonfly_document::edit::MoveKeys {
        take: walk(),
        keys: keys("hand.R", 0.5, 1.0),
        shapes: Vec::new(),
        by: 80_000.0,
    });
    model.apply(&late).expect("a valid time");
    let edit = Edit::FilterKeys(FilterKeys {
        take: walk(),
        keys: keys("hand.R", 0.0, 0.5),
        shapes: Vec::new(),
        filter: CurveFilter::Gaussian(0.1),
        rate: Some(1000.0),
        hold: Vec::new(),
    });
    assert_eq!(model.apply(&edit).err(), Some(EditError::TooManySamples));
}
