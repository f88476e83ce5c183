//! Files that were dropped onto the window: models and sounds of the scene, takes, or something to open.

use super::scene_gizmo::joined;
use super::scene_probe::surface_at;
use super::scene_text::{add_all, gesture};
use super::{execute, scene, scene_ground, scene_probe};
use crate::panels::dropped_files::{DropPlace, DroppedModels, UnknownModels};
use crate::panels::request::{Effect, Request};
use crate::panels::scene::{ChangedThings, NewThing, new_thing_splices, with_new_sound};
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::stage::gesture::{GestureScene, attach_splices, spliced_text};
use dragonfly_anim::stage::line::points_text;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::edit::ScriptLabel;
use dragonfly_document::{SceneModel, Source, formats, is_scene};
use dragonfly_sound::is_sound_file;
use glam::DVec3;
use std::path::{Path, PathBuf};
use std::sync::Arc;

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

/// Adds files to the scene: sounds begin at the playhead. Models that the scene does not know yet are looked at first.
fn add(workspace: &mut Workspace, models: &[PathBuf], sounds: &[PathBuf]) -> Option<Effect> {
    let [models, sounds] = [models, sounds].map(|files| -> Vec<(PathBuf, String)> {
        let named = |file: &PathBuf| Some((file.clone(), scene::name_in_scene(workspace, file)?));
        files.iter().filter_map(named).collect()
    });
    let place = place_under_pointer(workspace);
    let sounds: Vec<String> = sounds.into_iter().map(|(_, name)| name).collect();
    let known: Option<Vec<(String, bool)>> =
        models.iter().map(|(_, name)| Some((name.clone(), is_figure(workspace, name)?))).collect();
    match known {
        Some(models) => add_known(workspace, &DroppedModels { models, place, sounds }),
        None => Some(Effect::LookAtModels(Box::new(UnknownModels { models, place, sounds }))),
    }
}

/// Adds files to the scene whose models are known, in one step. A model without takes and skins is a prop. Models on a bone are props that it holds from the
/// start of the scene, in its place; elsewhere the first one is put under the pointer, and each further one a meter to the right of the one before.
pub(super) fn add_known(workspace: &mut Workspace, dropped: &DroppedModels) -> Option<Effect> {
    if let (DropPlace::Bone(bone), false) = (&dropped.place, dropped.models.is_empty()) {
        return hold(workspace, dropped, bone);
    }
    let first = match &dropped.place {
        DropPlace::At(place) => Some(*place),
        DropPlace::Bone(_) | DropPlace::Nowhere => None,
    };
    let places = (0..).map(|beside| points_text(&[first? + f64::from(beside) * DVec3::X]));
    let thing = |((model, is_figure), place): (&(String, bool), Option<String>)| match (is_figure, place) {
        (true, Some(place)) => NewThing::RoleAt(model.clone(), place),
        (true, None) => NewThing::Role(model.clone()),
        (false, Some(place)) => NewThing::PropAt(model.clone(), place),
        (false, None) => NewThing::Prop(model.clone()),
    };
    let things: Vec<NewThing> = dropped.models.iter().zip(places).map(thing).collect();
    add_all(workspace, &things, &dropped.sounds)
}

/// Adds props that a bone holds, and sounds.
fn hold(workspace: &mut Workspace, dropped: &DroppedModels, bone: &str) -> Option<Effect> {
    let mut added = Vec::new();
    let at = workspace.read().scene_time();
    let effect = gesture(workspace, ScriptLabel::AddProp, ChangedThings::None, |base| {
        let mut script = Arc::clone(&base.script);
        for (model, _) in &dropped.models {
            let (thing, id) = new_thing_splices(&script, &NewThing::Prop(model.clone()))?;
            // The plan of the scene before has the same actions, apart from those that were added here.
            let scene = GestureScene { script: &script, plan: &base.plan };
            let attach = attach_splices(&scene, &id, bone, StageTime::ZERO, None)?;
            let text = spliced_text(&script, joined(vec![thing, attach])?)?;
            script = Arc::new(script.reread(text)?);
            added.push(id);
        }
        for sound in &dropped.sounds {
            script = Arc::new(with_new_sound(&script, sound, at)?);
        }
        Ok(script.tree().text().to_string())
    });
    if effect.is_some() {
        workspace.scene.await_things(added);
        workspace.say(MessageSeverity::Info, format!("{bone} holds it; Move and Rotate change how"));
    }
    effect
}

/// Returns whether a model that the scene has read has takes or moves a skin; `None` for others.
fn is_figure(workspace: &Workspace, model: &str) -> Option<bool> {
    match workspace.read().scene()?.models.get(model)? {
        SceneModel::Loaded(loaded) => Some(loaded.is_figure()),
        SceneModel::Loading | SceneModel::Missing(_) => None,
    }
}

/// Returns what is under the pointer, or on the ground in the middle of the viewport where the window system does not report its place.
fn place_under_pointer(workspace: &mut Workspace) -> DropPlace {
    let rounded = |place: DVec3| (place * 100.0).round() / 100.0 + 0.0;
    let surface = scene_probe::pointer(workspace).and_then(|at| surface_at(workspace, at, &[]));
    match surface {
        Some(surface) if surface.is_role && surface.bone.is_some() => DropPlace::Bone(surface.name()),
        Some(surface) if !surface.is_role => DropPlace::At(rounded(surface.place)),
        Some(_) | None => {
            scene_ground::pointed(workspace).map_or(DropPlace::Nowhere, |place| DropPlace::At(rounded(place)))
        }
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
