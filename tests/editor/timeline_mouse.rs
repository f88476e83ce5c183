//! Mouse input on the timeline: selecting, moving, copying and scaling keys, and cancelling a drag.

use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::keys::{BoneFlag, KeyDragOp, KeysRequest};
use dragonfly_document::Change;
use dragonfly_document::edit::{DuplicateKeys, Edit, MoveKeys, RippleKeys, ScaleKeys, SetInterpolation};
use dragonfly_kit::document::fixture;
use egui::{Key, Modifiers, PointerButton, pos2, vec2};
use egui_kittest::kittest::Queryable;

const FRAME: f32 = 1.0 / 30.0;

#[test]
fn a_click_selects_a_key_and_a_click_on_no_key_clears_the_selection() {
    let mut animator = Animator::with_bone(3);
    let on = animator.at(animator.key(8), 2);
    animator.click(on);
    assert_eq!(animator.selected(), 1);
    let other = animator.at(animator.key(12), 2);
    animator.click(other);
    assert_eq!(animator.selected(), 1, "the other one instead");
    animator.hold(Modifiers::SHIFT);
    animator.click(on);
    assert_eq!(animator.selected(), 2, "Shift adds");
    animator.hold(Modifiers::COMMAND);
    animator.click(on);
    assert_eq!(animator.selected(), 1, "Ctrl takes out what is selected");
    animator.hold(Modifiers::NONE);
    let beside = animator.at(animator.key(8), 5);
    animator.click(beside);
    assert_eq!(animator.selected(), 0);
    assert!(animator.changes.is_empty(), "selecting is no edit");
}

#[test]
fn a_box_selects_what_it_touches_in_its_rows() {
    let mut animator = Animator::with_bone(3);
    let (from, to) = (animator.at(animator.key(4) - 0.04, 4), animator.at(animator.key(9) + 0.04, 2));
    animator.drag(from, to);
    animator.release(to);
    assert_eq!(animator.selected(), 6);
    // A box from right to left, with Shift, further right.
    animator.hold(Modifiers::SHIFT);
    let (from, to) = (animator.at(animator.key(22) + 0.04, 4), animator.at(animator.key(20) - 0.04, 2));
    animator.drag(from, to);
    animator.release(to);
    assert_eq!(animator.selected(), 9);
}

#[test]
fn a_drag_over_dense_keys_draws_a_box_until_they_are_selected() {
    let mut animator = Animator::with_bone(3);
    let far = animator.at(2.0, 2);
    for _ in 0..12 {
        animator.wheel(far, vec2(0.0, -120.0));
        animator.steps(2);
    }
    let apart = animator.at(animator.key(9), 2).x - animator.at(animator.key(8), 2).x;
    assert!(apart < 9.0, "zoomed out, keys are {apart} apart");
    let (from, to) = (animator.at(animator.key(8), 2), animator.at(animator.key(14), 2));
    animator.drag(from, to);
    animator.release(to);
    assert!(animator.changes.is_empty(), "no key was moved");
    assert_eq!(animator.selected(), 7, "all from the first to the last");
    animator.drag(from, from + vec2(30.0, 0.0));
    animator.release(from + vec2(30.0, 0.0));
    assert!(!animator.edits().is_empty(), "what is selected is moved");
}

#[test]
fn alt_click_selects_a_column_of_all_bones() {
    let mut animator = Animator::new(dragonfly_kit::document::fixture::full());
    animator.hold(Modifiers::ALT);
    let on = animator.at(animator.key(8), 2);
    animator.click(on);
    // Bone 0 has no translation there; each of the 64 bones has a rotation.
    assert_eq!(animator.selected(), 64);
}

#[test]
fn a_dragged_key_goes_to_the_nearest_frame_as_one_step() {
    let mut animator = Animator::with_bone(3);
    let grabbed = animator.key(8);
    let from = animator.at(grabbed, 2);
    let to = animator.at(grabbed + 0.03, 2) + vec2(0.0, 30.0);
    animator.drag(from, to);
    let held = animator.edited.adapter().slots()[0].result.tracks[3].rotation.times[8];
    assert!((held - grabbed).abs() > 1e-3, "the document follows while it is held");
    animator.release(to);
    let moved = animator.times(3)[8];
    let frames = moved / FRAME;
    assert!((frames - frames.round()).abs() < 1e-3, "{moved} is on a frame");
    assert!((moved - grabbed - 0.03).abs() <= FRAME / 2.0 + 1e-3, "{moved}");
    assert_eq!(animator.edited.steps().0.len(), 1, "one step, however many edits");
    assert_eq!(animator.selected(), 1, "what was dragged is selected where it is now");
    assert!(animator.edits().iter().all(|edit| matches!(edit, Edit::MoveKeys(MoveKeys { .. }))));
    assert!(animator.harness.state().state.read().keys.drag().is_none());
}

#[test]
fn the_selection_follows_the_dragged_keys_and_cancelling_restores_it() {
    let mut animator = Animator::with_bone(1);
    let (from, to) = (animator.key(4), 3.0);
    animator.click(animator.at(from, 1));
    let before = animator.times(1);
    animator.press(animator.at(from, 1));
    for part in 1..=4 {
        animator.move_to(animator.at(from + (to - from) * (part as f32 / 4.0), 1));
        assert_eq!(animator.selected(), 1, "step {part}");
        let panels = animator.harness.state().state.read();
        let drawn = panels.drawn_keys().unwrap();
        let time = drawn.selection.extent(&drawn.take).unwrap()[0];
        assert_eq!(panels.keys.selection().extent(panels.take().unwrap()), Some([time; 2]));
        let moved = panels.keys.drag().is_some() && part > 1;
        assert!(!moved || !before.contains(&time), "what is drawn contains the key where it was dragged");
    }
    animator.harness.key_press(egui::Key::Escape);
    animator.steps(3);
    assert_eq!(animator.times(1), before);
    let panels = animator.harness.state().state.read();
    let [time, _] = panels.keys.selection().extent(panels.take().unwrap()).unwrap();
    assert!((time - from).abs() < 1e-4, "{time}");
}

#[test]
fn ctrl_inverts_snapping() {
    let mut animator = Animator::with_bone(3);
    let grabbed = animator.key(8);
    animator.click(animator.at(grabbed, 2));
    animator.press(animator.at(grabbed, 2));
    animator.move_to(animator.at(grabbed + 0.04, 2));
    animator.hold(Modifiers::COMMAND);
    let to = animator.at(grabbed + 0.04, 2);
    animator.move_to(to);
    animator.release(to);
    let moved = animator.times(3)[8];
    assert!((moved - grabbed - 0.04).abs() < 4e-3, "{moved}");
}

#[test]
fn escape_and_the_right_button_cancel_a_drag() {
    for escape in [true, false] {
        let mut animator = Animator::with_bone(3);
        let before = animator.times(3);
        let (from, to) = (animator.at(animator.key(8), 2), animator.at(animator.key(11) + 0.04, 2));
        animator.drag(from, to);
        assert_ne!(animator.times(3), before);
        if escape {
            animator.harness.key_down(Key::Escape);
            animator.steps(2);
            animator.harness.key_up(Key::Escape);
        } else {
            animator.button(to, PointerButton::Secondary, true);
            animator.button(to, PointerButton::Secondary, false);
        }
        animator.steps(2);
        assert_eq!(animator.times(3), before, "Escape: {escape}");
        assert!(matches!(animator.changes.last(), Some(Change::Cancel(_))));
        // Input after the cancel, until the button is released, has no effect.
        let far = animator.at(animator.key(20), 2);
        animator.move_to(far);
        animator.release(far);
        assert_eq!(animator.times(3), before);
        assert_eq!(animator.edited.steps().0.len(), 0);
        assert_eq!(animator.harness.state().state.read().selected(), Some(3), "the bone stays selected");
        assert!(animator.harness.query_by_label("Duplicate keys").is_none(), "and no menu opens");
    }
}

#[test]
fn a_drag_back_to_its_start_changes_nothing() {
    let mut animator = Animator::with_bone(3);
    let before = animator.times(3);
    let from = animator.at(animator.key(8), 2);
    animator.drag(from, animator.at(animator.key(12), 2));
    animator.harness.state_mut().state.execute(Request::Timeline(KeysRequest::Snap(false)));
    animator.move_to(from);
    animator.release(from);
    assert_eq!(animator.times(3), before);
    assert_eq!(animator.edited.steps().0.len(), 0);
}

#[test]
fn a_drag_with_alt_copies_keys_and_with_the_2_key_held_inserts_time() {
    let mut animator = Animator::with_bone(3);
    animator.click(animator.at(animator.key(8), 2));
    animator.hold(Modifiers::ALT);
    let to = animator.at(animator.key(8) + 0.045, 2);
    animator.drag(animator.at(animator.key(8), 2), to);
    animator.release(to);
    assert_eq!(animator.times(3).len(), 42);
    assert!(matches!(animator.edits().last(), Some(Edit::DuplicateKeys(DuplicateKeys { .. }))));
    assert_eq!(animator.selected(), 1, "the copy");

    let mut animator = Animator::with_bone(3);
    animator.harness.key_down(Key::Num2);
    animator.steps(1);
    let to = animator.at(animator.key(9), 2);
    animator.drag(animator.at(animator.key(8), 2), to);
    animator.release(to);
    let Some(Edit::RippleKeys(RippleKeys { from, by, .. })) = animator.edits().last() else {
        panic!("{:?}", animator.edits())
    };
    assert!((from - animator.key(8)).abs() < 1e-4 && *by > 0.0);
    assert!((animator.times(9)[40] - 3.417 - by).abs() < 1e-3, "other bones make room too");
}

#[test]
fn dragging_the_playhead_snaps_to_keys_and_frames() {
    let mut animator = Animator::with_bone(3);
    let time = |animator: &Animator| animator.harness.state().state.read().time();
    let ruler = animator.harness.get_by_label("Time track").rect().center().y;
    let at = |animator: &Animator, time: f32| egui::pos2(animator.at(time, 0).x, ruler);
    // The keys of this model are not on whole frames.
    let near = at(&animator, animator.key(8)) + vec2(2.0, 0.0);
    animator.click(near);
    assert_eq!(time(&animator), animator.times(3)[8], "to the bit, so that a pose there is no second key");
    let between = at(&animator, animator.key(8) + 0.04);
    animator.click(between);
    let frames = time(&animator) * 30.0;
    assert!((frames - frames.round()).abs() < 1e-3, "{frames}");
    animator.hold(Modifiers::COMMAND);
    animator.click(near);
    assert_ne!(time(&animator), animator.times(3)[8], "Ctrl lets it go anywhere");
}

#[test]
fn after_a_click_on_a_row_the_other_rows_stay_listed_until_the_selection_changes_elsewhere() {
    let mut animator = Animator::new(fixture::full());
    let rows = |animator: &Animator| animator.harness.state().state.read().listed_bones().len();
    let all = rows(&animator);
    assert!(all > 3);
    for name in ["spine_00", "rib_00_left_inner"] {
        let row = animator.harness.get_by_label(&format!("Keys of {name}")).rect().center();
        animator.click(row);
        assert_eq!(animator.harness.state().state.read().selection.bones().len(), 1, "{name}");
        assert_eq!(rows(&animator), all, "{name}");
    }
    animator.request(Request::Select(Some(3)));
    assert_eq!(rows(&animator), 1);
}

#[test]
fn keying_a_pose_after_the_end_extends_the_take() {
    let mut animator = Animator::with_bone(3);
    animator.harness.state_mut().state.execute(Request::Command(Id::PlayPause));
    animator.request(Request::Command(Id::NewTake));
    let state = |animator: &Animator| animator.harness.state().state.read().take_bounds();
    let time = |animator: &Animator| animator.harness.state().state.read().time();
    assert_eq!(state(&animator), (0.0, 0.0), "one pose, and nothing to play");
    animator.request(Request::Command(Id::PlayPause));
    assert!(!animator.harness.state().state.read().playback.playing);
    assert!(animator.said().ends_with("there is nothing to play"), "{}", animator.said());
    // The time is set by a click in the ruler, by steps of a frame, and by a typed number.
    let ruler = animator.harness.get_by_label("Time track").rect();
    let at = pos2(animator.x_in(animator.keys(), 0.5), ruler.center().y);
    animator.click(at);
    assert_eq!(time(&animator), 0.5);
    for _ in 0..15 {
        animator.request(Request::Command(Id::NextFrame));
    }
    assert!((time(&animator) - 1.0).abs() < 1e-6);
    let x = animator.x_in(animator.keys(), 0.0);
    animator.request(Request::Command(Id::Key));
    assert_eq!(state(&animator), (0.0, 1.0));
    let seen = animator.x_in(animator.keys(), 1.05);
    assert!(animator.keys().x_range().contains(seen), "there is room to go on");
    assert_eq!(animator.x_in(animator.keys(), 0.0), x);
    animator.request(Request::Seek(20.0));
    let window = animator
        .harness
        .state()
        .state
        .read()
        .keys
        .window(animator.harness.state().state.read().take().unwrap());
    assert!(
        window.start <= 0.0 && window.start + window.length > 20.0,
        "the playhead is in sight: {window:?}"
    );
    animator.request(Request::Command(Id::Key));
    assert_eq!(state(&animator), (0.0, 20.0));
    // Undo leaves the playhead where the user put it; playback starts at the start.
    animator.request(Request::Command(Id::Undo));
    assert_eq!((state(&animator), time(&animator)), ((0.0, 1.0), 20.0));
    animator.request(Request::Command(Id::PlayPause));
    assert!(animator.harness.state().state.read().playback.playing && time(&animator) < 1.0);
    animator.request(Request::Command(Id::PlayPause));
    assert!(time(&animator) <= 1.0);
}

#[test]
fn dragging_to_the_edge_of_the_ruler_goes_to_the_end_of_the_take() {
    let mut animator = Animator::with_bone(3);
    let ruler = animator.harness.get_by_label("Time track").rect();
    let middle = ruler.center();
    for beyond in [-2.0, 60.0] {
        animator.drag(middle, pos2(ruler.right() + beyond, middle.y));
        animator.release(pos2(ruler.right() + beyond, middle.y));
        let state = &animator.harness.state().state;
        assert_eq!(
            state.read().time(),
            state.read().take().unwrap().end(),
            "{beyond} points beyond the edge"
        );
    }
}

#[test]
fn without_a_selected_bone_no_key_is_selected() {
    let mut animator = Animator::with_bone(3);
    animator.request(Request::Command(Id::SelectAllKeys));
    assert_eq!(animator.selected(), 41);
    animator.request(Request::Command(Id::ClearSelection));
    assert_eq!(animator.selected(), 0);
    animator.request(Request::Command(Id::DeleteKeys));
    assert!(animator.edits().is_empty());
}

#[test]
fn keys_stay_selected_when_time_is_inserted_or_removed_before_them() {
    let mut animator = Animator::with_bone(3);
    let (from, to) = (animator.at(animator.key(8) - 0.04, 4), animator.at(animator.key(11) + 0.04, 2));
    animator.drag(from, to);
    animator.release(to);
    assert_eq!(animator.selected(), 4);
    animator.request(Request::Seek(animator.key(9)));
    for id in [Id::RippleOpen, Id::RippleOpen, Id::RippleClose] {
        animator.request(Request::Command(id));
        assert_eq!(animator.selected(), 4, "{id:?}");
    }
    assert_eq!(animator.edited.steps().1, 3);
    // The same four keys: one before the gap, three after it.
    animator.request(Request::Command(Id::DeleteKeys));
    let times = animator.times(3);
    assert_eq!(times.len(), 37);
    assert!(times.iter().all(|&time| !(0.68..0.97).contains(&time)), "{times:?}");
}

#[test]
fn dragging_the_end_of_selected_keys_scales_about_their_start_or_with_alt_the_playhead() {
    for alt in [false, true] {
        scale_by_the_end(alt);
    }
}

fn scale_by_the_end(alt: bool) {
    let mut animator = Animator::with_bone(3);
    animator.request(Request::Seek(0.0));
    let (from, to) = (animator.at(animator.key(1) - 0.04, 4), animator.at(animator.key(10) + 0.04, 2));
    animator.drag(from, to);
    animator.release(to);
    assert_eq!(animator.selected(), 10);
    let grip = animator.harness.get_by_label("Scale keys by their end").rect().center();
    let end = grip + vec2(animator.at(2.0, 0).x - animator.at(1.0, 0).x, 0.0);
    animator.hold(if alt { Modifiers::ALT } else { Modifiers::NONE });
    animator.drag(grip, end);
    animator.release(end);
    let Some(Edit::ScaleKeys(ScaleKeys { about, factor, .. })) = animator.edits().last() else {
        panic!("{:?}", animator.edits())
    };
    let stays = if alt { 0.0 } else { animator.key(1) };
    assert!((about - stays).abs() < 1e-5, "{about} for {stays}");
    let wanted = (animator.key(10) + 1.0 - stays) / (animator.key(10) - stays);
    assert!((factor - wanted).abs() < 0.05, "{factor} for {wanted}");
    assert_eq!(animator.selected(), 10);
}

#[test]
fn editing_a_locked_bone_is_refused_with_a_message() {
    let mut animator = Animator::with_bone(3);
    animator.harness.get_by_label("Lock rib_00_left_middle").click();
    animator.steps(2);
    let before = animator.times(3);
    let to = animator.at(animator.key(12), 2);
    animator.drag(animator.at(animator.key(8), 2), to);
    animator.release(to);
    assert_eq!(animator.times(3), before);
    assert_eq!(animator.selected(), 0);
    let said = |animator: &Animator| {
        let line = animator.harness.state().state.read().status.last().map(|line| line.text.clone());
        line.unwrap_or_default()
    };
    assert!(said(&animator).contains("is locked"), "{}", said(&animator));
    // Edits from other panels are refused too.
    let poses = vec![dragonfly_document::edit::BonePose {
        bone: dragonfly_document::edit::BoneRef::Index(3),
        translation: Some([1.0, 0.0, 0.0]),
        rotation: None,
        scale: None,
    }];
    let edit = animator.harness.state().state.read().pose_edit(poses).unwrap();
    animator.request(Request::Change(Change::Edit(edit, None)));
    assert!(animator.changes.is_empty());
}

#[test]
fn muted_bones_show_the_rest_pose_and_solo_mutes_all_others() {
    let mut animator = Animator::new(dragonfly_kit::document::fixture::full());
    animator.request(Request::Timeline(KeysRequest::Flag(BoneFlag::Mute, 3, true)));
    assert_eq!(animator.harness.state().state.read().keys.flags().still(6), [3]);
    animator.request(Request::Timeline(KeysRequest::Flag(BoneFlag::Solo, 1, true)));
    assert_eq!(animator.harness.state().state.read().keys.flags().still(6), [0, 2, 3, 4, 5]);
    let view = animator.harness.state().state.read().view.cloned().unwrap();
    let takes = view.takes_without(&[3]);
    assert!(takes[0].tracks[3].is_empty() && !takes[0].tracks[2].is_empty());
    assert!(!view.takes[0].tracks[3].is_empty(), "what is saved stays");
}

#[test]
fn commands_interpolate_snap_retime_and_delete_the_selected_keys() {
    let mut animator = Animator::with_bone(3);
    animator.harness.key_press(Key::Delete);
    animator.steps(2);
    assert!(animator.changes.is_empty(), "no key is selected");
    animator.request(Request::Command(Id::SelectAllKeys));
    assert_eq!(animator.selected(), 41, "of the bone that is listed");
    animator.request(Request::Command(Id::InterpolateSpline));
    assert!(matches!(animator.edits().last(), Some(Edit::SetInterpolation(SetInterpolation { .. }))));
    animator.request(Request::Command(Id::SnapKeys));
    assert!(animator.times(3).iter().all(|time| (time * 30.0 - (time * 30.0).round()).abs() < 1e-3));
    let left = animator.times(3).len();
    assert_eq!(animator.selected(), left, "selected still");
    animator.request(Request::Seek(1.0));
    animator.request(Request::Command(Id::KeysFaster));
    let (first, last) = (animator.times(3)[0], *animator.times(3).last().unwrap());
    assert!((first - 0.5).abs() < 1e-3 && (last - 2.2).abs() < 0.02, "{first} {last}");
    animator.request(Request::Command(Id::KeysLater));
    assert!((animator.times(3)[0] - 0.5 - FRAME).abs() < 1e-3);
    let steps = animator.edited.steps().0.len();
    assert_eq!(steps, 4);
    animator.harness.key_press(Key::Delete);
    animator.steps(2);
    assert!(animator.times(3).is_empty());
    for _ in 0..5 {
        animator.request(Request::Change(Change::Undo));
    }
    assert_eq!(animator.times(3).len(), 41);
}

#[test]
fn the_wheel_zooms_about_the_pointer_and_the_middle_button_pans() {
    let mut animator = Animator::with_bone(3);
    let time = animator.key(8);
    let at = animator.at(time, 3);
    animator.wheel(at, vec2(0.0, 80.0));
    assert!((animator.at(time, 3).x - at.x).abs() < 1.0, "what is under the pointer stays");
    let state = &animator.harness.state().state;
    let zoomed = state.read().keys.window(state.read().take().unwrap());
    assert!(zoomed.length < 3.0, "{zoomed:?}");
    animator.move_to(at);
    animator.button(at, PointerButton::Middle, true);
    for part in 1..=4 {
        animator.move_to(at + vec2(part as f32 * -10.0, 0.0));
    }
    animator.button(at + vec2(-40.0, 0.0), PointerButton::Middle, false);
    assert!((animator.at(time, 3).x - at.x + 40.0).abs() < 1.5, "it follows the hand");
    animator.request(Request::Command(Id::FitKeys));
    let state = &animator.harness.state().state;
    assert_eq!(state.read().keys.window(state.read().take().unwrap()).length, f64::from(3.417_f32));
}

#[test]
fn only_the_play_range_plays_but_any_time_can_be_shown() {
    let mut animator = Animator::with_bone(3);
    animator.request(Request::Timeline(KeysRequest::Range(Some([1.0, 0.5]))));
    animator.request(Request::Seek(3.0));
    assert_eq!(animator.harness.state().state.read().time(), 3.0, "even outside of the range");
    animator.request(Request::Command(Id::PlayPause));
    let state = &animator.harness.state().state;
    assert_eq!((state.read().playback.start, state.read().playback.length), (0.5, 0.5));
    let later = state.read().now + std::time::Duration::from_millis(725);
    assert!(
        (state.read().playback.time_at(later) - 0.725).abs() < 1e-3,
        "{}",
        state.read().playback.time_at(later)
    );
    animator.request(Request::Command(Id::PlayPause));
    animator.request(Request::Command(Id::RangeWhole));
    let state = &animator.harness.state().state;
    assert_eq!((state.read().playback.start, state.read().playback.length), (0.0, 3.417));
}

#[test]
fn a_refused_drag_changes_nothing() {
    let mut animator = Animator::with_bone(3);
    let before = animator.times(3);
    animator.click(animator.at(0.0, 2));
    animator.request(Request::Timeline(KeysRequest::Drag(KeyDragOp::Move(-5.0))));
    animator.request(Request::Timeline(KeysRequest::Release));
    assert_eq!(animator.times(3), before);
    assert!(animator.harness.state().state.read().keys.drag().is_none(), "no drag is active");
    assert_eq!(animator.selected(), 1);
}

#[test]
fn keys_that_are_no_longer_listed_are_not_deleted() {
    let mut animator = Animator::with_bone(3);
    animator.request(Request::Command(Id::SelectAllKeys));
    assert_eq!(animator.selected(), 41);
    animator.harness.state_mut().state.execute(Request::Select(Some(2)));
    animator.steps(2);
    assert_eq!(animator.selected(), 0, "another bone is listed");
    animator.harness.key_press(Key::Delete);
    animator.steps(2);
    assert!(animator.changes.is_empty());
    // All bones are listed in the mode "all bones", and one bone when its name is searched for.
    animator.request(Request::Timeline(KeysRequest::OnlySelected(false)));
    animator.request(Request::Command(Id::SelectAllKeys));
    let all = animator.selected();
    let name = animator.harness.state().state.read().bone_name(3);
    animator.request(Request::Timeline(KeysRequest::Filter(name)));
    assert!((1..all).contains(&animator.selected()), "{} of {all}", animator.selected());
}

#[test]
fn pausing_moves_the_playhead_to_a_whole_frame() {
    let mut animator = Animator::with_bone(3);
    for (snaps, wanted) in [(true, 10.0 / 30.0), (false, 0.345)] {
        animator.request(Request::Timeline(KeysRequest::Snap(snaps)));
        // It plays, however slowly, until it is paused.
        let state = &mut animator.harness.state_mut().state;
        state.execute(Request::Seek(0.345));
        state.execute(Request::Command(Id::PlayPause));
        assert!(state.read().playback.playing);
        state.execute(Request::Command(Id::PlayPause));
        let state = &animator.harness.state().state;
        assert!(!state.read().playback.playing);
        assert!((state.read().time() - wanted).abs() < 1e-5, "{} s", state.read().time());
    }
}
