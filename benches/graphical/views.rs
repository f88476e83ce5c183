//! Views in the graphics thread: those that are sent to it, and those that it asks for when a frame is due.

use super::document::SharedDocument;
use super::frame::{FrameWork, shown};
use super::ledger::Ledger;
use super::messages::ToDocument;
use super::sharing::Viewing;
use dragonfly_runtime::{Address, Context, Receiver, ThreadHandle};
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The document as it was; whoever edits it copies what it alters.
pub(super) type DocumentRef = Arc<SharedDocument>;

/// The newest view that has come.
pub(super) struct NewestView {
    view: Rc<RefCell<DocumentRef>>,
    promised: u64,
}

impl NewestView {
    /// Shows `first` until a view comes to `address`.
    pub(super) fn new(first: DocumentRef, address: &Address<DocumentRef>, thread: &mut Context) -> Self {
        let view = Rc::new(RefCell::new(first));
        thread.register_receiver_at(address, ViewReceiver(Rc::clone(&view)));
        Self { view, promised: 0 }
    }
}

impl Viewing for NewestView {
    fn frame(&mut self, frame: &mut FrameWork) {
        let view = Arc::clone(&self.view.borrow());
        frame.read(shown(&view.takes));
        frame.draw();
        frame.confirm(shown(&view.takes));
    }

    /// What had been published before the messages of this iteration were taken out of the queue.
    fn promise(&mut self, ledger: &Ledger) -> u64 {
        std::mem::replace(&mut self.promised, ledger.published())
    }
}

struct ViewReceiver(Rc<RefCell<DocumentRef>>);

impl Receiver for ViewReceiver {
    type Message = DocumentRef;

    fn receive(&mut self, view: DocumentRef, _thread: &mut Context) {
        *self.0.borrow_mut() = view;
    }
}

/// A view is asked for when a frame is due, and the frame begins when it has come: so there is one copy and one wake-up a
/// frame, however many edits there are, and the view is as fresh as it can be.
pub(super) struct Asking {
    newest: NewestView,
    document: Address<ToDocument>,
    /// The document's thread, where it pauses between frames.
    pausing: Option<ThreadHandle>,
    /// When it was asked for, and which view was there then.
    asked: Option<(Instant, DocumentRef)>,
}

/// A document that is busy does not hold up the picture any longer than this; the frame shows the view that is there.
const PATIENCE: Duration = Duration::from_millis(2);

impl Asking {
    /// Asks `document`, which answers to where `newest` looks.
    pub(super) fn new(
        newest: NewestView,
        document: Address<ToDocument>,
        pausing: Option<ThreadHandle>,
    ) -> Self {
        Self { newest, document, pausing, asked: None }
    }
}

impl Viewing for Asking {
    fn frame(&mut self, frame: &mut FrameWork) {
        self.newest.frame(frame);
    }

    fn promise(&mut self, ledger: &Ledger) -> u64 {
        self.newest.promise(ledger)
    }

    fn is_ready(&mut self, thread: &mut Context) -> bool {
        let now = Instant::now();
        let Some((when, old)) = &self.asked else {
            // A document that has stopped does not answer; the frame begins without it.
            let _ = self.document.send(ToDocument::Publish);
            if let Some(pausing) = &self.pausing {
                pausing.resume();
            }
            self.asked = Some((now, Arc::clone(&self.newest.view.borrow())));
            thread.wake_at(now + PATIENCE);
            return false;
        };
        let ready = now >= *when + PATIENCE || !Arc::ptr_eq(old, &self.newest.view.borrow());
        if ready {
            self.asked = None;
        } else {
            thread.wake_at(*when + PATIENCE);
        }
        ready
    }
}
