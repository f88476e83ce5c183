//! Questions about files and their answers.

use super::playback;
use crate::panels::dialogs::{ChangedQuestion, ExistsQuestion, RewriteQuestion, UnsavedQuestion};
use crate::panels::prompts::Question;
use crate::panels::request::{Effect, FileAction};
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_document::{
    Decision, DocumentMessage, NotSaved, Offer, SaveOrder, SaveTo, SavedFile, StayingFiles,
};
use dragonfly_store::FileState;
use std::path::PathBuf;

/// Asks a question after those that are already waiting. Playback is paused.
pub(in crate::panels) fn ask(workspace: &mut Workspace, question: Question) {
    workspace.prompts.ask(question);
    playback::pause(workspace);
}

/// Asks before all other questions where the file of unsaved work is, or reports that `other` is another file.
pub(in crate::panels) fn ask_where_it_is(
    workspace: &mut Workspace,
    offer: Box<Offer>,
    other: Option<PathBuf>,
) {
    workspace.prompts.ask_where_it_is(offer, other);
    playback::pause(workspace);
}

/// Asks about unsaved work of an earlier run.
pub(in crate::panels) fn ask_to_recover(workspace: &mut Workspace, offers: Vec<Offer>) {
    workspace.prompts.ask_to_recover(offers);
    playback::pause(workspace);
}

/// Removes the question that was answered, and returns the effect of the answer.
pub(super) fn answered(workspace: &mut Workspace, action: FileAction) -> Option<Effect> {
    let finds = matches!(workspace.prompts.question(), Some(Question::Recover(_) | Question::Find(_)));
    // A layer of another model is the active one, as others that are added.
    if matches!(&action, FileAction::Send(DocumentMessage::Retarget(order)) if order.layer_of.is_some()) {
        workspace.layers.choose_next_new();
    }
    match &action {
        FileAction::Send(DocumentMessage::Decide(offer, Decision::Discard | Decision::Later)) => {
            workspace.prompts.decided(offer);
        }
        // The question stays, because the file dialog that follows may be closed without a choice.
        FileAction::Find(_) if finds => {}
        FileAction::Send(_)
        | FileAction::Where { .. }
        | FileAction::DoNotSave(_)
        | FileAction::Reload
        | FileAction::Find(_)
        | FileAction::Leave(_)
        | FileAction::QuitNow
        | FileAction::Stay => workspace.prompts.pop(),
    }
    Some(match action {
        FileAction::Send(DocumentMessage::Save(order)) => save_as(workspace, order),
        action => Effect::File(action),
    })
}

/// Closes a question without an answer. Unsaved work stays where it is.
pub(super) fn dismiss(workspace: &mut Workspace) -> Option<Effect> {
    let (offer, decision) = workspace.prompts.dismiss()?;
    Some(Effect::File(FileAction::Send(DocumentMessage::Decide(Box::new(offer), decision))))
}

/// Saves to the document's own file; shows what will change first if the settings say so.
pub(in crate::panels) fn save(workspace: &mut Workspace) -> Option<Effect> {
    let order = SaveOrder::own(None);
    if workspace.settings.show_changes && workspace.model.has_file() {
        return Some(Effect::File(FileAction::Send(DocumentMessage::Plan(Some(order)))));
    }
    Some(save_as(workspace, order))
}

/// Saves according to `order`; asks for a path if the document has no file yet.
fn save_as(workspace: &Workspace, order: SaveOrder) -> Effect {
    let asks = order.to == SaveTo::Own && !workspace.model.has_file();
    Effect::File(if asks {
        FileAction::Where { copy: false, then: order.then }
    } else {
        FileAction::Send(DocumentMessage::Save(order))
    })
}

/// Reports a save that was completed. Poses that are still pending are named: they are not in the file.
pub(in crate::panels) fn saved(workspace: &mut Workspace, saved: &SavedFile) {
    let name = saved.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    // A model in place of a scene is opened with the scene.
    let is_in_place = workspace.model.view().is_some_and(|view| view.waiting_scene.is_some());
    if !saved.copy && !is_in_place {
        workspace.settings.remember(&saved.path);
    }
    for notice in &saved.notices {
        workspace.say(MessageSeverity::Warning, format!("{name}: {notice}"));
    }
    let what = if saved.copy { "Saved a copy as" } else { "Saved" };
    let others = match saved.beside {
        0 => String::new(),
        1 => " and one further file".to_owned(),
        files => format!(" and {files} further files"),
    };
    // Only the newest message is shown, so that it includes the warnings before it.
    let (level, warnings) = match saved.notices.as_slice() {
        [] => (MessageSeverity::Info, String::new()),
        [notice] => (MessageSeverity::Warning, format!(", with a warning: {notice}")),
        [first, more @ ..] => {
            let count = more.len() + 1;
            (
                MessageSeverity::Warning,
                format!(", with {count} warnings: {first}; the others are among the messages"),
            )
        }
    };
    let errors = workspace.read().scene().map_or(0, |scene| scene.errors.len() + scene.project_errors.len());
    let errors = match errors {
        0 => String::new(),
        1 => ", with 1 error in its texts".to_owned(),
        errors => format!(", with {errors} errors in its texts"),
    };
    let text = format!("{what} {name}{others}{errors}{warnings}");
    match workspace.read().pending_poses().1 {
        0 => workspace.say(level, text),
        1 => workspace.say(
            MessageSeverity::Warning,
            format!("{text}, but 1 pending pose is not in the file: key it first"),
        ),
        poses => workspace.say(
            MessageSeverity::Warning,
            format!("{text}, but {poses} pending poses are not in the file: key them first"),
        ),
    }
}

/// Handles a save that failed: asks the user what to do, or reports the reason.
pub(in crate::panels) fn not_saved(
    workspace: &mut Workspace,
    order: SaveOrder,
    reason: NotSaved,
) -> Option<Effect> {
    match reason {
        NotSaved::NoFile => {
            return Some(Effect::File(FileAction::Where { copy: false, then: order.then }));
        }
        NotSaved::Changed(path) => {
            let (path, order) = (Some(path), Some(order));
            ask(workspace, ChangedQuestion { file: FileState::Changed, path, order }.into())
        }
        NotSaved::Exists(path) => ask(workspace, ExistsQuestion { path, order }.into()),
        NotSaved::Rewritten => ask(workspace, RewriteQuestion { order }.into()),
        NotSaved::Cancelled(stay) => {
            match stay.as_slice() {
                [] => workspace.say(MessageSeverity::Info, "The save was stopped; nothing was changed"),
                stay => {
                    let text = format!("The save was stopped{}", StayingFiles(stay));
                    workspace.say(MessageSeverity::Warning, text);
                }
            }
            ask_again(workspace, order);
        }
        NotSaved::Failed(reason) => {
            workspace.say(MessageSeverity::Error, format!("Not saved: {reason}"));
            ask_again(workspace, order);
        }
    }
    None
}

/// Asks a user who wanted to leave again what to do with the changes.
fn ask_again(workspace: &mut Workspace, order: SaveOrder) {
    if let Some(then) = order.then {
        ask(workspace, UnsavedQuestion { then }.into());
    }
}
