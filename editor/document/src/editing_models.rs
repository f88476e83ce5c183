//! Models of a scene that are edited in it: the scene waits until it is shown again, and then plays the edits.
//!
//! A model has its own history and journal while it is edited. When the scene is shown again, the edits that are not saved into the model
//! become one step of the project, and are saved with it ([`super::project_edits`]).

use super::edit::{Edit, parse_lines};
use super::message::DocumentReply;
use super::open::{Change, Open};
use super::owner::Document;
use super::project_edits::{EditedModel, kept_in};
use super::scene_models::SceneModelNews;
use super::waiting_scene::{SceneModelEdit, WaitingScene};
use super::{OpenedModel, Source};
use crate::text::sentence;
use std::sync::Arc;
use std::time::Instant;

impl Document {
    /// Shows another script of the open project.
    pub(super) fn show_script(&mut self, name: &str) {
        let scene = self.open.as_mut().and_then(|open| open.scene.as_mut());
        let is_there = scene.is_some_and(|scene| scene.show(name));
        match is_there {
            true => self.changed(),
            false => self.reply(DocumentReply::Refused(format!("The project has no script {name}"))),
        }
    }

    /// Takes a model of the open scene that was read.
    pub(super) fn scene_model_read(&mut self, news: SceneModelNews) {
        let scene = self.open.as_mut().and_then(|open| open.scene.as_mut());
        if scene.is_some_and(|scene| scene.take(news)) {
            self.changed();
        }
    }

    /// Starts to read a model of the open scene, to edit it.
    pub(super) fn edit_model(&mut self, name: &str) {
        match self.model_to_edit(name) {
            Ok((source, model)) => {
                self.open(source, None);
                if let Some(job) = &mut self.job {
                    job.of_scene = Some(model);
                }
            }
            Err(reason) => self.reply(DocumentReply::Refused(sentence(&reason))),
        }
    }

    fn model_to_edit(&self, name: &str) -> Result<(Source, SceneModelEdit), String> {
        let open = self.open.as_ref().ok_or("nothing is open")?;
        let scene =
            open.scene.as_ref().ok_or("only models of a scene are edited in it; show the scene first")?;
        let project = scene.project();
        let file = project.map_or(name, |project| project.source_of(name)).to_owned();
        let path = scene.models().folder()?.path_of(&file).map_err(|error| format!("{file}: {error}"))?;
        let texts = open.edited.adapter().texts();
        let edits = project.and_then(|project| project.edits_of(name)).and_then(|name| texts.called(name));
        let edits = edits.map(|file| Arc::clone(&file.text));
        Ok((Source::File(path), SceneModelEdit { name: name.to_owned(), file, edits }))
    }

    /// Shows a model of the scene, which waits. The edits that the project keeps are steps of it.
    pub(super) fn enter_model(&mut self, opened: OpenedModel, model: SceneModelEdit) {
        let Some(scene) = self.open.take() else { return };
        (self.waiting, self.noticed) = (None, None);
        let mut open = Open::new(opened, self.autosave.clone());
        let mut unfit = Vec::new();
        match model.edits.as_deref().map(parse_lines) {
            Some(Ok(edits)) => {
                for (line, edit) in edits {
                    if let Err(error) = open.edited.ask(edit, None) {
                        unfit.push(format!("line {line}: {error}"));
                    }
                }
            }
            Some(Err(error)) => unfit.push(error.to_string()),
            None => {}
        }
        open.look();
        let has_steps = open.edited.steps().1 > 0;
        let loaded = Arc::clone(&open.loaded);
        let file = model.file.clone();
        self.open = Some(open);
        self.scene = Some(WaitingScene { open: scene, model });
        self.reply(DocumentReply::Opened(loaded));
        match has_steps {
            true => self.begin_journal_of_steps(),
            false => self.begin_journal(),
        }
        if !unfit.is_empty() {
            let text = format!("Edits of {file} do not fit it: {}", unfit.join("; "));
            self.reply(DocumentReply::Warning(text));
        }
        self.report_trouble();
        self.changed();
    }

    /// Starts another journal, with the steps of the open document.
    pub(super) fn begin_journal_of_steps(&mut self) {
        let (Some(open), Some(autosave)) = (&mut self.open, &self.autosave) else { return };
        let (path, stamp) = (open.file.path.clone(), open.stamp());
        match autosave.begin_another(path.as_deref(), stamp.as_ref()) {
            Ok(journal) => open.begin_journal_with_steps(journal, Instant::now()),
            Err(error) => open.journal_writer.not_begun(path, stamp, &error),
        }
    }

    /// Shows the scene again. The project keeps the edits that are not saved into the model.
    pub(super) fn show_scene(&mut self, now: Instant) {
        let Some(mut waiting) = self.scene.take() else {
            let reason = "No model of a scene is being edited";
            return self.reply(DocumentReply::Refused(reason.to_owned()));
        };
        if let Err(reason) = self.keep_edits(&mut waiting, now) {
            self.scene = Some(waiting);
            return self.reply(DocumentReply::Refused(sentence(&reason)));
        }
        let WaitingScene { open: mut scene, model } = waiting;
        let is_recorded = !scene.journal_writer.has_gap();
        if let Some(mut edited) = self.open.take()
            && let Some(autosave) = &self.autosave
        {
            // The journal of the scene has the edits now.
            let ended =
                if is_recorded { edited.discard_journal(autosave) } else { edited.close(Some(autosave)) };
            if let Err(reason) = ended {
                self.reply(DocumentReply::Warning(reason));
            }
        }
        if let Some(scene) = &mut scene.scene {
            scene.read_again(&model.name);
        }
        (self.waiting, self.noticed) = (None, None);
        let loaded = Arc::clone(&scene.loaded);
        self.open = Some(scene);
        self.reply(DocumentReply::Opened(loaded));
        self.report_trouble();
        self.changed();
    }

    /// Gives the project of a waiting scene the edits that are not saved into the open model.
    fn keep_edits(&self, waiting: &mut WaitingScene, now: Instant) -> Result<(), String> {
        let Some(open) = &self.open else { return Ok(()) };
        let unsaved = open.edited.unsaved();
        let title = &open.file.title;
        if unsaved.has_undone {
            return Err(format!("steps of {title} are undone that its file contains; save it first"));
        }
        let edits: Vec<Edit> =
            open.edited.steps().0.range(unsaved.steps).map(|step| step.edit.clone()).collect();
        let scene = &mut waiting.open;
        let is_project = scene.scene.as_ref().is_some_and(|scene| scene.project().is_some());
        if !is_project {
            return match edits.is_empty() {
                true => Ok(()),
                false => Err(format!(
                    "{title} has edits that are not saved into it; save it, because only a project can keep them"
                )),
            };
        }
        let hash = open.stamp().map(|stamp| stamp.hash);
        let model = EditedModel { name: &waiting.model.name, file: &waiting.model.file, hash, edits: &edits };
        let Some(edit) = kept_in(scene.edited.adapter().texts(), &model)? else { return Ok(()) };
        let done = scene.change(Change::Edit(edit.into(), None), now);
        done.map(|_| ()).map_err(|error| error.to_string())
    }
}
