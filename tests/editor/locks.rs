//! Locked bones: edits that leave them out, edits that are refused, and edits of the whole take that include them.

use crate::timeline_rig::Animator;
use dragonfly::panels::commands::{Id, KeySettings, Preset};
use dragonfly::panels::keys::{BoneFlag, BoneFlags, KeysRequest};
use dragonfly::panels::{Effect, Request};
use dragonfly_document::Change;
use dragonfly_document::adapter::{ModelAdapter, TakeVersions};
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{
    Arbitrary, BonePose, BoneRef, DeleteKeys, DropPending, EDITS, Edit, EditedBones, KeyPending, PastePose,
    Property, RetimeTake, SetPending, TakeRef, TrimTake,
};
use dragonfly_document::posing::clipboard;
use dragonfly_kit::random::{Random, seed};
use egui_kittest::kittest::Queryable;

const LEFT: u32 = 3;
const RIGHT: u32 = 6;

fn lock(animator: &mut Animator, bone: u32, on: bool) {
    animator.request(Request::Timeline(KeysRequest::Flag(BoneFlag::Lock, bone, on)));
}

fn said(animator: &Animator) -> String {
    animator.harness.state().state.read().status.last().map(|line| line.text.clone()).unwrap_or_default()
}

fn turned(bone: u32) -> BonePose {
    let rotation = Some([0.6, 0.0, 0.0, 0.8]);
    BonePose { bone: BoneRef::Index(bone), translation: None, rotation, scale: None }
}

/// Returns the bones of the edit that was requested last.
fn bones(animator: &Animator) -> Vec<BoneRef> {
    match animator.edits().last() {
        Some(Edit::PastePose(PastePose { poses, .. })) => {
            poses.iter().map(|pose| pose.bone.clone()).collect()
        }
        Some(Edit::KeyPending(KeyPending { bones, .. }) | Edit::DropPending(DropPending { bones, .. })) => {
            bones.clone()
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn keys_typed_after_a_refused_drag_run_no_command() {
    let mut animator = Animator::with_bone(3);
    animator.request(Request::Keys(KeySettings { preset: Preset::Blender, ..KeySettings::default() }));
    animator.request(Request::Command(Id::ToggleGrid));
    animator.request(Request::Timeline(KeysRequest::OnlySelected(false)));
    animator.request(Request::Timeline(KeysRequest::Flag(BoneFlag::Lock, 3, true)));
    animator.request(Request::Command(Id::SelectAllKeys));
    assert!(animator.selected() > 0, "of the other bones");
    let viewport = animator.harness.get_by_label("Viewport").rect().center();
    animator.move_to(viewport);
    let camera = animator.harness.state().state.read().camera;
    for key in [egui::Key::R, egui::Key::X, egui::Key::Num3, egui::Key::Num0, egui::Key::Enter] {
        animator.harness.key_press(key);
        animator.steps(2);
    }
    assert!(animator.said().contains("is locked"), "{}", animator.said());
    assert!(animator.edits().is_empty(), "{:?}", animator.edits());
    assert_eq!(animator.harness.state().state.read().camera, camera);
    assert_eq!(animator.harness.state().state.read().playback.take, Some(0));
    // After the drag, keys run their commands again.
    animator.harness.key_press(egui::Key::X);
    animator.steps(2);
    assert!(matches!(animator.edits()[..], [Edit::DeleteKeys(DeleteKeys { .. })]), "{:?}", animator.edits());
}

#[test]
fn bones_are_muted_soloed_and_locked_by_commands_too() {
    let mut animator = Animator::with_bone(3);
    for (id, flag) in
        [(Id::MuteBones, BoneFlag::Mute), (Id::SoloBones, BoneFlag::Solo), (Id::LockBones, BoneFlag::Lock)]
    {
        for on in [true, false] {
            animator.request(Request::Command(id));
            assert_eq!(animator.harness.state().state.read().keys.flags().has(flag, 3), on, "{id:?}");
        }
    }
}

#[test]
fn a_pose_is_pasted_on_all_bones_but_the_locked_ones() {
    let mut animator = Animator::with_bone(LEFT);
    let text = clipboard::to_text(&[turned(LEFT), turned(RIGHT)]);
    lock(&mut animator, LEFT, true);
    animator.request(Request::PastePose { text: text.clone(), mirrored: false });
    assert_eq!(bones(&animator), [BoneRef::Index(RIGHT)]);
    assert!(said(&animator).contains("is locked and stays"), "{}", said(&animator));
    // For a mirrored pose, the lock of the bone on the other side counts.
    animator.request(Request::PastePose { text: text.clone(), mirrored: true });
    assert_eq!(bones(&animator), [BoneRef::Index(LEFT)], "it goes to the right one");
    lock(&mut animator, RIGHT, true);
    let asked = animator.changes.len();
    animator.request(Request::PastePose { text, mirrored: false });
    assert_eq!(animator.changes.len(), asked, "both are locked");
    assert!(said(&animator).contains("is locked"), "{}", said(&animator));
}

#[test]
fn the_pending_pose_of_a_locked_bone_is_neither_keyed_nor_dropped() {
    for command in [Id::KeyAllPending, Id::Key, Id::DropPending] {
        let mut animator = Animator::with_bone(LEFT);
        animator.request(Request::Seek(0.5));
        let poses = vec![turned(LEFT), turned(RIGHT)];
        let pend = Edit::SetPending(SetPending { take: TakeRef::Index(0), time: 0.5, poses });
        animator.request(Request::Change(Change::Edit(pend, None)));
        lock(&mut animator, LEFT, true);
        animator.request(Request::Command(command));
        assert_eq!(bones(&animator), [BoneRef::Index(RIGHT)], "{command:?}");
        let slot = animator.edited.adapter().slots()[0].clone();
        let waits: Vec<u32> = slot.pending()[0].poses.iter().map(|pose| pose.bone).collect();
        assert_eq!(waits, [LEFT], "{command:?}");
        assert_eq!(slot.key_at(LEFT, Property::Rotation, 0.5), None, "{command:?}");
        let asked = animator.changes.len();
        animator.request(Request::Command(Id::KeyAllPending));
        assert_eq!(animator.changes.len(), asked, "only the locked one waits");
        assert!(said(&animator).contains("is locked"), "{}", said(&animator));
        lock(&mut animator, LEFT, false);
        animator.request(Request::Command(Id::KeyAllPending));
        assert_eq!(bones(&animator), []);
        assert_eq!(animator.edited.adapter().pending_poses(), 0);
    }
}

#[test]
fn keys_are_added_to_unlocked_bones_that_moved_only() {
    let mut animator = Animator::with_bone(LEFT);
    lock(&mut animator, LEFT, true);
    animator.harness.state_mut().state.execute(Request::Select(None));
    animator.request(Request::Seek(0.05));
    let keys = |animator: &Animator, bone: u32| animator.times(bone as usize).len();
    let before = [LEFT, RIGHT].map(|bone| keys(&animator, bone));
    animator.request(Request::Command(Id::Key));
    assert_eq!([LEFT, RIGHT].map(|bone| keys(&animator, bone)), [before[0], before[1] + 1]);
    let track = &animator.edited.adapter().slots()[0].original.tracks[RIGHT as usize];
    assert!(track.scale.times.is_empty(), "it never grew");
    // If a locked and an unlocked bone are selected, the unlocked one gets its key.
    animator.harness.state_mut().state.execute(Request::SelectBones(vec![LEFT, RIGHT], Choice::Replace));
    animator.request(Request::Seek(0.06));
    animator.harness.get_by_label("Add a rotation key").click();
    animator.steps(3);
    assert_eq!([LEFT, RIGHT].map(|bone| keys(&animator, bone)), [before[0], before[1] + 2]);
}

#[test]
fn a_locked_bone_cannot_be_aimed_and_a_message_gives_the_reason() {
    let mut animator = Animator::with_bone(LEFT);
    lock(&mut animator, LEFT, true);
    animator.harness.state_mut().state.execute(Request::SelectBones(vec![LEFT, RIGHT], Choice::Replace));
    animator.request(Request::Command(Id::LookAt));
    assert_eq!(animator.changes, []);
    assert!(said(&animator).contains("is locked"), "{}", said(&animator));
}

#[test]
fn edits_of_the_whole_take_include_locked_bones() {
    let mut animator = Animator::with_bone(LEFT);
    lock(&mut animator, LEFT, true);
    let before = animator.times(LEFT as usize);
    animator.request(Request::Command(Id::ReverseTake));
    let after = animator.times(LEFT as usize);
    assert_eq!(after, animator.times(RIGHT as usize));
    let take = TakeRef::Index(0);
    for edit in [
        Edit::RetimeTake(RetimeTake { take: take.clone(), start: None, length: Some(2.0) }),
        Edit::TrimTake(TrimTake { take, from: 0.5, to: 1.5, to_start: false }),
    ] {
        animator.request(Request::Change(Change::Edit(edit, None)));
        assert_eq!(animator.times(LEFT as usize), animator.times(RIGHT as usize), "in step");
        assert_ne!(animator.times(LEFT as usize), before);
    }
    assert!(!animator.harness.state().effects.iter().any(|effect| matches!(effect, Effect::Change(_))));
}

/// Edits of whole takes: they include locked bones, see [`edits_of_the_whole_take_include_locked_bones`].
const OF_WHOLE_TAKES: [&str; 23] = [
    "add_root_bone",
    "create_take",
    "delete_take",
    "rename_take",
    "move_take",
    "split_take",
    "trim_take",
    "reverse_take",
    "retime_take",
    "add_take",
    "add_takes",
    "set_extras",
    "detect_contacts",
    "set_contacts",
    "set_events",
    "shift_loop",
    "add_layer",
    "delete_layer",
    "set_layer",
    "key_layer_weight",
    "set_layer_weights",
    "move_layer",
    "merge_layers",
];

/// Kinds of edits for which the small model has no spline, no travel, and no shape key.
const NOT_HERE: [&str; 8] = [
    "set_tangents",
    "set_many_tangents",
    "restore_travel",
    "set_shapes",
    "set_shape_keys",
    "offset_shapes",
    "pend_shapes",
    "script",
];

/// Returns a model of three bones with two takes and a pending pose.
fn small_model() -> ModelAdapter {
    let view = dragonfly_kit::document::fixture::view(
        "small.glb",
        dragonfly_kit::document::fixture::skeleton(1),
        &[("Walk", 1.0, 5), ("Run", 1.3, 4)],
    );
    let mut model = ModelAdapter::new(&view.loaded.model.animation);
    let poses = vec![turned(1), turned(LEFT)];
    model.apply(&Edit::SetPending(SetPending { take: TakeRef::Index(0), time: 0.3, poses })).expect("bones");
    for line in [
        r#"{"edit":"add_layer","take":0,"name":"Up"}"#,
        r#"{"edit":"set","take":{"take":0,"layer":0},"time":0.3,"poses":[{"bone":1,"translation":[0,3,0]}]}"#,
    ] {
        model.apply(&serde_json::from_str(line).expect("an edit")).expect(line);
    }
    model
}

#[test]
fn no_kind_of_edit_changes_a_locked_bone_unless_it_changes_the_whole_take() {
    let before = small_model();
    let skeleton = before.skeleton();
    let names: Vec<BoneRef> = (0..skeleton.len() as u32).map(BoneRef::Index).collect();
    let state = |slot: &TakeVersions, bone: u32| {
        let poses = slot.pending().iter().filter_map(|at| Some((at.time, *at.of(bone)?)));
        let tracks = [&slot.result, slot.shown()].map(|take| take.tracks.get(bone as usize).cloned());
        (tracks, poses.collect::<Vec<_>>())
    };
    let mut random = Random::new(seed(43));
    for locked in 0..skeleton.len() as u32 {
        let mut flags = BoneFlags::default();
        flags.set(BoneFlag::Lock, locked, true);
        for kind in EDITS {
            let (mut refused, mut applied) = (0, 0);
            for _ in 0..150 {
                let edit = (kind.arbitrary)(&mut Arbitrary::new(&mut || random.bits(), 2, &names));
                let whole = edit.bones(skeleton) == EditedBones::WholeTake;
                assert_eq!(whole, OF_WHOLE_TAKES.contains(&kind.name), "{edit:?}");
                let mut after = before.clone();
                if whole || after.apply(&edit).is_err() {
                    continue;
                }
                let change = Change::Edit(edit, None);
                if flags.locked_bone_in(&change, skeleton).is_some() {
                    refused += 1;
                    continue;
                }
                applied += 1;
                for (before, after) in before.slots().iter().zip(after.slots()) {
                    assert!(
                        state(before, locked) == state(after, locked),
                        "{change:?} changes bone {locked}"
                    );
                }
            }
            let none = NOT_HERE.contains(&kind.name) || OF_WHOLE_TAKES.contains(&kind.name);
            assert!(refused + applied > 0 || none, "no {} applies", kind.name);
        }
    }
}
