//! The document in its thread: receiver of messages about files, of changes and of news of jobs, and worker. The messages of all
//! three are handled in the order in which they were sent.

#![deny(clippy::wildcard_enum_match_arm)]

use super::Change;
use super::job::JobNews;
use super::message::{DocumentMessage, DocumentReply};
use super::new_folders::new_folders;
use super::owner::Document;
use dragonfly_runtime::{Context, Receiver, Worker};
use std::cell::RefCell;
use std::rc::Rc;
use std::time::Instant;

/// Receives messages about files.
pub(super) struct MessageReceiver(pub(super) Rc<RefCell<Document>>);

impl Receiver for MessageReceiver {
    type Message = DocumentMessage;

    fn receive(&mut self, message: DocumentMessage, thread: &mut Context) {
        let document = &mut *self.0.borrow_mut();
        if let Some(message) = document.unless_deferred(message) {
            document.message(message, thread.now());
        }
    }
}

impl Document {
    /// Handles a message about files.
    pub(super) fn message(&mut self, message: DocumentMessage, now: Instant) {
        match message {
            DocumentMessage::Open { source, anyway } => self.open_or_ask(source, anyway, now),
            DocumentMessage::CancelLoading => self.cancel(),
            DocumentMessage::Save(order) => self.save(order, now),
            DocumentMessage::Plan(order) => self.plan(order),
            DocumentMessage::Reload => self.reload(),
            DocumentMessage::Revert => self.revert(now),
            DocumentMessage::Quit => self.quit(now),
            DocumentMessage::DoNotSave => self.do_not_save(),
            DocumentMessage::EditModel(name) => self.edit_model(&name),
            DocumentMessage::ShowScene => self.show_scene(now),
            DocumentMessage::DecideOutdated(edits, choice) => self.decide_outdated(&edits, choice, now),
            DocumentMessage::DecideAllOutdated(edits, choice) => {
                self.decide_all_outdated(&edits, choice, now);
            }
            DocumentMessage::ShowScript(name) => self.show_script(&name),
            DocumentMessage::SoundsRead(lengths) => self.sounds_read(&lengths),
            DocumentMessage::LookAtFile => self.look_at_file(),
            DocumentMessage::LookAtFolder(folder) => {
                let created = new_folders(&folder);
                self.reply(DocumentReply::NewFolders { folder, created });
            }
            DocumentMessage::Search => {
                self.searched = true;
                self.search();
            }
            DocumentMessage::ReadSource(source) => self.read_source(source, self.load),
            DocumentMessage::ReadCompared(source) => self.read_compared(source, self.load),
            DocumentMessage::Retarget(order) => self.retarget(order),
            DocumentMessage::ImportTakes(order) => self.import_takes(order),
            DocumentMessage::Export(order) => self.export(order),
            DocumentMessage::MapFile(file) => self.map_file(file),
            DocumentMessage::CheckTake(check) => self.check_take(check),
            DocumentMessage::Poses(order) => self.pose_order(order),
            DocumentMessage::Decide(offer, decision) => self.decide(*offer, decision),
            DocumentMessage::FoundAt(offer, path) => self.found_at(*offer, path),
        }
    }
}

/// Receives changes. A sender that waits for the outcome numbers them: the first view with
/// [`View::answered`](super::View::answered) at or above the number contains the change, or was made after it was refused.
pub(super) struct ChangeReceiver(pub(super) Rc<RefCell<Document>>);

impl Receiver for ChangeReceiver {
    /// The change, and its number if it has one. Numbers ascend and begin at 1.
    type Message = (Change, Option<u64>);

    fn receive(&mut self, (change, number): (Change, Option<u64>), thread: &mut Context) {
        self.0.borrow_mut().change(change, number, thread.now());
    }
}

/// Receives the news of jobs.
pub(super) struct JobReceiver(pub(super) Rc<RefCell<Document>>);

impl Receiver for JobReceiver {
    type Message = JobNews;

    fn receive(&mut self, news: JobNews, thread: &mut Context) {
        let document = &mut *self.0.borrow_mut();
        match news {
            JobNews::Progress(ticket, progress) => document.show_progress(ticket, progress),
            JobNews::Loaded(ticket, loaded) => document.finish_loading(ticket, loaded),
            JobNews::SaveProgress(ticket, done) => document.show_save_progress(ticket, done),
            JobNews::SaveStep(ticket) => document.save_step(ticket, thread.now()),
            JobNews::Scanned(scan) => document.offer(scan),
            JobNews::Compared(loaded) => document.compared_read(loaded),
            JobNews::Retarget(news) => document.retarget_news(news, thread.now()),
            JobNews::Exported(done) => document.exported(*done),
            JobNews::Clips(news) => document.clip_news(news, thread.now()),
            JobNews::Checked(result) => document.checked(result),
            JobNews::SceneIncludes(news) => document.scene_includes_read(*news),
            JobNews::SceneModel(news) => document.scene_model_read(*news),
            JobNews::Poses(news) => document.poses_news(news),
        }
    }
}

/// Does the work of the document after the messages of an iteration.
pub(super) struct DocumentWorker(pub(super) Rc<RefCell<Document>>);

impl Worker for DocumentWorker {
    /// Publishes one view, however many changes there were, and only then does what may block on the disk.
    fn update(&mut self, thread: &mut Context) -> bool {
        let document = &mut *self.0.borrow_mut();
        document.publish();
        if let Some(due) = document.keep(thread.now()) {
            thread.wake_at(due);
        }
        true
    }
}
