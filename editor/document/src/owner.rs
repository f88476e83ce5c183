//! The document thread: owns what is open, loads in jobs, publishes the newest view, keeps the journal.

use super::handle::DocumentHandle;
use super::job::{JobNews, LoadJob};
use super::message::{DocumentMessage, DocumentReply, NewsBox, ScanBox};
use super::open::Open;
use super::recovering::{Decision, Scan, Waiting};
use super::saving::SaveOrder;
use super::{Change, LoadError, Loader, Offer, Source, View, open_model};
use crate::text::sentence;
use dragonfly_runtime::{Address, Context, Receiver, Thread, ThreadHandle, Worker};
use dragonfly_store::{Autosave, FileState};
use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::sync::Arc;
use std::time::Instant;

/// How a document is kept.
#[derive(Clone, Debug)]
pub struct Setup {
    /// How a model is opened.
    pub load: Loader,
    /// Where unsaved work is recorded; nowhere when `None`.
    pub autosave: Option<Autosave>,
    /// Panics at this change, once: for tests of what becomes of the work.
    pub fail_at: Option<u32>,
}

impl Default for Setup {
    fn default() -> Self {
        Self { load: open_model, autosave: None, fail_at: None }
    }
}

/// The document, as its own thread sees it.
pub struct Document {
    pub(super) open: Option<Open>,
    generation: u64,
    /// Has it changed since the last view?
    changed: bool,
    /// Number of the last numbered change that was carried out or refused.
    answered: u64,
    /// Whether a view has to tell the sender that a change was answered, though nothing changed.
    answers: bool,
    pub(super) job: Option<Running>,
    tickets: u64,
    load: Loader,
    pub(super) autosave: Option<Autosave>,
    /// Unsaved work of what is open, of which nothing is decided yet.
    pub(super) waiting: Option<Waiting>,
    /// What was found before the first model was there.
    pub(super) scan: Option<Scan>,
    /// Does a person wait for what is found?
    pub(super) searched: bool,
    /// How the file was when it was said that somebody else had changed it.
    noticed: Option<FileState>,
    /// Changes until a panic that a test asked for.
    fail_at: Rc<Cell<Option<u32>>>,
    replies: Address<DocumentReply>,
    /// The same, where the newest view takes the place of one that waits.
    views: Address<DocumentReply>,
    /// Who draws what is open, likewise.
    picture: Address<View>,
    /// Jobs send here.
    own: Address<DocumentMessage>,
}

pub(super) struct Running {
    /// Cancelled when this is dropped.
    _job: LoadJob,
    ticket: u64,
    pub(super) source: Source,
    /// Unsaved work that it is opened for.
    pub(super) offer: Option<(Offer, Decision)>,
}

/// One document, as receiver and as worker of its thread. When one of the two panics, both go on with a new one: nothing
/// half done is seen again, and what was recorded can be had back.
struct Shared(Rc<RefCell<Document>>);

impl Document {
    /// Starts the document thread; it answers to `replies`, and shows every state to `picture` without a detour. Nothing
    /// is recorded.
    pub fn start(replies: Address<DocumentReply>, picture: Address<View>) -> std::io::Result<DocumentHandle> {
        Self::start_with(Setup::default(), replies, picture)
    }

    /// The same, kept as `setup` says.
    pub fn start_with(
        setup: Setup,
        replies: Address<DocumentReply>,
        picture: Address<View>,
    ) -> std::io::Result<DocumentHandle> {
        let thread = Thread::start("document")?;
        let handle = Self::start_in(thread.handle(), setup, replies, picture);
        Ok(DocumentHandle { _owner: Some(thread), ..handle })
    }

    /// The same in a thread that somebody else owns and may turn by hand.
    pub fn start_in(
        thread: &ThreadHandle,
        setup: Setup,
        replies: Address<DocumentReply>,
        picture: Address<View>,
    ) -> DocumentHandle {
        let address = thread.reserve_address();
        let own = address.clone();
        // Fails only for a thread that has stopped, and then there is nobody to hear of it.
        let _ = thread.run(move |context| {
            let at = own.clone();
            let fail_at = Rc::new(Cell::new(setup.fail_at));
            let make = move || Self {
                open: None,
                generation: 0,
                changed: false,
                answered: 0,
                answers: false,
                job: None,
                tickets: 0,
                load: setup.load,
                autosave: setup.autosave.clone(),
                waiting: None,
                scan: None,
                searched: false,
                noticed: None,
                fail_at: Rc::clone(&fail_at),
                views: replies.latest(),
                picture: picture.latest(),
                replies: replies.clone(),
                own: own.clone(),
            };
            let document = Rc::new(RefCell::new(make()));
            document.borrow().search();
            let make = Rc::new(make);
            let again = move |fresh: &mut bool| {
                if !std::mem::replace(fresh, false) {
                    let mut lost = std::mem::replace(&mut *document.borrow_mut(), make());
                    // It may be half done: nothing more is written, and the journal has what was done.
                    drop(lost.open.take());
                    let mut document = document.borrow_mut();
                    (document.generation, document.tickets) = (lost.generation, lost.tickets);
                    document.answered = lost.answered;
                    document.reply(DocumentReply::Lost);
                    document.search();
                }
                Shared(Rc::clone(&document))
            };
            let (mut receives, mut works) = (true, true);
            let other = again.clone();
            context.register_restartable_receiver_at(&at, move |_| again(&mut receives));
            context.register_restartable_worker(move |_| other(&mut works));
        });
        DocumentHandle { thread: thread.clone(), address, _owner: None }
    }

    /// Looks for unsaved work of an earlier time, in a thread of its own.
    fn search(&self) {
        let Some(autosave) = self.autosave.clone() else { return };
        let own = self.own.clone();
        let search = move || {
            let _ = own.send(DocumentMessage::Found(ScanBox(Scan::of(&autosave))));
        };
        if let Err(error) = std::thread::Builder::new().name("recovery".to_owned()).spawn(search) {
            tracing::error!("unsaved work could not be looked for: {error}");
        }
    }

    pub(super) fn open(&mut self, source: Source, offer: Option<(Offer, Decision)>) {
        self.tickets += 1;
        let (ticket, own) = (self.tickets, self.own.clone());
        let tell = move |news| {
            // A document that has stopped does not want it any more.
            let _ = own.send(DocumentMessage::News(ticket, NewsBox(Box::new(news))));
        };
        match LoadJob::start(source.clone(), self.load, tell) {
            Ok(job) => self.job = Some(Running { _job: job, ticket, source, offer }),
            Err(error) => self.reply(DocumentReply::Failed { source, reason: error.to_string() }),
        }
    }

    fn cancel(&mut self) {
        if self.job.take().is_some() {
            self.reply(DocumentReply::Cancelled);
        }
    }

    fn hear(&mut self, ticket: u64, news: JobNews) {
        let Some(running) = self.job.take_if(|running| running.ticket == ticket) else { return };
        match news {
            JobNews::Progress(progress) => {
                let title = running.source.title();
                self.job = Some(running);
                self.reply(DocumentReply::Loading { title, progress });
            }
            JobNews::Done(Ok(opened)) => {
                self.close();
                let open = Open::new(*opened, self.autosave.clone());
                let loaded = Arc::clone(&open.loaded);
                self.open = Some(open);
                self.reply(DocumentReply::Opened(loaded));
                match running.offer {
                    Some((offer, decision)) => self.bring_back(&offer, decision),
                    None => self.begin_journal(),
                }
                self.tell_trouble();
                self.changed();
                self.offer_late();
            }
            JobNews::Done(Err(LoadError::Cancelled)) => self.reply(DocumentReply::Cancelled),
            JobNews::Done(Err(error)) => {
                let reason = error.to_string();
                self.reply(DocumentReply::Failed { source: running.source, reason });
                self.offer_late();
            }
        }
    }

    /// Lets go of what is open, before something else takes its place or the end.
    fn close(&mut self) {
        (self.waiting, self.noticed) = (None, None);
        let Some(mut open) = self.open.take() else { return };
        if !open.edited.is_saved() && !open.unwanted && self.autosave.is_some() {
            let text =
                format!("What was not saved of {} can be had back when it is opened again", open.file.title);
            self.reply(DocumentReply::Told(text));
        }
        if let Err(reason) = open.close(self.autosave.as_ref()) {
            self.reply(DocumentReply::Warned(reason));
        }
    }

    fn change(&mut self, change: Change, now: Instant) {
        if let Some(left) = self.fail_at.get() {
            self.fail_at.set(left.checked_sub(1));
            assert!(left != 1, "a test asked for it");
        }
        let Some(open) = &mut self.open else {
            return self.reply(DocumentReply::Refused("Nothing is open".to_owned()));
        };
        match open.change(change, now) {
            Ok(true) => self.changed(),
            Ok(false) => {}
            Err(error) => self.reply(DocumentReply::Refused(sentence(&error.to_string()))),
        }
        self.tell_trouble();
    }

    fn save(&mut self, order: SaveOrder, now: Instant) {
        let autosave = self.autosave.clone();
        let Some(open) = &mut self.open else { return };
        match open.save(&order, autosave.as_ref(), now) {
            Ok(saved) => {
                self.noticed = None;
                self.reply(DocumentReply::Saved(saved));
            }
            Err(reason) => self.reply(DocumentReply::NotSaved(order, reason)),
        }
        self.tell_trouble();
        self.changed();
    }

    fn plan(&mut self, order: Option<SaveOrder>) {
        let Some(open) = &self.open else { return };
        self.reply(DocumentReply::Plan(open.plan(), order));
    }

    fn revert(&mut self, now: Instant) {
        let Some(open) = &mut self.open else { return };
        if open.revert(now) {
            self.changed();
        } else if let Some(path) = open.file.path.clone() {
            // No undo leads there any more: it is read again.
            self.open(Source::File(path), None);
        } else {
            self.reply(DocumentReply::Refused(
                "It was never saved, so there is nothing to go back to".to_owned(),
            ));
        }
    }

    fn look_at_file(&mut self) {
        let state = self.open.as_ref().and_then(Open::changed_on_disk);
        // Said once; a person who went on working knows.
        if let Some(state) = state.filter(|state| self.noticed != Some(*state)) {
            self.reply(DocumentReply::FileChanged(state));
        }
        self.noticed = state;
    }

    /// The state is another from now on; it is published when all that came with this change is done.
    pub(super) fn changed(&mut self) {
        self.generation += 1;
        self.changed = true;
    }

    /// Shows the newest state to everybody.
    fn publish(&mut self) {
        let changed = std::mem::take(&mut self.changed);
        self.answers = false;
        let Some(view) = self.open.as_ref().map(|open| open.view(self.generation)) else { return };
        let view = View { answered: self.answered, ..view };
        // As in `reply`; the picture first, because nobody has to be quick for it.
        if changed {
            let _ = self.picture.send(view.clone());
        }
        let _ = self.views.send(DocumentReply::View(view));
    }

    pub(super) fn tell_trouble(&mut self) {
        let trouble = self.open.as_mut().map(|open| open.keeper.trouble()).unwrap_or_default();
        trouble.into_iter().for_each(|text| self.reply(DocumentReply::Warned(text)));
    }

    pub(super) fn reply(&self, reply: DocumentReply) {
        // The main thread stops last; when it has, nobody looks any more.
        let _ = self.replies.send(reply);
    }
}

impl Drop for Document {
    fn drop(&mut self) {
        if let Some(open) = &mut self.open
            && let Err(reason) = open.close(self.autosave.as_ref())
        {
            tracing::warn!("{reason}");
        }
    }
}

impl Receiver for Shared {
    type Message = DocumentMessage;

    fn receive(&mut self, message: DocumentMessage, thread: &mut Context) {
        let document = &mut *self.0.borrow_mut();
        let now = thread.now();
        match message {
            DocumentMessage::Open(source) => document.open(source, None),
            DocumentMessage::CancelLoading => document.cancel(),
            DocumentMessage::Change(change) => document.change(change, now),
            DocumentMessage::NumberedChange(number, change) => {
                document.change(change, now);
                document.answered = number;
                document.answers = true;
            }
            DocumentMessage::Save(order) => document.save(order, now),
            DocumentMessage::Plan(order) => document.plan(order),
            DocumentMessage::Revert => document.revert(now),
            DocumentMessage::Leave(then) => {
                let unsaved = document.open.as_ref().is_some_and(|open| !open.edited.is_saved());
                document.reply(DocumentReply::Leave(then, unsaved));
            }
            DocumentMessage::DoNotSave => {
                if let Some(open) = &mut document.open {
                    open.unwanted = true;
                }
            }
            DocumentMessage::LookAtFile => document.look_at_file(),
            DocumentMessage::Search => {
                document.searched = true;
                document.search();
            }
            DocumentMessage::Decide(offer, decision) => document.decide(*offer, decision),
            DocumentMessage::FoundAt(offer, path) => document.found_at(*offer, path),
            DocumentMessage::News(ticket, NewsBox(news)) => document.hear(ticket, *news),
            DocumentMessage::Found(ScanBox(scan)) => document.offer(scan),
        }
    }
}

impl Worker for Shared {
    /// Behind all messages of the iteration: however many changes they brought, one view goes out. Only then comes what
    /// may have to wait for the disk.
    fn update(&mut self, thread: &mut Context) -> bool {
        let document = &mut *self.0.borrow_mut();
        if document.changed || document.answers {
            document.publish();
        }
        let now = thread.now();
        if let Some(open) = &mut document.open {
            open.keep(now);
            if let Some(due) = open.keeper.next_due() {
                thread.wake_at(due);
            }
            document.tell_trouble();
        }
        true
    }
}
