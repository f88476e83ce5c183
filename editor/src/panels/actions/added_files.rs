//! Files of the folder of the scene that become a part of it: models as roles and props, and sounds.

use super::free_places::FreePlaces;
use super::scene_gizmo::joined;
use super::scene_text::{add_all, step, with_hashes};
use crate::panels::dropped_files::{
    DropPlace, DroppedModel, DroppedModels, JobScene, ModelForm, UnknownModels,
};
use crate::panels::request::Effect;
use crate::panels::scene::{
    ChangedThings, NewModel, NewThing, new_thing_splices, with_new_sound, with_new_thing,
};
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::stage::gesture::{GestureScene, attach_splices, spliced_text};
use dragonfly_anim::stage::line::points_text;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::SceneModel;
use dragonfly_document::edit::ScriptLabel;
use glam::DVec3;
use std::sync::Arc;

/// Adds files of the folder of the scene to it: models, and sounds, which begin at the playhead. Models that the scene does not know yet are
/// looked at first. Models with takes or a skin become roles, others props, unless the user made a choice.
pub(super) fn add(workspace: &mut Workspace, unknown: UnknownModels) -> Option<Effect> {
    let known: Option<Vec<DroppedModel>> =
        unknown.models.iter().map(|(_, name)| known(workspace, name, unknown.is_role)).collect();
    match known {
        Some(models) => {
            let UnknownModels { place, sounds, hashes, copied, target, .. } = unknown;
            add_known(workspace, &DroppedModels { models, place, sounds, hashes, copied, target })
        }
        None => Some(Effect::LookAtModels(Box::new(unknown))),
    }
}

/// Adds files to the scene whose models are known, in one step. A model without takes and skins is a prop. Models without a skin on a bone are props that it
/// holds from the start of the scene, in its place; the first other one is put on the ground under the pointer, and each further one a meter to the right of the
/// one before. Where the pointer is elsewhere, roles are put next to those that are there.
pub(super) fn add_known(workspace: &mut Workspace, dropped: &DroppedModels) -> Option<Effect> {
    if target_of(workspace) != dropped.target {
        workspace.say(MessageSeverity::Warning, other_scene(dropped.copied.as_deref()));
        return None;
    }
    let is_held = |model: &DroppedModel| model.form != ModelForm::Figure;
    let effect = if let DropPlace::Bone(bone, _) = &dropped.place
        && dropped.models.iter().any(is_held)
    {
        hold(workspace, dropped, bone)
    } else {
        let things = standing(workspace, dropped.models.iter(), &dropped.place);
        add_all(workspace, &things, &dropped.sounds, &dropped.hashes)
    };
    if effect.is_some() {
        say_scales(workspace, &dropped.models);
    }
    effect
}

/// Tells which models were made as high as a human.
fn say_scales(workspace: &mut Workspace, models: &[DroppedModel]) {
    for model in models.iter().filter(|model| model.scale != 1.0) {
        let text = format!(
            "{} is not of human size: its scale is {}, which Attributes can change",
            model.name, model.scale
        );
        workspace.say(MessageSeverity::Info, text);
    }
}

/// Returns models as things of the scene: a meter apart from the place of the pointer on. Where that is not known, roles are next to those that are there,
/// and not inside of them.
fn standing<'a>(
    workspace: &mut Workspace,
    models: impl Iterator<Item = &'a DroppedModel>,
    place: &DropPlace,
) -> Vec<NewThing> {
    let mut free = FreePlaces::of(workspace);
    let thing = |(beside, dropped): (u32, &DroppedModel)| {
        let by = f64::from(beside) * DVec3::X;
        let is_role = match dropped.form {
            ModelForm::Figure | ModelForm::Moving => true,
            ModelForm::Object => false,
        };
        let at = match place {
            DropPlace::At(first) | DropPlace::Bone(_, first) => Some(*first + by),
            DropPlace::Near(first) if is_role => {
                Some(free.as_mut().map_or(*first + by, |free| free.take(dropped, *first)))
            }
            DropPlace::Near(first) => Some(*first + by),
            DropPlace::Nowhere if is_role => free.as_mut().map(|free| free.take(dropped, free.next())),
            DropPlace::Nowhere => None,
        };
        let at = at.and_then(|at| points_text(&[at]));
        let model = NewModel { file: dropped.name.clone(), at, scale: dropped.scale };
        if is_role { NewThing::Role(model) } else { NewThing::Prop(model) }
    };
    (0..).zip(models).map(thing).collect()
}

/// Adds props that a bone holds, figures on the ground below it, and sounds.
fn hold(workspace: &mut Workspace, dropped: &DroppedModels, bone: &str) -> Option<Effect> {
    let (figures, held): (Vec<&DroppedModel>, Vec<&DroppedModel>) =
        dropped.models.iter().partition(|model| model.form == ModelForm::Figure);
    let figures = standing(workspace, figures.into_iter(), &dropped.place);
    let scene = workspace.model.view()?.scene.clone()?;
    let mut added = Vec::new();
    let at = workspace.read().scene_time();
    let effect = step(workspace, |base| {
        let mut script = Arc::clone(&base.script);
        for model in held {
            let prop = NewModel { file: model.name.clone(), at: None, scale: model.scale };
            let (thing, id) = new_thing_splices(&script, &NewThing::Prop(prop))?;
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
        let text = script.tree().text().to_string();
        let change = base.step(text, ScriptLabel::AddProp, ChangedThings::None);
        Ok(with_hashes(change, base, &scene, &dropped.hashes))
    });
    if effect.is_some() {
        workspace.scene.await_things(added);
        workspace.say(MessageSeverity::Info, format!("{bone} holds it; Move and Rotate change how"));
    }
    effect
}

/// Returns the message when the answer of a job is for a scene that is not shown any more. `copied` names the files that were copied for it, if there
/// are any.
pub(super) fn other_scene(copied: Option<&str>) -> String {
    let text = "The scene is not open any more: its files were not added";
    match copied {
        None => text.to_owned(),
        Some(names) => format!("{text}, but they were copied into its folder: {names}"),
    }
}

/// Returns the scene that is shown.
pub(super) fn target_of(workspace: &Workspace) -> JobScene {
    let read = workspace.read();
    let script = read.scene().filter(|scene| scene.is_of_project()).map(|scene| Arc::clone(&scene.name));
    JobScene { opened: read.scene_editing.sounds().opened(), script }
}

/// Returns what is known of a model that the scene has read; `None` for others.
fn known(workspace: &Workspace, model: &str, is_role: Option<bool>) -> Option<DroppedModel> {
    match workspace.read().scene()?.models.get(model)? {
        SceneModel::Loaded(loaded) => Some(DroppedModel::of(model.to_owned(), loaded, is_role)),
        SceneModel::Loading | SceneModel::Missing(_) => None,
    }
}
