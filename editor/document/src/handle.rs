//! The handle by which other threads send messages to the document.

use super::message::DocumentMessage;
use super::{Change, Source};
use dragonfly_runtime::{Address, Thread, ThreadHandle};

/// A handle to the document thread. Each method sends the message of the same name.
pub struct DocumentHandle {
    pub(super) thread: ThreadHandle,
    pub(super) address: Address<DocumentMessage>,
    /// The thread, where this handle owns it.
    pub(super) _owner: Option<Thread>,
}

impl DocumentHandle {
    /// See [`DocumentMessage::Open`].
    pub fn open(&self, source: Source) {
        self.send(DocumentMessage::Open { source, anyway: false });
    }

    /// See [`DocumentMessage::CancelLoading`].
    pub fn cancel_loading(&self) {
        self.send(DocumentMessage::CancelLoading);
    }

    /// See [`DocumentMessage::Change`].
    pub fn change(&self, change: Change) {
        self.send(DocumentMessage::Change(change));
    }

    /// Sends a numbered change; see [`DocumentMessage::NumberedChange`].
    pub fn change_numbered(&self, number: u64, change: Change) {
        self.send(DocumentMessage::NumberedChange(number, change));
    }

    /// Returns the document thread.
    pub fn thread(&self) -> &ThreadHandle {
        &self.thread
    }

    /// Stops the thread after the messages that were sent so far. Jobs are cancelled.
    pub fn stop(&self) {
        self.thread.remote_stop();
    }

    /// Sends a message. Returns `false` if the thread has stopped.
    pub fn send(&self, message: DocumentMessage) -> bool {
        let sent = self.address.send(message).is_ok();
        if !sent {
            tracing::error!("the document thread has stopped");
        }
        sent
    }
}
