//! A viewport that is not shown leaves the mouse to the panels in its place.

use crate::timeline_rig::Animator;
use dragonfly::panels::VIEWPORT;
use dragonfly_picture::camera::Camera;
use egui::{PointerButton, pos2, vec2};

/// Orbits with the middle button where the viewport is by default. Returns the camera before and after.
fn orbit(animator: &mut Animator) -> [Camera; 2] {
    let at = pos2(500.0, 250.0);
    let camera = |animator: &Animator| animator.harness.state().state.read().camera;
    let before = camera(animator);
    animator.move_to(at);
    animator.button(at, PointerButton::Middle, true);
    animator.move_to(at + vec2(60.0, 0.0));
    let after = camera(animator);
    animator.button(at + vec2(60.0, 0.0), PointerButton::Middle, false);
    [before, after]
}

#[test]
fn the_tools_of_a_viewport_that_is_not_shown_take_no_press() {
    let mut animator = Animator::with_bone(3);
    let [before, after] = orbit(&mut animator);
    assert_ne!(before, after);
    animator.harness.state_mut().desk.toggle_panel(VIEWPORT);
    animator.steps(2);
    let [before, after] = orbit(&mut animator);
    assert_eq!(before, after, "hidden");
    assert!(!animator.harness.state().state.read().tools.controls().is_busy());
    // Shown again, it works again.
    animator.harness.state_mut().desk.toggle_panel(VIEWPORT);
    animator.steps(2);
    let [before, after] = orbit(&mut animator);
    assert_ne!(before, after, "shown again");
}
