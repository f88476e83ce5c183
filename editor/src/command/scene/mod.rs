//! Scripts of scenes on the command line: `check`, `pose`, `render` and `script`.

mod pose;
mod render;
mod times;

pub(super) use pose::RolePoses;
pub(super) use render::{FrameRange, RenderOrder, ShotChoice, render};
pub(super) use times::ScriptArguments;

use super::Failure;
use dragonfly_document::{Cancel, LoadedScene, SceneLoadError, load_scene};
use std::path::Path;

/// Loads a script and its models.
pub(super) fn load(path: &Path) -> Result<LoadedScene, Failure> {
    load_scene(path, &Cancel::default()).map_err(Failure::from)
}

impl From<SceneLoadError> for Failure {
    fn from(error: SceneLoadError) -> Self {
        Self::Input(error.to_string())
    }
}
