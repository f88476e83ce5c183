//! Models of a scene that are edited in it: the scene waits until it is shown again, and then plays the edits.
//!
//! A model has its own history and journal while it is edited. When the scene is shown again, the edits that are not saved into the model
//! become one step of the project, and are saved with it ([`super::project_edits`]).

use super::edit::Edit;
use super::job::JobNews;
use super::message::DocumentReply;
use super::open::{Change, Open};
use super::open_scene::OpenScene;
use super::outdated_edits::{OutdatedEdits, OutdatedEditsChoice};
use super::owner::Document;
use super::project_edits::{EditedModel, kept_in, settled};
use super::project_models::ProjectModels;
use super::scene_includes::SceneIncludeNews;
use super::scene_model_source::{KeptEdits, SceneModelSource};
use super::scene_models::SceneModelNews;
use super::waiting_scene::{SceneModelEdit, WaitingScene};
use super::{OpenedModel, SoundSource, Source};
use crate::text::sentence;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_runtime::Address;
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

    /// Takes the lengths of sounds of the open scene, seconds. Those that were read for another scene are ignored.
    pub(super) fn sounds_read(&mut self, lengths: &[(SoundSource, Option<f64>)]) {
        let Some(open) = &mut self.open else { return };
        let Some(scene) = &mut open.scene else { return };
        let here = open.file.path.as_ref().or(open.loaded.path.as_ref()).and_then(|path| path.parent());
        let mut any = false;
        for (source, seconds) in lengths {
            if let SoundSource::Below { folder, name } = source
                && here == Some(folder)
            {
                any |= scene.take_sound(name, seconds.map(StageTime::from_seconds));
            }
        }
        if any {
            self.changed();
        }
    }

    /// Takes a model that was read for the open scene, or for the one that waits.
    pub(super) fn scene_model_read(&mut self, news: SceneModelNews) {
        self.change_scene(|scene| scene.take(news));
    }

    /// Takes files that the script of the scene includes.
    pub(super) fn scene_includes_read(&mut self, news: SceneIncludeNews) {
        self.change_scene(|scene| scene.take_includes(news));
    }

    /// Gives something to the scene that is open or waits; `change` returns whether the scene changed.
    fn change_scene(&mut self, change: impl FnOnce(&mut OpenScene) -> bool) {
        if let Some(waiting) = &mut self.scene {
            // It is planned when it is shown again.
            waiting.open.scene.as_mut().map(change);
            return;
        }
        let scene = self.open.as_mut().and_then(|open| open.scene.as_mut());
        if scene.is_some_and(change) {
            self.changed();
        }
    }

    /// Starts to read a model of the open scene, to edit it.
    pub(super) fn edit_model(&mut self, name: &str) {
        match self.model_to_edit(name) {
            Ok(model) => self.read_model(model),
            Err(reason) => self.reply(DocumentReply::Refused(sentence(&reason))),
        }
    }

    /// Starts to read a model of the scene that is open or waits. It takes the place of the one that is edited.
    pub(super) fn read_model(&mut self, model: SceneModelEdit) {
        self.open(Source::of(model.path.clone(), model.source.conventions), None);
        if let Some(job) = &mut self.job {
            job.of_scene = Some(model);
        }
    }

    fn model_to_edit(&mut self, name: &str) -> Result<SceneModelEdit, String> {
        let open = self.open.as_mut().ok_or("nothing is open")?;
        let source = source_in(open, name, &self.own);
        let scene =
            open.scene.as_ref().ok_or("only models of a scene are edited in it; show the scene first")?;
        if scene.has_project_errors() {
            let reason = "the text of the project has errors, so that it cannot keep edits of a model; correct it first";
            return Err(reason.to_owned());
        }
        let path = scene.models().folder()?.path_of(&source.file);
        let path = path.map_err(|error| format!("{}: {error}", source.file))?;
        Ok(SceneModelEdit { name: name.to_owned(), source, path })
    }

    /// Shows a model of the scene, which waits. The edits that the project keeps are steps of it. If they were made for another file, asks
    /// what becomes of them instead; if they cannot be read, refuses, because the next edit would remove them.
    pub(super) fn enter_model(&mut self, opened: OpenedModel, model: SceneModelEdit) {
        let mut open = Open::new(opened, self.autosave.clone());
        let kept = model.source.edits.as_ref();
        let hash = open.stamp().map(|stamp| stamp.hash);
        if let (Some(kept), Some(hash)) = (kept, hash)
            && !kept.are_of(hash)
        {
            let (title, model) = (open.file.title.clone(), model.name);
            self.stay();
            return self.reply(DocumentReply::OutdatedEdits(OutdatedEdits { model, title, hash }));
        }
        let steps = match kept.map_or(Ok(Vec::new()), KeptEdits::steps) {
            Ok(steps) => steps,
            Err(reason) => {
                self.stay();
                let text = format!("{} cannot be edited: {reason}; correct that line first", model.name);
                return self.reply(DocumentReply::Refused(text));
            }
        };
        let Some(scene) = self.scene_for_model() else { return };
        let unfit = apply_kept(&mut open, steps);
        open.edited.mark_kept();
        open.look();
        let has_steps = open.edited.steps().1 > 0;
        let loaded = Arc::clone(&open.loaded);
        if has_steps {
            let (path, stamp) = (open.file.path.clone(), open.stamp());
            open.journal_writer.begin_later_with_steps(path, stamp);
        }
        let file = model.source.file.clone();
        self.open = Some(open);
        self.scene = Some(WaitingScene { open: scene, model });
        self.reply(DocumentReply::Opened(loaded));
        if !has_steps {
            self.begin_journal();
        }
        if !unfit.is_empty() {
            let text = format!(
                "Edits of {file} do not fit it, and are removed from the project once the model is edited or saved: {}",
                unfit.join("; ")
            );
            self.reply(DocumentReply::Warning(text));
        }
        self.report_trouble();
        self.changed();
    }

    /// Takes the scene out, to show one of its models; a model of it that is edited is closed. Returns `None` where there is no scene.
    fn scene_for_model(&mut self) -> Option<Open> {
        self.noticed = None;
        if let Some(WaitingScene { open: mut scene, .. }) = self.scene.take() {
            self.waiting = None;
            if let Some(model) = self.open.take() {
                self.close_document(model);
            }
            scene.unwanted = false;
            return Some(scene);
        }
        self.open.as_ref().filter(|open| open.scene.is_some())?;
        // The scene records its work, although the user has not decided about that of an earlier session.
        if self.waiting.take().is_some() {
            self.begin_beside();
        }
        self.open.take()
    }

    /// Shows the scene again. The project keeps the edits that are not saved into the model.
    pub(super) fn show_scene(&mut self, now: Instant) {
        let shown = match self.scene {
            Some(_) => self.return_to_scene(now),
            None => Err("no model of a scene is being edited".to_owned()),
        };
        if let Err(reason) = shown {
            self.reply(DocumentReply::Refused(sentence(&reason)));
        }
    }

    /// Shows the scene that waits, if there is one. Its project keeps the edits that are not saved into the model, unless the user
    /// discarded them.
    ///
    /// # Errors
    ///
    /// The reason why edits would be lost. The model is still shown then.
    pub(super) fn return_to_scene(&mut self, now: Instant) -> Result<(), String> {
        let Some(mut waiting) = self.scene.take() else { return Ok(()) };
        let loses = self.open.as_ref().is_some_and(Open::has_unsaved_work);
        match self.keep_edits(&mut waiting, now) {
            Err(reason) if loses => {
                self.scene = Some(waiting);
                return Err(reason);
            }
            // The file of the model has everything.
            Err(reason) => self.reply(DocumentReply::Warning(sentence(&reason))),
            Ok(()) => {}
        }
        // A file that is still being read would take the place of the model.
        if self.job.take().is_some() {
            self.reply(DocumentReply::Cancelled);
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
            scene.read_again(&model.source.file);
        }
        (self.waiting, self.noticed) = (None, None);
        let loaded = Arc::clone(&scene.loaded);
        self.open = Some(scene);
        self.reply(DocumentReply::Opened(loaded));
        self.report_trouble();
        self.changed();
        Ok(())
    }

    /// Gives the project of a waiting scene the edits that are not saved into the open model.
    fn keep_edits(&self, waiting: &mut WaitingScene, now: Instant) -> Result<(), String> {
        let Some(open) = self.open.as_ref().filter(|open| !open.unwanted) else { return Ok(()) };
        if open.edited.is_kept() {
            return Ok(());
        }
        let title = &open.file.title;
        if open.file.path.as_deref() != Some(&*waiting.model.path) {
            return match open.has_unsaved_work() {
                true => Err(format!("{title} is not the file of the scene any more; save it first")),
                false => Err(format!("the scene still plays {}, and not {title}", waiting.model.source.file)),
            };
        }
        let unsaved = open.edited.unsaved();
        if unsaved.has_undone {
            return Err(format!("steps of {title} are undone that its file contains; save it first"));
        }
        let edits: Vec<Edit> =
            open.edited.steps().0.range(unsaved.steps).map(|step| step.edit.clone()).collect();
        let WaitingScene { open: scene, model } = waiting;
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
        let edited = EditedModel { name: &model.name, file: &model.source.file, hash, edits: &edits };
        give_edits(scene, &edited, now)
    }

    /// Returns the scene that is open or waits.
    fn shown_or_waiting_scene(&mut self) -> Option<&mut Open> {
        match &mut self.scene {
            Some(waiting) => Some(&mut waiting.open),
            None => self.open.as_mut(),
        }
    }

    /// Carries out the user's decision about edits of several models in one step of the scene.
    pub(super) fn decide_all_outdated(
        &mut self,
        outdated: &[OutdatedEdits],
        choice: OutdatedEditsChoice,
        now: Instant,
    ) {
        let done = match self.shown_or_waiting_scene() {
            Some(Open { scene: None, .. }) | None => Err("the scene is not open any more".to_owned()),
            Some(open) => settle(open, outdated, choice, now).map(|is_changed| {
                if let (Some(scene), OutdatedEditsChoice::Apply, true) = (&mut open.scene, choice, is_changed)
                {
                    scene.await_fit(outdated.iter().map(|edits| edits.model.clone()));
                }
            }),
        };
        match done {
            Ok(()) => self.changed(),
            Err(reason) => self.reply(DocumentReply::Refused(sentence(&reason))),
        }
    }

    /// Tells the user about models whose files changed since the edits that the project keeps were made.
    pub(super) fn report_changed_models(&mut self) {
        let scene = self.open.as_mut().and_then(|open| open.scene.as_mut());
        let news = scene.map(OpenScene::changed_models).unwrap_or_default();
        // One warning for all: a later one would hide those before.
        let unfit = news.unfit_sentence();
        if !news.outdated.is_empty() {
            self.reply(DocumentReply::ChangedModels(news.outdated));
        }
        if let Some(text) = unfit {
            self.reply(DocumentReply::Warning(sentence(&text)));
        }
    }

    /// Carries out the user's decision about edits that a project keeps for another file of a model, and then opens the model to edit it, which
    /// warns about edits that do not fit.
    pub(super) fn decide_outdated(
        &mut self,
        outdated: &OutdatedEdits,
        choice: OutdatedEditsChoice,
        now: Instant,
    ) {
        let done = match self.shown_or_waiting_scene() {
            Some(scene) if scene.scene.is_some() => {
                settle(scene, std::slice::from_ref(outdated), choice, now)
            }
            _ => Err("the scene is not open any more".to_owned()),
        };
        if let Err(reason) = done {
            return self.reply(DocumentReply::Refused(sentence(&reason)));
        }
        match &mut self.scene {
            Some(WaitingScene { open, model }) => {
                model.source = source_in(open, &model.name, &self.own);
                let model = model.clone();
                self.read_model(model);
            }
            None => {
                self.changed();
                self.edit_model(&outdated.model);
            }
        }
    }
}

/// Returns what a script means by `name`, in the newest texts of a scene.
fn source_in(scene: &mut Open, name: &str, document: &Address<JobNews>) -> SceneModelSource {
    // A change of a text that came just before counts.
    scene.update_scene(document);
    let project = scene.scene.as_ref().and_then(|scene| scene.project());
    let models = project.map(|project| ProjectModels::of(project));
    SceneModelSource::of(name, models.as_ref(), scene.edited.adapter().texts())
}

/// Applies edits that a project keeps, each with its line, as steps. Returns those that do not fit, a sentence for each.
fn apply_kept(open: &mut Open, edits: Vec<(usize, Edit)>) -> Vec<String> {
    let apply = |(line, edit)| {
        let error = open.edited.ask(edit, None).err()?;
        Some(format!("line {line}: {error}"))
    };
    edits.into_iter().filter_map(apply).collect()
}

/// Gives the project of a scene exactly these edits of a model.
fn give_edits(scene: &mut Open, model: &EditedModel<'_>, now: Instant) -> Result<(), String> {
    let folder = scene.scene.as_ref().map(|scene| scene.models().folder()).transpose()?;
    let has_file = |name: &str| folder.is_some_and(|folder| folder.has(name));
    let Some(edit) = kept_in(scene.edited.adapter().texts(), model, has_file)? else { return Ok(()) };
    let done = scene.change(Change::Edit(edit.into(), None), now);
    done.map(|_| ()).map_err(|error| error.to_string())
}

/// Carries out the choice of the user about edits that were made for other files, in one step. Returns whether it changed anything.
fn settle(
    scene: &mut Open,
    outdated: &[OutdatedEdits],
    choice: OutdatedEditsChoice,
    now: Instant,
) -> Result<bool, String> {
    let Some(edit) = settled(scene.edited.adapter().texts(), outdated, choice)? else { return Ok(false) };
    scene.change(Change::Edit(edit.into(), None), now).map_err(|error| error.to_string())
}
