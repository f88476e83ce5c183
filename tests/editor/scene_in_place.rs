//! A model that is edited in its scene: the unsaved work of the model and that of the scene are shown apart from each other.

use crate::scene_bench::{FOXES, scene};
use dragonfly::panels::dialogs::UnsavedQuestion;
use dragonfly_document::{HistoryView, Then, View, WaitingSceneView};
use dragonfly_kit::document::fixture;
use egui::Shape;
use egui_kittest::kittest::Queryable;
use std::sync::Arc;

/// Returns the view of a model in place of a scene.
fn in_place(model_saved: bool, scene_saved: bool) -> View {
    let view = fixture::full();
    let history = HistoryView { saved: model_saved, ..(*view.history).clone() };
    let waiting = WaitingSceneView { title: "scene.xml".into(), saved: scene_saved };
    View { waiting_scene: Some(waiting), history: Arc::new(history), ..view }
}

#[test]
fn the_title_the_viewport_and_the_way_back_have_a_dot_at_the_one_that_is_unsaved() {
    for (model_saved, scene_saved, name, scene_name) in [
        (true, true, "Fox.glb in scene.xml", "Back to scene.xml"),
        (false, true, "• Fox.glb in scene.xml", "Back to scene.xml"),
        (true, false, "Fox.glb in • scene.xml", "Back to • scene.xml"),
        (false, false, "• Fox.glb in • scene.xml", "Back to • scene.xml"),
    ] {
        let mut bench = scene(FOXES);
        bench.state.show(in_place(model_saved, scene_saved));
        assert_eq!(bench.state.read().window_title(), format!("{name} – Dragonfly"));
        let window = bench.window();
        let caption = format!("Shown model: {name}");
        assert!(window.query_by_label(&caption).is_some(), "{caption}");
        let mut shapes = window.output().shapes.iter().map(|clipped| &clipped.shape);
        let is_drawn =
            |shape: &Shape| matches!(shape, Shape::Text(text) if text.galley.text().ends_with(scene_name));
        assert!(shapes.any(is_drawn), "{scene_name}");
    }
}

#[test]
fn a_model_that_was_opened_itself_has_no_scene_in_its_title() {
    let mut bench = scene(FOXES);
    bench.state.show(fixture::full());
    assert_eq!(bench.state.read().window_title(), "Fox.glb – Dragonfly");
}

#[test]
fn the_question_about_unsaved_work_names_the_model_and_what_is_unsaved_of_its_scene() {
    for (scene_saved, sentence) in [
        (true, "It is edited in scene.xml, which is saved."),
        (false, "It is edited in scene.xml, which has unsaved changes, too."),
    ] {
        let mut bench = scene(FOXES);
        bench.state.show(in_place(false, scene_saved));
        bench.state.ask(UnsavedQuestion { then: Then::Quit }.into());
        let window = bench.window();
        assert!(window.query_by_label("Save Fox.glb?").is_some());
        assert!(window.query_by_label_contains(sentence).is_some(), "{sentence}");
    }
    // Shown again, the scene has the edits of its models.
    for (label, is_named) in [("Edit model", true), ("Move thing", false)] {
        let mut bench = scene(FOXES);
        let view = bench.state.read().view.expect("a scene").clone();
        let steps = vec!["Add role", label, "Move clip"];
        let history = HistoryView {
            steps,
            numbers: vec![1, 2, 3],
            about: vec!["".into(); 3],
            amounts: vec![None; 3],
            done: 3,
            saved_at: Some(1),
            ..HistoryView::default()
        };
        bench.state.show(View { history: Arc::new(history), generation: view.generation + 1, ..view });
        bench.state.ask(UnsavedQuestion { then: Then::Quit }.into());
        let window = bench.window();
        let sentence = "Edits of models are among them";
        assert_eq!(window.query_by_label_contains(sentence).is_some(), is_named, "{label}");
    }
}
