//! Edits are shown before the document confirms them.

use crate::viewport_tools_rig::ViewportHarness;
use dragonfly::panels::echo::Echo;
use dragonfly_document::edit::{
    BonePose, BoneRef, DropPending, Edit, KeySet, MoveKeys, PoseAt, ReverseTake, SetPose, SetPoses, TakeRef,
};
use dragonfly_document::history::Gesture;
use dragonfly_document::{Change, View, open_model};
use dragonfly_kit::document::fixture;
use std::sync::Arc;

const GESTURE: Gesture = Gesture(5);

/// Returns a change that moves bone 1 to `x` at the start of the first take.
fn set(x: f32, gesture: Option<Gesture>) -> Change {
    let translation = Some([x, 0.0, 0.0]);
    let pose = BonePose { bone: BoneRef::Index(1), translation, rotation: None, scale: None };
    let take = TakeRef::Index(0);
    Change::Edit(Edit::SetPose(SetPose { take, time: 0.0, poses: vec![pose], unstep: false }), gesture)
}

/// Returns a change that moves bone 1 to `x` at the start of the first take, by an edit that takes too long to be shown
/// before the document answers.
fn set_slowly(x: f32, gesture: Option<Gesture>) -> Change {
    let pose =
        BonePose { bone: BoneRef::Index(1), translation: Some([x, 0.0, 0.0]), rotation: None, scale: None };
    let at = vec![PoseAt { time: 0.0, poses: vec![pose] }; 5000];
    Change::Edit(Edit::SetPoses(SetPoses { take: TakeRef::Index(0), at, unstep: false }), gesture)
}

/// Returns a change that moves all keys of the first take.
fn move_keys(by: f32, gesture: Option<Gesture>) -> Change {
    let keys = vec![KeySet::default()];
    Change::Edit(Edit::MoveKeys(MoveKeys { take: TakeRef::Index(0), keys, shapes: Vec::new(), by }), gesture)
}

/// Returns the start of the first take.
fn start_of(view: Option<&View>) -> f32 {
    view.unwrap().takes[0].start
}

/// Returns the x coordinate of bone 1 at the start of the first take.
fn x_of(view: Option<&View>) -> f32 {
    let view = view.unwrap();
    let bone = &view.loaded.model.animation.skeleton.bones[1];
    dragonfly_anim::sample::sample_track(&view.takes[0].tracks[1], bone, 0.0).translation.x
}

/// Returns the document's view after `changes`, the last of which has number `answered`.
fn answer(first: &View, answered: u64, changes: &[Change]) -> View {
    let mut edited = first.edited();
    for change in changes {
        match change {
            Change::Edit(edit, gesture) => edited.ask(edit.clone(), *gesture).unwrap(),
            Change::Cancel(gesture) => assert!(edited.cancel(*gesture)),
            other => panic!("{other:?}"),
        }
    }
    let takes = edited.adapter().results().cloned().collect();
    let slots = edited.adapter().slots().into();
    View { generation: first.generation + answered, answered, takes, slots, ..first.clone() }
}

#[test]
fn an_edit_is_shown_until_the_view_that_contains_it_arrives() {
    let first = fixture::full();
    let (mut echo, mut shown) = (Echo::default(), Some(first.clone()));
    let number = echo.send(&set(3.0, None), &mut shown);
    assert_eq!(x_of(shown.as_ref()), 3.0, "at once");
    assert_ne!(
        shown.as_ref().unwrap().generation,
        first.generation,
        "the generation differs, so that caches are updated"
    );
    assert!(!echo.has_answered(number));
    let view = answer(&first, number, &[set(3.0, None)]);
    let takes = Arc::clone(&view.takes);
    let now = echo.receive(view, &mut shown);
    assert!(echo.has_answered(number) && Arc::ptr_eq(&now.takes, &takes), "the document's own");
    assert_eq!(shown.unwrap().generation, first.generation, "and before it the document's last one");
}

#[test]
fn a_view_without_the_newest_edit_does_not_hide_that_edit() {
    let first = fixture::full();
    let (mut echo, mut shown) = (Echo::default(), Some(first.clone()));
    let one = echo.send(&set(1.0, Some(GESTURE)), &mut shown);
    let two = echo.send(&set(2.0, Some(GESTURE)), &mut shown);
    let now = echo.receive(answer(&first, one, &[set(1.0, Some(GESTURE))]), &mut shown);
    assert_eq!(x_of(Some(&now)), 2.0);
    shown = Some(now);
    let changes = [set(1.0, Some(GESTURE)), set(2.0, Some(GESTURE))];
    let now = echo.receive(answer(&first, two, &changes), &mut shown);
    assert_eq!((x_of(Some(&now)), now.generation), (2.0, first.generation + two));
}

#[test]
fn an_edit_that_the_document_refuses_is_no_longer_shown() {
    let first = fixture::full();
    let (mut echo, mut shown) = (Echo::default(), Some(first.clone()));
    let before = x_of(shown.as_ref());
    let number = echo.send(&set(3.0, None), &mut shown);
    let now = echo.receive(View { answered: number, ..first }, &mut shown);
    assert_eq!(x_of(Some(&now)), before);
}

#[test]
fn a_cancelled_drag_is_undone_at_once() {
    let first = fixture::full();
    let (mut echo, mut shown) = (Echo::default(), Some(first.clone()));
    let before = x_of(shown.as_ref());
    echo.send(&set(1.0, Some(GESTURE)), &mut shown);
    echo.send(&set(2.0, Some(GESTURE)), &mut shown);
    echo.send(&Change::Cancel(GESTURE), &mut shown);
    assert_eq!(x_of(shown.as_ref()), before);
}

#[test]
fn an_invalid_edit_is_not_shown() {
    let first = fixture::full();
    let (mut echo, mut shown) = (Echo::default(), Some(first.clone()));
    let wrong = Change::Edit(
        Edit::DropPending(DropPending {
            take: TakeRef::Index(99),
            time: None,
            bones: Vec::new(),
            shapes: false,
        }),
        None,
    );
    echo.send(&wrong, &mut shown);
    assert_eq!(shown.unwrap().generation, first.generation);
}

#[test]
fn a_model_opened_during_an_edit_is_shown_unchanged() {
    let (first, other) = (fixture::full(), fixture::full());
    let (mut echo, mut shown) = (Echo::default(), Some(first));
    echo.send(&set(3.0, None), &mut shown);
    let now = echo.receive(other.clone(), &mut shown);
    assert_eq!(now.generation, other.generation);
    assert!(Arc::ptr_eq(&now.takes, &other.takes));
}

#[test]
fn each_edit_of_a_drag_moves_the_keys_from_where_they_were_at_its_start() {
    let first = fixture::full();
    let (mut echo, mut shown) = (Echo::default(), Some(first.clone()));
    let start = start_of(shown.as_ref());
    let mut changes = Vec::new();
    for by in [0.25, 0.5, 0.75] {
        changes.push(move_keys(by, Some(GESTURE)));
        let number = echo.send(changes.last().unwrap(), &mut shown);
        assert!(echo.shows(number) && !echo.has_answered(number));
        assert!((start_of(shown.as_ref()) - start - by).abs() < 1e-5, "{by}, at once");
        let now = echo.receive(answer(&first, number, &changes), &mut shown);
        assert!((start_of(Some(&now)) - start - by).abs() < 1e-5, "{by}, in the view of the document");
        shown = Some(now);
    }
    let number = echo.send(&Change::Cancel(GESTURE), &mut shown);
    assert!(echo.shows(number));
    assert_eq!(start_of(shown.as_ref()), start, "cancelled");
}

#[test]
fn a_slow_edit_is_shown_when_the_document_answers_it() {
    let first = fixture::full();
    let (mut echo, mut shown) = (Echo::default(), Some(first.clone()));
    let before = x_of(shown.as_ref());
    let number = echo.send(&set_slowly(3.0, None), &mut shown);
    assert!(!echo.shows(number));
    assert_eq!(x_of(shown.as_ref()), before);
    let now = echo.receive(answer(&first, number, &[set_slowly(3.0, None)]), &mut shown);
    assert!(echo.shows(number));
    assert_eq!(x_of(Some(&now)), 3.0);
}

#[test]
fn an_edit_after_a_slow_edit_is_shown_only_together_with_it() {
    let first = fixture::full();
    let (mut echo, mut shown) = (Echo::default(), Some(first.clone()));
    let start = start_of(shown.as_ref());
    let changes = [set_slowly(3.0, None), move_keys(0.5, None)];
    let long = echo.send(&changes[0], &mut shown);
    let after = echo.send(&changes[1], &mut shown);
    assert_eq!(start_of(shown.as_ref()), start);
    shown = Some(echo.receive(answer(&first, long, &changes[..1]), &mut shown));
    shown = Some(echo.receive(answer(&first, after, &changes), &mut shown));
    assert!((start_of(shown.as_ref()) - start - 0.5).abs() < 1e-5);
    let number = echo.send(&move_keys(0.5, None), &mut shown);
    assert!(echo.shows(number), "nothing is unanswered any more");
    assert!((start_of(shown.as_ref()) - start - 1.0).abs() < 1e-5);
}

#[test]
fn a_drag_begun_during_a_slow_edit_is_shown_only_as_the_document_answers() {
    let first = fixture::full();
    let (mut echo, mut shown) = (Echo::default(), Some(first.clone()));
    let start = start_of(shown.as_ref());
    let mut changes = vec![set_slowly(3.0, None), move_keys(0.25, Some(GESTURE))];
    echo.send(&changes[0], &mut shown);
    let number = echo.send(&changes[1], &mut shown);
    shown = Some(echo.receive(answer(&first, number, &changes), &mut shown));
    assert!((start_of(shown.as_ref()) - start - 0.25).abs() < 1e-5);
    changes.push(move_keys(0.5, Some(GESTURE)));
    let number = echo.send(&changes[2], &mut shown);
    assert!(!echo.shows(number), "the takes from the start of the drag are not known here");
    assert!((start_of(shown.as_ref()) - start - 0.25).abs() < 1e-5);
    shown = Some(echo.receive(answer(&first, number, &changes), &mut shown));
    assert!((start_of(shown.as_ref()) - start - 0.5).abs() < 1e-5);
}

#[test]
fn a_drag_may_alternate_between_quick_and_slow_edits() {
    let first = fixture::full();
    let (mut echo, mut shown) = (Echo::default(), Some(first.clone()));
    let start = start_of(shown.as_ref());
    let mut changes = vec![set_slowly(3.0, Some(GESTURE))];
    let number = echo.send(&changes[0], &mut shown);
    shown = Some(echo.receive(answer(&first, number, &changes), &mut shown));
    assert_eq!(x_of(shown.as_ref()), 3.0);
    changes.push(move_keys(0.5, Some(GESTURE)));
    let number = echo.send(&changes[1], &mut shown);
    assert!(echo.shows(number));
    assert_ne!(x_of(shown.as_ref()), 3.0, "an edit of a drag replaces the one before");
    assert!((start_of(shown.as_ref()) - start - 0.5).abs() < 1e-5);
    let guess = (x_of(shown.as_ref()), start_of(shown.as_ref()));
    let now = echo.receive(answer(&first, number, &changes), &mut shown);
    assert_eq!((x_of(Some(&now)), start_of(Some(&now))), guess);
}

#[test]
fn the_document_answers_a_numbered_change_that_it_refuses() {
    let mut viewport = ViewportHarness::new(open_model);
    let before = viewport.state.read().view.cloned().unwrap();
    viewport
        .change_numbered(7, Change::Edit(Edit::ReverseTake(ReverseTake { take: TakeRef::Index(99) }), None));
    assert_eq!(viewport.refused.len(), 1);
    let after = viewport.state.read().view.unwrap();
    assert_eq!((after.answered, after.generation), (7, before.generation));
}
