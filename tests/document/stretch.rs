//! A part of a take is slowed down or quickened: the motion in it is the same on another clock, and everything after it moves.

use crate::fox_edits::{apply, edit, fox_takes};
use dragonfly_anim::data::Transform;
use dragonfly_anim::sample::sample_take;
use dragonfly_document::adapter::{ModelAdapter, stored_contacts, stored_events};
use dragonfly_kit::random::{Random, seed};

const WALK: usize = 1;

/// Returns the new time of a time.
fn mapped(time: f32, [from, to]: [f32; 2], factor: f32) -> f32 {
    match time {
        _ if time <= from => time,
        _ if time >= to => from + (to - from) * factor + (time - to),
        _ => from + (time - from) * factor,
    }
}

/// Returns the largest angle and distance of a bone between two takes, sampled at a time and at its new time.
fn apart(before: &ModelAdapter, after: &ModelAdapter, time: f32, new: f32) -> f32 {
    let pose = |model: &ModelAdapter, time: f32| {
        let skeleton = model.skeleton();
        let mut poses = vec![Transform::IDENTITY; skeleton.len()];
        sample_take(Some(&model.slots()[WALK].result), skeleton, time, &mut poses);
        poses
    };
    let pairs = pose(before, time).into_iter().zip(pose(after, new));
    let off = pairs.map(|(a, b)| {
        let angle: f32 = 2.0 * (a.rotation - b.rotation).length().min((a.rotation + b.rotation).length());
        angle.max((a.translation - b.translation).length() / 100.0)
    });
    off.fold(0.0, f32::max)
}

fn line([from, to]: [f32; 2], factor: f32) -> String {
    format!(r#"{{"edit":"stretch_time","take":"Walk","from":{from},"to":{to},"factor":{factor}}}"#)
}

#[test]
fn the_motion_of_a_stretched_part_is_the_same_on_another_clock_with_splines_too() {
    let first = seed(2020);
    for number in first..first + 20 {
        let mut random = Random::new(number);
        for spline in [false, true] {
            let mut model = fox_takes();
            if spline {
                apply(
                    &mut model,
                    r#"{"edit":"set_interpolation","take":"Walk","interpolation":"cubic_spline"}"#,
                );
            }
            let before = fox_with(&model);
            // Both ends are at keys, so that no piece of a curve crosses them.
            let times = before.slots()[WALK].result.tracks.iter().find(|track| track.rotation.len() > 4);
            let times = times.expect("keys").rotation.times.to_vec();
            let start = random.below(times.len() - 2);
            let end = start + 1 + random.below(times.len() - 1 - start);
            let (part, factor) = ([times[start], times[end]], random.choice(&[0.25, 0.6, 2.0, 7.5]));
            let undo = model.apply(&edit(&line(part, factor))).expect("applied");
            model.check().expect("an invariant");
            for step in 0..=200 {
                let time = times[times.len() - 1] * step as f32 / 200.0;
                let off = apart(&before, &model, time, mapped(time, part, factor));
                assert!(
                    off < 2e-3,
                    "seed {number}, spline {spline}: off by {off} at {time} s for {part:?} × {factor}"
                );
            }
            model.revert(undo);
            let [old, new] = [&before, &model].map(|model| &model.slots()[WALK].result);
            assert_eq!(old.tracks, new.tracks, "seed {number}");
        }
    }
}

/// Returns a model with the same takes.
fn fox_with(model: &ModelAdapter) -> ModelAdapter {
    let animation = dragonfly_anim::data::AnimationData {
        skeleton: model.skeleton().clone(),
        takes: model.slots().iter().map(|slot| slot.result.clone()).collect(),
    };
    ModelAdapter::new(&animation)
}

#[test]
fn contacts_and_events_follow_and_what_cannot_be_stretched_is_refused() {
    let mut model = fox_takes();
    for line in [
        r#"{"edit":"set_contacts","take":"Walk","contacts":[{"bone":"b_LeftFoot01_017","from":0.1,"to":0.3},{"bone":"b_RightFoot01_021","from":0.5,"to":0.6}]}"#,
        r#"{"edit":"set_events","take":"Walk","events":[{"time":0.25,"name":"in"},{"time":0.5,"name":"after"}]}"#,
    ] {
        apply(&mut model, line);
    }
    apply(&mut model, &line([0.2, 0.4], 3.0));
    let extras = &model.slots()[WALK].result.extras;
    let near = |value: f32, wanted: f32| (value - wanted).abs() < 1e-5;
    let contacts = stored_contacts(extras, model.skeleton());
    let spans: Vec<[f32; 2]> = contacts.contacts().iter().map(|contact| [contact.from, contact.to]).collect();
    assert!(near(spans[0][0], 0.1) && near(spans[0][1], 0.5), "{spans:?}");
    assert!(near(spans[1][0], 0.9) && near(spans[1][1], 1.0), "{spans:?}");
    let events = stored_events(extras);
    assert!(near(events[0].time, 0.35) && near(events[1].time, 0.9), "{events:?}");
    for (part, factor, why) in [
        ([0.4, 0.2], 2.0, "before the start"),
        ([0.2, 0.4], 0.0, "factor"),
        ([0.2, 0.4], -1.0, "factor"),
        ([0.2, 0.4], 2000.0, "factor"),
        ([50.0, 60.0], 2.0, "no key"),
        ([0.2, 0.4], 1.0, "no key"),
    ] {
        let error = model.apply(&edit(&line(part, factor))).expect_err("refused").to_string();
        assert!(error.contains(why), "{part:?} × {factor}: {error}");
    }
}
