//! Files that the scene gets: dropped or chosen ones, and those that were missing. What is outside of its folder, also through links, is copied into
//! it first.

use super::added_files::{other_scene, target_of};
use super::scene_text::step;
use super::{added_files, files};
use crate::panels::dialogs::{CopyQuestion, MissingQuestion};
use crate::panels::dropped_files::{DropPlace, FileUse, UnknownModels, WantedFiles};
use crate::panels::file_choice::FileChoice;
use crate::panels::request::Effect;
use crate::panels::scene::ChangedThings;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::stage::gesture::{GestureRefusal, spliced_script};
use dragonfly_document::edit::ScriptLabel;
use dragonfly_document::{FoundFiles, MissingFile, SceneFile, SceneFileKind, SceneFiles, name_found_files};
use std::path::PathBuf;

/// Gives files to the scene. A job looks at them first, because whether they are in its folder depends on the disk.
pub(super) fn want(
    workspace: &mut Workspace,
    wanted: Vec<(SceneFileKind, PathBuf)>,
    used: FileUse,
) -> Option<Effect> {
    let folder = folder(workspace)?;
    let files = wanted.into_iter().map(|(kind, path)| SceneFile::new(kind, path)).collect();
    let (files, target) = (SceneFiles { folder, files }, target_of(workspace));
    Some(Effect::LookAtFiles(Box::new(WantedFiles { files, others: Vec::new(), used, target })))
}

/// Returns the folder of the scene; `None`, with a message, where it is in none.
fn folder(workspace: &mut Workspace) -> Option<PathBuf> {
    let folder = folder_of_scene(workspace);
    if folder.is_none() {
        workspace.say(MessageSeverity::Warning, "The scene is in no folder yet: save it first");
    }
    folder
}

/// Returns the folder of the scene that is open; `None` while none is, and for one without a file.
fn folder_of_scene(workspace: &Workspace) -> Option<PathBuf> {
    let folder = workspace.read().scene().and(workspace.read().model_folder())?;
    // That of a file that was opened by its name alone.
    Some(if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder })
}

/// Uses files of which a job has found out where they are, or asks whether those outside are copied. `copied` is the number of files that it
/// has copied.
pub(in crate::panels) fn answered(
    workspace: &mut Workspace,
    wanted: Box<WantedFiles>,
    copied: usize,
) -> Option<Effect> {
    let copies = copied_names(&wanted.files, copied);
    let is_here = folder_of_scene(workspace).as_ref() == Some(&wanted.files.folder);
    if !is_here || target_of(workspace) != wanted.target {
        workspace.say(MessageSeverity::Warning, other_scene(copies.as_deref()));
        return None;
    }
    if !wanted.files.are_inside() {
        files::ask(workspace, CopyQuestion { wanted }.into());
        return None;
    }
    let before = workspace.status.said();
    let effect = use_files(workspace, &wanted, copies.as_deref());
    if let Some(names) = copies {
        // That message has the reason why the files were not used.
        let is_refused = effect.is_none() && workspace.status.said() > before;
        let refusal = workspace.status.last().filter(|_| is_refused).map(|message| message.text.clone());
        let text = format!("Copied {names} into the folder of the scene");
        match refusal {
            None => workspace.say(MessageSeverity::Info, format!("{text}; Undo leaves the copies")),
            Some(reason) => {
                let text = format!("{text}, but the scene was not changed: {reason}");
                workspace.say(MessageSeverity::Warning, text);
            }
        }
    }
    effect
}

/// Returns the names of the files that were copied into the folder of the scene, and the number of those that they need; `None` where no file was
/// written.
fn copied_names(files: &SceneFiles, written: usize) -> Option<String> {
    let copies = files.files.iter().filter(|file| file.written > 0);
    let names: Vec<&str> = copies.filter_map(|file| file.name.as_deref()).collect();
    let more = match written.saturating_sub(names.len()) {
        0 => String::new(),
        1 => " and one more file".to_owned(),
        more => format!(" and {more} more files"),
    };
    (written > 0).then(|| format!("{}{more}", names.join(", ")))
}

/// Copies files after the user agreed.
pub(super) fn copy(workspace: &mut Workspace, wanted: Box<WantedFiles>) -> Effect {
    workspace.prompts.pop();
    Effect::CopyFiles(wanted)
}

/// Uses files that are in the folder of the scene; `copies` names those that were copied there.
fn use_files(workspace: &mut Workspace, wanted: &WantedFiles, copies: Option<&str>) -> Option<Effect> {
    let WantedFiles { files: SceneFiles { folder, files }, used, target, .. } = wanted;
    let hashes: Vec<(String, u64)> =
        files.iter().filter_map(|file| file.name.clone().zip(file.hash)).collect();
    let copied = copies.map(str::to_owned);
    let named =
        |kind| files.iter().filter(move |file| file.kind == kind).filter_map(|file| file.name.clone());
    match used {
        FileUse::Add(place) => {
            let models = named(SceneFileKind::Model).map(|name| (folder.join(&name), name)).collect();
            let sounds = named(SceneFileKind::Sound).collect();
            let (place, target) = (DropPlace::clone(place), target.clone());
            let unknown = UnknownModels { models, is_role: None, place, sounds, hashes, copied, target };
            added_files::add(workspace, unknown)
        }
        FileUse::Role | FileUse::Prop => {
            let models = named(SceneFileKind::Model).map(|name| (folder.join(&name), name)).collect();
            let (is_role, place) = (Some(*used == FileUse::Role), DropPlace::Nowhere);
            let (sounds, target) = (Vec::new(), target.clone());
            let unknown = UnknownModels { models, is_role, place, sounds, hashes, copied, target };
            added_files::add(workspace, unknown)
        }
        FileUse::Find => name_found(workspace, files),
    }
}

/// Asks where a missing file is now.
pub(super) fn find(workspace: &mut Workspace, missing: MissingFile) -> Option<Effect> {
    let folder = folder(workspace)?;
    let included =
        workspace.read().scene().and_then(|scene| scene.included_place_of(&missing).map(str::to_owned));
    if let Some(file) = included {
        workspace.say(MessageSeverity::Warning, missing.named_in(&file));
        return None;
    }
    let choice = match missing.kind {
        SceneFileKind::Model => FileChoice::MissingModel,
        SceneFileKind::Sound => FileChoice::MissingSound,
    };
    workspace.scene.set_finding(Some(missing));
    Some(Effect::Choose(choice, Some(folder)))
}

/// Asks for the path of the missing file that the user looks for, on a desktop without a dialog for files.
pub(super) fn type_path(workspace: &mut Workspace) {
    if let Some(missing) = workspace.scene.finding().cloned() {
        files::ask(workspace, MissingQuestion { missing }.into());
    }
}

/// Uses a file in place of the missing one that the user looks for. Others that are missing may be next to it.
pub(super) fn found(workspace: &mut Workspace, path: PathBuf) -> Option<Effect> {
    let missing = workspace.scene.finding().cloned()?;
    workspace.scene.set_finding(None);
    let folder = folder(workspace)?;
    let others = missing_files(workspace).into_iter().filter(|other| *other != missing).collect();
    let file = SceneFile::new(missing.kind, path);
    let files = vec![SceneFile { replaces: Some(missing), ..file }];
    let (files, target) = (SceneFiles { folder, files }, target_of(workspace));
    Some(Effect::LookAtFiles(Box::new(WantedFiles { files, others, used: FileUse::Find, target })))
}

/// Returns the models and sounds of the scene that are missing, apart from those that only included files name.
fn missing_files(workspace: &Workspace) -> Vec<MissingFile> {
    let read = workspace.read();
    let models = read.scene().into_iter().flat_map(|scene| scene.missing_models());
    let all = models.chain(read.scene_editing.sounds().missing());
    let is_named_here =
        |missing: &MissingFile| read.scene().is_none_or(|scene| scene.included_place_of(missing).is_none());
    all.filter(is_named_here).collect()
}

/// Names the files that were found in the texts of the scene, in one step.
fn name_found(workspace: &mut Workspace, files: &[SceneFile]) -> Option<Effect> {
    const LABEL: ScriptLabel = ScriptLabel::FindFiles;
    let found: Vec<(MissingFile, String)> =
        files.iter().filter_map(|file| file.replaces.clone().zip(file.name.clone())).collect();
    let view = workspace.model.view()?.scene.clone()?;
    let effect = step(workspace, |base| {
        let FoundFiles { script, others } =
            name_found_files(&view, &base.script, &found).map_err(GestureRefusal)?;
        let script = match script.list().is_empty() {
            true => None,
            false => Some(spliced_script(&base.script, &script)?),
        };
        let mut change =
            base.change(script.as_ref().unwrap_or(&base.script), LABEL, None, ChangedThings::None);
        change.also.extend(others);
        Ok(change)
    });
    // A file of the same name may be there now.
    workspace.scene.sounds_mut().look_again();
    if effect.is_some() && found.len() > 1 {
        workspace.say(MessageSeverity::Info, format!("Found {} files", found.len()));
    }
    effect
}
