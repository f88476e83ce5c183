//! Files of the folder of the scene that become a part of it: models as roles and props, and sounds.

use super::scene_gizmo::joined;
use super::scene_text::{add_all, step, with_hashes};
use crate::panels::dropped_files::{DropPlace, DroppedModels, SceneTarget, UnknownModels};
use crate::panels::request::Effect;
use crate::panels::scene::{ChangedThings, NewThing, new_thing_splices, with_new_sound};
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::stage::gesture::{GestureScene, attach_splices, spliced_text};
use dragonfly_anim::stage::line::points_text;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::SceneModel;
use dragonfly_document::edit::ScriptLabel;
use glam::DVec3;
use std::sync::Arc;

/// Adds files of the folder of the scene to it: models, and sounds, which begin at the playhead. Models that the scene
/// does not know yet are looked at first.
pub(super) fn add(workspace: &mut Workspace, unknown: UnknownModels) -> Option<Effect> {
    let models = &unknown.models;
    let known: Option<Vec<(String, bool)>> =
        models.iter().map(|(_, name)| Some((name.clone(), is_figure(workspace, name)?))).collect();
    match known {
        Some(models) => {
            let UnknownModels { place, sounds, hashes, target, .. } = unknown;
            add_known(workspace, &DroppedModels { models, place, sounds, hashes, target })
        }
        None => Some(Effect::LookAtModels(Box::new(unknown))),
    }
}

/// Adds files to the scene whose models are known, in one step. A model without takes and skins is a prop. Models on a bone are props that it holds from the
/// start of the scene, in its place; elsewhere the first one is put under the pointer, and each further one a meter to the right of the one before.
pub(super) fn add_known(workspace: &mut Workspace, dropped: &DroppedModels) -> Option<Effect> {
    if target_of(workspace) != dropped.target {
        workspace.say(MessageSeverity::Warning, OTHER_SCENE);
        return None;
    }
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
    add_all(workspace, &things, &dropped.sounds, &dropped.hashes)
}

/// Adds props that a bone holds, and sounds.
fn hold(workspace: &mut Workspace, dropped: &DroppedModels, bone: &str) -> Option<Effect> {
    let mut added = Vec::new();
    let at = workspace.read().scene_time();
    let effect = step(workspace, |base| {
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
        let text = script.tree().text().to_string();
        let change = base.step(text, ScriptLabel::AddProp, ChangedThings::None);
        Ok(with_hashes(change, base, &dropped.hashes))
    });
    if effect.is_some() {
        workspace.scene.await_things(added);
        workspace.say(MessageSeverity::Info, format!("{bone} holds it; Move and Rotate change how"));
    }
    effect
}

/// The message when the answer of a job is for a scene that is not shown any more.
pub(super) const OTHER_SCENE: &str = "The scene is not open any more: its files were not added";

/// Returns the scene that is shown.
pub(super) fn target_of(workspace: &Workspace) -> SceneTarget {
    let read = workspace.read();
    let script = read.scene().filter(|scene| scene.is_of_project()).map(|scene| Arc::clone(&scene.name));
    SceneTarget { opened: read.scene_editing.sounds().opened(), script }
}

/// Returns whether a model that the scene has read has takes or moves a skin; `None` for others.
fn is_figure(workspace: &Workspace, model: &str) -> Option<bool> {
    match workspace.read().scene()?.models.get(model)? {
        SceneModel::Loaded(loaded) => Some(loaded.is_figure()),
        SceneModel::Loading | SceneModel::Missing(_) => None,
    }
}
