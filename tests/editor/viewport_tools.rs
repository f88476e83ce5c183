//! The viewport tools: input in the viewport changes the document at once, with one undo step per drag.

use crate::viewport_tools_rig::ViewportHarness;
use dragonfly::control::{InputEvent, Key, Modifiers};
use dragonfly::panels::commands::Id;
use dragonfly::panels::keys::{BoneFlag, KeysRequest};
use dragonfly::panels::{Effect, Request};
use dragonfly_document::bones::Choice;
use dragonfly_document::{Cancel, LoadError, OpenedModel, Progress, Source};
use dragonfly_kit::counting;
use dragonfly_kit::document::arm;
use dragonfly_kit::document::fixture;
use dragonfly_picture::gizmo::{GizmoAxis, Handle, Tool};
use glam::{Quat, Vec2};
use std::sync::Arc;

fn load(_: &Source, _: &mut dyn FnMut(Progress), _: &Cancel) -> Result<OpenedModel, LoadError> {
    Ok(Arc::into_inner(arm::loaded()).expect("the only one").into())
}

/// Opens the arm with its middle bone selected.
fn arm() -> ViewportHarness {
    let mut viewport = ViewportHarness::new(load);
    viewport.state.execute(Request::Select(Some(1)));
    viewport.state.begin_frame(viewport.state.read().now);
    viewport
}

#[track_caller]
fn assert_turned(viewport: &ViewportHarness, before: Quat, by: Quat) {
    let (now, wanted) = (viewport.rotation(), before * by);
    assert!(now.angle_between(wanted) < 1e-3, "{now} is not {wanted}");
}

#[test]
fn dragging_a_ring_and_typing_a_number_is_one_undo_step() {
    let mut viewport = arm();
    let before = viewport.rotation();
    let ring = viewport.handle(Handle::Axis(GizmoAxis::X));
    viewport.press(ring);
    assert!(viewport.steps().is_empty(), "a press alone is no edit");
    viewport.to(ring + Vec2::new(5.0, 9.0));
    viewport.to(ring + Vec2::new(9.0, 20.0));
    assert_ne!(viewport.rotation(), before, "the pose follows the hand");
    viewport.keys("30");
    assert_turned(&viewport, before, Quat::from_rotation_x(30f32.to_radians()));
    viewport.key(Key::Enter);
    viewport.release();
    assert_eq!(viewport.steps(), ["Rotate"]);
    assert!(viewport.refused.is_empty(), "{:?}", viewport.refused);
    viewport.command(Id::Undo);
    assert_eq!(viewport.rotation(), before, "bit for bit");
    viewport.command(Id::Redo);
    assert_turned(&viewport, before, Quat::from_rotation_x(30f32.to_radians()));
}

#[test]
fn a_drag_started_by_a_command_is_locked_typed_and_confirmed_without_a_button() {
    let mut viewport = arm();
    let before = viewport.rotation();
    viewport.command(Id::RotateNow);
    assert!(viewport.state.read().tools.controls().is_busy() && viewport.steps().is_empty());
    viewport.keys("y45/2");
    viewport.key(Key::Enter);
    assert!(!viewport.state.read().tools.controls().is_busy());
    assert_turned(&viewport, before, Quat::from_rotation_y(22.5f32.to_radians()));
    assert_eq!(viewport.steps(), ["Rotate"]);
}

#[test]
fn escape_and_the_right_button_leave_no_trace() {
    let mut viewport = arm();
    let before = viewport.rotation();
    for end in [InputEvent::KeyDown(Key::Escape), InputEvent::MouseDown(dragonfly::control::Button::Right)] {
        let ring = viewport.handle(Handle::Axis(GizmoAxis::Z));
        viewport.press(ring);
        viewport.to(ring + Vec2::new(20.0, 20.0));
        assert_eq!(viewport.steps(), ["Rotate"]);
        viewport.send(end);
        assert_eq!(viewport.rotation(), before);
        viewport.send(InputEvent::MouseUp(dragonfly::control::Button::Right));
        viewport.release();
        assert!(viewport.steps().is_empty(), "{:?}", viewport.steps());
    }
}

#[test]
fn a_drag_back_to_its_start_is_no_undo_step() {
    let mut viewport = arm();
    let ring = viewport.handle(Handle::Axis(GizmoAxis::Z));
    viewport.hold(Modifiers { ctrl: true, ..Modifiers::default() });
    viewport.press(ring);
    viewport.to(ring + Vec2::new(60.0, 60.0));
    assert_eq!(viewport.steps().len(), 1);
    viewport.to(ring);
    viewport.release();
    assert!(viewport.steps().is_empty());
}

#[test]
fn a_click_inside_the_rings_picks_the_bone_behind() {
    let mut viewport = arm();
    let ball = viewport.handle(Handle::Center);
    viewport.hold(Modifiers { shift: true, ..Modifiers::default() });
    viewport.press(ball);
    viewport.to(ball + Vec2::X);
    viewport.release();
    assert_eq!(viewport.effects, [Effect::Pick(egui::pos2(ball.x, ball.y), Choice::Add)]);
    assert!(viewport.steps().is_empty());
    // Once the pointer has moved, the drag rotates the bone freely.
    viewport.hold(Modifiers::default());
    viewport.press(ball);
    viewport.to(ball + Vec2::new(30.0, 5.0));
    viewport.release();
    assert_eq!(viewport.steps(), ["Rotate"]);
}

#[test]
fn moving_and_scaling_change_their_own_channel_alone() {
    for (tool, id, label) in [(Tool::Move, Id::ToolMove, "Move"), (Tool::Scale, Id::ToolScale, "Scale")] {
        let mut viewport = arm();
        viewport.command(id);
        assert_eq!(viewport.state.read().tools.controls().gizmo().gizmo.tool, tool);
        let arrow = viewport.handle(Handle::Axis(GizmoAxis::Y));
        viewport.press(arrow);
        viewport.to(arrow - Vec2::Y * 20.0);
        viewport.release();
        assert_eq!(viewport.steps(), [label]);
    }
    let mut viewport = arm();
    viewport.command(Id::ToolSelect);
    let gizmo = &viewport.state.read().tools.controls().gizmo().gizmo;
    assert_eq!(
        crate::viewport_tools_rig::find(gizmo, viewport.joint(), Handle::Center),
        None,
        "the selection tool shows no gizmo"
    );
}

#[test]
fn the_rest_pose_cannot_be_edited_and_a_message_gives_the_reason() {
    let mut viewport = arm();
    viewport.state.execute(Request::ShowTake(None));
    viewport.state.begin_frame(viewport.state.read().now);
    let ring = viewport.handle(Handle::Axis(GizmoAxis::X));
    viewport.press(ring);
    viewport.to(ring + Vec2::new(20.0, 30.0));
    viewport.release();
    assert!(viewport.steps().is_empty());
    let said = viewport.state.read().status.last().expect("it was said").text.clone();
    assert!(said.contains("rest pose"), "{said}");
    // No box selection is started either, because the press was on a handle.
    assert!(viewport.effects.is_empty(), "{:?}", viewport.effects);
}

#[test]
fn locked_bones_stay_and_a_single_locked_bone_cannot_be_dragged() {
    let mut viewport = arm();
    let lock = |viewport: &mut ViewportHarness, bone, on| {
        viewport.state.execute(Request::Timeline(KeysRequest::Flag(BoneFlag::Lock, bone, on)));
        viewport.state.begin_frame(viewport.state.read().now);
    };
    let turns = |viewport: &ViewportHarness| {
        let poses = viewport.state.read().posed.animation().expect("posed").poses();
        poses.iter().map(|pose| pose.rotation).collect::<Vec<_>>()
    };
    viewport.state.execute(Request::SelectBones(vec![0, 1], Choice::Replace));
    lock(&mut viewport, 0, true);
    let before = turns(&viewport);
    let ring = viewport.handle(Handle::Axis(GizmoAxis::X));
    viewport.press(ring);
    viewport.to(ring + Vec2::new(9.0, 20.0));
    viewport.release();
    assert_eq!(viewport.steps(), ["Rotate"]);
    let after = turns(&viewport);
    assert_eq!(after[0], before[0], "it is locked");
    assert_ne!(after[1], before[1], "the other one is not");
    // If all selected bones are locked, nothing rotates, not even the gizmo.
    lock(&mut viewport, 1, true);
    for by_key in [false, true] {
        let ring = viewport.handle(Handle::Axis(GizmoAxis::X));
        if by_key {
            viewport.command(Id::RotateNow);
        } else {
            viewport.press(ring);
        }
        viewport.to(ring + Vec2::new(9.0, 20.0));
        assert!(!viewport.state.read().tools.controls().edits(), "by key: {by_key}");
        viewport.release();
        assert_eq!((viewport.steps(), turns(&viewport)), (vec!["Rotate"], after.clone()));
        let said = viewport.state.read().status.last().expect("said why").text.clone();
        assert!(said.contains("is locked"), "{said}");
    }
    lock(&mut viewport, 1, false);
    let ring = viewport.handle(Handle::Axis(GizmoAxis::X));
    viewport.press(ring);
    assert!(viewport.state.read().tools.controls().edits(), "free again");
}

#[test]
fn starting_a_gizmo_drag_pauses_playback() {
    let mut viewport = arm();
    viewport.command(Id::PlayPause);
    assert!(viewport.state.read().playback.playing);
    let ring = viewport.handle(Handle::Axis(GizmoAxis::X));
    viewport.press(ring);
    assert!(!viewport.state.read().playback.playing);
    viewport.to(ring + Vec2::new(4.0, 30.0));
    let time = viewport.state.read().time();
    viewport.to(ring + Vec2::new(9.0, 60.0));
    assert_eq!(viewport.state.read().time(), time);
    viewport.release();
    assert_eq!(viewport.steps(), ["Rotate"]);
}

#[test]
fn a_gizmo_grabbed_during_playback_is_dragged_at_a_whole_frame_as_after_a_pause() {
    for (snaps, whole) in [(true, true), (false, false)] {
        let mut viewport = arm();
        viewport.state.execute(Request::Timeline(KeysRequest::Snap(snaps)));
        viewport.state.execute(Request::Seek(0.345));
        viewport.command(Id::PlayPause);
        viewport.press(viewport.handle(Handle::Axis(GizmoAxis::X)));
        assert!(!viewport.state.read().playback.playing);
        let state = viewport.state.read();
        let frames = state.time() * state.frame_rate as f32;
        assert_eq!((frames - frames.round()).abs() < 1e-3, whole, "frame {frames}, snapping: {snaps}");
    }
}

#[test]
fn clicks_boxes_and_lassos_select_bones_with_the_held_modifiers() {
    let mut viewport = arm();
    viewport.command(Id::ToolSelect);
    let at = Vec2::new(260.0, 120.0);
    viewport.press(at);
    viewport.release();
    viewport.hold(Modifiers { ctrl: true, ..Modifiers::default() });
    viewport.press(at);
    viewport.to(at + Vec2::new(100.0, 50.0));
    assert!(viewport.state.read().tools.controls().picture().catching().is_some());
    viewport.release();
    let asked = std::mem::take(&mut viewport.effects);
    assert!(
        matches!(asked[0], Effect::Pick(at, Choice::Replace) if at == egui::pos2(260.0, 120.0)),
        "{asked:?}"
    );
    assert!(matches!(asked[1], Effect::Catch(_, Choice::Toggle)), "{asked:?}");
    // The pick result lists the nearest bone first; repeated clicks at one position cycle through the list.
    let place = egui::pos2(260.0, 120.0);
    let mut chosen = Vec::new();
    for _ in 0..4 {
        viewport.state.picked(place, &[2, 0], Choice::Replace);
        chosen.push(viewport.state.read().selected());
    }
    assert_eq!(chosen, [Some(2), Some(0), Some(2), Some(0)]);
    viewport.state.picked(place, &[2, 0], Choice::Add);
    assert_eq!(viewport.state.read().selection.bones(), [0, 2]);
    viewport.state.caught(&[0, 1], Choice::Toggle);
    assert_eq!(viewport.state.read().selection.bones(), [2, 1]);
}

#[test]
fn a_box_selection_started_by_command_can_start_on_a_handle() {
    let mut viewport = arm();
    viewport.command(Id::BoxSelect);
    let ring = viewport.handle(Handle::Axis(GizmoAxis::X));
    viewport.press(ring);
    viewport.to(ring + Vec2::splat(40.0));
    viewport.release();
    assert!(matches!(viewport.effects[..], [Effect::Catch(..)]), "{:?}", viewport.effects);
    assert!(viewport.steps().is_empty());
}

#[test]
fn a_click_on_an_overlay_does_not_reach_the_gizmo_below_it() {
    let mut viewport = arm();
    let ring = viewport.handle(Handle::Axis(GizmoAxis::X));
    let over = egui::Rect::from_center_size(egui::pos2(ring.x, ring.y), egui::Vec2::splat(30.0));
    viewport.state.execute(Request::Shields(vec![over]));
    viewport.press(ring);
    viewport.to(ring + Vec2::splat(60.0));
    viewport.release();
    assert!(viewport.steps().is_empty() && viewport.effects.is_empty());
    viewport.state.execute(Request::Shields(Vec::new()));
    viewport.press(ring);
    viewport.to(ring + Vec2::splat(60.0));
    viewport.release();
    assert_eq!(viewport.steps(), ["Rotate"]);
}

#[test]
fn bones_are_hidden_shown_and_chosen_by_commands() {
    let mut viewport = arm();
    viewport.command(Id::HideSelected);
    assert!(viewport.state.read().hidden.is_hidden(1) && viewport.state.read().selection.bones().is_empty());
    viewport.command(Id::SelectAll);
    assert_eq!(viewport.state.read().selection.bones(), [0, 2]);
    viewport.command(Id::ShowAll);
    assert_eq!(viewport.state.read().selection.bones(), [1]);
    viewport.command(Id::SelectBranch);
    assert_eq!(viewport.state.read().selection.bones(), [1, 2]);
    viewport.command(Id::InvertSelection);
    assert_eq!(viewport.state.read().selection.bones(), [0]);
    viewport.command(Id::ExtendChild);
    assert_eq!(viewport.state.read().selection.bones(), [0, 1]);
}

/// Returns the number of allocations and of bytes in 19 mouse moves while `bone` of the loaded model is dragged.
fn allocations_of_a_move(load: crate::viewport_tools_rig::Load, bone: u32) -> (u64, u64) {
    let mut viewport = ViewportHarness::new(load);
    viewport.state.execute(Request::Select(Some(bone)));
    viewport.command(Id::RotateNow);
    viewport.keys("x");
    let mut effects = Vec::with_capacity(64);
    let mut step = |viewport: &mut ViewportHarness, index: usize| {
        let at = Vec2::new(400.0 + index as f32 * 7.0, 300.0 + index as f32 * 3.0);
        viewport.state.input(InputEvent::MouseMove(at), &mut effects);
    };
    step(&mut viewport, 0);
    let (count, ()) = counting::count(|| (1..20).for_each(|index| step(&mut viewport, index)));
    assert!(effects.len() >= 19, "every move is an edit: {}", effects.len());
    (count.allocations, count.bytes)
}

#[test]
fn a_move_of_the_mouse_allocates_nothing_that_grows_with_the_model() {
    fn of_size(name: &str, bones: u32) -> OpenedModel {
        let view = fixture::view(name, fixture::skeleton(bones), TAKES);
        drop(view.opened);
        Arc::into_inner(view.loaded).expect("no other view").into()
    }
    fn few(_: &Source, _: &mut dyn FnMut(Progress), _: &Cancel) -> Result<OpenedModel, LoadError> {
        Ok(of_size("few", 3))
    }
    fn many(_: &Source, _: &mut dyn FnMut(Progress), _: &Cancel) -> Result<OpenedModel, LoadError> {
        Ok(of_size("many", 200))
    }
    const TAKES: &[(&str, f32, usize)] = &[("Walk", 1.0, 11)];
    let (small, large) = (allocations_of_a_move(few, 5), allocations_of_a_move(many, 5));
    assert_eq!(small, large);
    assert!(small.0 > 0, "edits are made of something");
}
