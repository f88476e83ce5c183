//! Numbers typed for many keys at once: values, times and slopes, absolute and relative.

use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly_anim::data::Interpolation;
use dragonfly_document::Change;
use dragonfly_document::edit::{Edit, KeyInterpolation, Property, SetInterpolation, TakeRef};
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT, Queryable};
use glam::EulerRot;

/// Returns the rotation about z of the keys of bone 3, degrees.
fn angles(animator: &Animator) -> Vec<f32> {
    let rotation = &animator.edited.adapter().slots()[0].result.tracks[3].rotation;
    let angle = |key| rotation.value(key).unwrap().to_euler(EulerRot::XYZ).2.to_degrees();
    (0..rotation.times.len()).map(angle).collect()
}

/// Returns the panels with all keys of bone 3 selected, of which the curves show only z.
fn animator() -> Animator {
    let mut animator = Animator::with_bone(3);
    animator.request(Request::Command(Id::SelectAllKeys));
    for component in ["Component X", "Component Y"] {
        animator.harness.get_by_label(component).click();
        animator.steps(2);
    }
    animator
}

/// Types a text into a field and presses Enter.
fn enter(animator: &mut Animator, field: &str, text: &str) {
    animator.harness.get_by_label(field).click();
    animator.steps(2);
    animator.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    animator.steps(1);
    animator.harness.event(egui::Event::Text(text.to_owned()));
    animator.steps(1);
    animator.harness.key_press(Key::Enter);
    animator.steps(3);
}

/// Returns the value of a field for screen readers.
fn spoken(animator: &Animator, field: &str) -> String {
    animator.harness.get_by_label(field).accesskit_node().value().unwrap_or_default()
}

#[track_caller]
fn assert_near(now: &[f32], wanted: impl Iterator<Item = f32>, tolerance: f32) {
    for (key, (now, wanted)) in now.iter().zip(wanted).enumerate() {
        assert!((now - wanted).abs() < tolerance, "key {key}: {now} instead of {wanted}");
    }
}

#[test]
fn a_typed_value_is_added_to_multiplied_with_or_given_to_all_selected_keys_in_one_step() {
    for (text, change) in [
        ("+5", (|angle| angle + 5.0) as fn(f32) -> f32),
        ("-=2*2", |angle| angle - 4.0),
        ("*2", |angle| angle * 2.0),
        ("/=4", |angle| angle / 4.0),
        ("-12", |_| -12.0),
    ] {
        let mut animator = animator();
        let before = angles(&animator);
        assert_eq!(spoken(&animator, "Value Z"), "different values");
        enter(&mut animator, "Value Z", text);
        assert_near(&angles(&animator), before.iter().map(|&angle| change(angle)), 0.02);
        assert_eq!(animator.edited.steps().0.len(), 1, "{text}");
        animator.request(Request::Command(Id::Undo));
        assert_near(&angles(&animator), before.iter().copied(), 1e-6);
    }
}

#[test]
fn keys_that_were_given_the_same_value_show_it() {
    let mut animator = animator();
    enter(&mut animator, "Value Z", "45/2");
    assert_eq!(spoken(&animator, "Value Z"), "22.5°");
    enter(&mut animator, "Value Z", "+2.5");
    assert_eq!(spoken(&animator, "Value Z"), "25°");
    assert_near(&angles(&animator), std::iter::repeat(25.0), 0.01);
}

#[test]
fn a_change_that_is_no_number_is_refused_and_changes_nothing() {
    for text in ["*", "/0", "+nonsense"] {
        let mut animator = animator();
        let before = angles(&animator);
        enter(&mut animator, "Value Z", text);
        assert_near(&angles(&animator), before.into_iter(), 1e-6);
        assert_eq!(animator.edited.steps().0.len(), 0, "{text}");
    }
}

#[test]
fn a_typed_time_moves_all_selected_keys_so_that_the_first_is_there() {
    let mut animator = animator();
    let before = animator.times(3);
    assert_eq!(spoken(&animator, "Time of the keys"), "different values");
    enter(&mut animator, "Time of the keys", "+0.5");
    assert_near(&animator.times(3), before.iter().map(|time| time + 0.5), 1e-4);
    enter(&mut animator, "Time of the keys", "2");
    assert_near(&animator.times(3), before.iter().map(|time| time + 2.0), 1e-4);
    enter(&mut animator, "Time of the keys", "*0.5");
    assert_near(&animator.times(3), before.iter().map(|time| (time + 2.0) / 2.0), 1e-4);
    assert_eq!(animator.edited.steps().0.len(), 3);
}

/// Returns the panels of [`animator`] with splines.
fn splines() -> Animator {
    let mut animator = animator();
    let edit = Edit::SetInterpolation(SetInterpolation {
        take: TakeRef::Index(0),
        bones: Vec::new(),
        properties: vec![Property::Rotation],
        interpolation: KeyInterpolation::CubicSpline,
    });
    animator.request(Request::Change(Change::Edit(edit, None)));
    animator.steps(4);
    animator
}

/// Returns the slopes of the z angle of a key, before and after it, degrees per second.
fn slopes(animator: &Animator, key: usize) -> [f32; 2] {
    let rotation = &animator.edited.adapter().slots()[0].result.tracks[3].rotation;
    let value = rotation.values[key * 3 + 1];
    [0, 2].map(|side| {
        let rate = rotation.values[key * 3 + side];
        let step = 1e-3;
        let angle = |by: f32| (value + rate * by).normalize().to_euler(EulerRot::XYZ).2.to_degrees();
        (angle(step) - angle(-step)) / (2.0 * step)
    })
}

#[test]
fn typed_slopes_are_given_to_all_selected_keys_before_after_or_on_both_sides() {
    let mut animator = splines();
    let steps = animator.edited.steps().0.len();
    animator.harness.get_by_label("Slopes").click();
    animator.steps(2);
    assert_eq!(spoken(&animator, "Slope both Z"), "different values");
    enter(&mut animator, "Slope both Z", "30");
    for key in 0..41 {
        assert_near(&slopes(&animator, key), [30.0, 30.0].into_iter(), 0.5);
    }
    assert!(spoken(&animator, "Slope both Z").starts_with("30"), "{}", spoken(&animator, "Slope both Z"));
    enter(&mut animator, "Slope after Z", "*-2");
    for key in 0..41 {
        assert_near(&slopes(&animator, key), [30.0, -60.0].into_iter(), 0.5);
    }
    assert_eq!(spoken(&animator, "Slope both Z"), "different values", "the tangents are broken");
    animator.harness.get_by_label("Unify tangents").click();
    animator.steps(3);
    for key in 0..41 {
        assert_near(&slopes(&animator, key), [-15.0, -15.0].into_iter(), 0.5);
    }
    assert_eq!(animator.edited.steps().0.len(), steps + 3);
}

#[test]
fn keys_without_tangents_offer_no_slopes() {
    let animator = animator();
    let rotation = &animator.edited.adapter().slots()[0].result.tracks[3].rotation;
    assert_ne!(rotation.interpolation, Interpolation::CubicSpline);
    assert!(animator.harness.query_by_label("Slopes").is_none());
}
