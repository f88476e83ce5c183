//! Scripts of scenes on the command line: `check`, `pose`, `render` and `script`.

mod pose;
mod render;
mod script_choice;
mod times;

pub(super) use pose::RolePoses;
pub(super) use render::{FrameRange, RenderOrder, ShotChoice, render};
pub(super) use script_choice::ScriptChoice;
pub(super) use times::ScriptArguments;

use super::Failure;
use dragonfly_document::{Cancel, LoadedScene, SceneLoadError, load_scene};
use std::path::Path;

/// Loads a script, or one of a project, and its models.
pub(super) fn load(path: &Path, script: &ScriptChoice) -> Result<LoadedScene, Failure> {
    load_scene(path, script.name(), &Cancel::default()).map_err(Failure::from)
}

impl From<SceneLoadError> for Failure {
    fn from(error: SceneLoadError) -> Self {
        Self::Input(error.to_string())
    }
}
