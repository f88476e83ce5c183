//! Files that were dropped onto the window: models and sounds of the scene, takes, or something to open.

use super::scene_text::add_all;
use super::{execute, scene, scene_ground};
use crate::panels::request::{Effect, Request};
use crate::panels::scene::NewThing;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::stage::line::points_text;
use dragonfly_document::{Source, formats, is_scene};
use dragonfly_sound::is_sound_file;
use glam::DVec3;
use std::path::{Path, PathBuf};

/// Uses the files: a scene is opened, models and sounds become a part of the scene that is open, and several files are takes of the model that is
/// open. Otherwise the first one is opened.
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
    let (models, others): (Vec<_>, Vec<_>) = files.into_iter().partition(|file| is_model(file));
    let (sounds, others): (Vec<_>, Vec<_>) = others.into_iter().partition(|file| is_sound_file(file));
    if models.is_empty() && sounds.is_empty() {
        return open(workspace, others);
    }
    if !others.is_empty() {
        let names: Vec<String> = others.iter().map(|file| name(file)).collect();
        workspace.say(MessageSeverity::Warning, format!("Not added to the scene: {}", names.join(", ")));
    }
    add(workspace, &models, &sounds)
}

/// Adds files to the scene in one step. Models are roles: the first one under the pointer, in the middle of the viewport where the window system does not
/// report its place, each further one a meter to the right of the one before. Sounds begin at the playhead.
fn add(workspace: &mut Workspace, models: &[PathBuf], sounds: &[PathBuf]) -> Option<Effect> {
    // To a centimeter, which is easy to read.
    let first = scene_ground::pointed(workspace).map(|place| (place * 100.0).round() / 100.0 + 0.0);
    let [models, sounds] = [models, sounds].map(|files| -> Vec<String> {
        files.iter().filter_map(|file| scene::name_in_scene(workspace, file)).collect()
    });
    let places = (0..).map(|beside| points_text(&[first? + f64::from(beside) * DVec3::X]));
    let role = |(model, place)| match place {
        Some(place) => NewThing::RoleAt(model, place),
        None => NewThing::Role(model),
    };
    let roles: Vec<NewThing> = models.into_iter().zip(places).map(role).collect();
    add_all(workspace, &roles, &sounds)
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
