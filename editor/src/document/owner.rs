//! The document thread: owns what is open, loads in jobs, publishes the newest view.

use super::job::{JobNews, LoadJob};
use super::{LoadError, LoadedModel, Loader, Progress, Source, View, load_model};
use dragonfly_runtime::{Address, Context, Receiver, Thread, ThreadHandle};
use std::sync::Arc;

/// What other threads may tell the document.
#[derive(Debug)]
pub enum DocumentMessage {
    /// Opens a model in place of the one that is open; what is being loaded is given up.
    Open(Source),
    /// Gives up what is being loaded.
    CancelLoading,
    /// From a job; `ticket` tells whether anybody still waits for it.
    #[doc(hidden)]
    News(u64, NewsBox),
}

/// What a job says, opaque to others.
#[derive(Debug)]
pub struct NewsBox(JobNews);

/// What the document tells the main thread.
#[derive(Debug)]
pub enum DocumentReply {
    /// The newest state.
    View(View),
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
}

/// The document, as its own thread sees it.
pub struct Document {
    open: Option<Arc<LoadedModel>>,
    generation: u64,
    job: Option<Running>,
    tickets: u64,
    load: Loader,
    replies: Address<DocumentReply>,
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
    thread: Thread,
    address: Address<DocumentMessage>,
}

impl Document {
    /// Starts the document thread; it answers to `replies`.
    pub fn start(replies: Address<DocumentReply>) -> std::io::Result<DocumentHandle> {
        Self::start_with(load_model, replies)
    }

    /// The same, with another way to open a model: one that fails as a test wants it to.
    pub fn start_with(load: Loader, replies: Address<DocumentReply>) -> std::io::Result<DocumentHandle> {
        let thread = Thread::start("document")?;
        let handle = thread.handle();
        let address = handle.reserve_address();
        let own = address.clone();
        handle.register_receiver_at(&address, move |_| Self {
            open: None,
            generation: 0,
            job: None,
            tickets: 0,
            load,
            replies,
            own,
        });
        Ok(DocumentHandle { thread, address })
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
                self.open = Some(Arc::clone(&loaded));
                self.generation += 1;
                self.reply(DocumentReply::View(View { generation: self.generation, loaded }));
            }
            JobNews::Done(Err(LoadError::Cancelled)) => self.reply(DocumentReply::Cancelled),
            JobNews::Done(Err(error)) => {
                let reason = error.to_string();
                self.reply(DocumentReply::Failed { source: running.source, reason });
            }
        }
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
            DocumentMessage::News(ticket, NewsBox(news)) => self.hear(ticket, news),
        }
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

    /// Its thread.
    pub fn thread(&self) -> &ThreadHandle {
        self.thread.handle()
    }

    /// Ends the thread behind what it was told so far; jobs are cancelled.
    pub fn stop(&self) {
        self.thread.handle().remote_stop();
    }

    fn send(&self, message: DocumentMessage) {
        if self.address.send(message).is_err() {
            tracing::error!("the document thread has stopped");
        }
    }
}
