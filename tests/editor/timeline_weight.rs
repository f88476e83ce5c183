//! The lane of the weight of the active layer on the timeline: keys are added, dragged and deleted as steps of the document.

use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use egui::{PointerButton, Pos2, vec2};
use egui_kittest::kittest::Queryable;

const LANE: &str = "Weight of the layer over time";

/// Returns a window with an active layer.
fn animator() -> Animator {
    let mut animator = Animator::with_bone(3);
    animator.request(Request::Command(Id::AddLayer));
    animator
}

fn weights(animator: &Animator) -> Vec<(f32, f32)> {
    let settings = &animator.edited.adapter().slots()[0].layers()[0].settings;
    settings.weights.iter().map(|key| (key.time, key.weight)).collect()
}

/// Returns the point of the lane at a time and a fraction of its height.
fn point(animator: &Animator, time: f32, height: f32) -> Pos2 {
    let lane = animator.harness.get_by_label(LANE).rect();
    Pos2::new(animator.at(time, 0).x, lane.top() + height * lane.height())
}

/// Clicks twice. A frame of this window is as long as a double click may usually take.
fn double_click(animator: &mut Animator, at: Pos2) {
    animator.harness.ctx.options_mut(|options| options.input_options.max_double_click_delay = 2.0);
    // So that this click is not the third of three.
    animator.steps(16);
    animator.click(at);
    animator.click(at);
    animator.steps(2);
}

/// Chooses an entry of the menu at a place.
fn choose(animator: &mut Animator, at: Pos2, entry: &str) {
    animator.move_to(at);
    animator.button(at, PointerButton::Secondary, true);
    animator.button(at, PointerButton::Secondary, false);
    animator.steps(2);
    animator.harness.get_by_label(entry).click();
    animator.steps(4);
}

#[test]
fn the_lane_is_there_while_a_layer_is_active() {
    let mut animator = Animator::with_bone(3);
    assert!(animator.harness.query_by_label(LANE).is_none());
    animator.request(Request::Command(Id::AddLayer));
    assert!(animator.harness.query_by_label(LANE).is_some());
    animator.request(Request::ChooseLayer(None));
    assert!(animator.harness.query_by_label(LANE).is_none());
}

#[test]
fn a_double_click_adds_a_key_that_leaves_the_curve_as_it_is_and_a_drag_changes_frame_and_weight() {
    let mut animator = animator();
    let at = point(&animator, 0.5, 0.6);
    double_click(&mut animator, at);
    assert_eq!(weights(&animator), [(0.5, 1.0)], "at the weight that the layer has");
    let steps = animator.edited.steps().1;
    let key = animator.harness.get_by_label("Key of the weight, 0.500 s").rect().center();
    let to = point(&animator, 1.0, 0.5);
    animator.drag(key, to);
    animator.release(to);
    let [(time, weight)] = weights(&animator)[..] else { panic!("one key") };
    assert_eq!((time, weight), (1.0, 0.5));
    assert_eq!(animator.edited.steps().1, steps + 1, "one step");
    animator.request(Request::Command(Id::Undo));
    assert_eq!(weights(&animator), [(0.5, 1.0)]);
}

#[test]
fn a_key_is_not_dragged_past_its_neighbor_or_below_zero() {
    let mut animator = animator();
    for time in [0.2, 0.5, 0.8] {
        let at = point(&animator, time, 0.6);
        double_click(&mut animator, at);
    }
    let key = animator.harness.get_by_label("Key of the weight, 0.500 s").rect().center();
    let to = point(&animator, 1.0, 0.5) + vec2(0.0, 90.0);
    animator.drag(key, to);
    animator.release(to);
    let [first, dragged, last] = weights(&animator)[..] else { panic!("three keys") };
    assert_eq!((first, last), ((0.2, 1.0), (0.8, 1.0)));
    assert!(dragged.0 < 0.8 && dragged.0 > 0.79 && dragged.1 == 0.0, "{dragged:?}");
}

#[test]
fn keys_are_added_and_deleted_by_menus() {
    let mut animator = animator();
    for time in [0.5, 1.0] {
        let at = point(&animator, time, 0.6);
        choose(&mut animator, at, "Add key");
    }
    assert_eq!(weights(&animator), [(0.5, 1.0), (1.0, 1.0)]);
    let key = animator.harness.get_by_label("Key of the weight, 0.500 s").rect().center();
    choose(&mut animator, key, "Delete key");
    assert_eq!(weights(&animator), [(1.0, 1.0)]);
    let beside = point(&animator, 0.25, 0.6);
    choose(&mut animator, beside, "Delete all keys of the weight");
    assert_eq!(weights(&animator), []);
}
