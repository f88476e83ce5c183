//! Events on the timeline: added, moved, edited and deleted as steps of the document.

use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly_document::adapter::stored_events;
use dragonfly_document::edit::TakeEvent;
use egui::{Event, Key, PointerButton, vec2};
use egui_kittest::kittest::Queryable;

fn events(animator: &Animator) -> Vec<TakeEvent> {
    stored_events(&animator.edited.adapter().slots()[0].result.extras)
}

/// Returns the place of an event on the timeline.
fn place(animator: &Animator, name: &str) -> egui::Pos2 {
    let rect = animator.harness.get_by_label(&format!("Event {name}")).rect();
    rect.left_center() + vec2(6.0, 0.0)
}

/// Chooses an entry of the menu of an event.
fn choose(animator: &mut Animator, name: &str, entry: &str) {
    let at = place(animator, name);
    animator.move_to(at);
    animator.button(at, PointerButton::Secondary, true);
    animator.button(at, PointerButton::Secondary, false);
    animator.steps(2);
    animator.harness.get_by_label(entry).click();
    animator.steps(4);
}

/// Types a text in place of the text of the field.
fn write(animator: &mut Animator, text: &str, then: Key) {
    animator.harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
    animator.steps(1);
    animator.harness.event(Event::Text(text.to_owned()));
    animator.steps(2);
    animator.harness.key_press(then);
    animator.steps(3);
}

fn with_event(time: f32) -> Animator {
    let mut animator = Animator::with_bone(3);
    animator.request(Request::Seek(time));
    animator.request(Request::Command(Id::AddEvent));
    animator
}

#[test]
fn an_event_is_added_at_the_playhead_and_a_click_goes_to_it() {
    let mut animator = with_event(1.0);
    let wanted = TakeEvent { time: 1.0, name: "Event 1".to_owned(), payload: None };
    assert_eq!(events(&animator), [wanted]);
    animator.request(Request::Seek(2.0));
    let at = place(&animator, "Event 1");
    animator.click(at);
    assert_eq!(animator.harness.state().state.read().time(), 1.0);
    animator.request(Request::Command(Id::Undo));
    assert!(events(&animator).is_empty());
    assert!(animator.harness.query_by_label("Event Event 1").is_none(), "the lane is empty");
}

#[test]
fn a_drag_moves_an_event_by_one_step_that_can_be_undone() {
    let mut animator = with_event(1.0);
    let from = place(&animator, "Event 1");
    let by = animator.at(2.0, 0) - animator.at(1.0, 0);
    animator.drag(from, from + by);
    animator.release(from + by);
    let time = events(&animator)[0].time;
    assert!((time - 2.0).abs() < 0.05, "{time}");
    assert_eq!(animator.edited.steps().1, 2);
    animator.request(Request::Command(Id::Undo));
    assert_eq!(events(&animator)[0].time, 1.0);
}

#[test]
fn name_and_payload_are_typed_as_one_text_and_a_broken_one_changes_nothing() {
    let mut animator = with_event(1.0);
    choose(&mut animator, "Event 1", "Edit event");
    write(&mut animator, r#"step {"foot": "left", "strength": 0.5}"#, Key::Enter);
    let payload = Some(serde_json::json!({"foot": "left", "strength": 0.5}));
    assert_eq!(events(&animator), [TakeEvent { time: 1.0, name: "step".to_owned(), payload }]);
    let steps = animator.edited.steps().1;
    for (text, key) in [(r#"step {"foot": }"#, Key::Enter), ("other", Key::Escape)] {
        choose(&mut animator, "step", "Edit event");
        write(&mut animator, text, key);
        assert_eq!(animator.edited.steps().1, steps, "{text}");
        assert!(animator.harness.query_by_label("Name and payload of the event").is_none());
    }
}

#[test]
fn an_event_is_deleted_by_its_menu() {
    let mut animator = with_event(1.0);
    animator.request(Request::Seek(2.0));
    animator.request(Request::Command(Id::AddEvent));
    choose(&mut animator, "Event 2", "Delete event");
    let names: Vec<String> = events(&animator).into_iter().map(|event| event.name).collect();
    assert_eq!(names, ["Event 1"]);
}
