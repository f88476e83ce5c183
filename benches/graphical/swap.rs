//! A document without waiting: the newest version is in an `ArcSwap`; an edit copies what it changes, and swaps.

use super::document::{NumberedEdit, SharedDocument};
use super::frame::{FrameWork, PoseQuestion, shown};
use super::sharing::{Sharing, SharingParts, SharingStart, TimedAnswer, Viewing};
use arc_swap::ArcSwap;
use dragonfly_anim::data::Take;
use dragonfly_runtime::Captured;
use std::sync::Arc;

struct SwapSharing {
    newest: Arc<ArcSwap<SharedDocument>>,
    originals: Vec<Arc<Take>>,
}

impl Sharing for SwapSharing {
    fn edit(&mut self, edit: NumberedEdit, _begins: bool) {
        // With one writer the version cannot change during the copy. Several writers would need `rcu`, which may
        // repeat the copy.
        let ready = edit.prepare(&self.originals);
        let mut document = SharedDocument::clone(&self.newest.load());
        drop(document.apply(ready));
        self.newest.store(Arc::new(document));
    }

    fn ask(&mut self, question: PoseQuestion, _main: &mut Captured) -> TimedAnswer {
        TimedAnswer::at_once(|| {
            let document = self.newest.load();
            question.answer(shown(&document.takes), &document.skeleton)
        })
    }

    fn document(&mut self, _main: &mut Captured) -> SharedDocument {
        SharedDocument::clone(&self.newest.load())
    }
}

struct SwapViewing(Arc<ArcSwap<SharedDocument>>);

impl Viewing for SwapViewing {
    fn frame(&mut self, frame: &mut FrameWork) {
        let document = self.0.load_full();
        frame.read(shown(&document.takes));
        frame.draw();
        frame.confirm(shown(&document.takes));
    }
}

/// Starts the method of this module.
pub fn start(start: SharingStart) -> SharingParts {
    let originals = start.document.originals();
    let newest = Arc::new(ArcSwap::from_pointee(start.document));
    let theirs = Arc::clone(&newest);
    let viewing = Box::new(|_: &mut _| Box::new(SwapViewing(theirs)) as Box<dyn Viewing>);
    SharingParts { sharing: Box::new(SwapSharing { newest, originals }), viewing }
}
