//! The timeline lists the bones that are asked for.

use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::keys::KeysRequest;
use dragonfly_document::Change;
use dragonfly_document::edit::{BonePose, BoneRef};
use dragonfly_kit::document::fixture;

fn listed(animator: &Animator) -> Vec<u32> {
    animator.harness.state().state.read().listed_bones()
}

#[test]
fn only_bones_whose_keys_are_not_those_of_the_file_are_listed_on_request() {
    let mut animator = Animator::new(fixture::full());
    animator.request(Request::Timeline(KeysRequest::OnlySelected(false)));
    let all = listed(&animator);
    assert!(all.len() > 3);
    animator.request(Request::Command(Id::SelectAllKeys));
    animator.request(Request::Command(Id::ListChangedBones));
    assert!(listed(&animator).is_empty());
    assert!(
        animator.harness.state().state.read().keys.selection().is_empty(),
        "only listed keys are selected"
    );
    let rotation = Some(glam::Quat::from_rotation_x(0.5).to_array());
    let poses = vec![BonePose { bone: BoneRef::Index(3), translation: None, rotation, scale: None }];
    let edit = animator.harness.state().state.read().pose_edit(poses).expect("an edit");
    animator.request(Request::Change(Change::Edit(edit, None)));
    assert_eq!(listed(&animator), [3]);
    animator.request(Request::Command(Id::Undo));
    assert!(listed(&animator).is_empty());
    // A take that is in no file is new in all its bones.
    animator.request(Request::Command(Id::DuplicateTake));
    assert_eq!(listed(&animator).len(), all.len());
    animator.request(Request::ShowTake(Some(0)));
    animator.request(Request::Command(Id::ListChangedBones));
    assert_eq!(listed(&animator), all);
}
