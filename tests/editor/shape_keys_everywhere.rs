//! Shape keys like other keys: selected with all keys, through the clipboard, as curves, over a scope, pending.

use crate::shape_keys::{FACE, face, face_of, type_weight, weights_at, with_interpolation};
use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::keys::clipboard::from_text;
use dragonfly_anim::data::Interpolation;
use dragonfly_document::edit::Edit;
use egui::{Pos2, pos2, vec2};
use egui_kittest::kittest::Queryable;

fn shape_times(animator: &Animator, take: usize) -> Vec<f32> {
    let morphs = &animator.edited.adapter().slots()[take].result.morphs;
    morphs.first().map(|track| track.times.to_vec()).unwrap_or_default()
}

#[test]
fn select_all_and_invert_include_the_keys_of_shape_keys() {
    let mut animator = face();
    let all = animator.edited.adapter().slots()[0].result.keys();
    let bones: usize = {
        let take = &animator.edited.adapter().slots()[0].result;
        take.tracks
            .iter()
            .map(|track| track.translation.len() + track.rotation.len() + track.scale.len())
            .sum()
    };
    animator.request(Request::Command(Id::SelectAllKeys));
    assert_eq!(animator.selected(), bones + 41, "of {all}");
    animator.request(Request::Command(Id::InvertKeys));
    assert_eq!(animator.selected(), 0);
}

#[test]
fn keys_of_shape_keys_are_copied_by_name_and_pasted_into_another_take() {
    let mut animator = face();
    animator.request(Request::Command(Id::SelectAllKeys));
    animator.request(Request::Select(None));
    let text = {
        let effect = animator.harness.state_mut().state.execute(Request::Command(Id::CopyKeys));
        match effect {
            Some(dragonfly::panels::Effect::Copy(text)) => text,
            other => panic!("{other:?}"),
        }
    };
    let keys = from_text(&text).expect("keys");
    let [mesh] = &keys.shapes[..] else { panic!("{:?}", keys.shapes) };
    assert_eq!((mesh.shapes.len(), mesh.keys.len()), (4, 41));
    assert!(
        text.contains(r#""mesh":"Face""#) && text.contains(r#""jawOpen""#),
        "{}",
        &text[text.len() - 400..]
    );
    animator.request(Request::ShowTake(Some(1)));
    animator.request(Request::Seek(0.5));
    assert_eq!(shape_times(&animator, 1), [] as [f32; 0]);
    let before = shape_times(&animator, 0);
    animator.request(Request::PastePose { text, mirrored: false });
    let after = shape_times(&animator, 1);
    assert_eq!(after.len(), 41);
    for (before, after) in before.iter().zip(&after) {
        assert!((before + 0.5 - after).abs() < 1e-5, "{before} {after}");
    }
    let track = &animator.edited.adapter().slots()[1].result.morphs[0];
    assert_eq!(track.weights[4 * 40..], [1.0, 0.25, 0.0, 0.0], "of the last key");
    animator.request(Request::Command(Id::Undo));
    assert_eq!(shape_times(&animator, 1), [] as [f32; 0]);
}

/// Creates a window with the curves of the shape keys, of which only that of the jaw moves.
fn curves() -> Animator {
    curves_of(face())
}

fn curves_of(mut animator: Animator) -> Animator {
    animator.harness.get_by_label("Curves").click();
    animator.steps(4);
    animator.harness.get_by_label("Weights of shape keys").click();
    animator.steps(4);
    animator
}

/// Returns the place of a weight of the jaw, whose curve goes from 0 at the start to 1 at the end, in the fitted view.
fn on_curve(animator: &Animator, key: usize) -> Pos2 {
    let x = animator.x_in(animator.curves(), animator.key(key));
    let shapes = &animator.harness.output().shapes;
    let near = shapes.iter().filter_map(|shape| match &shape.shape {
        egui::Shape::Mesh(mesh) if shape.clip_rect.center().distance(animator.curves().center()) < 2.0 => {
            Some(mesh)
        }
        _ => None,
    });
    let points = near.flat_map(|mesh| mesh.vertices.iter().map(|vertex| vertex.pos));
    let there: Vec<f32> = points.filter(|at| (at.x - x).abs() < 0.8).map(|at| at.y).collect();
    let (low, high) = there.iter().fold((f32::MAX, f32::MIN), |(low, high), y| (low.min(*y), high.max(*y)));
    assert!(low <= high, "no curve at {x}");
    pos2(x, (low + high) / 2.0)
}

#[test]
fn the_curve_of_a_shape_key_is_dragged_in_value_and_in_time() {
    let mut animator = curves();
    let before = weights_at(&animator, animator.key(20)).expect("a key");
    let at = on_curve(&animator, 20);
    animator.click(at);
    assert_eq!(animator.selected(), 1, "{}", animator.said());
    animator.drag(at, at - vec2(0.0, 30.0));
    animator.release(at - vec2(0.0, 30.0));
    let after = weights_at(&animator, animator.key(20)).expect("a key");
    assert!(after[0] > before[0] + 0.05, "{before:?} {after:?}");
    assert_eq!(after[1..], before[1..], "the other shape keys stay");
    assert!(matches!(animator.edits().last(), Some(Edit::SetShapeKeys(_))), "{:?}", animator.edits().last());
    assert_eq!((shape_times(&animator, 0).len(), animator.edited.steps().1), (41, 1));
    let at = on_curve(&animator, 20);
    let to = pos2(animator.x_in(animator.curves(), animator.key(20) + 0.04), at.y);
    animator.drag(at, to);
    animator.release(to);
    assert!(weights_at(&animator, animator.key(20)).is_none(), "{:?}", shape_times(&animator, 0));
    animator.request(Request::Command(Id::Undo));
    animator.request(Request::Command(Id::Undo));
    assert_eq!(weights_at(&animator, animator.key(20)), Some(before));
}

#[test]
fn the_tangent_of_a_key_of_a_spline_is_dragged_for_one_shape_key() {
    let view = with_interpolation(&FACE, Interpolation::CubicSpline);
    let mut animator = curves_of(face_of(view));
    let at = on_curve(&animator, 20);
    animator.click(at);
    assert_eq!(animator.selected(), 1);
    animator.steps(2);
    // The handle is 44 points after the key, in the direction of its tangent, which is flat.
    let handle = at + vec2(44.0, 0.0);
    animator.drag(handle, handle - vec2(0.0, 25.0));
    animator.release(handle - vec2(0.0, 25.0));
    let track = &animator.edited.adapter().slots()[0].result.morphs[0];
    // Tangents in, values, tangents out of four shape keys.
    let key = &track.weights[20 * 12..21 * 12];
    assert!(key[0] > 0.1 && key[0] == key[8], "{key:?}");
    assert_eq!((&key[1..4], key[4], &key[9..12]), (&[0.0; 3][..], 0.5, &[0.0; 3][..]));
    assert!(matches!(animator.edits().last(), Some(Edit::SetShapeKeys(_))), "{:?}", animator.edits().last());
    animator.request(Request::Command(Id::Undo));
    let track = &animator.edited.adapter().slots()[0].result.morphs[0];
    assert_eq!(track.weights[20 * 12], 0.0);
}

#[test]
fn a_slider_in_the_scope_of_the_whole_take_offsets_every_key() {
    let mut animator = face();
    animator.request(Request::Command(Id::EditWholeTake));
    type_weight(&mut animator, "eyeBlinkLeft", "0.75");
    for key in [0, 17, 40] {
        let weights = weights_at(&animator, animator.key(key)).expect("a key");
        assert_eq!((weights[0], weights[1], weights[2]), (key as f32 / 40.0, 0.75, 0.0));
    }
    assert_eq!((shape_times(&animator, 0).len(), animator.edited.steps().1), (41, 1));
    animator.request(Request::Command(Id::Undo));
    assert_eq!(weights_at(&animator, animator.key(17)).map(|weights| weights[1]), Some(0.25));
    // Without selected keys of shape keys, their scope changes nothing.
    animator.request(Request::Command(Id::EditSelectedKeys));
    type_weight(&mut animator, "eyeBlinkLeft", "0.5");
    assert_eq!(animator.edited.steps().1, 0);
}

#[test]
fn without_auto_key_a_slider_makes_a_pending_weight_that_the_key_button_writes() {
    let mut animator = face();
    animator.request(Request::Command(Id::AutoKey));
    type_weight(&mut animator, "eyeBlinkRight", "0.75");
    assert_eq!((weights_at(&animator, 1.0), animator.edited.adapter().pending_poses()), (None, 1));
    assert!(animator.harness.query_by_label("1 pose pending").is_some());
    animator.harness.get_by_label("Key the pending weights of Face").click();
    animator.steps(3);
    let weights = weights_at(&animator, 1.0).expect("a key");
    assert_eq!((weights[1], weights[2]), (0.25, 0.75));
    assert_eq!(animator.edited.adapter().pending_poses(), 0);
    // Pending weights are discarded and keyed with the pending poses.
    animator.request(Request::Seek(1.05));
    type_weight(&mut animator, "eyeBlinkRight", "0.5");
    animator.request(Request::Command(Id::DropPending));
    assert_eq!((weights_at(&animator, 1.05), animator.edited.adapter().pending_poses()), (None, 0));
    type_weight(&mut animator, "eyeBlinkRight", "0.5");
    animator.request(Request::Command(Id::Key));
    assert_eq!(weights_at(&animator, 1.05).map(|weights| weights[2]), Some(0.5));
}

#[test]
fn in_a_layer_the_panel_says_that_shape_keys_have_their_keys_in_the_take() {
    let mut animator = face();
    let text = "Keys of shape keys are in the take, not in layers";
    assert!(animator.harness.query_by_label(text).is_none());
    animator.request(Request::Command(Id::AddLayer));
    animator.steps(3);
    assert!(animator.harness.state().state.read().layer().is_some(), "the new layer is active");
    assert!(animator.harness.query_by_label(text).is_some());
    type_weight(&mut animator, "eyeBlinkRight", "0.75");
    assert_eq!(weights_at(&animator, 1.0).map(|weights| weights[2]), Some(0.75), "in the take");
}
