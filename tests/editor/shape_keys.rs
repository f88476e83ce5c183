//! Keys of morph targets are selected and deleted in their row of the timeline.

use crate::timeline_rig::Animator;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly_anim::data::{Interpolation, ModelData, MorphTrack};
use dragonfly_document::images::ImageSurvey;
use dragonfly_document::{LoadedModel, View};
use dragonfly_kit::document::fixture;
use std::sync::Arc;

/// Returns a model whose first take has 41 keys of a morph target as well.
fn with_shapes() -> View {
    let view = fixture::full();
    let mut model = ModelData::clone(&view.loaded.model);
    let take = Arc::make_mut(&mut model.animation.takes[0]);
    let times: Arc<[f32]> = take.tracks[3].rotation.times.clone();
    let weights = (0..times.len()).map(|key| key as f32 / 40.0).collect();
    take.morphs =
        vec![MorphTrack { instance: 0, targets: 1, times, weights, interpolation: Interpolation::Linear }];
    let LoadedModel { title, path, format, bounds, .. } = &*view.loaded;
    let loaded = LoadedModel {
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
fn a_click_selects_a_key_of_shapes_and_a_drag_does_not_move_it() {
    let mut animator = animator();
    let at = animator.at(animator.key(8), 3);
    animator.click(at);
    assert_eq!(animator.selected(), 1);
    let to = animator.at(animator.key(12), 3);
    animator.drag(at, to);
    animator.release(to);
    assert!(animator.edits().is_empty(), "{:?}", animator.edits());
    assert!(animator.said().contains("not moved"), "{}", animator.said());
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
