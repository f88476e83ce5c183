//! A press and a release within one frame are a click, as on a slow machine.

use crate::timeline_rig::Animator;
use dragonfly::panels::commands::Id;
use dragonfly::panels::{Request, State};
use egui::{Event, Modifiers, PointerButton, Pos2};
use egui_kittest::kittest::Queryable;

/// Presses and releases the button before the next frame.
fn quick_click(animator: &mut Animator, pos: Pos2, modifiers: Modifiers) {
    animator.move_to(pos);
    for pressed in [true, false] {
        let button = PointerButton::Primary;
        // The harness draws a frame for each event that it queues; these two are in one.
        let events = &mut animator.harness.input_mut().events;
        events.push(Event::ModifiersChanged(modifiers));
        events.push(Event::PointerButton { pos, button, pressed, modifiers });
    }
    animator.steps(3);
    animator.hold(Modifiers::NONE);
}

fn state(animator: &Animator) -> &State {
    &animator.harness.state().state
}

#[test]
fn a_quick_click_on_a_key_of_the_timeline_selects_it() {
    let mut animator = Animator::with_bone(3);
    for (keys, key) in [(1, 8), (1, 12)] {
        let at = animator.at(animator.key(key), 2);
        quick_click(&mut animator, at, Modifiers::NONE);
        assert_eq!(animator.selected(), keys, "key {key}");
    }
    let at = animator.at(animator.key(20), 2);
    quick_click(&mut animator, at, Modifiers::SHIFT);
    assert_eq!(animator.selected(), 2, "Shift adds");
    let empty = animator.keys().right_bottom() - egui::vec2(60.0, 6.0);
    quick_click(&mut animator, empty, Modifiers::NONE);
    assert_eq!(animator.selected(), 0, "a click on nothing deselects");
}

#[test]
fn a_quick_click_on_a_key_of_the_curves_selects_it() {
    let mut animator = Animator::with_bone(3);
    let x = animator.x_in(animator.curves(), animator.key(8));
    let curves = animator.curves();
    // The flat curves of the other components are at the lower edge of the curve's hill.
    let mut y = curves.bottom();
    while animator.selected() == 0 && y > curves.top() {
        y -= 5.0;
        quick_click(&mut animator, egui::pos2(x, y), Modifiers::NONE);
    }
    assert_eq!(animator.selected(), 1);
}

#[test]
fn a_quick_click_on_the_ruler_moves_the_playhead() {
    let mut animator = Animator::with_bone(3);
    for ruler in ["Time track", "Time track of the curves"] {
        animator.request(Request::Seek(0.0));
        let rect = animator.harness.get_by_label(ruler).rect();
        quick_click(&mut animator, rect.center(), Modifiers::NONE);
        assert!(state(&animator).read().time() > 1.0, "{ruler}");
    }
}

#[test]
fn a_quick_click_on_a_selected_key_is_no_drag() {
    let mut animator = Animator::with_bone(3);
    animator.request(Request::Command(Id::SelectAllKeys));
    let at = animator.at(animator.key(8), 2);
    quick_click(&mut animator, at, Modifiers::NONE);
    assert_eq!(animator.selected(), 1);
    assert!(animator.edits().is_empty());
}
