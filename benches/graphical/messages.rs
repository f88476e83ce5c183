//! A document that one thread owns: edits are sent to it, and it sends its newest view to the graphics thread.
//!
//! A view is a reference to the whole document. An edit copies shared data before it changes it; so the first edit
//! after a view was published pays for a copy, and those that follow before the next view do not.
//!
//! | name | edits | views |
//! |---|---|---|
//! | messages | each | after each edit |
//! | messages, newest | each | after all queued edits; a newer view replaces the queued one |
//! | messages, relayed | each | as "newest", but sent through the main thread |
//! | messages, read | each | as "newest", and also to the main thread, which reads its answers from them |
//! | messages, merged | in one gesture, a newer edit replaces the queued one | as "newest" |
//! | messages, on demand | each | when a frame is due and requests one |
//! | messages, batched | each, without a wake-up | as "on demand"; all queued edits are applied then |
//! | messages, spinning | each | as "newest"; the document's thread spins before it sleeps |

use super::document::{EditedData, NumberedEdit, SharedDocument};
use super::frame::{PoseAnswer, PoseQuestion, shown};
use super::ledger::Ledger;
use super::sharing::{Sharing, SharingParts, SharingStart, TimedAnswer, Viewing};
use super::views::{DocumentRef, NewestView, OnDemandView};
use dragonfly_anim::data::Take;
use dragonfly_runtime::{Address, Captured, Context, Next, Receiver, Thread, Worker};
use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::sync::{Arc, mpsc};
use std::time::{Duration, Instant};

/// Messages to the document's thread.
pub(super) enum ToDocument {
    NumberedEdit(NumberedEdit),
    Ask(PoseQuestion, Address<PoseAnswer>),
    /// A request of the graphics thread for the newest view, even if it already has it.
    Publish,
    /// A request for the document, for the comparison at the end.
    Give(mpsc::Sender<SharedDocument>),
}

/// Configuration: when views are sent, to which thread, and how edits are sent.
#[derive(Clone, Copy, Default)]
struct MessageMethod {
    each: bool,
    relayed: bool,
    read: bool,
    merges: bool,
    on_demand: bool,
    batched: bool,
    spin: Duration,
}

/// A message for every edit, and a view after every edit.
pub fn plain(start: SharingStart) -> SharingParts {
    begin(start, MessageMethod { each: true, ..MessageMethod::default() })
}

/// A message for every edit; a view when no more edits are queued.
pub fn newest(start: SharingStart) -> SharingParts {
    begin(start, MessageMethod::default())
}

/// As [`newest`], with views sent to the main thread, which forwards them.
pub fn relayed(start: SharingStart) -> SharingParts {
    begin(start, MessageMethod { relayed: true, ..MessageMethod::default() })
}

/// As [`newest`], with views also sent to the main thread, which reads answers from them.
pub fn read(start: SharingStart) -> SharingParts {
    begin(start, MessageMethod { read: true, ..MessageMethod::default() })
}

/// As [`newest`], with queued edits of one gesture replacing one another.
pub fn merged(start: SharingStart) -> SharingParts {
    begin(start, MessageMethod { merges: true, ..MessageMethod::default() })
}

/// A message for every edit; a view when a frame requests one.
pub fn on_demand(start: SharingStart) -> SharingParts {
    begin(start, MessageMethod { on_demand: true, ..MessageMethod::default() })
}

/// The document's thread pauses between frames, so that edits do not wake it; the frame that requests a view does.
pub fn batched(start: SharingStart) -> SharingParts {
    begin(start, MessageMethod { on_demand: true, batched: true, ..MessageMethod::default() })
}

/// As [`newest`], with a document's thread that spins before it sleeps.
pub fn spinning(start: SharingStart) -> SharingParts {
    begin(start, MessageMethod { spin: Duration::from_millis(2), ..MessageMethod::default() })
}

/// The document in its thread.
struct DocumentOwner {
    document: DocumentRef,
    originals: Vec<Arc<Take>>,
    views: Vec<Address<DocumentRef>>,
    kind: MessageMethod,
    changed: bool,
    ledger: Arc<Ledger>,
}

impl DocumentOwner {
    fn publish(&mut self) {
        for views in &self.views {
            // Fails only when the graphics thread has stopped.
            let _ = views.send(Arc::clone(&self.document));
        }
        if !self.kind.relayed {
            self.ledger.publish(shown(&self.document.takes).number);
        }
        self.changed = false;
    }
}

impl Receiver for DocumentOwner {
    type Message = ToDocument;

    fn receive(&mut self, message: ToDocument, thread: &mut Context) {
        match message {
            ToDocument::NumberedEdit(edit) => {
                let number = edit.number;
                let ready = edit.prepare(&self.originals);
                drop(Arc::make_mut(&mut self.document).apply(ready));
                self.ledger.apply(number);
                self.changed = true;
                if self.kind.each {
                    self.publish();
                }
            }
            ToDocument::Ask(question, to) => {
                let answer = question.answer(shown(&self.document.takes), &self.document.skeleton);
                // Fails only when the thread that asked has stopped.
                let _ = to.send(answer);
            }
            ToDocument::Publish => {
                if self.kind.batched {
                    // Paused before the view is sent, because its receiver may request the next one, which must end
                    // this pause.
                    thread.pause();
                }
                if !self.changed {
                    // The receiver recognizes an answer because it is a different view.
                    self.document = Arc::new((*self.document).clone());
                }
                self.publish();
            }
            ToDocument::Give(to) => _ = to.send((*self.document).clone()),
        }
    }
}

impl Worker for DocumentOwner {
    fn update(&mut self, _thread: &mut Context) -> bool {
        if self.changed && !self.kind.on_demand {
            self.publish();
        }
        true
    }
}

/// Forwards views from the main thread.
struct Relay {
    to: Address<DocumentRef>,
    ledger: Arc<Ledger>,
}

impl Receiver for Relay {
    type Message = DocumentRef;

    fn receive(&mut self, view: DocumentRef, _thread: &mut Context) {
        let number = shown(&view.takes).number;
        let _ = self.to.send(view);
        self.ledger.publish(number);
    }
}

/// Stores the newest message until it is read.
struct LatestValue<M>(Rc<Cell<Option<M>>>);

impl<M: Send + 'static> Receiver for LatestValue<M> {
    type Message = M;

    fn receive(&mut self, message: M, _thread: &mut Context) {
        self.0.set(Some(message));
    }
}

/// The main thread's side.
struct MessageSharing {
    thread: Thread,
    address: Address<ToDocument>,
    /// The `latest` address of the current gesture, where edits replace one another.
    gesture: Option<Address<ToDocument>>,
    merges: bool,
    answer: Rc<Cell<Option<PoseAnswer>>>,
    answers: Address<PoseAnswer>,
    /// The newest view, where the main thread receives views.
    view: Option<Rc<Cell<Option<DocumentRef>>>>,
}

impl Sharing for MessageSharing {
    fn edit(&mut self, edit: NumberedEdit, begins: bool) {
        // Only edits of one key may replace one another, and none may overtake edits sent before its gesture began.
        let mergeable = self.merges && matches!(edit.change, EditedData::Key(..));
        if !mergeable {
            self.gesture = None;
        } else if begins || self.gesture.is_none() {
            self.gesture = Some(self.address.latest());
        }
        let to = self.gesture.as_ref().unwrap_or(&self.address);
        to.send(ToDocument::NumberedEdit(edit)).expect("the document lives as long as this");
    }

    fn ask(&mut self, question: PoseQuestion, main: &mut Captured) -> TimedAnswer {
        if let Some(newest) = &self.view {
            return TimedAnswer::at_once(|| {
                let view = newest.take().expect("there has always been one");
                let answer = question.answer(shown(&view.takes), &view.skeleton);
                newest.set(Some(view));
                answer
            });
        }
        let begin = Instant::now();
        let message = ToDocument::Ask(question, self.answers.clone());
        self.address.send(message).expect("the document lives as long as this");
        self.thread.handle().resume();
        let blocked = begin.elapsed();
        loop {
            if let Some(answer) = self.answer.take() {
                return TimedAnswer { answer, blocked };
            }
            // The main thread could do other work here; it has none.
            if main.iterate() == Next::OnMessage && self.answer.get().is_none() {
                std::thread::park();
            }
        }
    }

    fn document(&mut self, main: &mut Captured) -> SharedDocument {
        let (to, from) = mpsc::channel();
        self.address.send(ToDocument::Give(to)).expect("the document lives as long as this");
        self.thread.handle().resume();
        main.iterate();
        from.recv().expect("it is given")
    }

    fn backlog(&self, posted: u64, ledger: &Ledger) -> u64 {
        posted.saturating_sub(ledger.applied())
    }
}

fn begin(start: SharingStart, kind: MessageMethod) -> SharingParts {
    let SharingStart { document, graphics, main, ledger } = start;
    let drawn: Address<DocumentRef> = graphics.reserve_address();
    let mut views = vec![if kind.each { drawn.clone() } else { drawn.latest() }];
    let originals = document.originals();
    let first = Arc::new(document);
    let mut view = None;
    if kind.relayed {
        let relay = Relay { to: views.remove(0), ledger: Arc::clone(ledger) };
        views.push(main.context().register_receiver(relay).latest());
    }
    if kind.read {
        let newest = Rc::new(Cell::new(Some(Arc::clone(&first))));
        views.push(main.context().register_receiver(LatestValue(Rc::clone(&newest))).latest());
        view = Some(newest);
    }
    let thread = Thread::start("document").expect("the system has a thread left");
    thread.handle().set_spin(kind.spin);
    let address = thread.handle().reserve_address();
    let (own, document, ledger) = (address.clone(), Arc::clone(&first), Arc::clone(ledger));
    let register = move |context: &mut Context| {
        let owner = DocumentOwner { document, originals, views, kind, changed: false, ledger };
        let owner = Rc::new(RefCell::new(owner));
        context.register_receiver_at(&own, Rc::clone(&owner));
        context.register_worker(owner);
    };
    thread.handle().run(register).expect("it was just started");
    let answer = Rc::new(Cell::new(None));
    let answers = main.context().register_receiver(LatestValue(Rc::clone(&answer)));
    let asked = (address.clone(), kind.batched.then(|| thread.handle().clone()));
    let merges = kind.merges;
    let sharing = MessageSharing { thread, address, gesture: None, merges, answer, answers, view };
    let viewing = Box::new(move |graphics: &mut Context| {
        let newest = NewestView::new(first, &drawn, graphics);
        match kind.on_demand {
            true => Box::new(OnDemandView::new(newest, asked.0, asked.1)) as Box<dyn Viewing>,
            false => Box::new(newest),
        }
    });
    SharingParts { sharing: Box::new(sharing), viewing }
}
