//! The document, as other threads see it.

use super::message::DocumentMessage;
use super::{Change, Source};
use dragonfly_runtime::{Address, Thread, ThreadHandle};

/// The document, as other threads see it: the same names, as messages.
pub struct DocumentHandle {
    pub(super) thread: ThreadHandle,
    pub(super) address: Address<DocumentMessage>,
    /// `None` where somebody else owns the thread.
    pub(super) _owner: Option<Thread>,
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

    /// See [`DocumentMessage::NumberedChange`].
    pub fn change_numbered(&self, number: u64, change: Change) {
        self.send(DocumentMessage::NumberedChange(number, change));
    }

    /// Its thread.
    pub fn thread(&self) -> &ThreadHandle {
        &self.thread
    }

    /// Ends the thread behind what it was told so far; jobs are cancelled.
    pub fn stop(&self) {
        self.thread.remote_stop();
    }

    /// Tells it anything; `false` when nobody hears any more.
    pub fn send(&self, message: DocumentMessage) -> bool {
        let heard = self.address.send(message).is_ok();
        if !heard {
            tracing::error!("the document thread has stopped");
        }
        heard
    }
}
