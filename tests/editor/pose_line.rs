//! A stroke in the viewport becomes the pose of the selected chain of bones.

use crate::scene_lines::{at, run, send, stroke};
use crate::workbench::{Window, Workbench};
use dragonfly::control::line::LineUse;
use dragonfly::control::{InputEvent, Key};
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly_anim::animation::to_root;
use dragonfly_anim::data::Transform;
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use dragonfly_kit::document::fixture;
use egui_kittest::kittest::Queryable;
use glam::{DVec3, Mat4, Vec3};

/// A view of a straight chain: four bones of half a meter, up from the origin.
pub(crate) fn chain() -> Window {
    use dragonfly_anim::data::{Bone, Skeleton};
    let bone = |index: u32| Bone {
        name: format!("bone {index}"),
        parent: index.checked_sub(1),
        rest: Transform {
            translation: if index == 0 { Vec3::ZERO } else { Vec3::Y * 0.5 },
            ..Transform::IDENTITY
        },
        ..Bone::root("")
    };
    let skeleton = Skeleton { bones: (0..4).map(bone).collect() };
    Workbench::new(Some(fixture::view("chain.glb", skeleton, &[("Wave", 1.0, 2)]))).window()
}

fn poses(window: &Window) -> Vec<Transform> {
    (0..4).map(|bone| window.state().pose(bone)).collect()
}

pub(crate) fn joints(window: &Window) -> Vec<Vec3> {
    let view = window.state().state.read().view.cloned().unwrap();
    let (skeleton, poses) = (&view.loaded.model.animation.skeleton, poses(window));
    let mut matrices = vec![Mat4::IDENTITY; 4];
    to_root(skeleton, &poses, &mut matrices);
    matrices.iter().map(|matrix| matrix.w_axis.truncate()).collect()
}

pub(crate) fn select(window: &mut Window, bones: &[u32]) {
    window.state_mut().state.execute(Request::SelectBones(bones.to_vec(), Choice::Replace));
    window.run_steps(2);
}

pub(crate) fn said(window: &Window) -> String {
    window.state().state.read().status.last().map(|message| message.text.clone()).unwrap_or_default()
}

#[test]
fn the_selected_chain_lies_along_the_stroke_in_the_view() {
    let mut window = chain();
    run(&mut window, Id::ViewFront);
    run(&mut window, Id::AutoKey);
    if !window.state().state.read().settings.auto_key {
        run(&mut window, Id::AutoKey);
    }
    run(&mut window, Id::FrameAll);
    select(&mut window, &[0, 1, 2]);
    let before = joints(&window);
    let steps = window.state().steps().0;
    // The key that draws lines in scenes draws the pose line here.
    run(&mut window, Id::ToolLine);
    assert_eq!(window.state().state.read().tools.controls().line().use_of(), Some(LineUse::Pose));
    // To the right, two thirds of the way, and up.
    let corner = |x: f64, y: f64| before[0].as_dvec3() + DVec3::new(x, y, 0.0);
    let right: Vec<DVec3> = (0..=40).map(|step| corner(f64::from(step) / 40.0, 0.0)).collect();
    let up = (1..=20).map(|step| corner(1.0, f64::from(step) / 40.0));
    let line: Vec<DVec3> = right.into_iter().chain(up).collect();
    stroke(&mut window, &line);
    assert_eq!(window.state().steps().0, steps + 1, "one step: {}", said(&window));
    let after = joints(&window);
    let expected = [corner(0.0, 0.0), corner(0.5, 0.0), corner(1.0, 0.0), corner(1.0, 0.5)];
    for (found, expected) in after.iter().zip(expected) {
        assert!(found.as_dvec3().distance(expected) < 0.04, "{after:?}");
    }
    let undo = window.state_mut();
    undo.change(Change::Undo);
    window.run_steps(2);
    let undone = joints(&window);
    assert!(undone.iter().zip(&before).all(|(a, b)| a.distance(*b) < 1e-6), "{undone:?}");
}

#[test]
fn a_locked_bone_of_the_chain_stays_and_the_others_follow_the_stroke() {
    let mut window = chain();
    run(&mut window, Id::ViewFront);
    run(&mut window, Id::FrameAll);
    select(&mut window, &[1]);
    run(&mut window, Id::LockBones);
    select(&mut window, &[0, 1, 2]);
    let (before, start) = (poses(&window), joints(&window)[0].as_dvec3());
    run(&mut window, Id::PoseLine);
    let from = at(&window, start);
    let to = at(&window, start + DVec3::X);
    send(&mut window, InputEvent::MouseMove(from));
    let line: Vec<DVec3> = (0..=30).map(|step| start + DVec3::X * 0.05 * f64::from(step)).collect();
    stroke(&mut window, &line);
    assert!(to.x > from.x + 50.0, "{from} {to}");
    let pending = window.state().state.read().pending_poses().0;
    let shown = window.state().steps().0;
    assert!(pending > 0 || shown > 0, "{}", said(&window));
    assert_eq!(poses(&window)[1].rotation, before[1].rotation);
    // The chain stood upright; the line goes to the right.
    for joint in &joints(&window)[2..] {
        let away = (joint.as_dvec3() - start).with_x(0.0).length();
        assert!(away < 0.1 && joint.x as f64 - start.x > 0.3, "{joint} is {away} m from the line");
    }
}

#[test]
fn bones_that_are_no_chain_are_refused_with_the_reason() {
    let mut window = Workbench::full().window();
    run(&mut window, Id::PoseLine);
    assert!(said(&window).contains("selected bone"), "{}", said(&window));
    let mut window = chain();
    select(&mut window, &[3]);
    run(&mut window, Id::PoseLine);
    assert!(said(&window).contains("two bones"), "{}", said(&window));
    select(&mut window, &[1, 2]);
    run(&mut window, Id::PoseLine);
    assert_eq!(window.state().state.read().tools.controls().line().use_of(), Some(LineUse::Pose));
    let pointer = at(&window, DVec3::ZERO);
    send(&mut window, InputEvent::MouseMove(pointer));
    send(&mut window, InputEvent::KeyDown(Key::Escape));
    assert_eq!(window.state().state.read().tools.controls().line().use_of(), None);
}

#[test]
fn a_bar_in_the_viewport_shows_that_the_pose_line_is_drawn_and_its_keys() {
    let mut window = chain();
    select(&mut window, &[0, 1, 2]);
    for (command, keys) in
        [(Id::PoseLine, "With Alt: motion path"), (Id::MotionStroke, "over time. Click: corners")]
    {
        assert!(window.query_by_label_contains(keys).is_none());
        run(&mut window, command);
        assert!(window.query_by_label_contains(keys).is_some(), "{keys}");
        run(&mut window, command);
    }
}
