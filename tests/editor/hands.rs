//! Hands on the picture: what mouse and keys do there reaches the document at once, as one step a drag.

use crate::hands_rig::Hand;
use dragonfly::control::{InputEvent, Key, Modifiers};
use dragonfly::panels::commands::Id;
use dragonfly::panels::keys::{BoneFlag, KeysRequest};
use dragonfly::panels::{Effect, Request};
use dragonfly_document::bones::Choice;
use dragonfly_document::{Cancel, LoadError, OpenedModel, Progress, Source};
use dragonfly_kit::counting;
use dragonfly_kit::document::arm;
use dragonfly_picture::gizmo::{GizmoAxis, Handle, Tool};
use glam::{Quat, Vec2};
use std::sync::Arc;

fn load(_: &Source, _: &mut dyn FnMut(Progress), _: &Cancel) -> Result<OpenedModel, LoadError> {
    Ok(Arc::into_inner(arm::loaded()).expect("the only one").into())
}

/// The middle bone of the arm is selected.
fn arm() -> Hand {
    let mut hand = Hand::new(load);
    hand.state.execute(Request::Select(Some(1)));
    hand.state.begin_frame(hand.state.read().now);
    hand
}

#[track_caller]
fn assert_turned(hand: &Hand, before: Quat, by: Quat) {
    let (now, wanted) = (hand.rotation(), before * by);
    assert!(now.angle_between(wanted) < 1e-3, "{now} is not {wanted}");
}

#[test]
fn a_ring_is_dragged_a_number_typed_and_it_is_one_step() {
    let mut hand = arm();
    let before = hand.rotation();
    let ring = hand.handle(Handle::Axis(GizmoAxis::X));
    hand.press(ring);
    assert!(hand.steps().is_empty(), "a press alone is no edit");
    hand.to(ring + Vec2::new(5.0, 9.0));
    hand.to(ring + Vec2::new(9.0, 20.0));
    assert_ne!(hand.rotation(), before, "the pose follows the hand");
    hand.keys("30");
    assert_turned(&hand, before, Quat::from_rotation_x(30f32.to_radians()));
    hand.key(Key::Enter);
    hand.release();
    assert_eq!(hand.steps(), ["Rotate"]);
    assert!(hand.refused.is_empty(), "{:?}", hand.refused);
    hand.command(Id::Undo);
    assert_eq!(hand.rotation(), before, "bit for bit");
    hand.command(Id::Redo);
    assert_turned(&hand, before, Quat::from_rotation_x(30f32.to_radians()));
}

#[test]
fn a_drag_started_by_a_command_is_locked_typed_and_confirmed_without_a_button() {
    let mut hand = arm();
    let before = hand.rotation();
    hand.command(Id::RotateNow);
    assert!(hand.state.read().tools.controls().is_busy() && hand.steps().is_empty());
    hand.keys("y45/2");
    hand.key(Key::Enter);
    assert!(!hand.state.read().tools.controls().is_busy());
    assert_turned(&hand, before, Quat::from_rotation_y(22.5f32.to_radians()));
    assert_eq!(hand.steps(), ["Rotate"]);
}

#[test]
fn escape_and_the_right_button_leave_no_trace() {
    let mut hand = arm();
    let before = hand.rotation();
    for end in [InputEvent::KeyDown(Key::Escape), InputEvent::MouseDown(dragonfly::control::Button::Right)] {
        let ring = hand.handle(Handle::Axis(GizmoAxis::Z));
        hand.press(ring);
        hand.to(ring + Vec2::new(20.0, 20.0));
        assert_eq!(hand.steps(), ["Rotate"]);
        hand.send(end);
        assert_eq!(hand.rotation(), before);
        hand.send(InputEvent::MouseUp(dragonfly::control::Button::Right));
        hand.release();
        assert!(hand.steps().is_empty(), "{:?}", hand.steps());
    }
}

#[test]
fn a_drag_that_comes_back_to_where_it_began_is_no_step() {
    let mut hand = arm();
    let ring = hand.handle(Handle::Axis(GizmoAxis::Z));
    hand.hold(Modifiers { ctrl: true, ..Modifiers::default() });
    hand.press(ring);
    hand.to(ring + Vec2::new(60.0, 60.0));
    assert_eq!(hand.steps().len(), 1);
    hand.to(ring);
    hand.release();
    assert!(hand.steps().is_empty());
}

#[test]
fn a_click_inside_the_rings_picks_the_bone_behind() {
    let mut hand = arm();
    let ball = hand.handle(Handle::Center);
    hand.hold(Modifiers { shift: true, ..Modifiers::default() });
    hand.press(ball);
    hand.to(ball + Vec2::X);
    hand.release();
    assert_eq!(hand.effects, [Effect::Pick(egui::pos2(ball.x, ball.y), Choice::Add)]);
    assert!(hand.steps().is_empty());
    // Once it moved it turns freely.
    hand.hold(Modifiers::default());
    hand.press(ball);
    hand.to(ball + Vec2::new(30.0, 5.0));
    hand.release();
    assert_eq!(hand.steps(), ["Rotate"]);
}

#[test]
fn moving_and_scaling_change_their_own_channel_alone() {
    for (tool, id, label) in [(Tool::Move, Id::ToolMove, "Move"), (Tool::Scale, Id::ToolScale, "Scale")] {
        let mut hand = arm();
        hand.command(id);
        assert_eq!(hand.state.read().tools.controls().gizmo().gizmo.tool, tool);
        let arrow = hand.handle(Handle::Axis(GizmoAxis::Y));
        hand.press(arrow);
        hand.to(arrow - Vec2::Y * 20.0);
        hand.release();
        assert_eq!(hand.steps(), [label]);
    }
    let mut hand = arm();
    hand.command(Id::ToolSelect);
    let gizmo = &hand.state.read().tools.controls().gizmo().gizmo;
    assert_eq!(
        crate::hands_rig::find(gizmo, hand.joint(), Handle::Center),
        None,
        "who only selects has none"
    );
}

#[test]
fn the_rest_pose_cannot_be_edited_and_a_message_gives_the_reason() {
    let mut hand = arm();
    hand.state.execute(Request::ShowTake(None));
    hand.state.begin_frame(hand.state.read().now);
    let ring = hand.handle(Handle::Axis(GizmoAxis::X));
    hand.press(ring);
    hand.to(ring + Vec2::new(20.0, 30.0));
    hand.release();
    assert!(hand.steps().is_empty());
    let said = hand.state.read().status.last().expect("it was said").text.clone();
    assert!(said.contains("rest pose"), "{said}");
    // A box is not drawn either: the handle was meant.
    assert!(hand.effects.is_empty(), "{:?}", hand.effects);
}

#[test]
fn locked_bones_stay_and_a_single_locked_bone_cannot_be_dragged() {
    let mut hand = arm();
    let lock = |hand: &mut Hand, bone, on| {
        hand.state.execute(Request::Timeline(KeysRequest::Flag(BoneFlag::Lock, bone, on)));
        hand.state.begin_frame(hand.state.read().now);
    };
    let turns = |hand: &Hand| {
        let poses = hand.state.read().posed.animation().expect("posed").poses();
        poses.iter().map(|pose| pose.rotation).collect::<Vec<_>>()
    };
    hand.state.execute(Request::SelectBones(vec![0, 1], Choice::Replace));
    lock(&mut hand, 0, true);
    let before = turns(&hand);
    let ring = hand.handle(Handle::Axis(GizmoAxis::X));
    hand.press(ring);
    hand.to(ring + Vec2::new(9.0, 20.0));
    hand.release();
    assert_eq!(hand.steps(), ["Rotate"]);
    let after = turns(&hand);
    assert_eq!(after[0], before[0], "it is locked");
    assert_ne!(after[1], before[1], "the other one is not");
    // With all of them locked nothing turns, not even the gizmo.
    lock(&mut hand, 1, true);
    for by_key in [false, true] {
        let ring = hand.handle(Handle::Axis(GizmoAxis::X));
        if by_key {
            hand.command(Id::RotateNow);
        } else {
            hand.press(ring);
        }
        hand.to(ring + Vec2::new(9.0, 20.0));
        assert!(!hand.state.read().tools.controls().edits(), "by key: {by_key}");
        hand.release();
        assert_eq!((hand.steps(), turns(&hand)), (vec!["Rotate"], after.clone()));
        let said = hand.state.read().status.last().expect("said why").text.clone();
        assert!(said.contains("is locked"), "{said}");
    }
    lock(&mut hand, 1, false);
    let ring = hand.handle(Handle::Axis(GizmoAxis::X));
    hand.press(ring);
    assert!(hand.state.read().tools.controls().edits(), "free again");
}

#[test]
fn starting_a_gizmo_drag_pauses_playback() {
    let mut hand = arm();
    hand.command(Id::PlayPause);
    assert!(hand.state.read().playback.playing);
    let ring = hand.handle(Handle::Axis(GizmoAxis::X));
    hand.press(ring);
    assert!(!hand.state.read().playback.playing);
    hand.to(ring + Vec2::new(4.0, 30.0));
    let time = hand.state.read().time();
    hand.to(ring + Vec2::new(9.0, 60.0));
    assert_eq!(hand.state.read().time(), time);
    hand.release();
    assert_eq!(hand.steps(), ["Rotate"]);
}

#[test]
fn clicks_boxes_and_lassos_select_bones_with_the_held_modifiers() {
    let mut hand = arm();
    hand.command(Id::ToolSelect);
    let at = Vec2::new(260.0, 120.0);
    hand.press(at);
    hand.release();
    hand.hold(Modifiers { ctrl: true, ..Modifiers::default() });
    hand.press(at);
    hand.to(at + Vec2::new(100.0, 50.0));
    assert!(hand.state.read().tools.controls().picture().catching().is_some());
    hand.release();
    let asked = std::mem::take(&mut hand.effects);
    assert!(
        matches!(asked[0], Effect::Pick(at, Choice::Replace) if at == egui::pos2(260.0, 120.0)),
        "{asked:?}"
    );
    assert!(matches!(asked[1], Effect::Catch(_, Choice::Toggle)), "{asked:?}");
    // The pick result lists the nearest bone first; repeated clicks at one position cycle through the list.
    let place = egui::pos2(260.0, 120.0);
    let mut chosen = Vec::new();
    for _ in 0..4 {
        hand.state.picked(place, &[2, 0], Choice::Replace);
        chosen.push(hand.state.read().selected());
    }
    assert_eq!(chosen, [Some(2), Some(0), Some(2), Some(0)]);
    hand.state.picked(place, &[2, 0], Choice::Add);
    assert_eq!(hand.state.read().selection.bones(), [0, 2]);
    hand.state.caught(&[0, 1], Choice::Toggle);
    assert_eq!(hand.state.read().selection.bones(), [2, 1]);
}

#[test]
fn a_box_selection_started_by_command_can_start_on_a_handle() {
    let mut hand = arm();
    hand.command(Id::BoxSelect);
    let ring = hand.handle(Handle::Axis(GizmoAxis::X));
    hand.press(ring);
    hand.to(ring + Vec2::splat(40.0));
    hand.release();
    assert!(matches!(hand.effects[..], [Effect::Catch(..)]), "{:?}", hand.effects);
    assert!(hand.steps().is_empty());
}

#[test]
fn overlays_on_the_viewport_take_precedence() {
    let mut hand = arm();
    let ring = hand.handle(Handle::Axis(GizmoAxis::X));
    let over = egui::Rect::from_center_size(egui::pos2(ring.x, ring.y), egui::Vec2::splat(30.0));
    hand.state.execute(Request::Shields(vec![over]));
    hand.press(ring);
    hand.to(ring + Vec2::splat(60.0));
    hand.release();
    assert!(hand.steps().is_empty() && hand.effects.is_empty());
    hand.state.execute(Request::Shields(Vec::new()));
    hand.press(ring);
    hand.to(ring + Vec2::splat(60.0));
    hand.release();
    assert_eq!(hand.steps(), ["Rotate"]);
}

#[test]
fn bones_are_hidden_shown_and_chosen_by_commands() {
    let mut hand = arm();
    hand.command(Id::HideSelected);
    assert!(hand.state.read().hidden.is_hidden(1) && hand.state.read().selection.bones().is_empty());
    hand.command(Id::SelectAll);
    assert_eq!(hand.state.read().selection.bones(), [0, 2]);
    hand.command(Id::ShowAll);
    assert_eq!(hand.state.read().selection.bones(), [1]);
    hand.command(Id::SelectBranch);
    assert_eq!(hand.state.read().selection.bones(), [1, 2]);
    hand.command(Id::InvertSelection);
    assert_eq!(hand.state.read().selection.bones(), [0]);
    hand.command(Id::ExtendChild);
    assert_eq!(hand.state.read().selection.bones(), [0, 1]);
}

/// Returns the number of allocations and of bytes in 19 mouse moves while `bone` of the loaded model is dragged.
fn allocations_of_a_move(load: crate::hands_rig::Load, bone: u32) -> (u64, u64) {
    let mut hand = Hand::new(load);
    hand.state.execute(Request::Select(Some(bone)));
    hand.command(Id::RotateNow);
    hand.keys("x");
    let mut effects = Vec::with_capacity(64);
    let mut step = |hand: &mut Hand, index: usize| {
        let at = Vec2::new(400.0 + index as f32 * 7.0, 300.0 + index as f32 * 3.0);
        hand.state.input(InputEvent::MouseMove(at), &mut effects);
    };
    step(&mut hand, 0);
    let (count, ()) = counting::count(|| (1..20).for_each(|index| step(&mut hand, index)));
    assert!(effects.len() >= 19, "every move is an edit: {}", effects.len());
    (count.allocations, count.bytes)
}

#[test]
fn a_move_of_the_mouse_allocates_nothing_that_grows_with_the_model() {
    fn few(_: &Source, _: &mut dyn FnMut(Progress), _: &Cancel) -> Result<OpenedModel, LoadError> {
        Ok(Arc::into_inner(
            dragonfly_kit::document::fixture::view(
                "few",
                dragonfly_kit::document::fixture::skeleton(3),
                TAKES,
            )
            .loaded,
        )
        .expect("one")
        .into())
    }
    fn many(_: &Source, _: &mut dyn FnMut(Progress), _: &Cancel) -> Result<OpenedModel, LoadError> {
        Ok(Arc::into_inner(
            dragonfly_kit::document::fixture::view(
                "many",
                dragonfly_kit::document::fixture::skeleton(200),
                TAKES,
            )
            .loaded,
        )
        .expect("one")
        .into())
    }
    const TAKES: &[(&str, f32, usize)] = &[("Walk", 1.0, 11)];
    let (small, large) = (allocations_of_a_move(few, 5), allocations_of_a_move(many, 5));
    assert_eq!(small, large);
    assert!(small.0 > 0, "edits are made of something");
}
