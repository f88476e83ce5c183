//! Undo restores the selection of keys and bones that was there before the edit, and redo the one after it.

use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use egui::vec2;

/// Returns the selected times of bone 3, as indices of the keys of the model.
fn selected(animator: &Animator) -> Vec<usize> {
    let state = &animator.harness.state().state;
    let (context, id) = (state.read(), (3, dragonfly_document::edit::Property::Rotation));
    let times = animator.times(3);
    let keys = context.keys.selection().of(id).keys(&times).flatten();
    keys.map(|key| (times[key] / animator.key(1)).round() as usize).collect()
}

fn bones(animator: &Animator) -> Vec<u32> {
    animator.harness.state().state.read().selection.bones().to_vec()
}

/// Selects the keys 3 to 5 of bone 3.
fn three_keys() -> Animator {
    let mut animator = Animator::with_bone(3);
    let (from, to) = (animator.at(animator.key(3) - 0.04, 4), animator.at(animator.key(5) + 0.04, 2));
    animator.drag(from, to);
    animator.release(to);
    assert_eq!(selected(&animator), [3, 4, 5]);
    animator
}

#[test]
fn undo_of_moved_keys_selects_the_keys_that_were_selected() {
    let mut animator = three_keys();
    let from = animator.at(animator.key(4), 2);
    let by = vec2(animator.at(animator.key(1), 0).x - animator.at(0.0, 0).x, 0.0);
    animator.drag(from, from + by);
    animator.release(from + by);
    assert_eq!(selected(&animator), [4, 5, 6]);
    animator.request(Request::Command(Id::Undo));
    assert_eq!(animator.times(3).len(), 41);
    assert_eq!(selected(&animator), [3, 4, 5]);
    animator.request(Request::Command(Id::Redo));
    assert_eq!(selected(&animator), [4, 5, 6]);
}

#[test]
fn undo_of_scaled_keys_selects_the_keys_that_were_selected() {
    let mut animator = three_keys();
    let time = animator.key(3);
    animator.request(Request::Seek(time));
    animator.request(Request::Command(Id::KeysSlower));
    assert_eq!(selected(&animator), [3, 5, 7], "one of the keys was overwritten");
    animator.request(Request::Command(Id::Undo));
    assert_eq!(animator.times(3).len(), 41);
    assert_eq!(selected(&animator), [3, 4, 5]);
}

#[test]
fn undo_of_deleted_keys_selects_them_again_with_their_bone() {
    let mut animator = three_keys();
    animator.request(Request::Command(Id::DeleteKeys));
    assert_eq!(animator.times(3).len(), 38);
    animator.request(Request::Select(Some(5)));
    animator.request(Request::Command(Id::Undo));
    assert_eq!(bones(&animator), [3]);
    assert_eq!(selected(&animator), [3, 4, 5]);
}

#[test]
fn undo_of_several_steps_restores_the_selection_before_the_first_of_them() {
    let mut animator = three_keys();
    animator.request(Request::Command(Id::KeysLater));
    animator.request(Request::Select(Some(2)));
    animator.request(Request::Command(Id::Key));
    animator.request(Request::Select(Some(4)));
    animator.request(Request::Change(dragonfly_document::Change::GoTo(0)));
    assert_eq!((bones(&animator), selected(&animator)), (vec![3], vec![3, 4, 5]));
}

#[test]
fn undo_of_an_edit_in_another_take_leaves_the_selection_of_keys() {
    let mut animator = three_keys();
    animator.request(Request::Command(Id::KeysLater));
    animator.request(Request::ShowTake(Some(1)));
    animator.request(Request::Command(Id::SelectAllKeys));
    let count = animator.selected();
    assert!(count > 3);
    animator.request(Request::Command(Id::Undo));
    assert_eq!(animator.selected(), count);
}

#[test]
fn with_undo_of_selections_undo_goes_back_through_selections_and_steps_in_their_order() {
    let mut animator = three_keys();
    let undo = |animator: &mut Animator| animator.request(Request::Command(Id::Undo));
    let redo = |animator: &mut Animator| animator.request(Request::Command(Id::Redo));
    animator.request(Request::Command(Id::UndoSelections));
    animator.request(Request::Select(Some(5)));
    animator.request(Request::Select(Some(6)));
    animator.request(Request::Command(Id::Key));
    animator.request(Request::Select(Some(7)));
    let steps =
        |animator: &Animator| animator.harness.state().state.read().view.map(|view| view.history.done);
    assert_eq!((bones(&animator), steps(&animator)), (vec![7], Some(1)));
    undo(&mut animator);
    assert_eq!((bones(&animator), steps(&animator)), (vec![6], Some(1)), "a selection first");
    undo(&mut animator);
    assert_eq!((bones(&animator), steps(&animator)), (vec![6], Some(0)), "then the step");
    undo(&mut animator);
    assert_eq!(bones(&animator), [5]);
    undo(&mut animator);
    assert_eq!((bones(&animator), selected(&animator)), (vec![3], vec![3, 4, 5]));
    for (bone, done) in [(5, 0), (6, 0), (6, 1), (7, 1)] {
        redo(&mut animator);
        assert_eq!((bones(&animator), steps(&animator)), (vec![bone], Some(done)));
    }
    // A new selection forgets those that were undone, and a new step those after it.
    undo(&mut animator);
    animator.request(Request::Select(Some(8)));
    redo(&mut animator);
    assert_eq!(bones(&animator), [8]);
}

#[test]
fn without_undo_of_selections_undo_takes_back_steps_alone() {
    let mut animator = three_keys();
    animator.request(Request::Command(Id::KeysLater));
    animator.request(Request::Select(Some(5)));
    animator.request(Request::Select(Some(6)));
    animator.request(Request::Command(Id::Undo));
    assert_eq!((bones(&animator), selected(&animator)), (vec![3], vec![3, 4, 5]));
}
