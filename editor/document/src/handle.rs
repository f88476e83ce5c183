//! The handle by which other threads send messages to the document.

use super::message::DocumentMessage;
use super::{Change, Source};
use dragonfly_runtime::{Address, Thread, ThreadHandle};

/// A handle to the document thread. Messages and changes are handled in the order in which they were sent.
pub struct DocumentHandle {
    pub(super) thread: ThreadHandle,
    pub(super) messages: Address<DocumentMessage>,
    pub(super) changes: Address<(Change, Option<u64>)>,
    /// The thread, where this handle owns it.
    pub(super) _owner: Option<Thread>,
}

impl DocumentHandle {
    /// See [`DocumentMessage::Open`].
    pub fn open(&self, source: Source) {
        self.send(DocumentMessage::Open { source, anyway: false });
    }

    /// Sends a change.
    pub fn change(&self, change: Change) {
        report_stopped(self.changes.send((change, None)).is_ok());
    }

    /// Sends a change whose sender waits for the outcome: the first view with [`View::answered`](super::View::answered) at or
    /// above the number contains the change, or was made after it was refused. Numbers ascend and begin at 1.
    pub fn change_numbered(&self, number: u64, change: Change) {
        report_stopped(self.changes.send((change, Some(number))).is_ok());
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
        report_stopped(self.messages.send(message).is_ok())
    }
}

/// Logs that a message could not be sent. Returns `sent`.
fn report_stopped(sent: bool) -> bool {
    if !sent {
        tracing::error!("the document thread has stopped");
    }
    sent
}
