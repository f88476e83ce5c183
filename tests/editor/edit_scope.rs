//! Edits of poses apply to this frame, to the selected keys, to the play range or to the whole take, as set by the switch.

use crate::viewport_tools_rig::ViewportHarness;
use crate::workbench::{Window, Workbench, drag, move_to, press, release, type_into};
use dragonfly::control;
use dragonfly::panels::commands::Id;
use dragonfly::panels::edit_scope::EditScope;
use dragonfly::panels::keys::KeysRequest;
use dragonfly::panels::{Effect, Request};
use dragonfly_anim::data::{Take, Transform};
use dragonfly_anim::sample::sample_track;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{BonePose, BoneRef, Edit, FadeShape, Property};
use dragonfly_document::{Cancel, Change, LoadError, OpenedModel, Progress, Source, View};
use dragonfly_kit::document::{arm, fixture};
use dragonfly_picture::gizmo::Handle;
use egui::{Key, Modifiers, PointerButton, vec2};
use egui_kittest::kittest::Queryable;
use glam::{Quat, Vec2};
use std::sync::Arc;

/// The bone that is edited.
const BONE: u32 = 3;

/// Returns the panels with one take of a second, `keys` keys per bone, and the bone selected in the middle.
fn bench(keys: usize, scope: Id) -> Workbench {
    let view = fixture::view("walk.glb", fixture::skeleton(9), &[("Walk", 1.0, keys)]);
    let mut bench = Workbench::new(Some(view));
    bench.state.execute(Request::Select(Some(BONE)));
    bench.state.execute(Request::Seek(0.5));
    bench.state.execute(Request::Command(scope));
    bench
}

fn view(bench: &Workbench) -> &View {
    bench.state.read().view.expect("open")
}

fn take(bench: &Workbench) -> Arc<Take> {
    Arc::clone(&view(bench).takes[0])
}

fn at(bench: &Workbench, take: &Take, bone: u32, time: f32) -> Transform {
    let bones = &view(bench).loaded.model.animation.skeleton.bones;
    sample_track(&take.tracks[bone as usize], &bones[bone as usize], time)
}

/// Returns the angle between two poses of a bone, radians.
fn angle(bench: &Workbench, takes: [&Take; 2], bone: u32, time: f32, by: Quat) -> f32 {
    let [before, after] = takes.map(|take| at(bench, take, bone, time).rotation);
    let (wanted, found) = ((by * before).as_dquat(), after.as_dquat());
    2.0 * (wanted - found).length().min((wanted + found).length()) as f32
}

fn grid() -> impl Iterator<Item = f32> {
    (0..=100).map(|step| step as f32 / 100.0)
}

fn select_keys(bench: &mut Workbench, stretch: [f32; 2]) {
    let channels = Arc::from([(BONE, Property::Rotation)]);
    let choice = Choice::Replace;
    let select = KeysRequest::Select { channels, shapes: false, stretch, choice };
    bench.state.execute(Request::Timeline(select));
}

/// Returns a pose of the bone, turned by an angle about x.
fn turned(angle: f32) -> Vec<BonePose> {
    let rotation = Some(Quat::from_rotation_x(angle).to_array());
    vec![BonePose { bone: BoneRef::Index(BONE), translation: None, rotation, scale: None }]
}

/// Returns whether no pose can be edited in the scope that is set.
fn is_refused(bench: &Workbench) -> bool {
    bench.state.read().pose_edit(turned(1.0)).is_none()
}

/// Returns what the newest step of the history is about.
fn about(bench: &Workbench) -> String {
    let (steps, done) = bench.edited.as_ref().expect("open").steps();
    let step = &steps[done - 1];
    format!("{} {}", step.edit.label(), step.about)
}

#[test]
fn twenty_degrees_over_the_walk_are_three_actions_and_exact_at_every_time() {
    let view = fixture::view("walk.glb", fixture::skeleton(9), &[("Walk", 1.0, 25)]);
    let mut bench = Workbench::new(Some(view));
    bench.state.execute(Request::Seek(0.37));
    let before = take(&bench);
    bench.state.execute(Request::Command(Id::EditWholeTake));
    bench.state.execute(Request::Select(Some(BONE)));
    let mut window = bench.window();
    type_into(&mut window, "Rotation change X", "20", Key::Enter);
    let bench = window.state();
    assert_eq!(bench.refused, [""; 0]);
    let after = take(bench);
    let turn = Quat::from_rotation_x(20_f32.to_radians());
    for time in grid() {
        let off = angle(bench, [&before, &after], BONE, time, turn);
        assert!(off < 2e-5, "{off} at {time}");
    }
    assert_eq!(after.tracks[BONE as usize].rotation.times, before.tracks[BONE as usize].rotation.times);
    for other in (0..9).filter(|other| *other != BONE as usize) {
        assert_eq!(after.tracks[other], before.tracks[other], "bone {other}");
    }
    assert_eq!(bench.steps(), (1, 1));
    assert!(about(bench).contains("25 keys in the whole take"), "{}", about(bench));
}

#[test]
fn a_field_that_is_dragged_edits_the_whole_take_in_one_step_and_escape_leaves_no_trace() {
    for keys in [25, 60_000] {
        let bench = bench(keys, Id::EditWholeTake);
        let before = take(&bench);
        let mut window = bench.window();
        let from = window.get_by_label("Rotation change X").rect().center();
        press(&mut window, from);
        for step in 1..=4 {
            move_to(&mut window, from + vec2(10.0 * step as f32, 0.0), Modifiers::NONE);
        }
        window.key_press(Key::Escape);
        window.run_steps(2);
        release(&mut window, from);
        assert_eq!(window.state().steps(), (0, 0), "{keys} keys");
        assert_eq!(take(window.state()), before, "{keys} keys");
        assert!(view(window.state()).slots[0].pending().is_empty());

        drag(&mut window, "Rotation change X", vec2(40.0, 0.0), Modifiers::NONE);
        let bench = window.state();
        let after = take(bench);
        let [was, is] = [&before, &after].map(|take| at(bench, take, BONE, 0.5).rotation);
        let turn = is * was.conjugate();
        assert!(turn.to_axis_angle().1 > 0.01, "{keys} keys: {turn}");
        for time in grid() {
            let off = angle(bench, [&before, &after], BONE, time, turn);
            assert!(off < 2e-5, "{keys} keys: {off} at {time}");
        }
        assert_eq!(bench.steps(), (1, 1), "{keys} keys");
        assert!(view(bench).slots[0].pending().is_empty(), "{keys} keys");
        assert_eq!(bench.refused, [""; 0]);
        window.state_mut().change(Change::Undo);
        assert_eq!(take(window.state()), before, "{keys} keys");
    }
}

#[test]
fn a_drag_over_a_long_take_sends_only_the_pose_at_the_playhead_until_it_is_released() {
    let mut bench = bench(60_000, Id::EditWholeTake);
    let gesture = bench.state.read().dragging.new_gesture();
    for step in 1..=3 {
        let edit = bench.state.read().pose_edit(turned(step as f32 * 0.1)).expect("a take is shown");
        bench.change(Change::Edit(edit, Some(gesture)));
        let shown = bench.state.read().pending_here().is_some();
        assert!(shown, "the pose at the playhead is shown");
    }
    assert!(
        bench.changes.iter().all(|change| matches!(change, Change::Edit(Edit::SetPending(_), Some(_)))),
        "{:?}",
        bench.changes
    );
    bench.change(Change::Release(gesture));
    let sent = &bench.changes[3..];
    assert!(matches!(sent, [Change::Edit(Edit::OffsetKeys(_), Some(_)), Change::Release(_)]), "{sent:?}");
    assert!(bench.pose(BONE).rotation.angle_between(Quat::from_rotation_x(0.3)) < 1e-3);
    assert_eq!(bench.steps(), (1, 1));
    assert!(bench.state.read().pending_here().is_none());
}

#[test]
fn the_selected_keys_change_alone_and_without_any_the_reason_is_given() {
    let mut bench = bench(11, Id::EditSelectedKeys);
    assert!(is_refused(&bench));
    select_keys(&mut bench, [0.28, 0.62]);
    assert!(!is_refused(&bench));
    let before = take(&bench);
    let mut window = bench.window();
    type_into(&mut window, "Rotation change X", "20", Key::Enter);
    let bench = window.state();
    let after = take(bench);
    for time in (0..11).map(|key| key as f32 / 10.0) {
        let inside = (0.28..0.62).contains(&time);
        let by = if inside { Quat::from_rotation_x(20_f32.to_radians()) } else { Quat::IDENTITY };
        let off = angle(bench, [&before, &after], BONE, time, by);
        assert!(off < 2e-5, "{off} at {time}");
    }
    assert!(about(bench).contains("4 selected keys"), "{}", about(bench));
}

#[test]
fn the_falloff_spreads_an_edit_of_selected_keys_over_those_around_them() {
    let mut bench = bench(11, Id::EditSelectedKeys);
    select_keys(&mut bench, [0.5, 0.5]);
    bench.state.execute(Request::FrameRate(10));
    bench.state.settings_mut().falloff.frames = 4;
    bench.state.settings_mut().falloff.shape = FadeShape::Linear;
    bench.state.execute(Request::Command(Id::ToggleFalloff));
    let before = take(&bench);
    let mut window = bench.window();
    type_into(&mut window, "Rotation change X", "20", Key::Enter);
    let bench = window.state();
    let after = take(bench);
    for key in 0..11 {
        let part = (1.0 - (key as f32 - 5.0).abs() / 4.0).max(0.0);
        let by = Quat::from_rotation_x((20.0 * part).to_radians());
        let off = angle(bench, [&before, &after], BONE, key as f32 / 10.0, by);
        // The falloff ends a little before the frame where nothing of it is left.
        assert!(off < 1e-3, "{off} at key {key}");
    }
    assert_eq!(bench.steps(), (1, 1));
}

#[test]
fn outside_the_play_range_nothing_changes_and_a_playhead_out_there_is_refused() {
    let mut bench = bench(11, Id::EditPlayRange);
    bench.state.execute(Request::Timeline(KeysRequest::Range(Some([0.3, 0.7]))));
    bench.state.execute(Request::FrameRate(20));
    let before = take(&bench);
    let mut window = bench.window();
    type_into(&mut window, "Rotation change X", "20", Key::Enter);
    let bench = window.state_mut();
    assert_eq!(bench.refused, [""; 0]);
    let after = take(bench);
    for time in grid() {
        let by = match time {
            0.2999..0.7001 => Quat::from_rotation_x(20_f32.to_radians()),
            // The frames at both ends lead from one motion to the other.
            0.2499..0.7501 => continue,
            _ => Quat::IDENTITY,
        };
        let off = angle(bench, [&before, &after], BONE, time, by);
        assert!(off < 2e-5, "{off} at {time}");
    }
    assert_eq!(bench.steps(), (1, 1));
    bench.state.execute(Request::Seek(0.9));
    assert!(is_refused(bench));
    window.run_steps(3);
    assert!(window.query_by_label_contains("the playhead is outside of it").is_some());
}

#[test]
fn a_pose_is_pasted_into_the_whole_take_as_an_offset_of_every_key() {
    let mut bench = bench(11, Id::EditWholeTake);
    let before = take(&bench);
    bench.state.execute(Request::Seek(0.1));
    let Some(Effect::Copy(text)) = bench.state.execute(Request::Command(Id::CopyPose)) else {
        panic!("nothing was copied");
    };
    bench.state.execute(Request::Seek(0.5));
    let [copied, there] = [0.1, 0.5].map(|time| at(&bench, &before, BONE, time).rotation);
    let turn = copied * there.conjugate();
    match bench.state.execute(Request::PastePose { text, mirrored: false }) {
        Some(Effect::Change(change)) => bench.change(change),
        _ => panic!("nothing was pasted"),
    }
    let after = take(&bench);
    for time in grid() {
        let off = angle(&bench, [&before, &after], BONE, time, turn);
        assert!(off < 2e-5, "{off} at {time}");
    }
    assert_eq!(bench.steps(), (1, 1));
}

#[test]
fn the_switch_names_the_scope_and_another_model_begins_with_this_frame() {
    let mut window = bench(11, Id::EditFrame).window();
    window.get_by_label("Edits apply to: This frame").click();
    window.run_steps(3);
    window.get_by_label_contains("Edit whole take").click();
    window.run_steps(3);
    assert!(window.query_by_label("Edits apply to: Whole take").is_some());
    assert_eq!(window.state().state.read().over.scope, EditScope::Take);
    // The command for the next one goes around.
    for wanted in [EditScope::Frame, EditScope::Keys, EditScope::Range, EditScope::Take] {
        window.state_mut().state.execute(Request::Command(Id::NextEditScope));
        assert_eq!(window.state().state.read().over.scope, wanted);
    }
    window.state_mut().state.show(fixture::empty());
    assert_eq!(window.state().state.read().over.scope, EditScope::Frame);
}

#[test]
fn the_menu_of_a_number_field_has_the_scopes() {
    let mut window = bench(11, Id::EditFrame).window();
    let pos = window.get_by_label("Rotation result X").rect().center();
    click(&mut window, pos);
    window.get_by_label_contains("Edit play range").click();
    window.run_steps(3);
    assert_eq!(window.state().state.read().over.scope, EditScope::Range);
    assert_eq!(window.state().steps(), (0, 0));
}

fn arm(_: &Source, _: &mut dyn FnMut(Progress), _: &Cancel) -> Result<OpenedModel, LoadError> {
    Ok(Arc::into_inner(arm::loaded()).expect("the only one").into())
}

/// Opens the arm in the middle of its take, where it is bent, with a bone selected.
fn viewport(bone: u32, scope: Id) -> ViewportHarness {
    let mut viewport = ViewportHarness::new(arm);
    viewport.state.execute(Request::Seek(0.5));
    viewport.state.execute(Request::Select(Some(bone)));
    viewport.command(scope);
    viewport.state.begin_frame(viewport.state.read().now);
    viewport
}

/// Returns the rotations of all bones at some times.
fn rotations(viewport: &ViewportHarness) -> Vec<[Quat; arm::BONES]> {
    let view = viewport.state.read().view.expect("open");
    let bones = &view.loaded.model.animation.skeleton.bones;
    let bone = |bone: usize, time| sample_track(&view.takes[0].tracks[bone], &bones[bone], time).rotation;
    grid().map(|time| std::array::from_fn(|index| bone(index, time))).collect()
}

#[test]
fn degrees_that_are_typed_while_the_gizmo_is_dragged_turn_the_bone_in_the_whole_take() {
    let mut viewport = viewport(1, Id::EditWholeTake);
    let before = rotations(&viewport);
    viewport.command(Id::RotateNow);
    viewport.keys("y20");
    viewport.key(control::Key::Enter);
    assert_eq!(viewport.refused, [""; 0]);
    assert_eq!(viewport.steps(), ["Rotate"]);
    let after = rotations(&viewport);
    let turn = after[50][1] * before[50][1].conjugate();
    assert!((turn.to_axis_angle().1.to_degrees() - 20.0).abs() < 1e-3, "{turn}");
    for (before, after) in before.iter().zip(&after) {
        assert!((turn * before[1] - after[1]).length() < 2e-6);
        assert_eq!([before[0], before[2]], [after[0], after[2]], "the other bones stay");
    }
    viewport.command(Id::Undo);
    assert_eq!(rotations(&viewport), before);
}

#[test]
fn a_chain_moved_by_ik_keeps_its_motion_in_the_whole_take_and_each_bone_gets_one_offset() {
    let mut viewport = viewport(2, Id::EditWholeTake);
    viewport.command(Id::ToolMove);
    viewport.command(Id::ToggleIk);
    viewport.state.begin_frame(viewport.state.read().now);
    let before = rotations(&viewport);
    let from = viewport.handle(Handle::Center);
    viewport.press(from);
    viewport.to(from + Vec2::new(15.0, 20.0));
    viewport.to(from + Vec2::new(30.0, 40.0));
    viewport.release();
    assert_eq!(viewport.refused, [""; 0]);
    assert_eq!(viewport.steps().len(), 1, "{:?}", viewport.steps());
    let after = rotations(&viewport);
    for bone in 0..arm::BONES {
        let turn = after[50][bone] * before[50][bone].conjugate();
        assert!(turn.to_axis_angle().1 > 0.01, "bone {bone} turns");
        for (before, after) in before.iter().zip(&after) {
            assert!((turn * before[bone] - after[bone]).length() < 2e-6, "bone {bone}");
        }
    }
}

/// Clicks with the secondary button.
fn click(window: &mut Window, pos: egui::Pos2) {
    window.event(egui::Event::PointerMoved(pos));
    for pressed in [true, false] {
        let modifiers = Modifiers::NONE;
        window.event(egui::Event::PointerButton {
            pos,
            button: PointerButton::Secondary,
            pressed,
            modifiers,
        });
        window.run_steps(2);
    }
}
