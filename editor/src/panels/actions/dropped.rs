//! Files that were dropped onto the window: models and sounds of the scene, takes, or something to open.

use super::scene_probe::surface_at;
use super::{execute, scene_files, scene_ground, scene_probe};
use crate::panels::dropped_files::{DropPlace, FileUse};
use crate::panels::request::{Effect, Request};
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_document::{SceneFileKind, SceneView, Source, formats, is_scene};
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
    let has_models = !models.is_empty();
    let models = models.into_iter().map(|file| (SceneFileKind::Model, file));
    let sounds = sounds.into_iter().map(|file| (SceneFileKind::Sound, file));
    let place = place_under_pointer(workspace);
    // A sound has no place.
    if place == DropPlace::Nowhere
        && has_models
        && let Some(reason) =
            scene_probe::pointer(workspace).and_then(|at| scene_ground::no_drop(workspace, at))
    {
        workspace.say(MessageSeverity::Warning, reason);
    }
    scene_files::want(workspace, models.chain(sounds).collect(), FileUse::Add(place))
}

/// Returns what is under the pointer, or on the ground in the middle of the viewport where the window system does not report its place.
fn place_under_pointer(workspace: &mut Workspace) -> DropPlace {
    let rounded = |place: DVec3| (place * 100.0).round() / 100.0 + 0.0;
    let surface = scene_probe::pointer(workspace).and_then(|at| surface_at(workspace, at, &[]));
    match surface {
        Some(surface) if surface.is_role && surface.bone.is_some() => {
            let ground = workspace.read().scene().map_or(0.0, SceneView::ground);
            DropPlace::Bone(surface.name(), rounded(surface.place).with_y(ground))
        }
        Some(surface) if !surface.is_role => DropPlace::At(rounded(surface.place)),
        Some(_) | None => match scene_ground::pointed(workspace).map(rounded) {
            Some(place) if scene_probe::pointer(workspace).is_some() => DropPlace::At(place),
            Some(place) => DropPlace::Near(place),
            None => DropPlace::Nowhere,
        },
    }
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
