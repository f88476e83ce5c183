//! Edits of the fox, given as JSON.

use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::Edit;

/// Returns the takes of the fox: Survey, Walk and Run.
pub(crate) fn fox_takes() -> ModelAdapter {
    let bytes = include_bytes!("../data/gltf/Fox.glb");
    let model = read("Fox.glb", bytes, &NoFiles, &ReadOptions::default()).expect("the fox").model;
    ModelAdapter::new(&model.animation)
}

/// Returns the edit in a text.
pub(crate) fn edit(json: &str) -> Edit {
    serde_json::from_str(json).expect(json)
}

/// Applies an edit, and checks the invariants.
#[track_caller]
pub(crate) fn apply(model: &mut ModelAdapter, json: &str) {
    model.apply(&edit(json)).unwrap_or_else(|error| panic!("{json}: {error}"));
    model.check().expect("an invariant");
}
