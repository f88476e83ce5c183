//! Files that were dropped onto the window: models of the scene, takes, a sound, or something to open.

use super::{execute, scene};
use crate::panels::request::{Effect, Request};
use crate::panels::sound::is_sound;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_document::{Source, formats, is_scene};
use std::path::{Path, PathBuf};

/// Uses the files: a scene is opened, models become roles of the scene that is open under the pointer, and several files are takes of the model that is open.
/// Otherwise the first one is opened.
pub(super) fn dropped(workspace: &mut Workspace, files: Vec<PathBuf>) -> Option<Effect> {
    if workspace.read().scene().is_some() {
        return dropped_on_scene(workspace, files);
    }
    // The built-in model is no work of the user.
    let is_own = workspace.model.view().is_some_and(|view| view.file.path.is_some());
    if files.len() > 1 && is_own {
        return execute::perform(workspace, Request::ImportTakes(files));
    }
    open(workspace, files)
}

fn dropped_on_scene(workspace: &mut Workspace, mut files: Vec<PathBuf>) -> Option<Effect> {
    if let Some(scene) = files.iter().position(|file| is_scene(file)) {
        files.swap(0, scene);
        return open(workspace, files);
    }
    let (models, mut others): (Vec<_>, Vec<_>) = files.into_iter().partition(|file| is_model(file));
    if models.is_empty() {
        return open(workspace, others);
    }
    if let Some(sound) = others.iter().position(|file| is_sound(file)) {
        execute::perform(workspace, Request::Open(Source::File(others.remove(sound))));
    }
    if !others.is_empty() {
        let names: Vec<String> = others.iter().map(|file| name(file)).collect();
        workspace.say(MessageSeverity::Warning, format!("Not added to the scene: {}", names.join(", ")));
    }
    scene::drop_roles(workspace, &models)
}

/// Opens the first file. The others stay closed.
fn open(workspace: &mut Workspace, files: Vec<PathBuf>) -> Option<Effect> {
    let others = files.len().saturating_sub(1);
    let first = files.into_iter().next()?;
    workspace.model.pass_over(others);
    execute::perform(workspace, Request::Open(Source::File(first)))
}

fn is_model(file: &Path) -> bool {
    let extension = file.extension().and_then(|extension| extension.to_str());
    extension
        .is_some_and(|extension| formats().extensions().iter().any(|own| own.eq_ignore_ascii_case(extension)))
}

fn name(file: &Path) -> String {
    file.file_name().unwrap_or_default().display().to_string()
}
