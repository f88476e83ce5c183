//! The document thread: owns the open document, loads models in jobs, publishes the newest view, writes the journal.

use super::export::ExportQuestions;
use super::fault::{FaultInjection, FaultPoint};
use super::handle::DocumentHandle;
use super::job::{JobNews, start_search};
use super::loading_model::LoadingModel;
use super::message::DocumentReply;
use super::open::Open;
use super::open_scene::OpenScene;
use super::pose_library::PoseFiles;
use super::receivers::{ChangeReceiver, DocumentWorker, JobReceiver, MessageReceiver};
use super::retarget_order::Retargeting;
use super::running_save::{Deferred, RunningSave};
use super::saving::SaveOrder;
use super::scan::RecoveryScan;
use super::take_check::TakeChecking;
use super::waiting_scene::WaitingScene;
use super::{Change, Loader, Source, View, open_model};
use crate::text::sentence;
use dragonfly_runtime::{Address, Job, Thread, ThreadHandle};
use dragonfly_store::{Autosave, FileState, Recoverable};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;
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

    /// Returns the number of the next job.
    pub(super) fn next_ticket(&mut self) -> u64 {
        self.tickets += 1;
        self.tickets
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
        let waiting_scene = self.scene.as_ref().map(WaitingScene::view);
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
