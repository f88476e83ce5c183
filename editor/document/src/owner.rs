//! The document thread: owns the open document, loads models in jobs, publishes the newest view, writes the journal.

use super::export::ExportQuestions;
use super::fault::{FaultInjection, FaultPoint};
use super::handle::DocumentHandle;
use super::job::{JobNews, start_loading, start_search};
use super::message::DocumentReply;
use super::open::Open;
use super::open_scene::OpenScene;
use super::pose_library::PoseFiles;
use super::receivers::{ChangeReceiver, DocumentWorker, JobReceiver, MessageReceiver};
use super::retarget_order::Retargeting;
use super::running_save::{Deferred, RunningSave};
use super::saving::SaveOrder;
use super::scan::{Decision, RecoveryScan};
use super::take_check::TakeChecking;
use super::waiting_scene::{SceneModelEdit, WaitingScene};
use super::{Change, LoadError, Loader, Offer, OpenedModel, Progress, Source, View, open_model};
use crate::text::sentence;
use dragonfly_runtime::{Address, Job, Thread, ThreadHandle};
use dragonfly_store::{Autosave, FileState, Recoverable};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Instant;

/// The setup of a document.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The function that opens a model.
    pub load: Loader,
    /// The folder that records unsaved work; nothing is recorded where `None`.
    pub autosave: Option<Autosave>,
    /// Faults that a test injects.
    pub faults: FaultInjection,
}

impl Default for Setup {
    fn default() -> Self {
        Self { load: open_model, autosave: None, faults: FaultInjection::default() }
    }
}

/// The document, on its own thread.
pub struct Document {
    pub(super) open: Option<Open>,
    /// The scene that waits while one of its models is edited.
    pub(super) scene: Option<WaitingScene>,
    generation: u64,
    /// Whether it changed since the last view.
    changed: bool,
    /// Number of the last numbered change that was carried out or refused.
    answered: u64,
    /// Whether a view must be published only to tell a sender that its change was answered: nothing else has changed.
    answers: bool,
    pub(super) job: Option<LoadingModel>,
    /// The save that is running.
    pub(super) save: Option<RunningSave>,
    /// The messages that wait for its end, in order.
    pub(super) deferred: VecDeque<Deferred>,
    tickets: u64,
    pub(super) load: Loader,
    /// Takes of another model for the open one.
    pub(super) retargeting: Retargeting,
    /// The job that imports takes; dropping it cancels it.
    pub(super) clip_import: Option<Job>,
    pub(super) export_questions: ExportQuestions,
    pub(super) checking: TakeChecking,
    /// The job that reads a file to compare with; dropping it cancels it.
    pub(super) comparing: Option<Job>,
    /// Orders for the pose library.
    pub(super) pose_files: PoseFiles,
    pub(super) autosave: Option<Autosave>,
    /// Unsaved work of the open file that awaits a decision of the user.
    pub(super) waiting: Option<Recoverable>,
    /// Unsaved work that was found before the first model was open.
    pub(super) scan: Option<RecoveryScan>,
    /// Whether the user asked for the search.
    pub(super) searched: bool,
    /// Value of [`View::is_unrecorded`] in the last view.
    shown_unrecorded: bool,
    /// The change of the file by another program that was reported last.
    pub(super) noticed: Option<FileState>,
    pub(super) faults: FaultInjection,
    replies: Address<DocumentReply>,
    /// The same address for views: the newest view replaces one that is still queued.
    views: Address<DocumentReply>,
    /// The graphics thread; here too, the newest view replaces one that is still queued.
    picture: Address<View>,
    /// The address of this document for its jobs.
    pub(super) own: Address<JobNews>,
}

/// A model that is loading.
pub(super) struct LoadingModel {
    /// The job, which is cancelled when this is dropped.
    _job: Job,
    ticket: u64,
    pub(super) source: Source,
    /// The unsaved work that is restored in it.
    pub(super) offer: Option<(Offer, Decision)>,
    /// Whether it is the open file, which gets the unsaved edits of the open document.
    pub(super) gets_edits: bool,
    /// The model of the open scene that it is.
    pub(super) of_scene: Option<SceneModelEdit>,
}

impl Document {
    /// Starts the document thread. It sends replies to `replies` and every state also directly to the graphics thread, `picture`. Nothing is
    /// recorded.
    pub fn start(replies: Address<DocumentReply>, picture: Address<View>) -> std::io::Result<DocumentHandle> {
        Self::start_with(Setup::default(), replies, picture)
    }

    /// Starts the document thread with a setup.
    pub fn start_with(
        setup: Setup,
        replies: Address<DocumentReply>,
        picture: Address<View>,
    ) -> std::io::Result<DocumentHandle> {
        let thread = Thread::start("document")?;
        let handle = Self::start_in(thread.handle(), setup, replies, picture);
        Ok(DocumentHandle { _owner: Some(thread), ..handle })
    }

    /// Starts the document in a thread that the caller owns, for example one that a test steps.
    pub fn start_in(
        thread: &ThreadHandle,
        setup: Setup,
        replies: Address<DocumentReply>,
        picture: Address<View>,
    ) -> DocumentHandle {
        let (messages, changes, own) =
            (thread.reserve_address(), thread.reserve_address(), thread.reserve_address());
        let handle = DocumentHandle {
            thread: thread.clone(),
            messages: messages.clone(),
            changes: changes.clone(),
            _owner: None,
        };
        // Fails only if the thread has stopped, and then there is no one to report it to.
        let _ = thread.run(move |context| {
            let jobs = own.clone();
            let make = move || Self {
                open: None,
                scene: None,
                generation: 0,
                changed: false,
                answered: 0,
                answers: false,
                job: None,
                save: None,
                deferred: VecDeque::new(),
                tickets: 0,
                load: setup.load,
                retargeting: Retargeting::default(),
                clip_import: None,
                export_questions: ExportQuestions::default(),
                checking: TakeChecking::default(),
                comparing: None,
                pose_files: PoseFiles::default(),
                autosave: setup.autosave.clone(),
                waiting: None,
                scan: None,
                searched: false,
                shown_unrecorded: false,
                noticed: None,
                faults: setup.faults.clone(),
                views: replies.latest(),
                picture: picture.latest(),
                replies: replies.clone(),
                own: own.clone(),
            };
            let document = Rc::new(RefCell::new(make()));
            document.borrow().search();
            // A receiver or worker that panicked is made again, and with it the document.
            let renewed = Rc::new({
                let document = Rc::clone(&document);
                move || document.borrow_mut().replace_lost(make())
            });
            let shared = move || {
                let (document, renewed, mut first) = (Rc::clone(&document), Rc::clone(&renewed), true);
                move || {
                    if !std::mem::replace(&mut first, false) {
                        renewed();
                    }
                    Rc::clone(&document)
                }
            };
            let (mut message, mut change, mut job, mut work) = (shared(), shared(), shared(), shared());
            context.register_restartable_receiver_at(&messages, move |_| MessageReceiver(message()));
            context.register_restartable_receiver_at(&changes, move |_| ChangeReceiver(change()));
            context.register_restartable_receiver_at(&jobs, move |_| JobReceiver(job()));
            context.register_restartable_worker(move |_| DocumentWorker(work()));
        });
        handle
    }

    /// Replaces a document that a panic may have left half changed with a new one; recorded work can be restored.
    fn replace_lost(&mut self, new: Self) {
        let mut lost = std::mem::replace(self, new);
        // The lost document is not written any more: its journal has all applied edits.
        drop((lost.open.take(), lost.scene.take()));
        (self.generation, self.tickets) = (lost.generation, lost.tickets);
        self.answered = lost.answered;
        self.reply(DocumentReply::Lost);
        self.search();
    }

    /// Searches for unsaved work of earlier sessions in a job.
    pub(super) fn search(&self) {
        let Some(autosave) = self.autosave.clone() else { return };
        match start_search(&self.own, autosave) {
            // The answer arrives although the job is dropped: the search does not look at the cancel flag.
            Ok(job) => drop(job),
            Err(error) => tracing::error!("the search for unsaved work could not be started: {error}"),
        }
    }

    /// Starts to load a model in the background; `offer` is the unsaved work that it is opened for.
    pub(super) fn open(&mut self, source: Source, offer: Option<(Offer, Decision)>) {
        let ticket = self.next_ticket();
        self.job = None;
        let started = match self.faults.refuses_read() {
            true => Err(std::io::Error::other("injected fault")),
            false => start_loading(&self.own, ticket, source.clone(), self.load),
        };
        match started {
            Ok(job) => {
                let (gets_edits, of_scene) = (false, None);
                self.job = Some(LoadingModel { _job: job, ticket, source, offer, gets_edits, of_scene });
            }
            Err(error) => {
                self.stay();
                self.reply(DocumentReply::Failed { source, reason: error.to_string() });
                self.offer_late();
            }
        }
    }

    /// Returns the number of the next job.
    pub(super) fn next_ticket(&mut self) -> u64 {
        self.tickets += 1;
        self.tickets
    }

    pub(super) fn cancel(&mut self) {
        let importing = self.cancel_import();
        if self.job.take().is_some() || importing {
            self.stay();
            self.reply(DocumentReply::Cancelled);
        }
    }

    /// Reports the progress of the loading job with this ticket.
    pub(super) fn show_progress(&self, ticket: u64, progress: Progress) {
        if let Some(running) = self.job.as_ref().filter(|running| running.ticket == ticket) {
            self.reply(DocumentReply::Loading { title: running.source.title(), progress });
        }
    }

    /// Opens what the loading job with this ticket has loaded, or reports why it failed.
    pub(super) fn finish_loading(&mut self, ticket: u64, loaded: Result<Box<OpenedModel>, LoadError>) {
        if self.save.is_some() {
            return self.deferred.push_back(Deferred::Loaded(ticket, loaded));
        }
        let Some(mut running) = self.job.take_if(|running| running.ticket == ticket) else { return };
        match (loaded, running.of_scene.take()) {
            (Ok(opened), Some(model)) => {
                self.enter_model(*opened, model);
                self.offer_late();
            }
            (loaded, _) => self.finish_opening(loaded, running),
        }
    }

    /// Opens a model in place of the open one, or reports why it could not be read.
    fn finish_opening(&mut self, loaded: Result<Box<OpenedModel>, LoadError>, running: LoadingModel) {
        match loaded {
            Ok(opened) if running.gets_edits => self.rebase(*opened, &running.source),
            Ok(opened) => {
                self.close();
                let open = Open::new(*opened, self.autosave.clone());
                let loaded = Arc::clone(&open.loaded);
                self.open = Some(open);
                self.reply(DocumentReply::Opened(loaded));
                match running.offer {
                    Some((offer, decision)) => self.restore(&offer, decision),
                    None => self.begin_journal(),
                }
                self.report_trouble();
                self.changed();
                self.offer_late();
            }
            Err(LoadError::Cancelled) => {
                self.stay();
                self.reply(DocumentReply::Cancelled);
            }
            Err(error) => {
                self.stay();
                let reason = error.to_string();
                self.reply(DocumentReply::Failed { source: running.source, reason });
                self.offer_late();
            }
        }
    }

    /// Closes the open document, before another one is opened or the program ends.
    fn close(&mut self) {
        (self.waiting, self.noticed) = (None, None);
        if let Some(scene) = self.scene.take() {
            self.close_document(scene.into_open());
        }
        if let Some(open) = self.open.take() {
            self.close_document(open);
        }
    }

    pub(super) fn close_document(&mut self, mut open: Open) {
        if open.has_unsaved_work() && self.autosave.is_some() {
            let text = format!(
                "The unsaved work of {} can be restored when the file is opened again",
                open.file.title
            );
            self.reply(DocumentReply::Notice(text));
        }
        if let Err(reason) = open.close(self.autosave.as_ref()) {
            self.reply(DocumentReply::Warning(reason));
        }
    }

    /// Carries out a change; `number` is that of a numbered one.
    pub(super) fn change(&mut self, change: Change, number: Option<u64>, now: Instant) {
        if self.save.is_some() && self.all_wait() {
            return self.deferred.push_back(Deferred::Change(change, number));
        }
        self.apply(change, now);
        if let Some(number) = number {
            (self.answered, self.answers) = (number, true);
        }
    }

    fn apply(&mut self, change: Change, now: Instant) {
        self.faults.reach(FaultPoint::Change);
        let Some(open) = &mut self.open else {
            return self.reply(DocumentReply::Refused("Nothing is open".to_owned()));
        };
        match open.change(change, now) {
            Ok(true) => self.changed(),
            Ok(false) => {}
            Err(error) => self.reply(DocumentReply::Refused(sentence(&error.to_string()))),
        }
        self.report_trouble();
    }

    pub(super) fn plan(&mut self, order: Option<SaveOrder>) {
        let Some(open) = &self.open else { return };
        self.reply(DocumentReply::Plan(open.plan(), order));
    }

    pub(super) fn revert(&mut self, now: Instant) {
        let Some(open) = &mut self.open else { return };
        if open.revert(now) {
            self.changed();
        } else if let Some(path) = open.file.path.clone() {
            // Undo no longer leads to the saved state, so the file is read again.
            if let Some(model) = self.scene.as_ref().map(|scene| scene.model.clone()) {
                open.unwanted = true;
                return self.read_model(model);
            }
            let chosen = open.source().conventions();
            self.open(Source::of(path, chosen), None);
        } else {
            self.reply(DocumentReply::Refused(
                "The document was never saved, so there is nothing to revert to".to_owned(),
            ));
        }
    }

    pub(super) fn look_at_file(&mut self) {
        let state = self.open.as_ref().and_then(Open::changed_on_disk);
        // Reported once: the user who continued knows it.
        if let Some(state) = state.filter(|state| self.noticed != Some(*state)) {
            self.reply(DocumentReply::FileChanged(state));
        }
        self.noticed = state;
        let scene = self.open.as_mut().and_then(|open| open.scene.as_mut());
        if scene.is_some_and(OpenScene::look_again) {
            self.changed();
        }
    }

    /// Marks the state as changed. It is published once all messages of this iteration are handled.
    pub(super) fn changed(&mut self) {
        self.generation += 1;
        self.changed = true;
    }

    /// Flushes and retries the journal where that is due, and publishes whether work is unrecorded. Returns the time at which there is
    /// something to do again.
    pub(super) fn keep(&mut self, now: Instant) -> Option<Instant> {
        let scene = self.scene.as_mut().and_then(|scene| scene.keep(now));
        let open = self.open.as_mut()?;
        let before = open.journal_writer.has_gap();
        open.keep(now);
        let due = open.journal_writer.next_due();
        if open.journal_writer.has_gap() != before || before != self.shown_unrecorded {
            self.changed();
            self.publish();
        }
        self.report_trouble();
        due.into_iter().chain(scene).min()
    }

    /// Publishes the newest state, if it changed or a sender waits for an answer.
    pub(super) fn publish(&mut self) {
        let (changed, answers) = (std::mem::take(&mut self.changed), std::mem::take(&mut self.answers));
        if !changed && !answers {
            return;
        }
        if let Some(open) = self.open.as_mut().filter(|_| changed) {
            open.update_scene(&self.own);
            self.report_changed_models();
        }
        let Some(view) = self.open.as_ref().map(|open| open.view(self.generation)) else { return };
        let waiting_scene = self.scene.as_ref().map(|scene| scene.open.file.title.as_str().into());
        let view = View { answered: self.answered, waiting_scene, ..view };
        self.shown_unrecorded = view.is_unrecorded;
        // Errors are ignored as in `reply`. The graphics thread comes first: it has more to do.
        if changed {
            let _ = self.picture.send(view.clone());
        }
        let _ = self.views.send(DocumentReply::View(view));
    }

    pub(super) fn report_trouble(&mut self) {
        let trouble = self.open.as_mut().map(|open| open.journal_writer.trouble()).unwrap_or_default();
        trouble.into_iter().for_each(|text| self.reply(DocumentReply::Warning(text)));
    }

    pub(super) fn reply(&self, reply: DocumentReply) {
        // The main thread stops last; afterwards no one reads replies.
        let _ = self.replies.send(reply);
    }
}

impl Drop for Document {
    fn drop(&mut self) {
        self.wait_for_save();
        let scene = self.scene.take().map(WaitingScene::into_open);
        for mut open in self.open.take().into_iter().chain(scene) {
            if let Err(reason) = open.close(self.autosave.as_ref()) {
                tracing::warn!("{reason}");
            }
        }
    }
}
