//! A stroke in the viewport becomes the path of a bone over time.

use crate::pose_line::{chain, joints, said, select};
use crate::scene_lines::{at, run, send, stroke};
use crate::workbench::Window;
use dragonfly::control::line::LineUse;
use dragonfly::control::{Button, InputEvent, Modifiers};
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::keys::KeysRequest;
use dragonfly_document::Change;
use glam::{DVec3, Vec3};

/// A part of a circle about the root of the chain, by shares of it: from above it to the right.
fn on_arc(root: Vec3, share: f64) -> DVec3 {
    let angle = (90.0 - 70.0 * share).to_radians();
    root.as_dvec3() + DVec3::new(angle.cos(), angle.sin(), 0.0) * 1.2
}

fn arc(root: Vec3) -> Vec<DVec3> {
    (0..=60).map(|step| on_arc(root, f64::from(step) / 60.0)).collect()
}

fn opened() -> Window {
    let mut window = chain();
    run(&mut window, Id::ViewFront);
    run(&mut window, Id::FrameAll);
    window
}

fn joint_at(window: &mut Window, time: f32, bone: usize) -> Vec3 {
    window.state_mut().state.execute(Request::Seek(time));
    window.run_steps(1);
    joints(window)[bone]
}

fn draw(window: &mut Window, line: &[DVec3], alt: bool) {
    let modifiers = Modifiers { alt, ..Modifiers::default() };
    let first = at(window, line[0]);
    send(window, InputEvent::MouseMove(first));
    send(window, InputEvent::Modifiers(modifiers));
    stroke(window, line);
    send(window, InputEvent::Modifiers(Modifiers::default()));
}

fn key_counts(window: &Window) -> Vec<usize> {
    let view = window.state().state.read().view.cloned().unwrap();
    view.takes[0].tracks.iter().map(|track| track.rotation.times.len()).collect()
}

#[test]
fn alt_and_a_stroke_let_the_end_of_the_chain_follow_it_over_the_take_in_one_step() {
    let mut window = opened();
    select(&mut window, &[0, 1, 2]);
    let root = joint_at(&mut window, 0.0, 0);
    let before: Vec<Vec3> = (0..=10).map(|step| joint_at(&mut window, step as f32 / 10.0, 3)).collect();
    let steps = window.state().steps().0;
    run(&mut window, Id::PoseLine);
    let camera = window.state().state.read().camera;
    draw(&mut window, &arc(root), true);
    assert_eq!(window.state().steps().0, steps + 1, "{}", said(&window));
    assert_eq!(window.state().state.read().camera, camera, "the camera does not orbit");
    let end = window.state().state.read().take_bounds().1;
    for step in 0..=20 {
        let share = f64::from(step) / 20.0;
        let found = joint_at(&mut window, end * share as f32, 3).as_dvec3();
        // The chain did not move, so the way is gone evenly.
        let wanted = on_arc(root, share);
        assert!(found.distance(wanted) < 0.04, "at {share}: {found} instead of {wanted}");
    }
    let counts = key_counts(&window);
    let frames = (f64::from(end) * window.state().state.read().frames_per_second()) as usize + 1;
    assert!(counts[0] > 2 && counts[0] < frames, "{counts:?} keys, and {frames} frames");
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    for (step, before) in before.iter().enumerate() {
        let found = joint_at(&mut window, step as f32 / 10.0, 3);
        assert!(found.distance(*before) < 1e-6, "{found} {before}");
    }
}

#[test]
fn only_the_play_range_follows_the_stroke() {
    let mut window = opened();
    select(&mut window, &[0, 1, 2]);
    let root = joint_at(&mut window, 0.0, 0);
    let start = joint_at(&mut window, 0.0, 3);
    let range = Request::Timeline(KeysRequest::Range(Some([0.25, 0.75])));
    window.state_mut().state.execute(range);
    run(&mut window, Id::MotionStroke);
    draw(&mut window, &arc(root), false);
    for (time, share) in [(0.25, 0.0), (0.5, 0.5), (0.75, 1.0)] {
        let found = joint_at(&mut window, time, 3).as_dvec3();
        assert!(found.distance(on_arc(root, share)) < 0.04, "at {time}: {found}");
    }
    assert!(joint_at(&mut window, 0.0, 3).distance(start) < 1e-6, "what is before stays");
}

#[test]
fn selected_keys_of_one_bone_go_to_the_stroke_at_their_times() {
    let mut window = opened();
    run(&mut window, Id::MotionStroke);
    assert_eq!(window.state().state.read().tools.controls().line().use_of(), None, "no bone is selected");
    select(&mut window, &[3]);
    run(&mut window, Id::SelectAllKeys);
    let before = key_counts(&window);
    let root = joint_at(&mut window, 0.0, 0);
    run(&mut window, Id::MotionStroke);
    assert_eq!(window.state().state.read().tools.controls().line().use_of(), Some(LineUse::Motion));
    draw(&mut window, &arc(root), false);
    let end = window.state().state.read().take_bounds().1;
    for share in [0.0, 1.0] {
        let found = joint_at(&mut window, end * share, 3).as_dvec3();
        assert!(found.distance(on_arc(root, f64::from(share))) < 0.02, "{found}: {}", said(&window));
    }
    assert_eq!(key_counts(&window), before, "no other keys");
    // The middle button orbits as ever.
    let pointer = at(&window, DVec3::ZERO);
    let camera = window.state().state.read().camera;
    send(&mut window, InputEvent::MouseMove(pointer));
    send(&mut window, InputEvent::MouseDown(Button::Middle));
    send(&mut window, InputEvent::MouseMove(pointer + 40.0));
    send(&mut window, InputEvent::MouseUp(Button::Middle));
    assert_ne!(window.state().state.read().camera, camera);
}
