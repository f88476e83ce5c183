//! Replies of the document and answers of file dialogs, shown in the window.

#![deny(clippy::wildcard_enum_match_arm)]

use super::interface::Interface;
use crate::panels::dialogs::{
    ChangedModelsQuestion, ChangedQuestion, OutdatedQuestion, PlanQuestion, UnfitQuestion, UnsavedQuestion,
};
use crate::panels::open_model::Loading;
use crate::panels::status::MessageSeverity;
use crate::panels::{Effect, FileAction, State};
use dragonfly_anim::model_unit::ModelUnit;
use dragonfly_document::{Change, DocumentReply, LoadStage, LoadedModel, SavedFile, View};
use std::sync::Arc;
use std::time::Instant;

/// Shows a reply of the document. All kinds of replies are handled here.
pub(super) fn show(interface: &mut Interface, reply: DocumentReply) {
    let state = &mut interface.state;
    match reply {
        DocumentReply::Loading { title, progress } => state.set_loading(Some(Loading { title, progress })),
        DocumentReply::Cancelled => {
            state.take_passed_over();
            state.set_loading(None);
            state.say(MessageSeverity::Info, "Stopped loading");
        }
        DocumentReply::Failed { source, reason } => {
            let passed_over = state.take_passed_over();
            state.set_loading(None);
            if let Some(path) = source.path() {
                state.settings_mut().recent.retain(|other| other != path || path.exists());
            }
            say_passed_over(state, passed_over);
            state.say(MessageSeverity::Error, reason);
        }
        DocumentReply::Refused(reason) => {
            state.edit_refused();
            state.say(MessageSeverity::Warning, reason);
        }
        DocumentReply::View(view) => show_view(interface, view),
        DocumentReply::Opened(loaded) => opened(interface, &loaded),
        DocumentReply::Rebased(unfit) if unfit.is_empty() => {
            state.say(MessageSeverity::Info, "Loaded the file again and applied the unsaved changes");
        }
        DocumentReply::Rebased(unfit) => {
            let lines: Vec<String> = unfit.iter().map(ToString::to_string).collect();
            state.ask(UnfitQuestion { lines: Arc::from(lines) }.into());
        }
        DocumentReply::Saved(saved) => {
            end_copies(state);
            show_saved(interface, saved);
        }
        DocumentReply::NotSaved(order, reason) => {
            end_copies(state);
            let effect = state.not_saved(order, reason);
            interface.effects.extend(effect);
        }
        DocumentReply::Plan(Ok(text), order) => {
            let lines: Vec<String> = text.lines().map(str::to_owned).collect();
            state.ask(PlanQuestion { lines: Arc::from(lines), order }.into());
        }
        DocumentReply::Plan(Err(reason), _) => {
            state.say(MessageSeverity::Error, format!("The document cannot be saved: {reason}"));
        }
        DocumentReply::Unsaved(then) => {
            state.ask(UnsavedQuestion { then }.into());
            interface.effects.push(Effect::File(FileAction::Stay));
        }
        DocumentReply::OutdatedEdits(edits) => {
            state.set_loading(None);
            state.ask(OutdatedQuestion { edits }.into());
        }
        DocumentReply::ChangedModels(edits) => state.ask(ChangedModelsQuestion { edits }.into()),
        DocumentReply::MayQuit => interface.effects.push(Effect::File(FileAction::QuitNow)),
        DocumentReply::FileChanged(file) => {
            state.ask(ChangedQuestion { file, path: None, order: None }.into())
        }
        DocumentReply::NewFolders { folder, created } => state.set_new_folders(folder, created),
        DocumentReply::Offers(offers) => state.ask_to_recover(offers),
        DocumentReply::OtherFile(offer, path) => state.ask_where_it_is(offer, Some(path)),
        DocumentReply::NothingToOffer => {
            state.say(MessageSeverity::Info, "There is no unsaved work of an earlier run");
        }
        DocumentReply::SourceRead(source) => state.source_read(source),
        DocumentReply::ComparedRead(file) => {
            let effect = state.compared_read(file);
            interface.effects.extend(effect);
        }
        DocumentReply::MapRead(map) => state.map_read(map),
        DocumentReply::Exported(order, done) => state.exported(order, done),
        DocumentReply::Checked(checked) => state.checked(checked),
        DocumentReply::Poses(folder) => state.poses_read(folder),
        DocumentReply::Notice(text) => state.say(MessageSeverity::Info, text),
        DocumentReply::Warning(text) => state.say(MessageSeverity::Warning, text),
        DocumentReply::Lost => {
            end_copies(state);
            state.document_lost();
            state.say(MessageSeverity::Error, "An internal error closed the document");
        }
    }
}

fn show_view(interface: &mut Interface, view: View) {
    interface.state.set_now(Instant::now());
    interface.state.show(view);
    let title = interface.state.read().window_title();
    interface.set_title(&title);
}

/// Reports a model that was opened, and applies the edits of the command line to it.
fn opened(interface: &mut Interface, loaded: &LoadedModel) {
    let state = &mut interface.state;
    let passed_over = state.take_passed_over();
    state.set_loading(None);
    if let Some(path) = loaded.path.as_ref().filter(|path| !state.is_opened_in_place(path)) {
        state.settings_mut().remember(path);
    }
    for warning in &loaded.warnings {
        state.say(MessageSeverity::Warning, format!("{}: {warning}", loaded.title));
    }
    for note in &loaded.notes {
        state.say(MessageSeverity::Info, format!("{}: {note}", loaded.title));
    }
    let unit = ModelUnit::of(&loaded.model.animation.skeleton);
    if let Some(remark) = unit.remark() {
        state.say(MessageSeverity::Info, format!("{}: {remark}; Size of the model… sets it", loaded.title));
    }
    let opened = format!("Opened {}", loaded.title);
    match loaded.warnings.len() {
        0 => state.say(MessageSeverity::Info, opened),
        // The newest message is the one that is shown.
        1 => state.say(MessageSeverity::Warning, format!("{opened}, with a warning: see Properties")),
        many => {
            state.say(MessageSeverity::Warning, format!("{opened}, with {many} warnings: see Properties"));
        }
    }
    say_passed_over(state, passed_over);
    let edits = std::mem::take(&mut interface.edits).into_iter();
    interface.effects.extend(edits.map(|edit| Effect::Change(Change::Edit(edit, None))));
}

/// Notes that no files are being copied into another folder any more.
fn end_copies(state: &mut State) {
    if state.read().loading.is_some_and(|loading| loading.progress.stage == LoadStage::Copying) {
        state.set_loading(None);
    }
}

fn show_saved(interface: &mut Interface, saved: SavedFile) {
    interface.state.saved(&saved);
    if let Some(then) = saved.then {
        interface.effects.push(Effect::File(FileAction::Leave(then)));
    }
}

/// Reports the number of files that were given together with the open one and stay closed.
fn say_passed_over(state: &mut State, files: usize) {
    match files {
        0 => {}
        1 => {
            state.say(MessageSeverity::Warning, "Only one model can be open: the second file was not opened")
        }
        _ => state.say(
            MessageSeverity::Warning,
            format!("Only one model can be open: {files} further files were not opened"),
        ),
    }
}
