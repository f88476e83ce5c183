//! With IK on, dragging a bone moves the bones above it too, and pinned bones stay where they are.

use crate::viewport_tools_rig::{PICTURE, ViewportHarness};
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

/// Opens the arm in the middle of its take, where it is bent, with this bone selected and this tool active.
fn arm(bone: BoneIndex, tool: Id) -> ViewportHarness {
    let mut viewport = ViewportHarness::new(load);
    viewport.state.execute(Request::Seek(0.5));
    viewport.state.execute(Request::Select(Some(bone)));
    viewport.command(tool);
    viewport.state.begin_frame(viewport.state.read().now);
    viewport
}

fn poses(viewport: &ViewportHarness) -> Vec<Transform> {
    viewport.state.read().posed.animation().expect("posed").poses().to_vec()
}

fn place(viewport: &ViewportHarness, bone: usize) -> Vec3 {
    viewport.state.read().posed.animation().expect("posed").to_root()[bone].w_axis.truncate()
}

fn facing(viewport: &ViewportHarness, bone: usize) -> Quat {
    viewport.state.read().posed.animation().expect("posed").to_root()[bone].to_scale_rotation_translation().1
}

/// Returns the channels that have a key at the current time, with their bones.
fn keyed(viewport: &ViewportHarness) -> Vec<(BoneIndex, Property)> {
    let slot = viewport.state.read().slot().expect("a take");
    let bones = 0..arm::BONES as BoneIndex;
    let all = bones.flat_map(|bone| Property::ALL.into_iter().map(move |property| (bone, property)));
    all.filter(|&(bone, property)| slot.key_at(bone, property, viewport.state.read().time()).is_some())
        .collect()
}

/// Presses the button on `handle` and moves the pointer by `by`, in points, in four steps. Returns the end position.
fn drag(viewport: &mut ViewportHarness, handle: Handle, by: Vec2) -> Vec2 {
    let from = viewport.handle(handle);
    viewport.press(from);
    for part in 1..=4 {
        viewport.to(from + by * part as f32 / 4.0);
    }
    from + by
}

#[test]
fn dragging_the_tip_moves_its_chain_in_one_undo_step() {
    let mut viewport = arm(2, Id::ToolMove);
    viewport.command(Id::ToggleIk);
    let (before, takes) = (poses(&viewport), viewport.state.read().view.cloned().expect("open").takes);
    let (tip, direction) = (place(&viewport, 2), facing(&viewport, 2));
    drag(&mut viewport, Handle::Center, Vec2::new(30.0, 40.0));
    viewport.release();
    assert!(viewport.refused.is_empty(), "{:?}", viewport.refused);
    assert_eq!(viewport.steps().len(), 1, "{:?}", viewport.steps());
    let after = poses(&viewport);
    for bone in 0..3 {
        assert_ne!(after[bone].rotation, before[bone].rotation, "bone {bone} turns");
        assert_eq!(after[bone].translation, before[bone].translation, "bone {bone} is not pulled off");
    }
    let rotations: Vec<_> = (0..3).map(|bone| (bone, Property::Rotation)).collect();
    assert_eq!(keyed(&viewport), rotations);
    assert!(place(&viewport, 2).distance(tip) > 0.1, "it moved");
    assert!(facing(&viewport, 2).angle_between(direction) < 1e-3, "a hand keeps its direction");
    // Undo restores the takes.
    viewport.command(Id::Undo);
    assert_eq!(poses(&viewport), before);
    assert_eq!(viewport.state.read().view.expect("open").takes, takes, "bit for bit");
    assert!(viewport.steps().is_empty());
    // Without IK the same drag moves the bone alone.
    viewport.command(Id::ToggleIk);
    drag(&mut viewport, Handle::Center, Vec2::new(30.0, 40.0));
    viewport.release();
    assert_eq!(keyed(&viewport), [(2, Property::Translation)]);
}

#[test]
fn with_ik_on_the_dragged_end_of_a_chain_follows_the_pointer() {
    let mut viewport = arm(2, Id::ToolMove);
    viewport.command(Id::ToggleIk);
    let from = viewport.joint();
    // Towards the root, so that it can be reached.
    let root = {
        viewport.state.execute(Request::Select(Some(0)));
        let root = viewport.joint();
        viewport.state.execute(Request::Select(Some(2)));
        viewport.state.begin_frame(viewport.state.read().now);
        root
    };
    let by = (root - from) * 0.3;
    drag(&mut viewport, Handle::Center, by);
    viewport.release();
    assert!(viewport.joint().distance(from + by) < 0.1, "{} is not {}", viewport.joint(), from + by);
}

#[test]
fn a_pinned_tip_is_held_at_every_played_frame_in_one_step() {
    let mut viewport = arm(2, Id::ToolMove);
    viewport.command(Id::Pin);
    let (tip, direction) = (place(&viewport, 2), facing(&viewport, 2));
    let takes = viewport.state.read().view.cloned().expect("open").takes;
    let at = |viewport: &mut ViewportHarness, time: f32| {
        viewport.state.execute(Request::Seek(time));
        viewport.state.begin_frame(viewport.state.read().now);
        (place(viewport, 2).distance(tip), facing(viewport, 2).angle_between(direction))
    };
    assert!(at(&mut viewport, 0.3).0 > 0.05, "without it the tip moves");
    let outside = [0.0, 1.0].map(|time| at(&mut viewport, time).0);
    at(&mut viewport, 0.5);
    viewport.state.execute(Request::Timeline(KeysRequest::Range(Some([0.25, 0.76]))));
    viewport.command(Id::BakePins);
    assert_eq!(viewport.steps().len(), 1, "{:?} {:?}", viewport.steps(), viewport.refused);
    // The tip is exact at the frames and at the ends of the play range, and nearly exact between them.
    let frames = (8..=22).map(|frame| frame as f32 / 30.0);
    for time in frames.chain([0.25, 0.76]) {
        let (apart, turned) = at(&mut viewport, time);
        assert!(apart < 1e-4 && turned < 1e-3, "at {time} s: {apart} m, {turned} rad");
        assert!(at(&mut viewport, (time + 0.011).min(0.76)).0 < 2e-3, "behind {time} s");
    }
    for (time, outside) in [0.0, 1.0].into_iter().zip(outside) {
        assert!((at(&mut viewport, time).0 - outside).abs() < 1e-5, "keys outside the play range stay");
    }
    viewport.command(Id::Undo);
    assert_eq!(viewport.state.read().view.expect("open").takes, takes, "bit for bit");
}

#[test]
fn a_bone_that_cannot_be_pinned_is_reported() {
    let mut viewport = arm(0, Id::ToolMove);
    viewport.command(Id::Pin);
    viewport.command(Id::BakePins);
    assert!(viewport.steps().is_empty());
    let said = &viewport.state.read().status.last().expect("a line").text;
    assert!(said.contains("No parent of the pinned bones"), "{said}");
}

#[test]
fn a_pinned_tip_stays_while_the_root_is_moved_and_turned() {
    for (tool, handle) in [
        (Id::ToolMove, Handle::Center),
        (Id::ToolRotate, Handle::Axis(GizmoAxis::Z)),
        (Id::ToolRotate, Handle::Axis(GizmoAxis::X)),
    ] {
        let mut viewport = arm(2, tool);
        viewport.command(Id::Pin);
        viewport.state.execute(Request::Select(Some(0)));
        viewport.state.begin_frame(viewport.state.read().now);
        let (tip, direction, before) = (place(&viewport, 2), facing(&viewport, 2), poses(&viewport));
        let from = viewport.handle(handle);
        viewport.press(from);
        for part in 1..=5 {
            viewport.to(from + Vec2::new(3.0, -4.0) * part as f32);
            let off = place(&viewport, 2).distance(tip);
            assert!(off < 1e-4, "{tool:?}: {off} from where it was");
            assert!(facing(&viewport, 2).angle_between(direction) < 1e-3);
        }
        viewport.release();
        assert_eq!(viewport.steps().len(), 1, "{:?}", viewport.steps());
        assert_ne!(poses(&viewport)[1], before[1], "the middle bends");
        viewport.command(Id::Undo);
        assert_eq!(poses(&viewport), before);
    }
}

#[test]
fn pinned_bones_stay_while_a_number_is_typed_for_their_root() {
    let mut viewport = arm(2, Id::ToolMove);
    viewport.command(Id::Pin);
    viewport.state.execute(Request::Select(Some(0)));
    viewport.state.begin_frame(viewport.state.read().now);
    let (tip, root) = (place(&viewport, 2), place(&viewport, 0));
    viewport.command(Id::MoveNow);
    viewport.keys("y0.05");
    viewport.key(Key::Enter);
    assert!((place(&viewport, 0) - root).distance(Vec3::Y * 0.05) < 1e-4);
    assert!(place(&viewport, 2).distance(tip) < 1e-4);
    assert_eq!(viewport.steps().len(), 1);
}

#[test]
fn escape_restores_chain_and_pins_bit_for_bit() {
    for (bone, pin) in [(2, None), (0, Some(2))] {
        let mut viewport = arm(pin.unwrap_or(bone), Id::ToolMove);
        match pin {
            Some(_) => viewport.command(Id::Pin),
            None => viewport.command(Id::ToggleIk),
        }
        viewport.state.execute(Request::Select(Some(bone)));
        viewport.state.begin_frame(viewport.state.read().now);
        let (before, takes) = (poses(&viewport), viewport.state.read().view.cloned().expect("open").takes);
        for end in
            [InputEvent::KeyDown(Key::Escape), InputEvent::MouseDown(dragonfly::control::Button::Right)]
        {
            drag(&mut viewport, Handle::Center, Vec2::new(8.0, 20.0));
            assert_ne!(poses(&viewport), before);
            assert_eq!(viewport.steps().len(), 1);
            viewport.send(end);
            viewport.send(InputEvent::MouseUp(dragonfly::control::Button::Right));
            viewport.release();
            assert!(viewport.steps().is_empty());
            assert_eq!(poses(&viewport), before);
            assert_eq!(viewport.state.read().view.expect("open").takes, takes);
        }
    }
}

#[test]
fn with_auto_key_off_the_whole_chain_is_pending() {
    let mut viewport = arm(2, Id::ToolMove);
    viewport.command(Id::ToggleIk);
    viewport.command(Id::AutoKey);
    let before = poses(&viewport);
    drag(&mut viewport, Handle::Center, Vec2::new(30.0, 40.0));
    viewport.release();
    assert!(keyed(&viewport).is_empty(), "{:?}", keyed(&viewport));
    let pending = viewport.state.read().pending_here().expect("pending");
    let bones: Vec<u32> = pending.poses.iter().map(|pose| pose.bone).collect();
    assert_eq!(bones, [0, 1, 2]);
    assert_ne!(poses(&viewport), before, "and seen");
    viewport.command(Id::Undo);
    assert!(viewport.state.read().pending_here().is_none());
}

#[test]
fn switching_ik_during_a_drag_applies_to_the_next_drag() {
    let mut viewport = arm(2, Id::ToolMove);
    viewport.command(Id::ToggleIk);
    let to = drag(&mut viewport, Handle::Center, Vec2::new(20.0, 20.0));
    viewport.command(Id::ToggleIk);
    viewport.to(to + Vec2::new(5.0, 5.0));
    viewport.release();
    assert_eq!(viewport.steps().len(), 1);
    assert!(keyed(&viewport).iter().all(|key| key.1 == Property::Rotation), "{:?}", keyed(&viewport));
}

#[test]
fn the_ik_overlay_follows_the_ik_setting() {
    let mut viewport = arm(2, Id::ToolMove);
    assert_eq!(viewport.state.read().ik_look(), None);
    viewport.command(Id::ToggleIk);
    let look = viewport.state.read().ik_look();
    assert_eq!(look, Some(IkLook { pins: vec![], chain: Some((2, 2)), pole: None }));
    assert!(viewport.state.read().shows_ik(look.as_ref()));
    viewport.command(Id::LongerIk);
    assert!(!viewport.state.read().shows_ik(look.as_ref()));
    viewport.command(Id::Pin);
    viewport.command(Id::ToggleIk);
    let look = viewport.state.read().ik_look();
    assert_eq!(look, Some(IkLook { pins: vec![2], chain: None, pole: None }));
    assert!(viewport.state.read().shows_ik(look.as_ref()) && !viewport.state.read().shows_ik(None));
}

#[test]
fn a_muted_bone_is_dragged_where_it_is_drawn() {
    let mut viewport = arm(2, Id::ToolMove);
    let bent = place(&viewport, 2);
    viewport.state.execute(Request::Timeline(KeysRequest::Flag(BoneFlag::Mute, 1, true)));
    viewport.state.begin_frame(viewport.state.read().now);
    assert!(place(&viewport, 2).distance(Vec3::Y * 2.0) < 1e-6, "straight, not {}", place(&viewport, 2));
    assert!(
        viewport.state.read().tools.controls().gizmo().gizmo.handle_at(viewport.joint()).is_some(),
        "the gizmo stands there"
    );
    viewport.state.execute(Request::Timeline(KeysRequest::Flag(BoneFlag::Mute, 1, false)));
    viewport.state.begin_frame(viewport.state.read().now);
    assert_eq!(place(&viewport, 2), bent);
}

#[test]
fn with_auto_key_off_a_dragged_key_of_the_motion_path_becomes_a_pending_pose() {
    let mut viewport = arm(2, Id::ToolSelect);
    viewport.command(Id::TogglePath);
    viewport.state.execute(Request::Seek(0.0));
    viewport.command(Id::AutoKey);
    let last = *viewport.state.read().tools.path().look().expect("a path").keys.last().expect("a key");
    let view = GizmoView::new(&viewport.state.read().camera, Vec2::new(800.0, 600.0));
    let from = view.to_screen(last.1.as_dvec3()).expect("seen").as_vec2() + Vec2::new(200.0, 50.0);
    viewport.press(from);
    viewport.to(from + Vec2::new(30.0, -20.0));
    viewport.release();
    assert_eq!(viewport.state.read().pending_times().collect::<Vec<_>>(), [last.0]);
    let now = *viewport.state.read().tools.path().look().expect("a path").keys.last().expect("a key");
    assert!(now.1.distance(last.1) > 0.05, "the path shows what is pending");
    viewport.command(Id::Undo);
    assert_eq!(viewport.state.read().tools.path().look().expect("a path").keys.last(), Some(&last));
}

/// Returns the scene that the graphics thread would hold for the same state, without drawn bones.
fn scene(viewport: &ViewportHarness) -> Scene {
    let mut scene = Scene::new(viewport.state.read().now);
    let [_, _, width, height] = PICTURE.map(|number| number as u32);
    scene.look.viewport = [0, 0, width, height];
    scene.camera = viewport.state.read().camera;
    scene.playback = viewport.state.read().playback;
    scene.show(viewport.state.read().view.expect("open"));
    scene.prepare(viewport.state.read().now);
    scene
}

#[test]
fn pins_and_the_chain_are_drawn_where_the_bones_are() {
    let viewport = arm(2, Id::ToolMove);
    let mut scene = scene(&viewport);
    let look = IkLook { pins: vec![2, 77], chain: Some((2, 9)), pole: Some(77) };
    scene.appearances.set(IkAppearance(Some(look)));
    scene.prepare(viewport.state.read().now);
    let shape = scene.controls.shape();
    let lines: Vec<Vec3> = shape.lines().iter().map(|corner| corner.position).collect();
    assert_eq!(lines[..4], [1, 2, 0, 1].map(|bone| place(&viewport, bone)), "up the chain");
    assert_eq!(lines.len(), 2 * 2 + 4 * 2, "and a frame around the pin");
    let middle = lines[4..].iter().sum::<Vec3>() / 8.0;
    assert!(middle.distance(place(&viewport, 2)) < 1e-5);
    assert_eq!(shape.triangles().len(), 2 * 6, "a dot at the root, and in the frame");
    scene.appearances.set(IkAppearance(None));
    scene.prepare(viewport.state.read().now);
    assert!(scene.controls.shape().lines().is_empty());
}

#[test]
fn a_click_on_the_skin_of_a_pending_pose_picks_its_bone() {
    let mut viewport = arm(0, Id::ToolMove);
    viewport.command(Id::AutoKey);
    viewport.command(Id::MoveNow);
    viewport.keys("x1.5");
    viewport.key(Key::Enter);
    assert!(place(&viewport, 0).distance(Vec3::X * 1.5) < 1e-4, "{}", place(&viewport, 0));
    let mut scene = scene(&viewport);
    let view = GizmoView::new(&scene.camera, Vec2::new(PICTURE[2], PICTURE[3]));
    let at = |place: Vec3| view.to_screen(place.as_dvec3()).expect("seen").as_vec2().to_array();
    let side = scene.camera.right() * 0.18;
    assert_eq!(scene.pick_all(at(Vec3::new(1.5, 0.3, 0.0) + side)), [0]);
    assert!(scene.pick_all(at(Vec3::new(0.0, 0.3, 0.0) - side)).is_empty(), "not where the keys have it");
}

#[test]
fn a_locked_or_muted_bone_in_the_middle_of_a_chain_does_not_rotate() {
    for flag in [BoneFlag::Lock, BoneFlag::Mute] {
        let mut viewport = arm(2, Id::ToolMove);
        viewport.state.execute(Request::Timeline(KeysRequest::Flag(flag, 1, true)));
        viewport.state.begin_frame(viewport.state.read().now);
        viewport.command(Id::ToggleIk);
        let (before, tip) = (poses(&viewport), place(&viewport, 2));
        drag(&mut viewport, Handle::Center, Vec2::new(30.0, 40.0));
        viewport.release();
        assert!(viewport.refused.is_empty(), "{:?}", viewport.refused);
        assert_eq!(viewport.steps().len(), 1, "{flag:?}: {:?}", viewport.steps());
        assert_eq!(keyed(&viewport), [(0, Property::Rotation), (2, Property::Rotation)], "{flag:?}");
        let after = poses(&viewport);
        assert_eq!(after[1], before[1], "{flag:?}: it stays as it is");
        assert_ne!(after[0].rotation, before[0].rotation, "{flag:?}: the others reach");
        assert!(place(&viewport, 2).distance(tip) > 0.05, "{flag:?}");
    }
    // A locked bone cannot be dragged itself, and a message gives the reason.
    let mut viewport = arm(2, Id::ToolMove);
    viewport.state.execute(Request::Timeline(KeysRequest::Flag(BoneFlag::Lock, 2, true)));
    viewport.command(Id::ToggleIk);
    let from = viewport.handle(Handle::Center);
    viewport.press(from);
    viewport.to(from + Vec2::new(20.0, 20.0));
    viewport.release();
    assert!(viewport.steps().is_empty(), "{:?}", viewport.steps());
}
