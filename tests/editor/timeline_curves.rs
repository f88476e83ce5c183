//! Mouse input on the curves: vertical drags change values, horizontal drags times, handle drags tangents.

use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::keys::KeysRequest;
use dragonfly_anim::data::Interpolation;
use dragonfly_document::Change;
use dragonfly_document::edit::{
    BonePose, BoneRef, Edit, KeyInterpolation, MoveKeys, Property, SetInterpolation, SetPose, SetPoses,
    SetTangents, TakeRef,
};
use egui::{Key, Modifiers, Pos2, pos2, vec2};
use egui_kittest::kittest::Queryable;
use glam::EulerRot;

/// Returns the rotation about z of a key of bone 3, degrees.
fn angle(animator: &Animator, key: usize) -> f32 {
    let rotation = animator.edited.adapter().slots()[0].result.tracks[3].rotation.value(key).unwrap();
    rotation.to_euler(EulerRot::XYZ).2.to_degrees()
}

/// Returns the position of the key of the z curve: all values of the bone fit the height of the panel.
pub(crate) fn place_of_z_key(animator: &Animator, key: usize) -> Pos2 {
    let curves = animator.curves();
    let all: Vec<f32> = (0..41).map(|key| angle(animator, key)).collect();
    let low = all.iter().copied().fold(0.0, f32::min);
    let high = all.iter().copied().fold(0.0, f32::max);
    let (middle, span) = ((low + high) / 2.0, (high - low) * 1.16);
    let part = (all[key] - (middle - span / 2.0)) / span;
    pos2(animator.x_in(curves, animator.key(key)), curves.bottom() - part * curves.height())
}

#[test]
fn a_key_dragged_up_changes_one_angle_as_one_step() {
    let mut animator = Animator::with_bone(3);
    animator.steps(2);
    let (before, at) = (angle(&animator, 8), place_of_z_key(&animator, 8));
    animator.drag(at, at - vec2(0.0, 40.0));
    animator.release(at - vec2(0.0, 40.0));
    let after = angle(&animator, 8);
    assert!(after > before + 3.0, "{before} → {after}");
    assert!((angle(&animator, 7) - animator_angle(7)).abs() < 0.01, "the neighboring key stays");
    assert!(
        matches!(animator.edits().last(), Some(Edit::SetPose(SetPose { poses, .. })) if poses[0].rotation.is_some())
    );
    assert_eq!(animator.edited.steps().0.len(), 1);
    assert_eq!(animator.selected(), 1);
}

fn animator_angle(key: usize) -> f32 {
    let animator = Animator::with_bone(3);
    angle(&animator, key)
}

#[test]
fn several_keys_are_dragged_up_together_and_escape_cancels() {
    let mut animator = Animator::with_bone(3);
    animator.request(Request::Command(Id::SelectAllKeys));
    let before: Vec<f32> = (0..41).map(|key| angle(&animator, key)).collect();
    let at = place_of_z_key(&animator, 8);
    animator.drag(at, at - vec2(0.0, 30.0));
    let by = angle(&animator, 8) - before[8];
    assert!(by > 2.0);
    for (key, before) in before.iter().enumerate() {
        assert!((angle(&animator, key) - before - by).abs() < 0.02, "key {key}");
    }
    assert!(matches!(animator.edits().last(), Some(Edit::SetPoses(SetPoses { at, .. })) if at.len() == 41));
    animator.harness.key_down(Key::Escape);
    animator.steps(3);
    animator.release(at);
    for (key, before) in before.iter().enumerate() {
        assert!((angle(&animator, key) - before).abs() < 1e-4, "key {key}");
    }
}

#[test]
fn a_key_dragged_horizontally_changes_its_time() {
    let mut animator = Animator::with_bone(3);
    animator.steps(2);
    let at = place_of_z_key(&animator, 8);
    let by = animator.x_in(animator.curves(), 0.045) - animator.x_in(animator.curves(), 0.0);
    animator.drag(at, at + vec2(by, 0.0));
    animator.release(at + vec2(by, 0.0));
    assert!(
        matches!(animator.edits().last(), Some(Edit::MoveKeys(MoveKeys { .. }))),
        "{:?}",
        animator.edits()
    );
    assert!((animator.times(3)[8] - animator.key(8)).abs() > 0.01);
}

#[test]
fn a_tangent_is_dragged_by_its_end_and_alt_breaks_it() {
    for broken in [false, true] {
        let mut animator = Animator::with_bone(3);
        let edit = Edit::SetInterpolation(SetInterpolation {
            take: dragonfly_document::edit::TakeRef::Index(0),
            bones: Vec::new(),
            properties: vec![Property::Rotation],
            interpolation: KeyInterpolation::CubicSpline,
        });
        animator.request(Request::Change(dragonfly_document::Change::Edit(edit, None)));
        animator.steps(4);
        let rotation = || animator.edited.adapter().slots()[0].result.tracks[3].rotation.clone();
        assert_eq!(rotation().interpolation, Interpolation::CubicSpline);
        // A key at a maximum: its tangent is horizontal, so its handle is 44 points to the right.
        let crest = (9..30).max_by(|&a, &b| angle(&animator, a).total_cmp(&angle(&animator, b))).unwrap();
        let at = place_of_z_key(&animator, crest);
        let before = rotation();
        animator.click(at);
        assert_eq!(animator.selected(), 1);
        let end = at + vec2(44.0, 0.0);
        if broken {
            animator.hold(Modifiers::ALT);
        }
        animator.drag(end, end - vec2(0.0, 25.0));
        animator.release(end - vec2(0.0, 25.0));
        let Some(Edit::SetTangents(SetTangents { arrive, leave, .. })) = animator.edits().last() else {
            panic!("{:?}", animator.edits().last())
        };
        assert!(leave.is_some());
        assert_eq!(arrive.is_none(), broken, "both sides, unless Alt breaks them");
        let after = animator.edited.adapter().slots()[0].result.tracks[3].rotation.clone();
        assert_ne!(after.values[crest * 3 + 2], before.values[crest * 3 + 2]);
        assert_eq!(after.values[crest * 3] == before.values[crest * 3], broken);
        assert_eq!(after.value(crest), before.value(crest), "the key itself stays");
    }
}

#[test]
fn the_fields_of_a_key_accept_formulas_and_refuse_other_text() {
    let mut animator = Animator::with_bone(3);
    animator.click(animator.at(animator.key(8), 2));
    animator.harness.get_by_label("Component X").click();
    animator.steps(2);
    animator.harness.get_by_label("Component Y").click();
    animator.steps(2);
    for (text, wanted) in [("45/2", Some(22.5)), ("nonsense", None)] {
        let before = angle(&animator, 8);
        animator.harness.get_by_label("Value Z").click();
        animator.steps(2);
        animator.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        animator.steps(1);
        animator.harness.event(egui::Event::Text(text.to_owned()));
        animator.steps(1);
        animator.harness.key_press(Key::Enter);
        animator.steps(3);
        let now = angle(&animator, 8);
        assert!((now - wanted.unwrap_or(before)).abs() < 0.01, "{text}: {now}");
    }
}

#[test]
fn a_selected_key_shows_its_value_where_several_components_are_drawn() {
    let mut animator = Animator::with_bone(3);
    let names = ["Value X", "Value Y", "Value Z", "Time of the key"];
    let there = |animator: &Animator| names.map(|name| animator.harness.query_by_label(name).is_some());
    assert_eq!(there(&animator), [false; 4], "without a key there is no number");
    let at = place_of_z_key(&animator, 8);
    animator.click(at);
    // At this width only one field fits: that of the clicked curve.
    assert_eq!(there(&animator), [false, false, true, true]);
    animator.harness.get_by_label("Component Z").click();
    animator.steps(2);
    assert_eq!(there(&animator), [true, false, false, true], "what is not drawn is not shown");
    animator.harness.set_size(vec2(1920.0, 1080.0));
    animator.steps(2);
    animator.harness.get_by_label("Component Z").click();
    animator.steps(4);
    assert_eq!(there(&animator), [true; 4], "all of them where there is room");
}

#[test]
fn dragging_a_number_of_a_key_is_one_step_and_escape_cancels_it() {
    use egui_kittest::kittest::NodeT;
    let mut animator = Animator::with_bone(3);
    let at = place_of_z_key(&animator, 8);
    animator.click(at);
    let (value, time) = (angle(&animator, 8), animator.key(8));
    let shown = |animator: &Animator, name: &str| {
        animator.harness.get_by_label(name).accesskit_node().numeric_value().unwrap() as f32
    };
    assert!((shown(&animator, "Value Z") - value).abs() < 0.01);
    let field = animator.harness.get_by_label("Value Z").rect().center();
    animator.drag(field, field + vec2(30.0, 0.0));
    animator.steps(2);
    let held = angle(&animator, 8);
    assert!(held > value + 1.0, "{value} → {held}");
    assert!((shown(&animator, "Value Z") - held).abs() < 0.01, "the number goes along");
    animator.release(field + vec2(30.0, 0.0));
    assert_eq!((angle(&animator, 8), animator.edited.steps().1), (held, 1));
    let field = animator.harness.get_by_label("Time of the key").rect().center();
    animator.drag(field, field + vec2(20.0, 0.0));
    assert!(shown(&animator, "Time of the key") > time + 0.05);
    animator.harness.key_press(Key::Escape);
    animator.steps(3);
    animator.release(field + vec2(20.0, 0.0));
    assert_eq!(animator.edited.steps().1, 1, "Escape cancels it");
    assert!((shown(&animator, "Time of the key") - time).abs() < 1e-3);
    animator.drag(field, field + vec2(20.0, 0.0));
    animator.release(field + vec2(20.0, 0.0));
    assert_eq!((animator.edited.steps().1, animator.selected()), (2, 1));
    let moved = shown(&animator, "Time of the key");
    let frames = moved * animator.harness.state().state.read().frame_rate as f32;
    assert!(moved > time + 0.05 && (frames - frames.round()).abs() < 1e-3, "to a frame: {moved} s");
}

/// Rotates a key of bone 3 about z, as a gizmo would.
fn turn(animator: &mut Animator, key: usize, degrees: f32) {
    let edit = Edit::SetPose(SetPose {
        take: TakeRef::Index(0),
        time: animator.key(key),
        poses: vec![BonePose {
            bone: BoneRef::Index(3),
            translation: None,
            rotation: Some(glam::Quat::from_rotation_z(degrees.to_radians()).to_array()),
            scale: None,
        }],
        unstep: false,
    });
    animator.request(Request::Change(Change::Edit(edit, None)));
    animator.steps(2);
}

#[test]
fn the_view_grows_to_edited_values_unless_it_was_zoomed() {
    let mut animator = Animator::with_bone(3);
    animator.steps(2);
    turn(&mut animator, 8, 150.0);
    let at = place_of_z_key(&animator, 8);
    animator.click(at);
    assert_eq!(animator.selected(), 1, "the key is where all values fit");
    animator.request(Request::Timeline(KeysRequest::Deselect));
    // A view that was zoomed to a part of the curve stays as it is.
    let values = animator.harness.get_by_label("Values").rect().center();
    animator.drag(values, values + vec2(0.0, 90.0));
    animator.release(values + vec2(0.0, 90.0));
    turn(&mut animator, 8, -170.0);
    let at = place_of_z_key(&animator, 8);
    animator.click(at);
    assert_eq!(animator.selected(), 0, "it is out of sight");
}
