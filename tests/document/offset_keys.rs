//! Offsets of many keys: exact inside their scope, nothing outside of it, undone to the bit.

use dragonfly_anim::data::{Take, Transform};
use dragonfly_anim::sample::sample_track;
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::{
    BonePose, Edit, FadeShape, KeySet, OffsetFalloff, OffsetKeys, OffsetRange, OffsetScope, Property,
    SetPending, SetTangents, TakeRef,
};
use dragonfly_document::history::{Edited, Gesture};
use dragonfly_kit::document::made_take::{BONES, bone, model, pose, walk};
use dragonfly_kit::random::{Random, seed};
use glam::{Quat, Vec3};
use std::sync::Arc;

/// Returns an offset of three channels, of moderate size.
fn offset(random: &mut Random, name: &str) -> BonePose {
    let mut vector = || Vec3::from_array([0; 3].map(|_| random.between(-1.0, 1.0)));
    let (by, axis, factors) = (vector(), vector(), vector());
    BonePose {
        translation: Some(by.to_array()),
        rotation: Some(Quat::from_scaled_axis(axis * 2.0).to_array()),
        scale: Some((factors * 0.5 + 1.0).to_array()),
        ..pose(name)
    }
}

fn over(scope: OffsetScope, poses: Vec<BonePose>) -> OffsetKeys {
    OffsetKeys { take: walk(), poses, at: None, over: scope, falloff: None }
}

fn range(from: f32, to: f32) -> OffsetScope {
    OffsetScope::Range(OffsetRange { from, to })
}

fn sample(adapter: &ModelAdapter, take: usize, bone: usize, time: f32) -> Transform {
    let track = &adapter.slots()[take].result.tracks[bone];
    sample_track(track, &adapter.skeleton().bones[bone], time)
}

/// Returns a pose with the offset on top.
fn with_offset(pose: Transform, offset: &BonePose) -> Transform {
    Transform {
        translation: pose.translation + offset.translation.map_or(Vec3::ZERO, Vec3::from_array),
        rotation: offset.rotation.map_or(Quat::IDENTITY, Quat::from_array) * pose.rotation,
        scale: pose.scale * offset.scale.map_or(Vec3::ONE, Vec3::from_array),
    }
}

/// Returns how far two poses are apart, in the largest of the three channels.
fn apart(a: Transform, b: Transform) -> f32 {
    let turn = (a.rotation - b.rotation).length().min((a.rotation + b.rotation).length());
    turn.max((a.translation - b.translation).length()).max((a.scale - b.scale).length())
}

fn grid() -> impl Iterator<Item = f32> {
    (0..=200).map(|step| step as f32 / 200.0)
}

/// Asserts that undo and redo of `edit` are exact to the bit, and returns the document with the edit.
fn applied(before: &ModelAdapter, edit: OffsetKeys) -> ModelAdapter {
    let mut edited = Edited::new(before.clone());
    edited.apply(edit.into(), None).expect("it can be applied");
    let after = edited.adapter().clone();
    assert_eq!(after.check(), Ok(()));
    assert!(edited.undo());
    for (was, now) in before.slots().iter().zip(edited.adapter().slots()) {
        assert_eq!((&was.original, &was.result), (&now.original, &now.result), "undone");
        assert_eq!(was.changed().collect::<Vec<_>>(), now.changed().collect::<Vec<_>>());
        assert_eq!(was.pending(), now.pending());
    }
    assert!(edited.redo());
    for (was, now) in after.slots().iter().zip(edited.adapter().slots()) {
        assert_eq!((&was.original, &was.result), (&now.original, &now.result), "redone");
    }
    after
}

#[test]
fn over_the_whole_take_every_time_gets_exactly_the_offset_and_other_bones_stay() {
    let first = seed(300);
    for number in first..first + 40 {
        let mut random = Random::new(number);
        let before = model(number);
        for (index, name) in BONES.iter().enumerate() {
            let by = offset(&mut random, name);
            let after = applied(&before, over(OffsetScope::Take, vec![by.clone()]));
            for time in grid() {
                let wanted = with_offset(sample(&before, 0, index, time), &by);
                let off = apart(sample(&after, 0, index, time), wanted);
                assert!(off < 2e-5, "seed {number}, {name} at {time}: {off}");
            }
            for other in (0..BONES.len()).filter(|other| *other != index) {
                let tracks = [&before, &after].map(|model| &model.slots()[0].result.tracks[other]);
                assert_eq!(tracks[0], tracks[1], "{name} changed bone {other}");
            }
            let take = &after.slots()[0].result;
            assert_eq!((take.start, take.length), (0.0, 1.0));
        }
    }
}

#[test]
fn the_pose_that_is_wanted_at_a_time_is_there_afterwards_and_every_key_gets_the_same_offset() {
    let first = seed(301);
    for number in first..first + 40 {
        let mut random = Random::new(number);
        let before = model(number);
        let at = random.choice(&[0.0, 0.125, 0.3, 0.405, 0.99]);
        for (index, name) in BONES.iter().enumerate() {
            let wanted = offset(&mut random, name);
            let edit = OffsetKeys { at: Some(at), ..over(OffsetScope::Take, vec![wanted.clone()]) };
            let after = applied(&before, edit);
            let there = sample(&after, 0, index, at);
            let exact = Transform {
                translation: Vec3::from_array(wanted.translation.unwrap()),
                rotation: Quat::from_array(wanted.rotation.unwrap()),
                scale: Vec3::from_array(wanted.scale.unwrap()),
            };
            assert!(apart(there, exact) < 3e-6, "seed {number}, {name}: {there:?} is not {exact:?}");
            let was = sample(&before, 0, index, at);
            for time in grid() {
                let (now, old) = (sample(&after, 0, index, time), sample(&before, 0, index, time));
                let by = exact.rotation * was.rotation.conjugate();
                let wanted = Transform {
                    translation: old.translation + exact.translation - was.translation,
                    rotation: (by * old.rotation).normalize(),
                    scale: old.scale * exact.scale / was.scale,
                };
                assert!(apart(now, wanted) < 2e-5, "seed {number}, {name} at {time}");
            }
        }
    }
}

#[test]
fn the_inverse_of_an_offset_leads_back_and_the_identity_changes_no_bit() {
    let first = seed(302);
    for number in first..first + 40 {
        let mut random = Random::new(number);
        let before = model(number);
        let there: Vec<BonePose> = BONES.iter().map(|name| offset(&mut random, name)).collect();
        let back = there.iter().map(|pose| BonePose {
            translation: pose.translation.map(|by| by.map(|number| -number)),
            rotation: pose.rotation.map(|turn| Quat::from_array(turn).conjugate().to_array()),
            scale: pose.scale.map(|factors| factors.map(f32::recip)),
            ..pose.clone()
        });
        let mut edited = Edited::new(before.clone());
        edited.apply(over(OffsetScope::Take, there.clone()).into(), None).unwrap();
        edited.apply(over(OffsetScope::Take, back.collect()).into(), None).unwrap();
        for time in grid() {
            for index in 0..BONES.len() {
                let off = apart(sample(edited.adapter(), 0, index, time), sample(&before, 0, index, time));
                assert!(off < 5e-6, "seed {number}, bone {index} at {time}: {off}");
            }
        }
        let none = BonePose {
            translation: Some([0.0; 3]),
            rotation: Some([0.0, 0.0, 0.0, 1.0]),
            scale: Some([1.0; 3]),
            ..pose("hip")
        };
        let same = applied(&before, over(OffsetScope::Take, vec![none]));
        assert!(
            Arc::ptr_eq(&same.slots()[0].result, &before.slots()[0].result),
            "the identity copied a take"
        );
    }
}

#[test]
fn tangents_that_were_changed_follow_the_offset_as_well() {
    let mut before = model(5);
    for (time, property, tangent) in [
        (0.25, Property::Rotation, vec![0.3, -0.2, 0.1, 0.4]),
        (0.5, Property::Scale, vec![0.5, 0.25, -0.5]),
        (0.5, Property::Translation, vec![1.0, 2.0, -1.0]),
    ] {
        let edit = Edit::SetTangents(SetTangents {
            take: walk(),
            time,
            bone: bone("hip"),
            property,
            arrive: Some(tangent.clone()),
            leave: Some(tangent),
        });
        before.apply(&edit).unwrap();
    }
    let by = offset(&mut Random::new(6), "hip");
    let after = applied(&before, over(OffsetScope::Take, vec![by.clone()]));
    for time in grid() {
        let wanted = with_offset(sample(&before, 0, 1, time), &by);
        assert!(apart(sample(&after, 0, 1, time), wanted) < 2e-5, "at {time}");
    }
}

/// Frames of the range test, seconds.
const FRAME: f32 = 1.0 / 30.0;

#[test]
fn over_a_range_with_a_falloff_nothing_changes_beyond_it_and_the_range_gets_the_whole_offset() {
    let first = seed(303);
    for number in first..first + 40 {
        let mut random = Random::new(number);
        let before = model(number);
        let (from, to) = random.choice(&[(0.3, 0.6), (0.0, 0.4), (0.55, 1.0), (0.125, 0.25), (0.42, 0.42)]);
        let reach = random.choice(&[FRAME, 0.2]);
        for (index, name) in BONES.iter().enumerate() {
            // A key that is inserted in a spline of rotations is normalized, which changes the curve around it a little.
            let by = BonePose {
                rotation: offset(&mut random, name).rotation.filter(|_| *name != "hip"),
                ..offset(&mut random, name)
            };
            let falloff = Some(OffsetFalloff { seconds: reach, shape: FadeShape::Linear });
            let after = applied(&before, OffsetKeys { falloff, ..over(range(from, to), vec![by.clone()]) });
            let take = &after.slots()[0].result;
            assert_eq!((take.start, take.length), (0.0, 1.0), "the take has another length");
            for time in grid() {
                let (now, was) = (sample(&after, 0, index, time), sample(&before, 0, index, time));
                let context = format!("seed {number}, {name} at {time}, {from} to {to}, {reach}");
                if (from..=to).contains(&time) {
                    let off = apart(now, with_offset(was, &by));
                    assert!(off < 5e-5, "{context}: {off} from the whole offset");
                } else if time < from - reach - 1e-4 || time > to + reach + 1e-4 {
                    assert!(apart(now, was) < 5e-5, "{context}: {now:?} was {was:?}");
                }
            }
        }
    }
}

#[test]
fn over_a_range_without_a_falloff_only_the_keys_inside_change_and_none_is_made() {
    let before = model(7);
    let by = offset(&mut Random::new(8), "root");
    let after = applied(&before, over(range(0.25, 0.5), vec![by]));
    let [was, now] = [&before, &after].map(|model| &model.slots()[0].result.tracks[0].translation);
    assert_eq!(was.times, now.times);
    for (key, time) in was.times.iter().enumerate() {
        assert_eq!(was.values[key] == now.values[key], !(0.25..=0.5).contains(time), "{time}");
    }
}

#[test]
fn a_channel_without_keys_gets_one_at_the_start_of_the_take_and_keeps_its_pose_outside_a_range() {
    let before = model(9);
    let by = BonePose { translation: Some([0.0, 0.5, 0.0]), ..pose("still") };
    let after = applied(&before, over(OffsetScope::Take, vec![by.clone()]));
    let channel = &after.slots()[0].result.tracks[4].translation;
    assert_eq!((&channel.times[..], channel.values[0]), (&[0.0][..], Vec3::new(0.0, 1.5, 0.0)));
    let falloff = Some(OffsetFalloff { seconds: FRAME, shape: FadeShape::Linear });
    let after = applied(&before, OffsetKeys { falloff, ..over(range(0.5, 0.75), vec![by]) });
    let channel = &after.slots()[0].result.tracks[4].translation;
    let heights: Vec<(f32, f32)> =
        channel.times.iter().zip(channel.values.iter()).map(|(time, value)| (*time, value.y)).collect();
    assert_eq!(heights, [(0.5 - FRAME, 1.0), (0.5, 1.5), (0.75, 1.5), (0.75 + FRAME, 1.0)]);
}

#[test]
fn selected_keys_change_alone_and_with_a_falloff_their_neighbors_follow_in_part() {
    let before = model(10);
    let by = BonePose { translation: Some([0.0, 1.0, 0.0]), ..pose("root") };
    let sets = vec![KeySet { at: Some(vec![0.5]), ..KeySet::default() }];
    let moved = |after: &ModelAdapter| -> Vec<f32> {
        let [was, now] =
            [&before, after].map(|model| model.slots()[0].result.tracks[0].translation.values.clone());
        was.iter().zip(now.iter()).map(|(was, now)| ((now - was).y * 1e4).round() / 1e4).collect()
    };
    let alone = applied(&before, over(OffsetScope::Keys(sets.clone()), vec![by.clone()]));
    assert_eq!(moved(&alone), [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
    // Keys are an eighth of a second apart.
    let shape = FadeShape::Sharp;
    let falloff = Some(OffsetFalloff { seconds: 0.375, shape });
    let wide = OffsetKeys { falloff, ..over(OffsetScope::Keys(sets.clone()), vec![by.clone()]) };
    let parts = moved(&applied(&before, wide));
    for (part, wanted) in
        parts.iter().zip([0.0, 0.0, 1.0 / 9.0, 4.0 / 9.0, 1.0, 4.0 / 9.0, 1.0 / 9.0, 0.0, 0.0])
    {
        assert!((part - wanted).abs() < 2e-3, "{parts:?}");
    }
    let turn = BonePose { rotation: Some(Quat::from_rotation_z(0.9).to_array()), ..pose("root") };
    let wide = OffsetKeys {
        falloff: Some(OffsetFalloff { seconds: 0.25, shape: FadeShape::Linear }),
        ..over(OffsetScope::Keys(sets.clone()), vec![turn])
    };
    let after = applied(&before, wide);
    let [was, now] = [&before, &after].map(|model| model.slots()[0].result.tracks[0].rotation.values.clone());
    let angle = (now[3] * was[3].conjugate()).to_scaled_axis();
    assert!((angle - Vec3::Z * 0.45).length() < 1e-3, "half of the offset at half of the distance: {angle}");
    let other =
        over(OffsetScope::Keys(sets), vec![BonePose { translation: by.translation, ..pose("still") }]);
    let refused = before.clone().apply(&other.into()).unwrap_err();
    assert_eq!(refused.to_string(), "these bones have no key there");
}

#[test]
fn pending_poses_of_the_scope_get_the_offset_too() {
    let mut before = model(11);
    let waits = BonePose { translation: Some([1.0, 2.0, 3.0]), ..pose("hip") };
    let pend = |time| Edit::SetPending(SetPending { take: walk(), time, poses: vec![waits.clone()] });
    before.apply(&pend(0.3)).unwrap();
    before.apply(&pend(0.8)).unwrap();
    let wanted = BonePose { translation: Some([1.0, 2.5, 3.0]), ..pose("hip") };
    let edit = OffsetKeys { at: Some(0.3), ..over(range(0.2, 0.4), vec![wanted]) };
    let after = applied(&before, edit);
    let slot = &after.slots()[0];
    let height = |time| slot.pending_at(time).unwrap().of(1).unwrap().get(Property::Translation).unwrap()[1];
    assert_eq!((height(0.3), height(0.8)), (2.5, 2.0));
    let by = sample(&after, 0, 1, 0.25).translation - sample(&before, 0, 1, 0.25).translation;
    assert!((by - Vec3::Y * 0.5).length() < 1e-6, "{by}");
}

#[test]
fn a_drag_over_the_whole_take_is_one_step_and_a_cancelled_one_leaves_no_trace() {
    let before = model(12);
    let mut edited = Edited::new(before.clone());
    let gesture = Some(Gesture(1));
    for step in 1..=10 {
        let turn = Quat::from_rotation_x(step as f32 * 0.1).to_array();
        let to = BonePose { rotation: Some(turn), ..pose("hip") };
        let edit = OffsetKeys { at: Some(0.3), ..over(OffsetScope::Take, vec![to]) };
        edited.apply(edit.into(), gesture).unwrap();
        let off = sample(edited.adapter(), 0, 1, 0.3).rotation.dot(Quat::from_array(turn)).abs();
        assert!(off > 1.0 - 1e-6, "{step}: {off}");
    }
    assert_eq!(edited.steps().0.len(), 1);
    assert!(edited.cancel(Gesture(1)));
    assert_eq!(edited.steps().0.len(), 0);
    assert_eq!(edited.adapter().slots()[0].result, before.slots()[0].result);
}

#[test]
fn a_preview_that_becomes_an_offset_at_its_end_is_one_step_that_tells_its_keys() {
    let mut edited = Edited::new(model(13));
    let gesture = Some(Gesture(1));
    let turn = BonePose { rotation: Some([0.0, 0.0, 0.6, 0.8]), ..pose("hip") };
    let preview = Edit::SetPending(SetPending { take: walk(), time: 0.3, poses: vec![turn.clone()] });
    edited.apply(preview.clone(), gesture).unwrap();
    edited.apply(preview, gesture).unwrap();
    let last = OffsetKeys { at: Some(0.3), ..over(OffsetScope::Take, vec![turn]) };
    edited.apply(last.into(), gesture).unwrap();
    let (steps, _) = edited.steps();
    assert_eq!(steps.len(), 1);
    assert_eq!(&*steps[0].about, "hip  ·  walk  ·  9 keys in the whole take");
    assert!(edited.adapter().slots()[0].pending().is_empty(), "the preview is gone");
}

#[test]
fn an_offset_outside_the_take_or_of_nothing_is_refused() {
    let mut before = model(14);
    let by = BonePose { translation: Some([0.0, 1.0, 0.0]), ..pose("root") };
    let mut refused = |edit: OffsetKeys| before.apply(&edit.into()).unwrap_err().to_string();
    assert!(refused(over(range(2.0, 3.0), vec![by.clone()])).contains("2 s is not between"));
    assert_eq!(refused(over(OffsetScope::Take, vec![pose("root")])), "no pose is given");
    let zero = BonePose { rotation: Some([0.0; 4]), ..pose("root") };
    assert_eq!(refused(over(OffsetScope::Take, vec![zero])), "a rotation must not have length zero");
    let infinite = BonePose { scale: Some([f32::INFINITY, 1.0, 1.0]), ..pose("root") };
    assert!(refused(over(OffsetScope::Take, vec![infinite])).contains("a scale cannot be"));
    let take = OffsetKeys { take: TakeRef::Name("none".to_owned()), ..over(OffsetScope::Take, vec![by]) };
    assert_eq!(refused(take), "there is no take \"none\"");
}

/// Returns the number of keys of a bone.
fn keys(take: &Take, bone: usize) -> usize {
    let track = &take.tracks[bone];
    track.translation.len() + track.rotation.len() + track.scale.len()
}

#[test]
fn an_offset_of_the_whole_take_adds_no_keys_to_channels_that_have_some() {
    let before = model(15);
    let poses = BONES[..4].iter().map(|name| offset(&mut Random::new(16), name)).collect();
    let after = applied(&before, over(OffsetScope::Take, poses));
    for bone in 0..4 {
        let [was, now] = [&before, &after].map(|model| keys(&model.slots()[0].result, bone));
        assert_eq!(was, now, "bone {bone}");
    }
}
