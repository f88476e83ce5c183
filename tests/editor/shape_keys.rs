//! Shape keys (morph targets): their keys are selected, moved and deleted in their row of the timeline, and a panel has a slider for
//! each weight.

use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::shape_keys::ShapeGroup;
use dragonfly_anim::data::{
    Interpolation, Mesh, MeshInstance, ModelData, MorphTarget, MorphTrack, Primitive,
};
use dragonfly_document::images::ImageSurvey;
use dragonfly_document::{LoadedModel, View};
use dragonfly_kit::document::fixture;
use egui_kittest::kittest::Queryable;
use std::sync::Arc;

/// The shape keys of the face; the last one has no name.
pub(crate) const FACE: [&str; 4] = ["jawOpen", "eyeBlinkLeft", "eyeBlinkRight", ""];

/// Returns a model whose first take has 41 keys of shape keys as well: the weight of the first goes from 0 to 1.
fn with_shapes() -> View {
    with_names(&FACE)
}

/// Returns the same model with shape keys of other names.
pub(crate) fn with_names(names: &[&str]) -> View {
    with_interpolation(names, Interpolation::Linear)
}

/// Returns the same model with keys of this interpolation, whose tangents are 0.
pub(crate) fn with_interpolation(names: &[&str], interpolation: Interpolation) -> View {
    let (count, view) = (names.len(), fixture::full());
    let mut model = ModelData::clone(&view.loaded.model);
    let take = Arc::make_mut(&mut model.animation.takes[0]);
    let times: Arc<[f32]> = take.tracks[3].rotation.times.clone();
    let weight = |key: usize, shape: usize| match shape {
        0 => key as f32 / 40.0,
        1 => 0.25,
        _ => 0.0,
    };
    let key = |key: usize| -> Vec<f32> {
        let values: Vec<f32> = (0..count).map(|shape| weight(key, shape)).collect();
        match interpolation {
            Interpolation::CubicSpline => {
                [&vec![0.0; count], &values, &vec![0.0; count]].map(Vec::as_slice).concat()
            }
            _ => values,
        }
    };
    let weights = (0..times.len()).flat_map(key).collect();
    let targets = count as u32;
    take.morphs = vec![MorphTrack { instance: 0, targets, times, weights, interpolation }];
    let target = |name: &&str| MorphTarget { name: (*name).to_owned(), ..MorphTarget::default() };
    let primitive = Primitive { morph_targets: names.iter().map(target).collect(), ..Primitive::default() };
    let mut rest = vec![0.0; count];
    rest[count - 1] = 0.125;
    model.meshes =
        vec![Mesh { name: "Face".to_owned(), primitives: vec![primitive], morph_weights: rest.clone() }];
    model.instances = vec![MeshInstance {
        mesh: 0,
        node: None,
        skin: None,
        bone: None,
        to_bone: glam::Mat4::IDENTITY,
        morph_weights: rest,
    }];
    let LoadedModel { title, path, format, bounds, .. } = &*view.loaded;
    let loaded = LoadedModel {
        conversion: Default::default(),
        title: title.clone(),
        path: path.clone(),
        format: *format,
        model: Arc::new(model),
        bounds: *bounds,
        images: ImageSurvey::default(),
        warnings: Vec::new(),
        notes: Vec::new(),
    };
    View::opened(1, Arc::new(loaded))
}

/// Creates a window in which the row of shapes is the fourth: below all bones, one bone and its channel.
fn animator() -> Animator {
    let mut animator = Animator::new(with_shapes());
    animator.harness.state_mut().state.execute(Request::Select(Some(3)));
    animator.steps(2);
    animator
}

fn shape_keys(animator: &Animator) -> usize {
    animator.edited.adapter().slots()[0].result.morphs[0].times.len()
}

#[test]
fn a_box_over_the_row_of_shapes_selects_their_keys_and_delete_removes_them() {
    let mut animator = animator();
    let (from, to) = (animator.at(animator.key(3) - 0.04, 4), animator.at(animator.key(5) + 0.04, 3));
    animator.drag(from, to);
    animator.release(to);
    assert_eq!(animator.selected(), 3);
    animator.harness.key_press(egui::Key::Delete);
    animator.steps(3);
    assert_eq!((shape_keys(&animator), animator.times(3).len()), (38, 41));
    animator.request(Request::Command(Id::Undo));
    assert_eq!((shape_keys(&animator), animator.selected()), (41, 3));
}

#[test]
fn one_step_deletes_the_keys_of_shapes_and_of_bones_in_a_box() {
    let mut animator = animator();
    let (from, to) = (animator.at(animator.key(3) - 0.04, 4), animator.at(animator.key(5) + 0.04, 2));
    animator.drag(from, to);
    animator.release(to);
    assert_eq!(animator.selected(), 6);
    animator.request(Request::Command(Id::DeleteKeys));
    assert_eq!((shape_keys(&animator), animator.times(3).len()), (38, 38));
    assert_eq!(animator.edited.steps().1, 1);
}

#[test]
fn a_click_selects_a_key_of_shapes_and_a_drag_moves_or_copies_it() {
    let mut animator = animator();
    let at = animator.at(animator.key(8), 3);
    animator.click(at);
    assert_eq!(animator.selected(), 1);
    let to = animator.at(animator.key(12) + 0.03, 3);
    animator.drag(at, to);
    animator.release(to);
    let times = |animator: &Animator| animator.edited.adapter().slots()[0].result.morphs[0].times.to_vec();
    let before = animator.times(3);
    let moved = times(&animator);
    assert_eq!((moved.len(), animator.selected(), animator.edited.steps().1), (41, 1, 1));
    assert!((moved[12] - animator.key(12) - 0.03).abs() < 0.02, "{moved:?}");
    assert_eq!(animator.times(3).len(), 41, "the keys of bones stay");
    // The moved key stays selected, so that it can be dragged on.
    animator.hold(egui::Modifiers::ALT);
    let (from, to) = (animator.at(moved[12], 3), animator.at(moved[12] + 1.0, 3));
    animator.drag(from, to);
    animator.release(to);
    animator.hold(egui::Modifiers::NONE);
    assert_eq!((shape_keys(&animator), animator.edited.steps().1), (42, 2));
    animator.request(Request::Command(Id::Undo));
    animator.request(Request::Command(Id::Undo));
    assert_eq!(times(&animator), before);
    animator.click(animator.at(animator.key(20) + 0.04, 4));
    assert_eq!(animator.selected(), 0);
}

#[test]
fn the_last_key_of_shapes_is_not_deleted() {
    let mut animator = animator();
    let (from, to) = (animator.at(0.0, 4), animator.at(3.417, 3));
    animator.drag(from - egui::vec2(8.0, 0.0), to + egui::vec2(8.0, 0.0));
    animator.release(to + egui::vec2(8.0, 0.0));
    assert_eq!(animator.selected(), 41);
    animator.request(Request::Command(Id::DeleteKeys));
    assert_eq!(shape_keys(&animator), 41);
}

/// Creates a window with the panel of shape keys at 1 s, where no key is.
pub(crate) fn face() -> Animator {
    face_of(with_shapes())
}

/// Creates such a window with another face.
pub(crate) fn face_of(view: View) -> Animator {
    let mut animator = Animator::new(view);
    animator.harness.get_by_label("Shape keys").click();
    animator.steps(2);
    animator.request(Request::Seek(1.0));
    animator
}

/// Returns the weights of a key.
pub(crate) fn weights_at(animator: &Animator, time: f32) -> Option<[f32; 4]> {
    let track = &animator.edited.adapter().slots()[0].result.morphs[0];
    let key = track.times.iter().position(|key| (key - time).abs() < 1e-4)?;
    track.weights[4 * key..4 * key + 4].try_into().ok()
}

pub(crate) fn type_weight(animator: &mut Animator, name: &str, text: &str) {
    let field = animator.harness.get_by_label(name).rect().center();
    animator.click(field);
    animator.harness.event(egui::Event::Text(text.to_owned()));
    animator.steps(2);
    animator.harness.key_press(egui::Key::Enter);
    animator.steps(3);
}

#[test]
fn a_typed_weight_becomes_a_key_at_the_playhead_and_expressions_are_computed() {
    let mut animator = face();
    // At 1 s the first weight is 1 / 3.417.
    type_weight(&mut animator, "eyeBlinkRight", "1/2 + 0.25");
    let [jaw, left, right, last] = weights_at(&animator, 1.0).expect("a key");
    assert!((jaw - 1.0 / 3.417).abs() < 1e-4, "{jaw}");
    assert_eq!((left, right, last), (0.25, 0.75, 0.0));
    assert_eq!(shape_keys(&animator), 42);
    type_weight(&mut animator, "Shape 4", "-0.5");
    assert_eq!(
        weights_at(&animator, 1.0).map(|weights| weights[3]),
        Some(-0.5),
        "a shape key without a name"
    );
    assert_eq!((shape_keys(&animator), animator.edited.steps().1), (42, 2));
    animator.request(Request::Command(Id::Undo));
    animator.request(Request::Command(Id::Undo));
    assert_eq!((shape_keys(&animator), weights_at(&animator, 1.0)), (41, None));
}

#[test]
fn a_slider_is_dragged_as_one_step_and_escape_leaves_no_trace() {
    let mut animator = face();
    let slider = animator.harness.get_by_label("eyeBlinkLeft, slider").rect();
    let (from, to) = (slider.left_center() + egui::vec2(slider.width() * 0.25, 0.0), slider.right_center());
    animator.drag(from, to);
    assert!(weights_at(&animator, 1.0).is_some_and(|weights| weights[1] > 0.9));
    animator.harness.key_press(egui::Key::Escape);
    animator.steps(2);
    animator.release(to);
    assert_eq!((weights_at(&animator, 1.0), animator.edited.steps().1), (None, 0));
    animator.drag(from, to);
    animator.release(to);
    let weights = weights_at(&animator, 1.0).expect("a key");
    assert!(weights[1] > 0.95 && weights[2] == 0.0, "{weights:?}");
    assert_eq!(animator.edited.steps().1, 1);
}

#[test]
fn without_auto_key_the_weights_of_a_key_are_changed_in_the_key() {
    let mut animator = face();
    animator.request(Request::Command(Id::AutoKey));
    animator.harness.get_by_label("Add a key of the shape keys of Face").click();
    animator.steps(3);
    assert_eq!(weights_at(&animator, 1.0).map(|weights| weights[1]), Some(0.25), "as it was");
    type_weight(&mut animator, "eyeBlinkLeft", "0.5");
    assert_eq!(weights_at(&animator, 1.0).map(|weights| weights[1]), Some(0.5));
    animator.harness.get_by_label("Delete the key of the shape keys of Face").click();
    animator.steps(3);
    assert_eq!((weights_at(&animator, 1.0), shape_keys(&animator)), (None, 41));
}

#[test]
fn the_menu_of_a_mesh_mirrors_and_resets_its_weights() {
    let mut animator = face();
    let menu = |animator: &mut Animator, entry: &str| {
        animator.harness.get_by_label("More for the shape keys of Face").click();
        animator.steps(3);
        animator.harness.get_by_label(entry).click();
        animator.steps(3);
    };
    menu(&mut animator, "Mirror");
    assert_eq!(weights_at(&animator, 1.0).map(|weights| [weights[1], weights[2]]), Some([0.0, 0.25]));
    menu(&mut animator, "Reset all");
    assert_eq!(weights_at(&animator, 1.0), Some([0.0, 0.0, 0.0, 0.125]), "the weights of the mesh");
    assert_eq!(animator.edited.steps().1, 2);
}

#[test]
fn the_search_leaves_the_shape_keys_whose_names_contain_the_text() {
    let mut animator = face();
    let shown = |animator: &Animator| {
        FACE.map(|name| animator.harness.query_by_label(&format!("{name}, slider")).is_some())
    };
    assert_eq!(shown(&animator)[..3], [true; 3]);
    let field = animator.harness.get_by_label("Find a shape key").rect().center();
    animator.click(field);
    animator.harness.event(egui::Event::Text("BLINK".to_owned()));
    animator.steps(3);
    assert_eq!(shown(&animator)[..3], [false, true, true]);
}

#[test]
fn shape_keys_are_grouped_by_the_names_of_arkit_and_vrm() {
    for (name, group) in [
        ("jawOpen", ShapeGroup::Jaw),
        ("browInnerUp", ShapeGroup::Brows),
        ("eyeBlinkLeft", ShapeGroup::Eyes),
        ("blink_L", ShapeGroup::Eyes),
        ("lookUp", ShapeGroup::Eyes),
        ("mouthSmile_R", ShapeGroup::Mouth),
        ("cheekPuff", ShapeGroup::Cheeks),
        ("noseSneerLeft", ShapeGroup::Nose),
        ("tongueOut", ShapeGroup::Tongue),
        ("aa", ShapeGroup::Vowels),
        ("Happy", ShapeGroup::Expressions),
        ("happiness of the wings", ShapeGroup::Other),
        ("Key 1", ShapeGroup::Other),
        ("", ShapeGroup::Other),
    ] {
        assert_eq!(ShapeGroup::of(name), group, "{name}");
    }
}
