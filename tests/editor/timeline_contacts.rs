//! Contacts of the take on the timeline: found and added by commands, dragged as bars, and the slide of feet in the status line.

use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::keys::KeysRequest;
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{BoneRef, Edit};
use dragonfly_kit::document::fixture;
use egui::{Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::kittest::Queryable;

/// A bone of the fixture with two bones above it.
const BONE: u32 = 3;

fn animator() -> Animator {
    Animator::with_bone(BONE)
}

/// Returns the contacts that the panels show: bone, start and end in frames.
fn frames(animator: &Animator) -> Vec<(u32, i32, i32)> {
    let panels = animator.harness.state().state.read();
    let frame = |time: f32| (time * panels.frame_rate as f32).round() as i32;
    let contacts = panels.contacts.track().contacts();
    contacts.iter().map(|contact| (contact.bone, frame(contact.from), frame(contact.to))).collect()
}

fn edit(animator: &mut Animator, line: &str) {
    let edit: Edit = serde_json::from_str(line).expect(line);
    animator.request(Request::Change(Change::Edit(edit, None)));
}

/// An animator whose take has a contact from 1 s to 2 s.
fn with_contact() -> Animator {
    let mut animator = animator();
    edit(&mut animator, r#"{"edit":"set_contacts","take":0,"contacts":[{"bone":3,"from":1,"to":2}]}"#);
    animator
}

fn bar(animator: &Animator) -> egui::Rect {
    animator.harness.get_by_label_contains("Contact of ").rect()
}

#[test]
fn a_contact_is_added_over_the_play_range_and_deleted() {
    let mut animator = animator();
    let rate = animator.harness.state().state.read().frame_rate as i32;
    animator.request(Request::Command(Id::AddContact));
    assert!(animator.edits().is_empty());
    assert!(animator.said().starts_with("Set a play range"), "{}", animator.said());
    animator.request(Request::Command(Id::DeleteContacts));
    assert!(animator.said().contains("has no contacts"), "{}", animator.said());
    animator.request(Request::SelectBones(vec![3, 4], Choice::Replace));
    animator.request(Request::Timeline(KeysRequest::Range(Some([1.0, 2.0]))));
    animator.request(Request::Command(Id::AddContact));
    assert_eq!(frames(&animator), [(3, rate, 2 * rate), (4, rate, 2 * rate)]);
    animator.request(Request::Timeline(KeysRequest::Range(Some([1.5, 2.5]))));
    animator.request(Request::Select(Some(3)));
    animator.request(Request::Command(Id::AddContact));
    assert_eq!(frames(&animator)[0], (3, rate, rate * 5 / 2), "they are joined");
    animator.request(Request::Command(Id::DeleteContacts));
    assert_eq!(frames(&animator), [(4, rate, 2 * rate)], "only those of the selected bone");
    animator.request(Request::Command(Id::DeleteContacts));
    assert_eq!(frames(&animator), []);
    animator.request(Request::Command(Id::Undo));
    assert_eq!(frames(&animator).len(), 1);
}

#[test]
fn the_bar_of_a_contact_is_moved_and_its_ends_are_dragged_to_frames() {
    let mut animator = with_contact();
    let rate = animator.harness.state().state.read().frame_rate as i32;
    let keys = animator.keys();
    let second = animator.x_in(keys, 2.0) - animator.x_in(keys, 1.0);
    let half = vec2(second / 2.0, 0.0);
    let drag = |animator: &mut Animator, from: Pos2, by: egui::Vec2| {
        animator.drag(from, from + by);
        animator.release(from + by);
    };
    let from = bar(&animator).center();
    drag(&mut animator, from, half);
    let moved = frames(&animator)[0];
    assert!((moved.1 - rate * 3 / 2).abs() <= 1 && moved.2 - moved.1 == rate, "{moved:?}");
    let left = bar(&animator).left_center() + vec2(3.0, 0.0);
    drag(&mut animator, left, -half);
    let longer = frames(&animator)[0];
    assert!((longer.1 - rate).abs() <= 1 && longer.2 == moved.2, "{longer:?}");
    let right = bar(&animator).right_center() - vec2(3.0, 0.0);
    drag(&mut animator, right, vec2(-10.0 * second, 0.0));
    assert_eq!(frames(&animator)[0].2, longer.1 + 1, "a frame remains");
    let from = bar(&animator).center();
    drag(&mut animator, from, vec2(100.0 * second, 0.0));
    let (_, length) = animator.harness.state().state.read().take_bounds();
    let end = animator.harness.state().state.read().contacts.track().contacts()[0].to;
    assert!((end - length).abs() < 1e-3, "{end} in {length}");
    for _ in 0..4 {
        animator.request(Request::Command(Id::Undo));
    }
    assert_eq!(frames(&animator), [(BONE, rate, 2 * rate)], "each drag is one step");
}

#[test]
fn a_drag_of_a_contact_that_is_cancelled_changes_nothing() {
    let mut animator = with_contact();
    let (before, edits) = (frames(&animator), animator.edits().len());
    let from = bar(&animator).center();
    animator.drag(from, from + vec2(60.0, 0.0));
    animator.harness.key_press(egui::Key::Escape);
    animator.steps(2);
    animator.release(from + vec2(60.0, 0.0));
    assert_eq!((frames(&animator), animator.edits().len()), (before, edits));
}

#[test]
fn a_contact_is_deleted_and_played_by_its_menu_and_a_click_selects_its_bone() {
    let mut animator = with_contact();
    animator.request(Request::Select(Some(1)));
    let center = bar(&animator).center();
    animator.click(center);
    assert_eq!(animator.harness.state().state.read().selection.bones(), [BONE]);
    let menu = |animator: &mut Animator, entry: &str| {
        animator.move_to(center);
        animator.button(center, PointerButton::Secondary, true);
        animator.button(center, PointerButton::Secondary, false);
        animator.steps(2);
        animator.harness.get_by_label(entry).click();
        animator.steps(3);
    };
    menu(&mut animator, "Play this contact");
    assert_eq!(animator.harness.state().state.read().keys.range(), Some([1.0, 2.0]));
    menu(&mut animator, "Delete contact");
    assert_eq!(frames(&animator), []);
}

#[test]
fn feet_are_locked_in_the_contacts_of_the_take() {
    let mut animator = with_contact();
    animator.request(Request::Command(Id::LockContacts));
    let Some(Edit::LockContacts(edit)) = animator.edits().last().copied() else { panic!("no edit") };
    assert_eq!((edit.contacts.len(), edit.contacts[0].bone.clone()), (1, BoneRef::Index(BONE)));
    // The root has no bones above it that could hold it.
    let mut animator = Animator::new(fixture::full());
    self::edit(&mut animator, r#"{"edit":"set_contacts","take":0,"contacts":[{"bone":0,"from":1,"to":2}]}"#);
    let edits = animator.edits().len();
    animator.request(Request::Command(Id::LockContacts));
    assert_eq!(animator.edits().len(), edits);
    assert!(animator.said().contains("two bones above it"), "{}", animator.said());
}

#[test]
fn contacts_are_found_at_the_frame_rate_of_the_document() {
    let mut animator = animator();
    animator.request(Request::Command(Id::DetectContacts));
    let rate = animator.harness.state().state.read().frame_rate;
    let Some(Edit::DetectContacts(edit)) = animator.edits().last().copied() else { panic!("no edit") };
    assert_eq!(edit.rate, Some(rate as f32));
}

#[test]
fn the_status_line_shows_the_slide_of_the_worst_contact_and_a_click_goes_there() {
    let mut animator = animator();
    assert!(animator.harness.query_by_label_contains("Foot slide").is_none());
    edit(&mut animator, r#"{"edit":"set_contacts","take":0,"contacts":[{"bone":3,"from":1,"to":2}]}"#);
    animator.steps(2);
    let worst = animator.harness.state().state.read().contacts.worst().expect("a measurement");
    assert!(worst.millimeters_per_second > 1.0, "{worst:?}");
    let text = format!("Foot slide {:.0} mm/s", worst.millimeters_per_second);
    animator.request(Request::Select(None));
    animator.harness.get_by_label(&text).click();
    animator.steps(2);
    let panels = animator.harness.state().state.read();
    assert_eq!((panels.time(), panels.selected()), (1.0, Some(BONE)));
    animator.request(Request::Command(Id::LockContacts));
    animator.steps(2);
    let locked = animator.harness.state().state.read().contacts.worst().expect("a measurement");
    assert!(locked.millimeters_per_second < 0.5 * worst.millimeters_per_second, "{locked:?}, {worst:?}");
    animator.hold(Modifiers::NONE);
    animator.request(Request::ShowTake(None));
    animator.steps(2);
    assert!(animator.harness.query_by_label_contains("Foot slide").is_none(), "of no take");
}
