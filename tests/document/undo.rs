//! Undo and redo are exact to the bit for all edits, and work by gesture.

use dragonfly_anim::data::{Channel, MorphTrack, Take, Track};
use dragonfly_document::adapter::{ModelAdapter, TakeVersions};
use dragonfly_document::edit::{
    Arbitrary, BonePose, BoneRef, Edit, OffsetPose, Property, RenameTake, SetPose, TakeRef,
};
use dragonfly_document::history::{Edited, Gesture};
use dragonfly_kit::document::made_take::{BONES, animation};
use dragonfly_kit::document::made_take::{model, pose, walk};
use dragonfly_kit::random::{Random, seed};
use glam::{Quat, Vec3};
use std::sync::Arc;

/// Returns a random edit, valid or not, of a model with this number of takes and these bones.
pub(crate) fn any_edit(random: &mut Random, takes: usize, bones: &[BoneRef]) -> Edit {
    Arbitrary::new(&mut || random.bits(), takes, bones).edit()
}

/// Returns whether two documents are equal in all visible data, every number to the bit.
fn same(a: &ModelAdapter, b: &ModelAdapter) -> bool {
    let slots = a.slots().len() == b.slots().len();
    slots && a.slots().iter().zip(b.slots()).all(|(a, b)| Arc::ptr_eq(a, b) || same_slot(a, b))
}

fn same_slot(a: &TakeVersions, b: &TakeVersions) -> bool {
    let changes = |slot: &TakeVersions| -> Vec<_> {
        slot.changed()
            .map(|(bone, property)| (bone, property, slot.changes(bone, property).to_vec()))
            .collect()
    };
    (a.id, a.origin) == (b.id, b.origin)
        && same_take(&a.original, &b.original)
        && same_take(&a.result, &b.result)
        && changes(a) == changes(b)
        && a.pending() == b.pending()
}

pub(crate) fn same_take(a: &Take, b: &Take) -> bool {
    fn same_channel<T: Copy, const N: usize>(
        a: &Channel<T>,
        b: &Channel<T>,
        numbers: fn(T) -> [f32; N],
    ) -> bool {
        let bits = |value: T| numbers(value).map(f32::to_bits);
        a.interpolation == b.interpolation
            && a.values.len() == b.values.len()
            && same_numbers(&a.times, &b.times)
            && (Arc::ptr_eq(&a.values, &b.values)
                || a.values.iter().zip(b.values.iter()).all(|(a, b)| bits(*a) == bits(*b)))
    }
    let tracks = |(a, b): (&Track, &Track)| {
        a.bone == b.bone
            && same_channel(&a.translation, &b.translation, |vector: Vec3| vector.to_array())
            && same_channel(&a.rotation, &b.rotation, |rotation: Quat| rotation.to_array())
            && same_channel(&a.scale, &b.scale, |vector: Vec3| vector.to_array())
    };
    let morphs = |(a, b): (&MorphTrack, &MorphTrack)| {
        a.interpolation == b.interpolation
            && same_numbers(&a.times, &b.times)
            && same_numbers(&a.weights, &b.weights)
    };
    a.name == b.name
        && same_numbers(&[a.start, a.length], &[b.start, b.length])
        && (a.tracks.len(), a.morphs.len()) == (b.tracks.len(), b.morphs.len())
        && a.tracks.iter().zip(&b.tracks).all(tracks)
        && a.morphs.iter().zip(&b.morphs).all(morphs)
}

fn same_numbers(a: &[f32], b: &[f32]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
}

#[test]
fn undo_and_redo_of_random_edits_are_exact_to_the_bit() {
    let first = seed(900);
    let bones = BONES.map(|name| BoneRef::Name(name.to_owned()));
    for number in first..first + 200 {
        let mut random = Random::new(number);
        let mut edited = Edited::new(ModelAdapter::new(&animation(&mut random)));
        let mut states = vec![edited.adapter().clone()];
        for _ in 0..500 {
            let edit = any_edit(&mut random, edited.adapter().slots().len(), &bones);
            let before = edited.adapter().clone();
            if edited.apply(edit.clone(), None).is_ok() {
                states.push(edited.adapter().clone());
            } else {
                assert!(
                    same(&before, edited.adapter()),
                    "seed {number}: {edit:?} failed and changed something"
                );
            }
            if let Err(broken) = edited.adapter().check() {
                panic!("seed {number}: {edit:?}: {broken}");
            }
        }
        assert!(states.len() > 100, "seed {number}: only {} edits could be done", states.len());
        for (back, state) in states.iter().enumerate().rev().skip(1) {
            assert!(edited.undo() && edited.adapter().check().is_ok(), "seed {number}: undo to {back}");
            assert!(same(state, edited.adapter()), "seed {number}: undo to {back}");
        }
        assert!(!edited.undo());
        for (forth, state) in states.iter().enumerate().skip(1) {
            assert!(edited.redo() && same(state, edited.adapter()), "seed {number}: redo to {forth}");
        }
        assert!(edited.go_to(0) && same(&states[0], edited.adapter()), "seed {number}: back to the start");
    }
}

#[test]
fn all_edits_of_a_gesture_are_one_undo_step_and_each_starts_from_the_state_before_it() {
    let mut edited = Edited::new(model(15));
    let start = edited.adapter().clone();
    let gesture = Some(Gesture(1));
    let lift = |by| {
        let poses = vec![BonePose { translation: Some([0.0, by, 0.0]), ..pose("root") }];
        Edit::OffsetPose(OffsetPose { take: walk(), time: 0.5, poses, unstep: false })
    };
    for step in 1..=10 {
        edited.apply(lift(step as f32 * 0.1), gesture).unwrap();
    }
    assert_eq!(edited.steps().0.len(), 1);
    let change = edited.adapter().slots()[0].change(0, Property::Translation, 4);
    assert!((change[1] - 1.0).abs() < 1e-6, "{change:?}");
    let state = edited.adapter().clone();
    assert!(edited.apply(lift(f32::NAN), gesture).is_err());
    assert!(same(edited.adapter(), &state));
    edited.undo();
    assert!(same(edited.adapter(), &start));
    edited.redo();
    edited.cancel(Gesture(1));
    assert!(same(edited.adapter(), &start));
    assert_eq!(edited.labels(), [None, None]);
}

#[test]
fn a_dragged_pose_equals_its_last_edit_alone_to_the_bit() {
    let first = seed(930);
    for number in first..first + 300 {
        let mut random = Random::new(number);
        let mut edited = Edited::new(ModelAdapter::new(&animation(&mut random)));
        for _ in 0..random.below(4) {
            let bones = BONES.map(|name| BoneRef::Name(name.to_owned()));
            let edit = any_edit(&mut random, edited.adapter().slots().len(), &bones);
            let _ = edited.apply(edit, None);
        }
        let start = edited.clone();
        let take = TakeRef::Index(random.below(edited.adapter().slots().len()));
        let time = random.choice(&[0.0, 0.125, 0.3, 0.41, 1.3]);
        let names: Vec<&str> = BONES.into_iter().filter(|_| random.below(2) == 0).collect();
        let parts: Vec<[bool; 3]> = names.iter().map(|_| [0; 3].map(|_| random.below(2) == 0)).collect();
        let offset = random.below(3) == 0;
        let mut shown = Vec::new();
        for _ in 0..random.below(12) {
            let three = |random: &mut Random| [0; 3].map(|_| random.between(-2.0, 2.0));
            let poses: Vec<BonePose> = names
                .iter()
                .zip(&parts)
                .map(|(name, parts)| BonePose {
                    translation: parts[0].then(|| three(&mut random)),
                    rotation: parts[1].then(|| [0; 4].map(|_| random.between(-1.0, 1.0))),
                    scale: parts[2].then(|| three(&mut random)),
                    ..pose(name)
                })
                .collect();
            let take = take.clone();
            let edit = if offset {
                Edit::OffsetPose(OffsetPose { take, time, poses, unstep: true })
            } else {
                Edit::SetPose(SetPose { take, time, poses, unstep: true })
            };
            let mut alone = start.clone();
            let before = edited.adapter().clone();
            let done = edited.apply(edit.clone(), Some(Gesture(5)));
            assert_eq!(done, alone.apply(edit, Some(Gesture(5))), "seed {number}");
            let wanted = if done.is_ok() { alone.adapter() } else { &before };
            assert!(same(wanted, edited.adapter()), "seed {number}");
            assert_eq!(edited.adapter().check(), Ok(()), "seed {number}");
            drop((before, alone));
            // A view that is still shown does not change.
            let now = edited.adapter().slots().to_vec();
            let looks: Vec<TakeVersions> = now.iter().map(|slot| TakeVersions::clone(slot)).collect();
            shown.push((now, looks));
            if random.below(3) == 0 {
                shown.clear();
            }
            for (slots, looks) in &shown {
                assert!(slots.iter().zip(looks).all(|(slot, look)| same_slot(slot, look)), "seed {number}");
            }
        }
        let end = edited.adapter().clone();
        let steps = edited.steps().1;
        if steps > start.steps().1 {
            edited.undo();
            assert!(same(start.adapter(), edited.adapter()), "seed {number}: undo");
            edited.redo();
            assert!(same(&end, edited.adapter()), "seed {number}: redo");
        }
    }
}

#[test]
fn undo_back_to_the_saved_state_marks_the_document_as_saved() {
    let mut edited = Edited::new(model(16));
    let name = |name: &str| Edit::RenameTake(RenameTake { take: TakeRef::Index(0), name: name.to_owned() });
    assert!(edited.is_saved());
    edited.apply(name("a"), None).unwrap();
    edited.mark_saved();
    edited.apply(name("b"), None).unwrap();
    assert!(!edited.is_saved());
    edited.undo();
    assert!(edited.is_saved());
    edited.undo();
    edited.apply(name("c"), None).unwrap();
    // The saved state cannot be reached any more, even with the same number of steps.
    assert!(!edited.is_saved());
    assert_eq!(edited.labels(), [Some("Rename take"), None]);
}

#[test]
fn a_cancelled_gesture_changes_nothing_and_can_be_followed_by_redo() {
    let mut edited = Edited::new(model(1));
    let rename = |name: &str| Edit::RenameTake(RenameTake { take: TakeRef::Index(0), name: name.to_owned() });
    for name in ["a", "b", "c"] {
        edited.apply(rename(name), None).unwrap();
    }
    edited.mark_saved();
    let whole = edited.adapter().clone();
    edited.undo();
    edited.undo();
    let before = edited.adapter().clone();
    let steps = |edited: &Edited| (edited.steps().0.len(), edited.steps().1, edited.saved());
    for name in ["d", "e"] {
        edited.apply(rename(name), Some(Gesture(7))).unwrap();
    }
    assert_eq!(steps(&edited), (2, 2, None), "until it is cancelled, it replaces what was undone");
    assert!(edited.cancel(Gesture(7)));
    assert_eq!(steps(&edited), (3, 1, Some(3)));
    assert!(same(edited.adapter(), &before));
    // Again with the same gesture, as a drag that comes back to where it began.
    edited.apply(rename("f"), Some(Gesture(7))).unwrap();
    assert!(edited.cancel(Gesture(7)));
    assert!(edited.redo() && edited.redo() && !edited.redo());
    assert!(same(edited.adapter(), &whole) && edited.is_saved());
}

#[test]
fn a_gesture_that_is_kept_removes_the_undone_steps() {
    let mut edited = Edited::new(model(1));
    let rename = |name: &str| Edit::RenameTake(RenameTake { take: TakeRef::Index(0), name: name.to_owned() });
    for end in [0, 1, 2] {
        edited.apply(rename("a"), None).unwrap();
        edited.apply(rename("b"), None).unwrap();
        edited.undo();
        let done = edited.steps().1;
        edited.apply(rename("c"), Some(Gesture(end))).unwrap();
        match end {
            0 => edited.end_gesture(),
            1 => edited.apply(rename("d"), None).unwrap(),
            _ => assert!(edited.undo() && edited.redo()),
        }
        edited.cancel(Gesture(end));
        assert!(!edited.redo(), "{end}");
        assert!(edited.steps().1 >= done, "{end}");
    }
}
