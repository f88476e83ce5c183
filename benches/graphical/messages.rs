//! A document that one thread owns: edits are sent to it, and it sends its newest view to those who draw it.
//!
//! A view is a reference to the whole document. What somebody else still has is copied when it is edited, as far as it must
//! be; so the first edit after a view was published pays for a copy, and those that follow before the next view do not.
//!
//! | name | edits | views |
//! |---|---|---|
//! | messages | each | after each edit |
//! | messages, newest | each | after all edits that were waiting; a newer one replaces the one that waits |
//! | messages, relayed | each | likewise, but by way of the main thread |
//! | messages, merged | in one gesture, a newer one replaces the one that waits | likewise |

use super::document::{Document, Edit};
use super::frame::{Answer, Frame, Question, shown};
use super::ledger::Ledger;
use super::sharing::{Asked, Sharing, Start, Started, Viewing};
use dragonfly_anim::data::Take;
use dragonfly_runtime::{Address, Captured, Context, Next, Receiver, Thread, Worker};
use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::sync::{Arc, mpsc};
use std::time::Instant;

type View = Arc<Document>;

/// What the document's thread understands.
enum ToDocument {
    Edit(Edit),
    Ask(Question, Address<Answer>),
    /// For the comparison at the end.
    Give(mpsc::Sender<Document>),
}

/// The document in its thread.
struct Owner {
    document: View,
    originals: Vec<Arc<Take>>,
    views: Address<View>,
    /// For those who are to hear of every edit.
    each: bool,
    changed: bool,
    ledger: Arc<Ledger>,
    /// Does somebody else pass the views on, and say so then?
    relayed: bool,
}

impl Owner {
    fn publish(&mut self) {
        let number = shown(&self.document.takes).number;
        // Who draws may have stopped; then nobody looks.
        let _ = self.views.send(Arc::clone(&self.document));
        if !self.relayed {
            self.ledger.publish(number);
        }
        self.changed = false;
    }
}

impl Receiver for Owner {
    type Message = ToDocument;

    fn receive(&mut self, message: ToDocument, _thread: &mut Context) {
        match message {
            ToDocument::Edit(edit) => {
                let number = edit.number;
                let ready = edit.prepare(&self.originals);
                drop(Arc::make_mut(&mut self.document).apply(ready));
                self.ledger.apply(number);
                self.changed = true;
                if self.each {
                    self.publish();
                }
            }
            ToDocument::Ask(question, to) => {
                let answer = question.answer(shown(&self.document.takes), &self.document.skeleton);
                // Who asked may have stopped.
                let _ = to.send(answer);
            }
            ToDocument::Give(to) => _ = to.send((*self.document).clone()),
        }
    }
}

impl Worker for Owner {
    fn update(&mut self, _thread: &mut Context) -> bool {
        if self.changed {
            self.publish();
        }
        true
    }
}

/// Passes views on from the main thread.
struct Relay {
    to: Address<View>,
    ledger: Arc<Ledger>,
}

impl Receiver for Relay {
    type Message = View;

    fn receive(&mut self, view: View, _thread: &mut Context) {
        let number = shown(&view.takes).number;
        let _ = self.to.send(view);
        self.ledger.publish(number);
    }
}

/// Where an answer lies until it is read.
struct Answers(Rc<Cell<Option<Answer>>>);

impl Receiver for Answers {
    type Message = Answer;

    fn receive(&mut self, answer: Answer, _thread: &mut Context) {
        self.0.set(Some(answer));
    }
}

/// The main thread's side.
struct Main {
    _thread: Thread,
    address: Address<ToDocument>,
    /// The place of the running gesture, where edits replace each other.
    gesture: Option<Address<ToDocument>>,
    merges: bool,
    answer: Rc<Cell<Option<Answer>>>,
    answers: Address<Answer>,
}

impl Sharing for Main {
    fn edit(&mut self, edit: Edit, begins: bool) {
        if self.merges && begins {
            self.gesture = Some(self.address.latest());
        }
        let to = self.gesture.as_ref().unwrap_or(&self.address);
        to.send(ToDocument::Edit(edit)).expect("the document lives as long as this");
    }

    fn ask(&mut self, question: Question, main: &mut Captured) -> Asked {
        let begin = Instant::now();
        let message = ToDocument::Ask(question, self.answers.clone());
        self.address.send(message).expect("the document lives as long as this");
        let blocked = begin.elapsed();
        loop {
            if let Some(answer) = self.answer.take() {
                return Asked { answer, blocked };
            }
            // Here the main thread could do anything else; it has nothing else to do.
            if main.iterate() == Next::OnMessage && self.answer.get().is_none() {
                std::thread::park();
            }
        }
    }

    fn document(&mut self, main: &mut Captured) -> Document {
        let (to, from) = mpsc::channel();
        self.address.send(ToDocument::Give(to)).expect("the document lives as long as this");
        main.iterate();
        from.recv().expect("it is given")
    }

    fn backlog(&self, posted: u64, ledger: &Ledger) -> u64 {
        posted.saturating_sub(ledger.applied())
    }
}

/// The graphics thread's side: the newest view that has come.
struct Newest {
    view: Rc<RefCell<View>>,
    promised: u64,
}

impl Viewing for Newest {
    fn frame(&mut self, frame: &mut Frame) {
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

struct Views(Rc<RefCell<View>>);

impl Receiver for Views {
    type Message = View;

    fn receive(&mut self, view: View, _thread: &mut Context) {
        *self.0.borrow_mut() = view;
    }
}

struct Kind {
    each: bool,
    relayed: bool,
    merges: bool,
}

/// Every edit a message, and after every edit a view.
pub fn plain(start: Start) -> Started {
    begin(start, Kind { each: true, relayed: false, merges: false })
}

/// Every edit a message; a view when no more edits wait.
pub fn newest(start: Start) -> Started {
    begin(start, Kind { each: false, relayed: false, merges: false })
}

/// The same, with views sent to the main thread, which passes them on.
pub fn relayed(start: Start) -> Started {
    begin(start, Kind { each: false, relayed: true, merges: false })
}

/// Edits of one gesture replace each other while they wait, and so do views.
pub fn merged(start: Start) -> Started {
    begin(start, Kind { each: false, relayed: false, merges: true })
}

fn begin(start: Start, kind: Kind) -> Started {
    let Start { document, graphics, main, ledger } = start;
    let drawn: Address<View> = graphics.reserve_address();
    let views = if kind.each { drawn.clone() } else { drawn.latest() };
    let views = match kind.relayed {
        true => {
            let relay = Relay { to: views, ledger: Arc::clone(ledger) };
            main.context().register_receiver(relay).latest()
        }
        false => views,
    };
    let originals = document.originals();
    let first = Arc::new(document);
    let thread = Thread::start("document").expect("the system has a thread left");
    let address = thread.handle().reserve_address();
    let (own, document, theirs) = (address.clone(), Arc::clone(&first), Arc::clone(ledger));
    let (each, relayed) = (kind.each, kind.relayed);
    let register = move |context: &mut Context| {
        let owner = Owner { document, originals, views, each, changed: false, ledger: theirs, relayed };
        let owner = Rc::new(RefCell::new(owner));
        context.register_receiver_at(&own, Rc::clone(&owner));
        context.register_worker(owner);
    };
    thread.handle().run(register).expect("it was just started");
    let answer = Rc::new(Cell::new(None));
    let answers = main.context().register_receiver(Answers(Rc::clone(&answer)));
    let sharing = Main { _thread: thread, address, gesture: None, merges: kind.merges, answer, answers };
    let viewing = Box::new(move |graphics: &mut Context| {
        let view = Rc::new(RefCell::new(first));
        graphics.register_receiver_at(&drawn, Views(Rc::clone(&view)));
        Box::new(Newest { view, promised: 0 }) as Box<dyn Viewing>
    });
    Started { sharing: Box::new(sharing), viewing }
}
