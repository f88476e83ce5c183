//! Keys are copied, cut and pasted with exactly their values, at the playhead.

use crate::timeline_rig::Animator;
use dragonfly::panels::commands::Id;
use dragonfly::panels::keys::clipboard::{CopiedKeys, CopiedValues, copied, from_text, to_text};
use dragonfly::panels::keys::intervals::WHOLE;
use dragonfly::panels::keys::{BoneFlag, ChannelId, KeySelection, KeysRequest, channel};
use dragonfly::panels::{Effect, Request};
use dragonfly_anim::data::{Interpolation, Take};
use dragonfly_document::Change;
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{
    BonePose, BoneRef, CopiedChannel, CopiedKey, Edit, KeyInterpolation, PasteKeys, Property, SetPending,
    SetPose, TakeRef,
};
use dragonfly_kit::document::made_take::{model, walk};
use dragonfly_kit::random::{Random, seed};
use egui::{Event, Modifiers, PointerButton};

fn all(take: &Take) -> Vec<ChannelId> {
    take.tracks.iter().flat_map(|track| channel::channels(take, track.bone)).collect()
}

fn selected(take: &Take, stretch: [f32; 2]) -> KeySelection {
    let mut selection = KeySelection::default();
    selection.choose(take, &all(take), stretch, Choice::Replace);
    selection
}

/// Returns the keys of a channel from a time on: the bits of the time and of all numbers of each key.
fn bits(take: &Take, (bone, property): ChannelId, from: f32) -> Vec<(u32, Vec<u32>)> {
    let track = channel::track(take, bone).expect("a track");
    let times = channel::times(take, (bone, property));
    let value = |key: usize| -> Vec<u32> {
        let numbers: Vec<f32> = match property {
            Property::Translation => of(&track.translation.values, times.len(), key, |v| v.to_array().into()),
            Property::Rotation => of(&track.rotation.values, times.len(), key, |v| v.to_array().into()),
            Property::Scale => of(&track.scale.values, times.len(), key, |v| v.to_array().into()),
        };
        numbers.into_iter().map(f32::to_bits).collect()
    };
    let keys = times.iter().enumerate().filter(|(_, time)| **time >= from);
    keys.map(|(key, time)| (time.to_bits(), value(key))).collect()
}

fn of<T: Copy>(values: &[T], keys: usize, key: usize, numbers: fn(T) -> Vec<f32>) -> Vec<f32> {
    let per_key = values.len() / keys;
    values[key * per_key..(key + 1) * per_key].iter().flat_map(|&value| numbers(value)).collect()
}

fn paste(take: TakeRef, time: f32, channels: Vec<CopiedChannel>) -> Edit {
    Edit::PasteKeys(PasteKeys { take, time, channels, shapes: Vec::new() })
}

#[test]
fn pasting_copied_keys_over_themselves_changes_no_bit() {
    let first = seed(41);
    for number in first..first + 20 {
        let mut random = Random::new(number);
        let mut model = model(number);
        let turned = BonePose {
            bone: BoneRef::Index(1),
            translation: Some([0.3, -0.2, 0.1]),
            rotation: Some([0.1, 0.2, 0.3, 0.9]),
            scale: None,
        };
        model
            .apply(&Edit::SetPose(SetPose { take: walk(), time: 0.3, poses: vec![turned], unstep: false }))
            .unwrap();
        let take = model.slots()[0].result.clone();
        let from = random.between(0.0, 0.8);
        let selection = selected(&take, [from, from + random.between(0.0, 0.5)]);
        let channels = copied(&take, &selection, model.skeleton());
        if channels.is_empty() {
            continue;
        }
        // Through the clipboard, as text.
        let keys = CopiedKeys { channels: channels.clone(), values: CopiedValues::Poses, shapes: Vec::new() };
        assert_eq!(from_text(&to_text(keys.clone())).unwrap(), keys);
        let at = selection.extent(&take).unwrap()[0];
        let before = model.clone();
        let inverse = model.apply(&paste(walk(), at, channels)).unwrap();
        model.check().unwrap();
        for id in all(&take) {
            assert_eq!(
                bits(&take, id, 0.0),
                bits(&model.slots()[0].result, id, 0.0),
                "seed {number}, {id:?}"
            );
        }
        model.revert(inverse);
        assert_eq!(model.slots()[0].result, before.slots()[0].result, "seed {number}: undone");
    }
}

#[test]
fn keys_pasted_into_another_take_at_another_time_keep_their_spacing_and_values() {
    let mut model = model(8);
    let take = model.slots()[0].result.clone();
    let channels = copied(&take, &selected(&take, WHOLE), model.skeleton());
    let wave = TakeRef::Name("wave".to_owned());
    model.apply(&paste(wave, 2.0, channels)).unwrap();
    model.check().unwrap();
    let now = &model.slots()[1].result;
    for id in all(&take) {
        let (old, new) = (bits(&take, id, 0.0), bits(now, id, 1.0));
        assert_eq!(old.len(), new.len(), "{id:?}");
        for (old, new) in old.iter().zip(&new) {
            let (was, is) = (f32::from_bits(old.0), f32::from_bits(new.0));
            assert!((was + 2.0 - is).abs() < 1e-6, "{id:?}: {was} {is}");
            // The channel that gets the keys keeps its own interpolation, so only the values are compared.
            let per_key = old.1.len() / new.1.len();
            let value = if per_key == 3 { &old.1[new.1.len()..2 * new.1.len()] } else { &old.1[..] };
            assert_eq!(value, &new.1[..], "{id:?}");
        }
    }
    assert_eq!((now.start, now.length), (0.0, 3.0));
}

fn key(after: f64, value: &[f32]) -> CopiedKey {
    CopiedKey { after, value: value.to_vec(), arrive: None, leave: None }
}

fn one(bone: &str, interpolation: KeyInterpolation, keys: Vec<CopiedKey>) -> Vec<CopiedChannel> {
    let bone = BoneRef::Name(bone.to_owned());
    vec![CopiedChannel { bone, property: Property::Translation, interpolation, keys }]
}

#[test]
fn a_channel_without_keys_gets_the_pasted_interpolation_and_a_spline_gets_tangents() {
    let mut model = model(9);
    let keys = vec![key(0.0, &[0.0; 3]), key(1.0, &[1.0, 0.0, 0.0]), key(2.0, &[4.0, 0.0, 0.0])];
    model.apply(&paste(walk(), 0.5, one("still", KeyInterpolation::Step, keys.clone()))).unwrap();
    model.check().unwrap();
    let slot = model.slots()[0].clone();
    assert_eq!(slot.result.tracks[4].translation.interpolation, Interpolation::Step);
    assert_eq!(slot.result.tracks[4].translation.times[..], [0.5, 1.5, 2.5]);
    assert_eq!(slot.result.end(), 2.5, "the take goes on as long as they do");
    // Long after the last key of a spline: the tangent of the middle key points from the first key to the last.
    model.apply(&paste(walk(), 4.0, one("hip", KeyInterpolation::Linear, keys))).unwrap();
    model.check().unwrap();
    let hip = model.slots()[0].result.tracks[1].translation.clone();
    assert_eq!(hip.interpolation, Interpolation::CubicSpline);
    let at = hip.times.iter().position(|&time| time == 5.0).unwrap();
    assert_eq!(hip.values[at * 3].to_array(), [2.0, 0.0, 0.0]);
    assert_eq!(hip.values[at * 3 + 2].to_array(), [2.0, 0.0, 0.0]);
}

#[test]
fn invalid_pasted_keys_are_refused_and_unknown_bones_skipped() {
    let mut model = model(10);
    let before = model.slots()[0].clone();
    for (time, channels) in [
        (0.5, one("root", KeyInterpolation::Linear, vec![key(0.0, &[0.0; 2])])),
        (0.5, one("root", KeyInterpolation::Linear, vec![key(0.0, &[f32::NAN, 0.0, 0.0])])),
        (0.5, one("root", KeyInterpolation::Linear, vec![key(f64::INFINITY, &[0.0; 3])])),
        (0.5, one("root", KeyInterpolation::Linear, vec![key(-1.0, &[0.0; 3])])),
        (f32::NAN, one("root", KeyInterpolation::Linear, vec![key(0.0, &[0.0; 3])])),
        (0.5, one("root", KeyInterpolation::Linear, Vec::new())),
        (0.5, one("tail of another model", KeyInterpolation::Linear, vec![key(0.0, &[0.0; 3])])),
        (0.5, Vec::new()),
    ] {
        assert!(model.apply(&paste(walk(), time, channels.clone())).is_err(), "{channels:?}");
        assert!(std::sync::Arc::ptr_eq(&model.slots()[0], &before));
    }
    let mut both = one("tail of another model", KeyInterpolation::Linear, vec![key(0.0, &[0.0; 3])]);
    both.extend(one("root", KeyInterpolation::Linear, vec![key(0.1, &[1.0; 3])]));
    model.apply(&paste(walk(), 0.5, both)).unwrap();
    // A pasted key replaces the pending pose at its time.
    let wait = BonePose { bone: BoneRef::Index(0), translation: Some([5.0; 3]), rotation: None, scale: None };
    model.apply(&Edit::SetPending(SetPending { take: walk(), time: 0.9, poses: vec![wait] })).unwrap();
    model
        .apply(&paste(walk(), 0.8, one("root", KeyInterpolation::Linear, vec![key(0.1, &[2.0; 3])])))
        .unwrap();
    assert_eq!(model.slots()[0].pending_poses(), 0);
    assert_eq!(ModelAdapter::check(&model), Ok(()));
}

/// Returns the text copied to the clipboard last.
fn clipboard(animator: &mut Animator) -> String {
    let effects = std::mem::take(&mut animator.harness.state_mut().effects);
    let text = |effect: Effect| if let Effect::Copy(text) = effect { Some(text) } else { None };
    effects.into_iter().filter_map(text).next_back().unwrap_or_default()
}

fn put_in(animator: &mut Animator, text: &str) {
    animator.request(Request::PastePose { text: text.to_owned(), mirrored: false });
}

fn said(animator: &Animator) -> String {
    animator.harness.state().state.read().status.last().map(|line| line.text.clone()).unwrap_or_default()
}

#[test]
fn ctrl_c_copies_keys_in_the_timeline_and_the_pose_elsewhere() {
    let mut animator = Animator::with_bone(3);
    animator.click(animator.at(animator.key(8), 2));
    animator.hold(Modifiers::SHIFT);
    animator.click(animator.at(animator.key(11), 2));
    animator.hold(Modifiers::NONE);
    assert_eq!(animator.selected(), 2);
    animator.harness.event(Event::Copy);
    animator.steps(2);
    let text = clipboard(&mut animator);
    let CopiedKeys { channels, .. } = from_text(&text).unwrap_or_else(|| panic!("keys, not {text}"));
    assert_eq!((channels.len(), channels[0].keys.len()), (1, 2));
    assert!(said(&animator).contains("Copied 2 keys"), "{}", said(&animator));
    // With the pointer over the viewport, the pose is copied.
    let picture = animator.harness.state().state.read().viewport.center();
    animator.press(picture);
    animator.button(picture, PointerButton::Primary, false);
    animator.harness.event(Event::Copy);
    animator.steps(2);
    let pose = clipboard(&mut animator);
    assert!(from_text(&pose).is_none() && pose.contains("\"pose\""), "{pose}");
    // Pasted keys start at the playhead, keep their distances and are selected, in one undo step.
    let before = animator.times(3);
    animator.request(Request::Seek(2.0));
    put_in(&mut animator, &text);
    let now = animator.times(3);
    let new: Vec<f32> = now.iter().copied().filter(|time| !before.contains(time)).collect();
    let apart = animator.key(11) - animator.key(8);
    assert_eq!(new.len(), 2, "{new:?}");
    assert!((new[0] - 2.0).abs() < 1e-6 && (new[1] - 2.0 - apart).abs() < 1e-6, "{new:?}");
    assert_eq!(animator.selected(), 2, "the pasted keys");
    assert_eq!(animator.edited.steps().0.len(), 1);
    animator.request(Request::Change(Change::Undo));
    assert_eq!(animator.times(3), before);
    // A view that arrives between the paste and its answer does not prevent the selection of the pasted keys.
    let bench = animator.harness.state_mut();
    let effect = bench.state.execute(Request::PastePose { text, mirrored: false });
    let mut view = bench.state.read().view.cloned().expect("open");
    view.generation += 1;
    bench.state.show(view);
    bench.effects.extend(effect);
    animator.steps(3);
    assert_eq!(animator.selected(), 2, "the pasted keys");
}

#[test]
fn keys_are_pasted_onto_the_same_number_of_bones_and_into_another_take() {
    let mut animator = Animator::with_bone(3);
    animator.click(animator.at(animator.key(8), 2));
    animator.request(Request::Command(Id::Copy));
    let text = clipboard(&mut animator);
    animator.request(Request::Select(Some(5)));
    animator.request(Request::Seek(1.01));
    let (three, five) = (animator.times(3), animator.times(5));
    put_in(&mut animator, &text);
    assert_eq!(animator.times(3), three);
    assert_eq!(animator.times(5).len(), five.len() + 1);
    // Two bones are selected, and the keys are from one bone, so they are pasted to the bone that they came from.
    animator.request(Request::SelectBones(vec![6], Choice::Add));
    animator.request(Request::Seek(1.03));
    put_in(&mut animator, &text);
    assert_eq!(animator.times(3).len(), three.len() + 1);
    // In another take.
    animator.request(Request::ShowTake(Some(1)));
    animator.request(Request::Seek(0.31));
    let keys = |animator: &Animator| animator.edited.adapter().slots()[1].result.tracks[3].rotation.len();
    let before = keys(&animator);
    put_in(&mut animator, &text);
    assert_eq!(keys(&animator), before + 1);
}

#[test]
fn cutting_copies_and_deletes_in_one_step_and_a_locked_bone_gets_no_keys() {
    let mut animator = Animator::with_bone(3);
    animator.click(animator.at(animator.key(8), 2));
    let before = animator.times(3);
    animator.harness.event(Event::Cut);
    animator.steps(3);
    let text = clipboard(&mut animator);
    assert!(from_text(&text).is_some(), "{text}");
    assert_eq!(animator.times(3).len(), before.len() - 1);
    assert_eq!(animator.edited.steps().0.len(), 1);
    animator.request(Request::Timeline(KeysRequest::Flag(BoneFlag::Lock, 3, true)));
    let asked = animator.changes.len();
    put_in(&mut animator, &text);
    assert_eq!(animator.changes.len(), asked);
    assert!(said(&animator).contains("is locked"), "{}", said(&animator));
    animator.request(Request::Timeline(KeysRequest::Flag(BoneFlag::Lock, 3, false)));
    animator.request(Request::Seek(animator.key(8)));
    put_in(&mut animator, &text);
    assert_eq!(animator.times(3), before, "back where it was");
    // Only poses can be pasted mirrored.
    animator.request(Request::PastePose { text, mirrored: true });
    assert!(said(&animator).contains("only poses"), "{}", said(&animator));
}
