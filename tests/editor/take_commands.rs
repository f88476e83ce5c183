//! The commands that change a whole take use what is chosen in the window: the play range, the selected bones, the playhead.

use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::keys::KeysRequest;
use dragonfly_document::edit::{BoneRef, Edit};
use dragonfly_kit::document::fixture;

#[test]
fn a_take_or_its_play_range_is_mirrored_and_the_second_time_gives_it_back() {
    let mut animator = Animator::new(fixture::full());
    let take = |animator: &Animator| animator.edited.adapter().slots()[0].result.clone();
    let before = take(&animator);
    for _ in 0..2 {
        animator.request(Request::Command(Id::MirrorTake));
    }
    assert!(matches!(animator.edits()[..], [Edit::MirrorTake(_), Edit::MirrorTake(_)]));
    assert_eq!(animator.edited.steps().0.len(), 2);
    for (was, is) in before.tracks.iter().zip(&take(&animator).tracks) {
        for key in 0..was.rotation.len() {
            let (was, is) = (was.rotation.value(key).unwrap(), is.rotation.value(key).unwrap());
            assert!(was.dot(is).abs() > 1.0 - 1e-5, "key {key}: {was} {is}");
        }
    }
    animator.request(Request::Timeline(KeysRequest::Range(Some([0.5, 1.5]))));
    animator.request(Request::Select(Some(3)));
    animator.request(Request::Command(Id::MirrorTake));
    let Some(Edit::MirrorTake(edit)) = animator.edits().last().copied() else { panic!("no edit") };
    assert_eq!((edit.from, edit.to, edit.bones.len()), (Some(0.5), Some(1.5), 0));
    animator.request(Request::Command(Id::MirrorBonesInTake));
    let Some(Edit::MirrorTake(edit)) = animator.edits().last().copied() else { panic!("no edit") };
    assert_eq!(edit.bones, [BoneRef::Index(3)]);
}

#[test]
fn a_loop_is_closed_from_the_playhead_to_the_end_of_the_take() {
    let mut animator = Animator::new(fixture::full());
    let (start, length) = animator.harness.state().state.read().take_bounds();
    animator.request(Request::Seek(start + length));
    animator.request(Request::Command(Id::CloseLoop));
    assert!(animator.edits().is_empty());
    assert!(animator.said().starts_with("Move the playhead"), "{}", animator.said());
    let rate = animator.harness.state().state.read().frame_rate;
    animator.request(Request::Seek(start + length - 6.0 / rate as f32));
    animator.request(Request::Command(Id::CloseLoop));
    let Some(Edit::CloseLoop(edit)) = animator.edits().last().copied() else { panic!("no edit") };
    assert_eq!((edit.frames, edit.rate), (6, Some(rate as f32)));
    assert_eq!(animator.edited.steps().0.len(), 1);
    animator.request(Request::Command(Id::Undo));
    assert_eq!(animator.edited.steps().1, 0);
}

#[test]
fn feet_are_locked_at_the_frame_rate_of_the_document() {
    let mut animator = Animator::new(fixture::full());
    animator.request(Request::Command(Id::LockContacts));
    let rate = animator.harness.state().state.read().frame_rate;
    let Some(Edit::LockContacts(edit)) = animator.edits().last().copied() else { panic!("no edit") };
    assert_eq!((edit.rate, edit.ease, edit.contacts.len()), (Some(rate as f32), 4, 0));
}
