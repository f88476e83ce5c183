//! A save that is running, and what must wait for its end.

use super::job::JobNews;
use super::message::{DocumentMessage, DocumentReply};
use super::owner::Document;
use super::save_job::{PreparedSave, SaveInput, WrittenSave, prepare};
use super::saving::{FailedSave, NotSaved, SaveOrder, SavedFile};
use super::{Cancel, Change, LoadError, LoadStage, OpenedModel, Progress};
use dragonfly_runtime::{Address, Job, JobContext};
use std::time::Instant;

/// Size in bytes of a file from which the status line shows that it is being saved.
const LARGE: u64 = 8 << 20;

/// Fraction of a save with copies after which the files that are copied are known. Before, the models of the scene are read.
const FILES_KNOWN: f32 = 0.5;

/// A save that is running.
pub(super) struct RunningSave {
    order: SaveOrder,
    ticket: u64,
    steps: flume::Receiver<SaveStage>,
    /// Whether files are copied along, which may take long: it can be cancelled then.
    copies_along: bool,
    is_cancelled: bool,
    job: Job,
}

/// The end of a step of a save.
enum SaveStage {
    Prepared(Result<Box<PreparedSave>, NotSaved>),
    Written(Result<Box<WrittenSave>, FailedSave>),
}

/// A message that waits for the end of a save.
pub(super) enum Deferred {
    Message(DocumentMessage),
    Change(Change, Option<u64>),
    Loaded(u64, Result<Box<OpenedModel>, LoadError>),
}

/// Whether a message must wait while a save is running.
#[derive(PartialEq, Eq)]
enum Waits {
    /// It never waits, not even for messages before it that do.
    Never,
    No,
    /// It waits, and later messages do not wait for it.
    Alone,
    /// It waits, and so do all later messages.
    WithAllAfter,
}

fn waits(message: &DocumentMessage) -> Waits {
    match message {
        DocumentMessage::CancelLoading | DocumentMessage::LookAtFolder(_) => Waits::Never,
        DocumentMessage::Plan(_)
        | DocumentMessage::ShowScript(_)
        | DocumentMessage::SoundsRead(_)
        | DocumentMessage::Search
        | DocumentMessage::ReadSource(_)
        | DocumentMessage::ReadCompared(_)
        | DocumentMessage::Retarget(_)
        | DocumentMessage::ImportTakes(_)
        | DocumentMessage::Export(_)
        | DocumentMessage::MapFile(_)
        | DocumentMessage::CheckTake(_)
        | DocumentMessage::Poses(_) => Waits::No,
        DocumentMessage::Save(_) | DocumentMessage::LookAtFile => Waits::Alone,
        DocumentMessage::Open { .. }
        | DocumentMessage::EditModel(_)
        | DocumentMessage::ShowScene
        | DocumentMessage::DecideOutdated(..)
        | DocumentMessage::DecideAllOutdated(..)
        | DocumentMessage::Reload
        | DocumentMessage::Revert
        | DocumentMessage::Quit
        | DocumentMessage::DoNotSave
        | DocumentMessage::Decide(..)
        | DocumentMessage::FoundAt(..) => Waits::WithAllAfter,
    }
}

impl RunningSave {
    /// Starts `work`, a step of a save, in a job. The document gets a message when it has ended, and finds the outcome in `steps`.
    fn start(
        document: &Address<JobNews>,
        ticket: u64,
        order: SaveOrder,
        copies_along: bool,
        failed: fn(NotSaved) -> SaveStage,
        work: impl FnOnce(&JobContext<JobNews>) -> SaveStage + Send + 'static,
    ) -> Result<Self, Box<(SaveOrder, NotSaved)>> {
        let (ended, steps) = flume::bounded(1);
        let panicked = ended.clone();
        let job = Job::start(
            document,
            "save",
            move |job| {
                // Fails only if the document has ended without waiting for the save.
                let _ = ended.send(work(job));
                JobNews::SaveStep(ticket)
            },
            move |panic| {
                let reason = format!("an internal error stopped the save: {panic}");
                let _ = panicked.send(failed(NotSaved::Failed(reason)));
                JobNews::SaveStep(ticket)
            },
        );
        match job {
            Ok(job) => Ok(Self { order, ticket, steps, copies_along, is_cancelled: false, job }),
            Err(error) => {
                let reason = NotSaved::Failed(format!("the save could not be started: {error}"));
                Err(Box::new((order, reason)))
            }
        }
    }

    fn prepare(
        document: &Address<JobNews>,
        ticket: u64,
        order: SaveOrder,
        input: SaveInput,
    ) -> Result<Self, Box<(SaveOrder, NotSaved)>> {
        let copies_along = input.copies_along();
        let work = move |job: &JobContext<JobNews>| {
            let progress =
                |done: f32| job.report(done * FILES_KNOWN, |done| JobNews::SaveProgress(ticket, done));
            let prepared = prepare(input, job.cancel_flag(), &progress).map(Box::new);
            SaveStage::Prepared(prepared.map_err(|reason| match job.is_cancelled() {
                true => NotSaved::Cancelled(Vec::new()),
                false => NotSaved::Failed(reason),
            }))
        };
        Self::start(document, ticket, order, copies_along, |reason| SaveStage::Prepared(Err(reason)), work)
    }

    fn write(
        document: &Address<JobNews>,
        ticket: u64,
        order: SaveOrder,
        prepared: Box<PreparedSave>,
    ) -> Result<Self, Box<(SaveOrder, NotSaved)>> {
        let copies_along = prepared.copies_along();
        let work = move |job: &JobContext<JobNews>| {
            let progress = |done: f32| {
                let done = FILES_KNOWN + done * (1.0 - FILES_KNOWN);
                job.report(done, |done| JobNews::SaveProgress(ticket, done));
            };
            let written = prepared.write(job.cancel_flag(), &progress);
            SaveStage::Written(written.map(Box::new).map_err(FailedSave::from))
        };
        Self::start(
            document,
            ticket,
            order,
            copies_along,
            |reason| SaveStage::Written(Err(reason.into())),
            work,
        )
    }
}

impl Document {
    /// Returns the message, or `None` where it must wait for the end of a save.
    pub(super) fn unless_deferred(&mut self, message: DocumentMessage) -> Option<DocumentMessage> {
        let waits = match waits(&message) {
            Waits::Never => false,
            Waits::No => self.all_wait(),
            Waits::Alone | Waits::WithAllAfter => true,
        };
        if self.save.is_none() || !waits {
            return Some(message);
        }
        self.deferred.push_back(Deferred::Message(message));
        None
    }

    /// Returns whether changes wait for the end of a save, because a message before them does.
    pub(super) fn all_wait(&self) -> bool {
        self.deferred.iter().any(|deferred| match deferred {
            Deferred::Message(message) => waits(message) == Waits::WithAllAfter,
            Deferred::Change(..) | Deferred::Loaded(..) => true,
        })
    }

    /// Begins to save. The document can be edited in the meantime.
    pub(super) fn save(&mut self, order: SaveOrder, now: Instant) {
        let (autosave, faults) = (self.autosave.clone(), self.faults.clone());
        let Some(open) = &mut self.open else { return };
        let large = open.stamp().is_some_and(|stamp| stamp.size >= LARGE);
        let title = open.file.title.clone();
        match open.begin_save(&order, self.scene.as_ref(), autosave.as_ref(), faults, now) {
            Ok(input) => {
                if input.copies_along() {
                    let progress = Progress { stage: LoadStage::Copying, done: 0.0 };
                    self.reply(DocumentReply::Loading { title, progress });
                } else if large {
                    self.reply(DocumentReply::Notice(format!("Saving {title}…")));
                }
                let ticket = self.next_ticket();
                let begun = RunningSave::prepare(&self.own, ticket, order, input);
                self.go_on_saving(begun, now);
            }
            Err(reason) => {
                self.reply(DocumentReply::NotSaved(order, reason));
                self.report_trouble();
                self.changed();
            }
        }
    }

    fn go_on_saving(&mut self, step: Result<RunningSave, Box<(SaveOrder, NotSaved)>>, now: Instant) {
        match step {
            Ok(running) => self.save = Some(running),
            Err(failed) => {
                let (order, reason) = *failed;
                self.end_save(order, Err(reason.into()), now);
            }
        }
    }

    /// Handles the end of a step of the save with this ticket.
    pub(super) fn save_step(&mut self, ticket: u64, now: Instant) {
        let Some(save) = self.save.take_if(|save| save.ticket == ticket) else { return };
        match save.steps.recv() {
            // It was cancelled while this step ended.
            Ok(SaveStage::Prepared(Ok(_))) if save.is_cancelled => {
                self.end_save(save.order, Err(NotSaved::Cancelled(Vec::new()).into()), now);
            }
            Ok(SaveStage::Prepared(Ok(mut prepared))) => {
                let Some(open) = &mut self.open else { return };
                open.record_saving(&mut prepared, now);
                let ticket = self.next_ticket();
                let begun = RunningSave::write(&self.own, ticket, save.order, prepared);
                self.go_on_saving(begun, now);
            }
            Ok(SaveStage::Prepared(Err(reason))) => self.end_save(save.order, Err(reason.into()), now),
            Ok(SaveStage::Written(written)) => self.end_save(save.order, written, now),
            // Its sender is in the job, which sends before it ends.
            Err(flume::RecvError::Disconnected) => {}
        }
    }

    /// Reports how much of the save with this ticket is done, if it copies files into another folder.
    pub(super) fn show_save_progress(&self, ticket: u64, done: f32) {
        let is_shown = |save: &RunningSave| save.ticket == ticket && save.copies_along;
        let Some(open) = self.open.as_ref().filter(|_| self.save.as_ref().is_some_and(is_shown)) else {
            return;
        };
        let progress = Progress { stage: LoadStage::Copying, done };
        self.reply(DocumentReply::Loading { title: open.file.title.clone(), progress });
    }

    /// Cancels a save that copies files into another folder, if one is running: it stops between two files.
    pub(super) fn cancel_copies(&mut self) {
        if self.stop_copies() {
            let text = "Saving stops after the file that is being copied";
            self.reply(DocumentReply::Notice(text.to_owned()));
        }
    }

    /// Asks a save that copies files into another folder to stop. Returns whether there is one.
    fn stop_copies(&mut self) -> bool {
        let Some(save) = self.save.as_mut().filter(|save| save.copies_along) else { return false };
        save.is_cancelled = true;
        save.job.cancel();
        true
    }

    /// Waits for the end of the save that is running, before the document ends. One that copies files into another folder is cancelled: what is
    /// not saved is in the journal.
    pub(super) fn wait_for_save(&mut self) {
        self.stop_copies();
        let Some(save) = self.save.take() else { return };
        let now = Instant::now();
        let written = match save.steps.recv() {
            Ok(SaveStage::Prepared(Ok(prepared))) if prepared.copies_along() => {
                Err(NotSaved::Cancelled(Vec::new()).into())
            }
            Ok(SaveStage::Prepared(Ok(mut prepared))) => {
                // The document was lost, and with it the journal.
                let Some(open) = &mut self.open else { return };
                open.record_saving(&mut prepared, now);
                prepared.write(&Cancel::default(), &|_| {}).map(Box::new).map_err(FailedSave::from)
            }
            Ok(SaveStage::Prepared(Err(reason))) => Err(reason.into()),
            Ok(SaveStage::Written(written)) => written,
            Err(flume::RecvError::Disconnected) => return,
        };
        self.reply_saved(save.order, written, now);
    }

    fn end_save(&mut self, order: SaveOrder, written: Result<Box<WrittenSave>, FailedSave>, now: Instant) {
        self.reply_saved(order, written, now);
        self.report_trouble();
        self.changed();
        while self.save.is_none()
            && let Some(deferred) = self.deferred.pop_front()
        {
            match deferred {
                Deferred::Message(message) => self.message(message, now),
                Deferred::Change(change, number) => self.change(change, number, now),
                Deferred::Loaded(ticket, loaded) => self.finish_loading(ticket, loaded),
            }
        }
    }

    fn reply_saved(&mut self, order: SaveOrder, written: Result<Box<WrittenSave>, FailedSave>, now: Instant) {
        let autosave = self.autosave.clone();
        let Some(open) = &mut self.open else { return };
        match written {
            Ok(written) => {
                let saved = open.end_save(*written, autosave.as_ref(), now);
                // The decision was about this file.
                open.is_rewritten |= order.rewrite && !saved.copy;
                self.noticed = None;
                self.reply(DocumentReply::Saved(SavedFile { then: order.then, ..saved }));
            }
            Err(FailedSave { reason, partly, copies }) => {
                open.save_failed(partly, copies);
                self.reply(DocumentReply::NotSaved(order, reason));
            }
        }
    }
}
