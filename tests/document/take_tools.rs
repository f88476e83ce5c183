//! Edits of whole takes that compute motion: mirrored takes, locked contacts, closed loops.

use crate::fox_edits::{edit, fox_takes};
use dragonfly_anim::contact::{Contact, contact_slide};
use dragonfly_anim::data::{Skeleton, Take, Transform};
use dragonfly_anim::frames::TakeFrames;
use dragonfly_anim::motion::Axis;
use dragonfly_anim::sample::sample_take;
use dragonfly_document::adapter::{EditError, ModelAdapter};
use dragonfly_document::bones::MirrorPairs;
use dragonfly_document::edit::EditedBones;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Applies an edit, and checks the invariants. Returns the take that it changed.
#[track_caller]
fn applied(model: &mut ModelAdapter, json: &str) -> Arc<Take> {
    let edit = edit(json);
    model.apply(&edit).unwrap_or_else(|error| panic!("{json}: {error}"));
    model.check().expect("an invariant");
    let take = edit.take().expect("a take");
    Arc::clone(&model.take(take).expect("the take").result)
}

fn poses(skeleton: &Skeleton, take: &Take, time: f32) -> Vec<Transform> {
    let mut poses = vec![Transform::IDENTITY; skeleton.len()];
    sample_take(Some(take), skeleton, time, &mut poses);
    poses
}

/// Returns the largest difference of two takes at `times`; lengths relative to the largest.
fn apart(skeleton: &Skeleton, a: &Take, b: &Take, times: impl Iterator<Item = f32>) -> f32 {
    let mut largest = 0.0_f32;
    for time in times {
        for (a, b) in poses(skeleton, a, time).iter().zip(poses(skeleton, b, time)) {
            let turn = (a.rotation - b.rotation).length().min((a.rotation + b.rotation).length());
            let length = 1.0 + a.translation.length();
            let moved = a.translation.distance(b.translation) / length;
            largest = largest.max(turn).max(moved).max(a.scale.distance(b.scale));
        }
    }
    largest
}

fn times(take: &Take) -> impl Iterator<Item = f32> {
    let (start, length) = (take.start, take.length);
    (0..=100).map(move |step| start + length * step as f32 / 100.0)
}

#[test]
fn a_take_mirrored_twice_is_the_take() {
    let mut model = fox_takes();
    for (index, name) in ["Survey", "Walk", "Run"].into_iter().enumerate() {
        let before = Arc::clone(&model.slots()[index].result);
        let line = format!(r#"{{"edit":"mirror_take","take":"{name}"}}"#);
        let once = applied(&mut model, &line);
        assert!(apart(model.skeleton(), &before, &once, times(&before)) > 0.05, "{name}");
        let twice = applied(&mut model, &line);
        let difference = apart(model.skeleton(), &before, &twice, times(&before));
        assert!(difference < 1e-6, "{name}: {difference}");
    }
}

#[test]
fn a_mirrored_take_puts_each_foot_at_the_mirror_image_of_the_other() {
    let mut model = fox_takes();
    let before = Arc::clone(&model.slots()[1].result);
    let after = applied(&mut model, r#"{"edit":"mirror_take","take":"Walk"}"#);
    let skeleton = Arc::clone(model.skeleton());
    let frames = |take: &Take| TakeFrames::of(take, &skeleton, 24.0).expect("frames");
    let (before, after) = (frames(&before), frames(&after));
    let bone = |name: &str| skeleton.find(name).expect(name);
    let (left, right) = (bone("b_LeftFoot01_017"), bone("b_RightFoot01_021"));
    for frame in 0..before.len() {
        let (was, is) = (before.position(frame, left), after.position(frame, right));
        // The fox is 150 units long, and its rest pose is symmetric to within a few tenths.
        let apart = ((was.x + is.x).abs()).max((was.y - is.y).abs()).max((was.z - is.z).abs());
        assert!(apart < 4.0, "frame {frame}: {was} {is}");
    }
}

#[test]
fn a_mirrored_range_leaves_the_rest_of_the_take_alone() {
    let mut model = fox_takes();
    let before = Arc::clone(&model.slots()[1].result);
    let whole = applied(&mut fox_takes(), r#"{"edit":"mirror_take","take":"Walk"}"#);
    let after = applied(&mut model, r#"{"edit":"mirror_take","take":"Walk","from":0.25,"to":0.5}"#);
    let skeleton = model.skeleton();
    let part = |from: f32, to: f32| times(&before).filter(move |time| (from..=to).contains(time));
    assert!(apart(skeleton, &before, &after, part(0.0, 0.2)) < 1e-6);
    assert!(apart(skeleton, &before, &after, part(0.55, 9.0)) < 1e-6);
    assert!(apart(skeleton, &whole, &after, part(0.25, 0.5)) < 1e-6);
    assert_eq!((after.start, after.length), (before.start, before.length));
}

#[test]
fn mirrored_bones_give_their_motion_to_their_mirror_bones_only() {
    let line = r#"{"edit":"mirror_take","take":"Walk","bones":["b_LeftForeArm_010"]}"#;
    let mut model = fox_takes();
    let before = Arc::clone(&model.slots()[1].result);
    let after = applied(&mut model, line);
    let right = model.skeleton().find("b_RightForeArm_07").expect("a bone");
    assert_eq!(edit(line).bones(model.skeleton()), EditedBones::Named(BTreeSet::from([right])));
    for (before, after) in before.tracks.iter().zip(&after.tracks) {
        assert_eq!(before != after, before.bone == right, "{}", before.bone);
    }
}

#[test]
fn locked_contacts_slide_less_than_two_millimeters_and_an_undo_restores_the_take() {
    let mut model = fox_takes();
    let before = Arc::clone(&model.slots()[1].result);
    let line = r#"{"edit":"lock_contacts","take":"Walk","contacts":[{"bone":"b_LeftFoot01_017","from":0.2,"to":0.3}],"ease":3}"#;
    let undo = model.apply(&edit(line)).expect("applied");
    let after = Arc::clone(&model.slots()[1].result);
    let bone = model.skeleton().find("b_LeftFoot01_017").expect("a bone");
    let contact = Contact { bone, from: 0.2, to: 0.3 };
    let slide = |take: &Take| {
        let frames = TakeFrames::of(take, model.skeleton(), 120.0).expect("frames");
        contact_slide(&frames, &contact, Axis::Y, 0.01).millimeters
    };
    assert!(slide(&before) > 20.0, "{}", slide(&before));
    assert!(slide(&after) < 2.0, "{}", slide(&after));
    model.revert(undo);
    assert_eq!(model.slots()[1].result, before);
}

#[test]
fn a_closed_loop_has_no_gap_and_keeps_the_original_of_its_old_keys() {
    let mut model = fox_takes();
    let shifted =
        r#"{"edit":"offset","take":"Run","time":0,"poses":[{"bone":"b_Hip_01","rotation":[0,0,0.1,0.995]}]}"#;
    applied(&mut model, shifted);
    let closed = applied(&mut model, r#"{"edit":"close_loop","take":"Run","frames":8}"#);
    // The length of the run is no whole number of frames, so the end itself is compared.
    let (start, end) =
        (poses(model.skeleton(), &closed, closed.start), poses(model.skeleton(), &closed, closed.end()));
    for (bone, (start, end)) in start.iter().zip(&end).enumerate() {
        let gap = (start.rotation - end.rotation).length().min((start.rotation + end.rotation).length());
        assert!(gap < 1e-5, "bone {bone}: {gap}");
        assert!(start.translation.distance(end.translation) < 1e-3, "bone {bone}");
    }
    let slot = &model.slots()[2];
    assert!(slot.changed().count() > 0);
    let fresh = fox_takes();
    let original = &fresh.slots()[2].original;
    for (old, new) in original.tracks.iter().zip(&slot.original.tracks) {
        for (&time, value) in old.rotation.times.iter().zip(old.rotation.values.iter()) {
            let at = new.rotation.times.iter().position(|&other| other == time);
            // A key in the closed frames may have been replaced by one at the time of its frame.
            assert!(at.is_none_or(|at| new.rotation.values[at] == *value), "bone {} at {time} s", old.bone);
        }
    }
}

#[test]
fn edits_that_cannot_be_carried_out_say_why() {
    let mut model = fox_takes();
    let wrong = |line: &str, model: &mut ModelAdapter| model.apply(&edit(line)).expect_err(line);
    let error = wrong(r#"{"edit":"lock_contacts","take":"Walk"}"#, &mut model);
    assert_eq!(error, EditError::Nothing("no foot is in contact with the ground"));
    for (line, wanted) in [
        (r#"{"edit":"lock_contacts","take":"Walk","contacts":[{"bone":0,"from":0,"to":0.5}]}"#, "limb"),
        (
            r#"{"edit":"lock_contacts","take":"Walk","contacts":[{"bone":0,"from":0.5,"to":0}]}"#,
            "before the start",
        ),
        (r#"{"edit":"close_loop","take":"Walk","frames":0}"#, "over 0 frames"),
        (r#"{"edit":"mirror_take","take":"Walk","from":0.5,"to":0.2}"#, "before the start"),
        (r#"{"edit":"mirror_take","take":"Walk","from":-3}"#, "-3"),
    ] {
        let error = wrong(line, &mut model).to_string();
        assert!(error.contains(wanted), "{line}: {error}");
    }
}

#[test]
fn one_side_is_mirrored_to_the_other_and_the_rest_stays_bit_for_bit() {
    let mut model = fox_takes();
    let skeleton = Arc::clone(model.skeleton());
    let pairs = MirrorPairs::of(&skeleton);
    let before = Arc::clone(&model.slots()[1].result);
    let after = applied(&mut model, r#"{"edit":"mirror_take","take":"Walk","side":"left"}"#);
    let mut changed = 0;
    for (was, is) in before.tracks.iter().zip(&after.tracks) {
        let is_right = pairs.pairs.iter().any(|pair| pair.right == was.bone);
        assert!(is_right || was == is, "bone {}", was.bone);
        changed += usize::from(was != is);
    }
    assert!(changed > 5, "{changed}");
    // The right side has the mirrored motion of the left one: the left one gets its own motion back.
    let back = model.apply(&edit(r#"{"edit":"mirror_take","take":"Walk","side":"right"}"#)).map(|_| ());
    let back = back.map_or_else(|_| Arc::clone(&after), |()| Arc::clone(&model.slots()[1].result));
    assert!(apart(&skeleton, &after, &back, times(&after)) < 1e-6);
}

#[test]
fn corrected_pairs_are_followed_by_the_mirrored_take() {
    let skeleton = Arc::clone(fox_takes().skeleton());
    let bone = |name: &str| skeleton.find(name).expect(name);
    let [left, right, tail] = ["b_LeftFoot02_018", "b_RightFoot01_021", "b_Tail01_012"].map(bone);
    let pairs = MirrorPairs::of(&skeleton).corrected(&[[left, right], [tail, bone("b_Tail02_013")]]);
    assert_eq!((pairs.partner(left), pairs.partner(right)), (Some(right), Some(left)));
    assert_eq!(pairs.partner(bone("b_LeftFoot01_017")), None);
    assert_eq!(pairs.mirror_of(bone("b_LeftFoot01_017")), None, "its counterpart is in another pair now");
    assert_eq!(pairs.mirror_of(tail), Some(bone("b_Tail02_013")));
    let listed = |one| pairs.pairs.iter().filter(|pair| pair.left == one || pair.right == one).count();
    assert_eq!((listed(left), listed(right), listed(tail)), (1, 1, 1));
    let middle = MirrorPairs::of(&skeleton).corrected(&[[left, left]]);
    assert_eq!(middle.mirror_of(left), Some(left));
    assert_eq!(MirrorPairs::of(&skeleton).corrected(&[]), MirrorPairs::of(&skeleton));
    let mut model = fox_takes();
    let before = Arc::clone(&model.slots()[1].result);
    let line = r#"{"edit":"mirror_take","take":"Walk","bones":["b_Tail01_012"],"pairs":[["b_Tail01_012","b_Tail02_013"]]}"#;
    let after = applied(&mut model, line);
    let changed: Vec<u32> = before
        .tracks
        .iter()
        .zip(&after.tracks)
        .filter(|(was, is)| was != is)
        .map(|(was, _)| was.bone)
        .collect();
    assert_eq!(changed, [bone("b_Tail02_013")]);
}
