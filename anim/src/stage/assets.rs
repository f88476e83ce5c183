//! Models, drawn lines and sounds that scripts refer to.

use super::model::StageModel;
use super::time::StageTime;
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Length in seconds of a take whose model is missing.
pub(in crate::stage) const UNKNOWN_TAKE: f64 = 1.0;

/// Speed in meters per second of a walk at the stride of a take whose model is missing: a calm walk.
pub(in crate::stage) const UNKNOWN_SPEED: f64 = 1.4;

/// The models, lines and sounds that scripts may name, by the text with which scripts name them.
#[derive(Clone, Debug, Default)]
pub struct StageAssets {
    models: BTreeMap<String, Arc<StageModel>>,
    lines: BTreeMap<String, Arc<[DVec3]>>,
    sounds: BTreeMap<String, StageTime>,
    allows_missing: bool,
}

impl StageAssets {
    /// Adds a model under the name that the attribute `model` has.
    pub fn add_model(&mut self, source: impl Into<String>, model: Arc<StageModel>) {
        self.models.insert(source.into(), model);
    }

    /// Adds the points of a drawn line, meters, under the name that the attribute `line` has.
    pub fn add_line(&mut self, source: impl Into<String>, points: impl Into<Arc<[DVec3]>>) {
        self.lines.insert(source.into(), points.into());
    }

    /// Removes all lines.
    pub fn clear_lines(&mut self) {
        self.lines.clear();
    }

    /// Adds the length of a sound under the name that the attribute `src` has.
    pub fn add_sound(&mut self, source: impl Into<String>, length: StageTime) {
        self.sounds.insert(source.into(), length);
    }

    /// Allows scripts to name models that are not here: the things of these models are placed and moved without a pose, their takes last
    /// a second, they walk calmly, and their bones are where the things are. For scenes whose models are
    /// still being read, or are lost.
    pub fn allow_missing_models(&mut self) {
        self.allows_missing = true;
    }

    /// Returns whether scripts may name other models.
    pub(in crate::stage) fn allows_missing_models(&self) -> bool {
        self.allows_missing
    }

    /// Removes the model called `source`.
    pub fn remove_model(&mut self, source: &str) {
        self.models.remove(source);
    }

    /// Returns the model called `source`.
    pub fn model(&self, source: &str) -> Option<&Arc<StageModel>> {
        self.models.get(source)
    }

    /// Returns the line called `source`.
    pub fn line(&self, source: &str) -> Option<&Arc<[DVec3]>> {
        self.lines.get(source)
    }

    /// Returns the length of the sound called `source`; `None` where it is not known.
    pub fn sound(&self, source: &str) -> Option<StageTime> {
        self.sounds.get(source).copied()
    }

    pub(in crate::stage) fn model_names(&self) -> impl Iterator<Item = &str> {
        self.models.keys().map(String::as_str)
    }

    pub(in crate::stage) fn line_names(&self) -> impl Iterator<Item = &str> {
        self.lines.keys().map(String::as_str)
    }
}
