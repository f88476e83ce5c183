//! A bone that is dragged takes those above it along with IK on, and pinned bones stay where they are.

use crate::hands_rig::{Hand, PICTURE};
use dragonfly::control::{InputEvent, Key};
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::keys::{BoneFlag, KeysRequest};
use dragonfly_anim::data::{BoneIndex, Transform};
use dragonfly_document::edit::Property;
use dragonfly_document::{Cancel, LoadError, OpenedModel, Progress, Source};
use dragonfly_kit::document::arm;
use dragonfly_picture::gizmo::{GizmoAxis, GizmoView, Handle};
use dragonfly_picture::scene::Scene;
use dragonfly_picture::{IkAppearance, IkLook};
use glam::{Quat, Vec2, Vec3};
use std::sync::Arc;

fn load(_: &Source, _: &mut dyn FnMut(Progress), _: &Cancel) -> Result<OpenedModel, LoadError> {
    Ok(Arc::into_inner(arm::loaded()).expect("the only one").into())
}

/// The arm in the middle of its take, where it is bent; this bone is selected, and moved with this tool.
fn arm(bone: BoneIndex, tool: Id) -> Hand {
    let mut hand = Hand::new(load);
    hand.state.execute(Request::Seek(0.5));
    hand.state.execute(Request::Select(Some(bone)));
    hand.command(tool);
    hand.state.begin_frame(hand.state.read().now);
    hand
}

fn poses(hand: &Hand) -> Vec<Transform> {
    hand.state.read().posed.animation().expect("posed").poses().to_vec()
}

fn place(hand: &Hand, bone: usize) -> Vec3 {
    hand.state.read().posed.animation().expect("posed").to_root()[bone].w_axis.truncate()
}

fn facing(hand: &Hand, bone: usize) -> Quat {
    hand.state.read().posed.animation().expect("posed").to_root()[bone].to_scale_rotation_translation().1
}

/// Returns the channels that have a key at the current time, with their bones.
fn keyed(hand: &Hand) -> Vec<(BoneIndex, Property)> {
    let slot = hand.state.read().slot().expect("a take");
    let bones = 0..arm::BONES as BoneIndex;
    let all = bones.flat_map(|bone| Property::ALL.into_iter().map(move |property| (bone, property)));
    all.filter(|&(bone, property)| slot.key_at(bone, property, hand.state.read().time()).is_some()).collect()
}

/// Presses the button on `handle` and moves the pointer by `by`, in points, in four steps. Returns the end position.
fn drag(hand: &mut Hand, handle: Handle, by: Vec2) -> Vec2 {
    let from = hand.handle(handle);
    hand.press(from);
    for part in 1..=4 {
        hand.to(from + by * part as f32 / 4.0);
    }
    from + by
}

#[test]
fn dragging_the_tip_moves_its_chain_in_one_undo_step() {
    let mut hand = arm(2, Id::ToolMove);
    hand.command(Id::ToggleIk);
    let (before, takes) = (poses(&hand), hand.state.read().view.cloned().expect("open").takes);
    let (tip, direction) = (place(&hand, 2), facing(&hand, 2));
    drag(&mut hand, Handle::Center, Vec2::new(30.0, 40.0));
    hand.release();
    assert!(hand.refused.is_empty(), "{:?}", hand.refused);
    assert_eq!(hand.steps().len(), 1, "{:?}", hand.steps());
    let after = poses(&hand);
    for bone in 0..3 {
        assert_ne!(after[bone].rotation, before[bone].rotation, "bone {bone} turns");
        assert_eq!(after[bone].translation, before[bone].translation, "bone {bone} is not pulled off");
    }
    let rotations: Vec<_> = (0..3).map(|bone| (bone, Property::Rotation)).collect();
    assert_eq!(keyed(&hand), rotations);
    assert!(place(&hand, 2).distance(tip) > 0.1, "it moved");
    assert!(facing(&hand, 2).angle_between(direction) < 1e-3, "a hand keeps its direction");
    // Where the pointer is.
    hand.command(Id::Undo);
    assert_eq!(poses(&hand), before);
    assert_eq!(hand.state.read().view.expect("open").takes, takes, "bit for bit");
    assert!(hand.steps().is_empty());
    // Without IK the same drag moves the bone alone.
    hand.command(Id::ToggleIk);
    drag(&mut hand, Handle::Center, Vec2::new(30.0, 40.0));
    hand.release();
    assert_eq!(keyed(&hand), [(2, Property::Translation)]);
}

#[test]
fn the_end_of_a_chain_follows_the_pointer() {
    let mut hand = arm(2, Id::ToolMove);
    hand.command(Id::ToggleIk);
    let from = hand.joint();
    // Towards the root, so that it can be reached.
    let root = {
        hand.state.execute(Request::Select(Some(0)));
        let root = hand.joint();
        hand.state.execute(Request::Select(Some(2)));
        hand.state.begin_frame(hand.state.read().now);
        root
    };
    let by = (root - from) * 0.3;
    drag(&mut hand, Handle::Center, by);
    hand.release();
    assert!(hand.joint().distance(from + by) < 0.1, "{} is not {}", hand.joint(), from + by);
}

#[test]
fn a_pinned_tip_is_held_at_every_played_frame_in_one_step() {
    let mut hand = arm(2, Id::ToolMove);
    hand.command(Id::Pin);
    let (tip, direction) = (place(&hand, 2), facing(&hand, 2));
    let takes = hand.state.read().view.cloned().expect("open").takes;
    let at = |hand: &mut Hand, time: f32| {
        hand.state.execute(Request::Seek(time));
        hand.state.begin_frame(hand.state.read().now);
        (place(hand, 2).distance(tip), facing(hand, 2).angle_between(direction))
    };
    assert!(at(&mut hand, 0.3).0 > 0.05, "without it the tip moves");
    let outside = [0.0, 1.0].map(|time| at(&mut hand, time).0);
    at(&mut hand, 0.5);
    hand.state.execute(Request::Timeline(KeysRequest::Range(Some([0.25, 0.76]))));
    hand.command(Id::BakePins);
    assert_eq!(hand.steps().len(), 1, "{:?} {:?}", hand.steps(), hand.refused);
    // At frames, at the ends of what plays, and nearly so between them.
    let frames = (8..=22).map(|frame| frame as f32 / 30.0);
    for time in frames.chain([0.25, 0.76]) {
        let (apart, turned) = at(&mut hand, time);
        assert!(apart < 1e-4 && turned < 1e-3, "at {time} s: {apart} m, {turned} rad");
        assert!(at(&mut hand, (time + 0.011).min(0.76)).0 < 2e-3, "behind {time} s");
    }
    for (time, outside) in [0.0, 1.0].into_iter().zip(outside) {
        assert!((at(&mut hand, time).0 - outside).abs() < 1e-5, "what does not play stays");
    }
    hand.command(Id::Undo);
    assert_eq!(hand.state.read().view.expect("open").takes, takes, "bit for bit");
}

#[test]
fn a_bone_that_cannot_be_pinned_is_reported() {
    let mut hand = arm(0, Id::ToolMove);
    hand.command(Id::Pin);
    hand.command(Id::BakePins);
    assert!(hand.steps().is_empty());
    let said = &hand.state.read().status.last().expect("a line").text;
    assert!(said.contains("Nothing above"), "{said}");
}

#[test]
fn a_pinned_tip_stays_while_the_root_is_moved_and_turned() {
    for (tool, handle) in [
        (Id::ToolMove, Handle::Center),
        (Id::ToolRotate, Handle::Axis(GizmoAxis::Z)),
        (Id::ToolRotate, Handle::Axis(GizmoAxis::X)),
    ] {
        let mut hand = arm(2, tool);
        hand.command(Id::Pin);
        hand.state.execute(Request::Select(Some(0)));
        hand.state.begin_frame(hand.state.read().now);
        let (tip, direction, before) = (place(&hand, 2), facing(&hand, 2), poses(&hand));
        let from = hand.handle(handle);
        hand.press(from);
        for part in 1..=5 {
            hand.to(from + Vec2::new(3.0, -4.0) * part as f32);
            let off = place(&hand, 2).distance(tip);
            assert!(off < 1e-4, "{tool:?}: {off} from where it was");
            assert!(facing(&hand, 2).angle_between(direction) < 1e-3);
        }
        hand.release();
        assert_eq!(hand.steps().len(), 1, "{:?}", hand.steps());
        assert_ne!(poses(&hand)[1], before[1], "the middle bends");
        hand.command(Id::Undo);
        assert_eq!(poses(&hand), before);
    }
}

#[test]
fn numbers_typed_while_dragging_hold_pins_too() {
    let mut hand = arm(2, Id::ToolMove);
    hand.command(Id::Pin);
    hand.state.execute(Request::Select(Some(0)));
    hand.state.begin_frame(hand.state.read().now);
    let (tip, root) = (place(&hand, 2), place(&hand, 0));
    hand.command(Id::MoveNow);
    hand.keys("y0.05");
    hand.key(Key::Enter);
    assert!((place(&hand, 0) - root).distance(Vec3::Y * 0.05) < 1e-4);
    assert!(place(&hand, 2).distance(tip) < 1e-4);
    assert_eq!(hand.steps().len(), 1);
}

#[test]
fn escape_restores_chain_and_pins_bit_for_bit() {
    for (bone, pin) in [(2, None), (0, Some(2))] {
        let mut hand = arm(pin.unwrap_or(bone), Id::ToolMove);
        match pin {
            Some(_) => hand.command(Id::Pin),
            None => hand.command(Id::ToggleIk),
        }
        hand.state.execute(Request::Select(Some(bone)));
        hand.state.begin_frame(hand.state.read().now);
        let (before, takes) = (poses(&hand), hand.state.read().view.cloned().expect("open").takes);
        for end in
            [InputEvent::KeyDown(Key::Escape), InputEvent::MouseDown(dragonfly::control::Button::Right)]
        {
            drag(&mut hand, Handle::Center, Vec2::new(8.0, 20.0));
            assert_ne!(poses(&hand), before);
            assert_eq!(hand.steps().len(), 1);
            hand.send(end);
            hand.send(InputEvent::MouseUp(dragonfly::control::Button::Right));
            hand.release();
            assert!(hand.steps().is_empty());
            assert_eq!(poses(&hand), before);
            assert_eq!(hand.state.read().view.expect("open").takes, takes);
        }
    }
}

#[test]
fn with_auto_key_off_the_whole_chain_is_pending() {
    let mut hand = arm(2, Id::ToolMove);
    hand.command(Id::ToggleIk);
    hand.command(Id::AutoKey);
    let before = poses(&hand);
    drag(&mut hand, Handle::Center, Vec2::new(30.0, 40.0));
    hand.release();
    assert!(keyed(&hand).is_empty(), "{:?}", keyed(&hand));
    let pending = hand.state.read().pending_here().expect("pending");
    let bones: Vec<u32> = pending.poses.iter().map(|pose| pose.bone).collect();
    assert_eq!(bones, [0, 1, 2]);
    assert_ne!(poses(&hand), before, "and seen");
    hand.command(Id::Undo);
    assert!(hand.state.read().pending_here().is_none());
}

#[test]
fn switching_ik_during_a_drag_applies_to_the_next_drag() {
    let mut hand = arm(2, Id::ToolMove);
    hand.command(Id::ToggleIk);
    let to = drag(&mut hand, Handle::Center, Vec2::new(20.0, 20.0));
    hand.command(Id::ToggleIk);
    hand.to(to + Vec2::new(5.0, 5.0));
    hand.release();
    assert_eq!(hand.steps().len(), 1);
    assert!(keyed(&hand).iter().all(|key| key.1 == Property::Rotation), "{:?}", keyed(&hand));
}

#[test]
fn the_ik_overlay_follows_the_ik_setting() {
    let mut hand = arm(2, Id::ToolMove);
    assert_eq!(hand.state.read().ik_look(), None);
    hand.command(Id::ToggleIk);
    let look = hand.state.read().ik_look();
    assert_eq!(look, Some(IkLook { pins: vec![], chain: Some((2, 2)), pole: None }));
    assert!(hand.state.read().shows_ik(look.as_ref()));
    hand.command(Id::LongerIk);
    assert!(!hand.state.read().shows_ik(look.as_ref()));
    hand.command(Id::Pin);
    hand.command(Id::ToggleIk);
    let look = hand.state.read().ik_look();
    assert_eq!(look, Some(IkLook { pins: vec![2], chain: None, pole: None }));
    assert!(hand.state.read().shows_ik(look.as_ref()) && !hand.state.read().shows_ik(None));
}

#[test]
fn a_muted_bone_is_dragged_where_it_is_drawn() {
    let mut hand = arm(2, Id::ToolMove);
    let bent = place(&hand, 2);
    hand.state.execute(Request::Timeline(KeysRequest::Flag(BoneFlag::Mute, 1, true)));
    hand.state.begin_frame(hand.state.read().now);
    assert!(place(&hand, 2).distance(Vec3::Y * 2.0) < 1e-6, "straight, not {}", place(&hand, 2));
    assert!(
        hand.state.read().tools.controls().gizmo().gizmo.handle_at(hand.joint()).is_some(),
        "the gizmo stands there"
    );
    hand.state.execute(Request::Timeline(KeysRequest::Flag(BoneFlag::Mute, 1, false)));
    hand.state.begin_frame(hand.state.read().now);
    assert_eq!(place(&hand, 2), bent);
}

#[test]
fn a_key_of_the_path_is_pending_with_auto_key_off() {
    let mut hand = arm(2, Id::ToolSelect);
    hand.command(Id::TogglePath);
    hand.state.execute(Request::Seek(0.0));
    hand.command(Id::AutoKey);
    let last = *hand.state.read().tools.path().look().expect("a path").keys.last().expect("a key");
    let view = GizmoView::new(&hand.state.read().camera, Vec2::new(800.0, 600.0));
    let from = view.to_screen(last.1.as_dvec3()).expect("seen").as_vec2() + Vec2::new(200.0, 50.0);
    hand.press(from);
    hand.to(from + Vec2::new(30.0, -20.0));
    hand.release();
    assert_eq!(hand.state.read().pending_times().collect::<Vec<_>>(), [last.0]);
    let now = *hand.state.read().tools.path().look().expect("a path").keys.last().expect("a key");
    assert!(now.1.distance(last.1) > 0.05, "the path shows what is pending");
    hand.command(Id::Undo);
    assert_eq!(hand.state.read().tools.path().look().expect("a path").keys.last(), Some(&last));
}

/// Returns the scene that the graphics thread would hold for the same state, without drawn bones.
fn scene(hand: &Hand) -> Scene {
    let mut scene = Scene::new(hand.state.read().now);
    let [_, _, width, height] = PICTURE.map(|number| number as u32);
    scene.look.viewport = [0, 0, width, height];
    scene.camera = hand.state.read().camera;
    scene.playback = hand.state.read().playback;
    scene.show(hand.state.read().view.expect("open"));
    scene.prepare(hand.state.read().now);
    scene
}

#[test]
fn pins_and_the_chain_are_drawn_where_the_bones_are() {
    let hand = arm(2, Id::ToolMove);
    let mut scene = scene(&hand);
    let look = IkLook { pins: vec![2, 77], chain: Some((2, 9)), pole: Some(77) };
    scene.appearances.set(IkAppearance(Some(look)));
    scene.prepare(hand.state.read().now);
    let shape = scene.controls.shape();
    let lines: Vec<Vec3> = shape.lines().iter().map(|corner| corner.position).collect();
    assert_eq!(lines[..4], [1, 2, 0, 1].map(|bone| place(&hand, bone)), "up the chain");
    assert_eq!(lines.len(), 2 * 2 + 4 * 2, "and a frame around the pin");
    let middle = lines[4..].iter().sum::<Vec3>() / 8.0;
    assert!(middle.distance(place(&hand, 2)) < 1e-5);
    assert_eq!(shape.triangles().len(), 2 * 6, "a dot at the root, and in the frame");
    scene.appearances.set(IkAppearance(None));
    scene.prepare(hand.state.read().now);
    assert!(scene.controls.shape().lines().is_empty());
}

#[test]
fn the_skin_is_clicked_where_a_pending_pose_shows_it() {
    let mut hand = arm(0, Id::ToolMove);
    hand.command(Id::AutoKey);
    hand.command(Id::MoveNow);
    hand.keys("x1.5");
    hand.key(Key::Enter);
    assert!(place(&hand, 0).distance(Vec3::X * 1.5) < 1e-4, "{}", place(&hand, 0));
    let mut scene = scene(&hand);
    let view = GizmoView::new(&scene.camera, Vec2::new(PICTURE[2], PICTURE[3]));
    let at = |place: Vec3| view.to_screen(place.as_dvec3()).expect("seen").as_vec2().to_array();
    let side = scene.camera.right() * 0.18;
    assert_eq!(scene.pick_all(at(Vec3::new(1.5, 0.3, 0.0) + side)), [0]);
    assert!(scene.pick_all(at(Vec3::new(0.0, 0.3, 0.0) - side)).is_empty(), "not where the keys have it");
}

#[test]
fn a_bone_that_is_locked_or_muted_is_a_stiff_joint_of_the_chain() {
    for flag in [BoneFlag::Lock, BoneFlag::Mute] {
        let mut hand = arm(2, Id::ToolMove);
        hand.state.execute(Request::Timeline(KeysRequest::Flag(flag, 1, true)));
        hand.state.begin_frame(hand.state.read().now);
        hand.command(Id::ToggleIk);
        let (before, tip) = (poses(&hand), place(&hand, 2));
        drag(&mut hand, Handle::Center, Vec2::new(30.0, 40.0));
        hand.release();
        assert!(hand.refused.is_empty(), "{:?}", hand.refused);
        assert_eq!(hand.steps().len(), 1, "{flag:?}: {:?}", hand.steps());
        assert_eq!(keyed(&hand), [(0, Property::Rotation), (2, Property::Rotation)], "{flag:?}");
        let after = poses(&hand);
        assert_eq!(after[1], before[1], "{flag:?}: it stays as it is");
        assert_ne!(after[0].rotation, before[0].rotation, "{flag:?}: the others reach");
        assert!(place(&hand, 2).distance(tip) > 0.05, "{flag:?}");
    }
    // A locked bone cannot be dragged itself, and a message gives the reason.
    let mut hand = arm(2, Id::ToolMove);
    hand.state.execute(Request::Timeline(KeysRequest::Flag(BoneFlag::Lock, 2, true)));
    hand.command(Id::ToggleIk);
    let from = hand.handle(Handle::Center);
    hand.press(from);
    hand.to(from + Vec2::new(20.0, 20.0));
    hand.release();
    assert!(hand.steps().is_empty(), "{:?}", hand.steps());
}
