//! Smoothing holds the feet of a take with contacts, unless that is switched off.

use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::keys::{BoneFlag, KeysRequest};
use dragonfly_document::Change;
use dragonfly_document::edit::{BoneRef, Edit};
use egui_kittest::kittest::Queryable;

/// A bone of the fixture with two bones above it.
const BONE: u32 = 3;

/// An animator whose take has a contact, with all keys of the bone selected.
fn animator() -> Animator {
    let mut animator = Animator::with_bone(BONE);
    let line = r#"{"edit":"set_contacts","take":0,"contacts":[{"bone":3,"from":1,"to":2}]}"#;
    let edit: Edit = serde_json::from_str(line).expect(line);
    animator.request(Request::Change(Change::Edit(edit, None)));
    animator.request(Request::Command(Id::SelectAllKeys));
    animator.steps(2);
    animator
}

/// Runs a command and returns the feet that its edit holds.
fn held(animator: &mut Animator, id: Id) -> Vec<BoneRef> {
    animator.request(Request::Command(id));
    match animator.edits().last() {
        Some(Edit::FilterKeys(edit)) => edit.hold.clone(),
        Some(Edit::BlendKeys(edit)) => edit.hold.clone(),
        Some(Edit::NoiseKeys(edit)) => edit.hold.clone(),
        other => panic!("{id:?}: {other:?}"),
    }
}

#[test]
fn tools_that_smooth_hold_feet_and_those_that_pose_do_not() {
    for id in [Id::SmoothKeys, Id::SmoothButterworth, Id::RemovePeaks, Id::RelaxKeys, Id::NoiseKeys] {
        assert_eq!(held(&mut animator(), id), [BoneRef::Index(BONE)], "{id:?}");
    }
    for id in [Id::TweenKeys, Id::PushKeys, Id::BlendToRest, Id::DelayKeys] {
        assert_eq!(held(&mut animator(), id), [], "{id:?}");
    }
}

#[test]
fn the_switch_beside_the_sliders_lets_feet_move_and_is_remembered() {
    let mut animator = animator();
    animator.harness.get_by_label("In-between").click();
    animator.steps(3);
    let switch = animator.harness.get_by_label("Hold feet").rect().center();
    animator.click(switch);
    animator.steps(2);
    assert_eq!(held(&mut animator, Id::SmoothKeys), []);
    assert!(!animator.harness.state().state.read().settings.timeline.hold_feet);
    animator.request(Request::Command(Id::ToggleHoldFeet));
    assert_eq!(held(&mut animator, Id::SmoothKeys), [BoneRef::Index(BONE)]);
}

#[test]
fn feet_are_not_held_by_locked_bones_in_layers_or_without_contacts() {
    let mut locked = animator();
    let skeleton = &locked.harness.state().state.read().loaded().expect("a model").model.animation.skeleton;
    let parent = skeleton.bones[BONE as usize].parent.expect("a parent");
    locked.request(Request::Timeline(KeysRequest::Flag(BoneFlag::Lock, parent, true)));
    locked.request(Request::Command(Id::SelectAllKeys));
    assert_eq!(held(&mut locked, Id::SmoothKeys), []);

    let mut layered = animator();
    let line = r#"{"edit":"add_layer","take":0,"name":"Up"}"#;
    let edit: Edit = serde_json::from_str(line).expect(line);
    layered.request(Request::Change(Change::Edit(edit, None)));
    layered.request(Request::ChooseLayer(None));
    layered.request(Request::Command(Id::SelectAllKeys));
    assert_eq!(held(&mut layered, Id::SmoothKeys), []);
    layered.harness.get_by_label("In-between").click();
    layered.steps(3);
    assert!(layered.harness.query_by_label("Hold feet").is_none());

    let mut without = Animator::with_bone(BONE);
    without.request(Request::Command(Id::SelectAllKeys));
    assert_eq!(held(&mut without, Id::SmoothKeys), []);
}
