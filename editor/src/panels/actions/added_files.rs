//! Files of the folder of the scene that become a part of it: models as roles and props, and sounds.

use super::scene_gizmo::joined;
use super::scene_text::{add_all, gesture};
use crate::panels::dropped_files::{DropPlace, DroppedModels, ModelForm, UnknownModels};
use crate::panels::request::Effect;
use crate::panels::scene::{ChangedThings, NewThing, new_thing_splices, with_new_sound, with_new_thing};
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::stage::gesture::{GestureScene, attach_splices, spliced_text};
use dragonfly_anim::stage::line::points_text;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::SceneModel;
use dragonfly_document::edit::ScriptLabel;
use glam::DVec3;
use std::path::PathBuf;
use std::sync::Arc;

/// Adds files of the folder of the scene to it: models with their names, and the names of sounds, which begin at the playhead. Models that the scene
/// does not know yet are looked at first.
pub(super) fn add(
    workspace: &mut Workspace,
    models: Vec<(PathBuf, String)>,
    sounds: Vec<String>,
    place: DropPlace,
) -> Option<Effect> {
    let known: Option<Vec<(String, ModelForm)>> =
        models.iter().map(|(_, name)| Some((name.clone(), form_of(workspace, name)?))).collect();
    match known {
        Some(models) => add_known(workspace, &DroppedModels { models, place, sounds }),
        None => Some(Effect::LookAtModels(Box::new(UnknownModels { models, place, sounds }))),
    }
}

/// Adds files to the scene whose models are known, in one step. A model without takes and skins is a prop. Models without a skin on a bone are props that it
/// holds from the start of the scene, in its place; the first other one is put on the ground under the pointer, and each further one a meter to the right of the
/// one before.
pub(super) fn add_known(workspace: &mut Workspace, dropped: &DroppedModels) -> Option<Effect> {
    let is_held = |(_, form): &(String, ModelForm)| *form != ModelForm::Figure;
    if let DropPlace::Bone(bone, _) = &dropped.place
        && dropped.models.iter().any(is_held)
    {
        return hold(workspace, dropped, bone);
    }
    add_all(workspace, &standing(&dropped.models, &dropped.place), &dropped.sounds)
}

/// Returns models as things of the scene, a meter apart.
fn standing(models: &[(String, ModelForm)], place: &DropPlace) -> Vec<NewThing> {
    let first = match place {
        DropPlace::At(place) | DropPlace::Bone(_, place) => Some(*place),
        DropPlace::Nowhere => None,
    };
    let places = (0..).map(|beside| points_text(&[first? + f64::from(beside) * DVec3::X]));
    let thing = |((model, form), place): (&(String, ModelForm), Option<String>)| match (form, place) {
        (ModelForm::Figure | ModelForm::Moving, Some(place)) => NewThing::RoleAt(model.clone(), place),
        (ModelForm::Figure | ModelForm::Moving, None) => NewThing::Role(model.clone()),
        (ModelForm::Object, Some(place)) => NewThing::PropAt(model.clone(), place),
        (ModelForm::Object, None) => NewThing::Prop(model.clone()),
    };
    models.iter().zip(places).map(thing).collect()
}

/// Adds props that a bone holds, figures on the ground below it, and sounds.
fn hold(workspace: &mut Workspace, dropped: &DroppedModels, bone: &str) -> Option<Effect> {
    let (figures, held): (Vec<_>, Vec<_>) =
        dropped.models.iter().cloned().partition(|(_, form)| *form == ModelForm::Figure);
    let figures = standing(&figures, &dropped.place);
    let mut added = Vec::new();
    let at = workspace.read().scene_time();
    let effect = gesture(workspace, ScriptLabel::AddProp, ChangedThings::None, |base| {
        let mut script = Arc::clone(&base.script);
        for (model, _) in held {
            let (thing, id) = new_thing_splices(&script, &NewThing::Prop(model.clone()))?;
            // The plan of the scene before has the same actions, apart from those that were added here.
            let scene = GestureScene { script: &script, plan: &base.plan };
            let attach = attach_splices(&scene, &id, bone, StageTime::ZERO, None)?;
            let text = spliced_text(&script, joined(vec![thing, attach])?)?;
            script = Arc::new(script.reread(text)?);
            added.push(id);
        }
        for figure in &figures {
            let (next, id) = with_new_thing(&script, figure)?;
            script = Arc::new(next);
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

/// Returns what a model is that the scene has read; `None` for others.
fn form_of(workspace: &Workspace, model: &str) -> Option<ModelForm> {
    match workspace.read().scene()?.models.get(model)? {
        SceneModel::Loaded(loaded) => Some(ModelForm::of(loaded)),
        SceneModel::Loading | SceneModel::Missing(_) => None,
    }
}
