//! Three documents: one is drawn, one is edited, and one is the newest finished version, ready for an exchange. No
//! thread waits, and nothing is copied after the first edits: the editing thread also applies the edits that a document
//! missed when it gets it back.
//!
//! The roles of the documents are one number, exchanged atomically; each thread accesses only the documents that it
//! has. The locks exist because the compiler cannot check that; they are never contended.

use super::document::{NumberedEdit, PreparedEdit, SharedDocument};
use super::frame::{FrameWork, PoseQuestion, shown};
use super::sharing::{Sharing, SharingParts, SharingStart, TimedAnswer, Viewing};
use dragonfly_anim::data::Take;
use dragonfly_runtime::Captured;
use std::collections::VecDeque;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};

/// Flag that is added to the number of the exchanged document if it is newer than the one that is drawn.
const FRESH: usize = 4;

struct Buffers {
    documents: [Mutex<SharedDocument>; 3],
    /// Number of the document to exchange.
    waiting: AtomicUsize,
}

impl Buffers {
    fn own(&self, index: usize) -> MutexGuard<'_, SharedDocument> {
        self.documents[index].try_lock().expect("each has one owner at a time")
    }
}

struct TripleSharing {
    buffers: Arc<Buffers>,
    back: usize,
    originals: Vec<Arc<Take>>,
    /// Edits that at least one of the documents misses, oldest first.
    log: VecDeque<PreparedEdit>,
    /// Newest edit in each document; for documents that the other thread has, as of their exchange.
    has: [u64; 3],
}

impl TripleSharing {
    /// Applies the edits that the back document misses.
    fn catch_up(&mut self) {
        let mut document = self.buffers.own(self.back);
        let has = self.has[self.back];
        let missed = self.log.partition_point(|ready| ready.number() <= has);
        for ready in self.log.range(missed..) {
            self.has[self.back] = ready.number();
            drop(document.apply(ready.clone()));
        }
        drop(document);
        let oldest = self.has.iter().copied().min().unwrap_or(0);
        let done = self.log.partition_point(|ready| ready.number() <= oldest);
        self.log.drain(..done);
    }
}

impl Sharing for TripleSharing {
    fn edit(&mut self, edit: NumberedEdit, _begins: bool) {
        // Whole takes are computed once; the three documents share them.
        self.log.push_back(edit.prepare(&self.originals));
        self.catch_up();
        self.back = self.buffers.waiting.swap(self.back | FRESH, Ordering::AcqRel) & !FRESH;
    }

    fn ask(&mut self, question: PoseQuestion, _main: &mut Captured) -> TimedAnswer {
        TimedAnswer::at_once(|| {
            self.catch_up();
            let document = self.buffers.own(self.back);
            question.answer(shown(&document.takes), &document.skeleton)
        })
    }

    fn document(&mut self, _main: &mut Captured) -> SharedDocument {
        self.catch_up();
        self.buffers.own(self.back).clone()
    }
}

struct TripleViewing {
    buffers: Arc<Buffers>,
    front: usize,
}

impl Viewing for TripleViewing {
    fn frame(&mut self, frame: &mut FrameWork) {
        if self.buffers.waiting.load(Ordering::Relaxed) & FRESH != 0 {
            self.front = self.buffers.waiting.swap(self.front, Ordering::AcqRel) & !FRESH;
        }
        let document = self.buffers.own(self.front);
        frame.read(shown(&document.takes));
        frame.draw();
        frame.confirm(shown(&document.takes));
    }
}

/// Starts the method of this module.
pub fn start(start: SharingStart) -> SharingParts {
    let originals = start.document.originals();
    let documents = [start.document.clone(), start.document.clone(), start.document].map(Mutex::new);
    let buffers = Arc::new(Buffers { documents, waiting: AtomicUsize::new(1) });
    let theirs = Arc::clone(&buffers);
    let viewing =
        Box::new(|_: &mut _| Box::new(TripleViewing { buffers: theirs, front: 0 }) as Box<dyn Viewing>);
    let main = TripleSharing { buffers, back: 2, originals, log: VecDeque::new(), has: [0; 3] };
    SharingParts { sharing: Box::new(main), viewing }
}
