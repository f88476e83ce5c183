//! Views in the graphics thread: sent to it, or requested by it when a frame is due.

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

/// A version of the document; an edit copies the shared data that it changes.
pub(super) type DocumentRef = Arc<SharedDocument>;

/// The newest view that has arrived.
pub(super) struct NewestView {
    view: Rc<RefCell<DocumentRef>>,
    promised: u64,
}

impl NewestView {
    /// Shows `first` until a view arrives at `address`.
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

    /// Returns the edit that was published before the messages of this iteration were taken from the queue.
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

/// A view is requested when a frame is due, and the frame starts when it arrives: so there is one copy and one wake-up
/// for each frame, however many edits there are, and the view is as fresh as possible.
pub(super) struct OnDemandView {
    newest: NewestView,
    document: Address<ToDocument>,
    /// The document's thread, if it pauses between frames.
    pausing: Option<ThreadHandle>,
    /// Time of the request, and the view at that time.
    asked: Option<(Instant, DocumentRef)>,
}

/// Longest time that a busy document delays a frame; then the frame shows the existing view.
const PATIENCE: Duration = Duration::from_millis(2);

impl OnDemandView {
    /// Returns a graphics thread's side that requests views from `document`, which arrive in `newest`.
    pub(super) fn new(
        newest: NewestView,
        document: Address<ToDocument>,
        pausing: Option<ThreadHandle>,
    ) -> Self {
        Self { newest, document, pausing, asked: None }
    }
}

impl Viewing for OnDemandView {
    fn frame(&mut self, frame: &mut FrameWork) {
        self.newest.frame(frame);
    }

    fn promise(&mut self, ledger: &Ledger) -> u64 {
        self.newest.promise(ledger)
    }

    fn is_ready(&mut self, thread: &mut Context) -> bool {
        let now = Instant::now();
        let Some((when, old)) = &self.asked else {
            // A document that has stopped does not answer; the frame starts without it.
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
