//! The document thread: owns what is open, loads in jobs, publishes the newest view.

use super::job::{JobNews, LoadJob};
use super::open::Open;
use super::{Change, LoadError, LoadedModel, Loader, Progress, Source, View, load_model};
use dragonfly_runtime::{Address, Context, Receiver, Thread, ThreadHandle, Worker};
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;

/// What other threads may tell the document.
#[derive(Debug)]
pub enum DocumentMessage {
    /// Opens a model in place of the one that is open; what is being loaded is given up.
    Open(Source),
    /// Gives up what is being loaded.
    CancelLoading,
    /// Edits what is open, undoes, does again.
    Change(Change),
    /// From a job; `ticket` tells whether anybody still waits for it.
    #[doc(hidden)]
    News(u64, NewsBox),
}

/// What a job says, opaque to others.
#[derive(Debug)]
pub struct NewsBox(JobNews);

/// What the document tells the main thread, for the panels.
#[derive(Debug)]
pub enum DocumentReply {
    /// The newest state; it takes the place of one that still waits, so it may overtake what else is said.
    View(View),
    /// What was on its way is open: said once for each, in order with the other answers.
    Opened(Arc<LoadedModel>),
    /// A model is on its way.
    Loading {
        /// Its title.
        title: String,
        /// How far it is.
        progress: Progress,
    },
    /// Loading was given up on request; what was open still is.
    Cancelled,
    /// Loading failed; what was open still is.
    Failed {
        /// What was to be opened.
        source: Source,
        /// Place and reason.
        reason: String,
    },
    /// An edit could not be done, and nothing changed.
    Refused(String),
}

/// The document, as its own thread sees it.
pub struct Document {
    open: Option<Open>,
    generation: u64,
    /// Has it changed since the last view?
    changed: bool,
    job: Option<Running>,
    tickets: u64,
    load: Loader,
    replies: Address<DocumentReply>,
    /// The same, where the newest view takes the place of one that waits.
    views: Address<DocumentReply>,
    /// Who draws what is open, likewise.
    picture: Address<View>,
    /// Jobs send here.
    own: Address<DocumentMessage>,
}

struct Running {
    /// Cancelled when this is dropped.
    _job: LoadJob,
    ticket: u64,
    source: Source,
}

/// The document, as other threads see it: the same names, as messages.
pub struct DocumentHandle {
    thread: ThreadHandle,
    address: Address<DocumentMessage>,
    /// `None` where somebody else owns the thread.
    _owner: Option<Thread>,
}

impl Document {
    /// Starts the document thread; it answers to `replies`, and shows every state to `picture` without a detour.
    pub fn start(replies: Address<DocumentReply>, picture: Address<View>) -> std::io::Result<DocumentHandle> {
        Self::start_with(load_model, replies, picture)
    }

    /// The same, with another way to open a model: one that fails as a test wants it to.
    pub fn start_with(
        load: Loader,
        replies: Address<DocumentReply>,
        picture: Address<View>,
    ) -> std::io::Result<DocumentHandle> {
        let thread = Thread::start("document")?;
        let handle = Self::start_in(thread.handle(), load, replies, picture);
        Ok(DocumentHandle { _owner: Some(thread), ..handle })
    }

    /// The same in a thread that somebody else owns and may turn by hand.
    pub fn start_in(
        thread: &ThreadHandle,
        load: Loader,
        replies: Address<DocumentReply>,
        picture: Address<View>,
    ) -> DocumentHandle {
        let address = thread.reserve_address();
        let own = address.clone();
        // Fails only for a thread that has stopped, and then there is nobody to hear of it.
        let _ = thread.run(move |context| {
            let at = own.clone();
            let document = Rc::new(RefCell::new(Self {
                open: None,
                generation: 0,
                changed: false,
                job: None,
                tickets: 0,
                load,
                views: replies.latest(),
                picture: picture.latest(),
                replies,
                own,
            }));
            context.register_receiver_at(&at, Rc::clone(&document));
            context.register_worker(document);
        });
        DocumentHandle { thread: thread.clone(), address, _owner: None }
    }

    fn open(&mut self, source: Source) {
        self.tickets += 1;
        let (ticket, own) = (self.tickets, self.own.clone());
        let tell = move |news| {
            // A document that has stopped does not want it any more.
            let _ = own.send(DocumentMessage::News(ticket, NewsBox(news)));
        };
        match LoadJob::start(source.clone(), self.load, tell) {
            Ok(job) => self.job = Some(Running { _job: job, ticket, source }),
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
            JobNews::Done(Ok(loaded)) => {
                let loaded = Arc::new(loaded);
                self.open = Some(Open::new(Arc::clone(&loaded)));
                self.changed();
                self.reply(DocumentReply::Opened(loaded));
            }
            JobNews::Done(Err(LoadError::Cancelled)) => self.reply(DocumentReply::Cancelled),
            JobNews::Done(Err(error)) => {
                let reason = error.to_string();
                self.reply(DocumentReply::Failed { source: running.source, reason });
            }
        }
    }

    fn change(&mut self, change: Change) {
        let Some(open) = &mut self.open else { return };
        match open.change(change) {
            Ok(true) => self.changed(),
            Ok(false) => {}
            Err(error) => self.reply(DocumentReply::Refused(error.to_string())),
        }
    }

    /// The state is another from now on; it is published when all that came with this change is done.
    fn changed(&mut self) {
        self.generation += 1;
        self.changed = true;
    }

    /// Shows the newest state to everybody.
    fn publish(&mut self) {
        let Some(view) = self.open.as_ref().map(|open| open.view(self.generation)) else { return };
        // As in `reply`; the picture first, because nobody has to be quick for it.
        let _ = self.picture.send(view.clone());
        let _ = self.views.send(DocumentReply::View(view));
    }

    fn reply(&self, reply: DocumentReply) {
        // The main thread stops last; when it has, nobody looks any more.
        let _ = self.replies.send(reply);
    }
}

impl Receiver for Document {
    type Message = DocumentMessage;

    fn receive(&mut self, message: DocumentMessage, _thread: &mut Context) {
        match message {
            DocumentMessage::Open(source) => self.open(source),
            DocumentMessage::CancelLoading => self.cancel(),
            DocumentMessage::Change(change) => self.change(change),
            DocumentMessage::News(ticket, NewsBox(news)) => self.hear(ticket, news),
        }
    }
}

impl Worker for Document {
    /// Behind all messages of the iteration: however many changes they brought, one view goes out.
    fn update(&mut self, _thread: &mut Context) -> bool {
        if std::mem::take(&mut self.changed) {
            self.publish();
        }
        true
    }
}

impl DocumentHandle {
    /// See [`DocumentMessage::Open`].
    pub fn open(&self, source: Source) {
        self.send(DocumentMessage::Open(source));
    }

    /// See [`DocumentMessage::CancelLoading`].
    pub fn cancel_loading(&self) {
        self.send(DocumentMessage::CancelLoading);
    }

    /// See [`DocumentMessage::Change`].
    pub fn change(&self, change: Change) {
        self.send(DocumentMessage::Change(change));
    }

    /// Its thread.
    pub fn thread(&self) -> &ThreadHandle {
        &self.thread
    }

    /// Ends the thread behind what it was told so far; jobs are cancelled.
    pub fn stop(&self) {
        self.thread.remote_stop();
    }

    fn send(&self, message: DocumentMessage) {
        if self.address.send(message).is_err() {
            tracing::error!("the document thread has stopped");
        }
    }
}
