//! A document that nobody waits for: the newest version hangs in an `ArcSwap`; an edit copies what it alters and swaps.

use super::document::{Document, Edit};
use super::frame::{Frame, Question, shown};
use super::sharing::{Asked, Sharing, Start, Started, Viewing};
use arc_swap::ArcSwap;
use dragonfly_anim::data::Take;
use dragonfly_runtime::Captured;
use std::sync::Arc;

struct Main {
    newest: Arc<ArcSwap<Document>>,
    originals: Vec<Arc<Take>>,
}

impl Sharing for Main {
    fn edit(&mut self, edit: Edit, _begins: bool) {
        // There is one writer, so a copy can be changed at leisure; with more this would be `rcu`, and may be done twice.
        let ready = edit.prepare(&self.originals);
        let mut document = Document::clone(&self.newest.load());
        drop(document.apply(ready));
        self.newest.store(Arc::new(document));
    }

    fn ask(&mut self, question: Question, _main: &mut Captured) -> Asked {
        Asked::at_once(|| {
            let document = self.newest.load();
            question.answer(shown(&document.takes), &document.skeleton)
        })
    }

    fn document(&mut self, _main: &mut Captured) -> Document {
        Document::clone(&self.newest.load())
    }
}

struct Theirs(Arc<ArcSwap<Document>>);

impl Viewing for Theirs {
    fn frame(&mut self, frame: &mut Frame) {
        let document = self.0.load_full();
        frame.read(shown(&document.takes));
        frame.draw();
        frame.confirm(shown(&document.takes));
    }
}

/// See the module.
pub fn start(start: Start) -> Started {
    let originals = start.document.originals();
    let newest = Arc::new(ArcSwap::from_pointee(start.document));
    let theirs = Arc::clone(&newest);
    let viewing = Box::new(|_: &mut _| Box::new(Theirs(theirs)) as Box<dyn Viewing>);
    Started { sharing: Box::new(Main { newest, originals }), viewing }
}
