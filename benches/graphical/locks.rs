//! A document protected by locks, used in five ways: a lock held for the whole frame, held to sample the poses that the
//! frame needs, held to copy the take, held to clone a reference to a document that is copied on write, and one lock
//! for each take.

use super::document::{NumberedEdit, SharedDocument, TakeEntry};
use super::frame::{FrameWork, PoseQuestion, shown};
use super::script::SHOWN;
use super::sharing::{Sharing, SharingParts, SharingStart, TimedAnswer, Viewing};
use dragonfly_anim::data::{Skeleton, Take};
use dragonfly_runtime::Captured;
use std::sync::Arc;

/// A kind of lock. A poisoned lock is a bug of the benchmark.
pub trait AnyLock<T>: Send + Sync + 'static {
    /// Returns a lock around `value`.
    fn around(value: T) -> Self;
    /// Calls `work` with the lock held for reading; concurrently with other readers where the lock supports that.
    fn read<R>(&self, work: impl FnOnce(&T) -> R) -> R;
    /// Calls `work` with the lock held exclusively.
    fn write<R>(&self, work: impl FnOnce(&mut T) -> R) -> R;
}

impl<T: Send + 'static> AnyLock<T> for std::sync::Mutex<T> {
    fn around(value: T) -> Self {
        Self::new(value)
    }
    fn read<R>(&self, work: impl FnOnce(&T) -> R) -> R {
        work(&self.lock().expect("no thread panics with the lock"))
    }
    fn write<R>(&self, work: impl FnOnce(&mut T) -> R) -> R {
        work(&mut self.lock().expect("no thread panics with the lock"))
    }
}

impl<T: Send + Sync + 'static> AnyLock<T> for std::sync::RwLock<T> {
    fn around(value: T) -> Self {
        Self::new(value)
    }
    fn read<R>(&self, work: impl FnOnce(&T) -> R) -> R {
        work(&Self::read(self).expect("no thread panics with the lock"))
    }
    fn write<R>(&self, work: impl FnOnce(&mut T) -> R) -> R {
        work(&mut Self::write(self).expect("no thread panics with the lock"))
    }
}

impl<T: Send + 'static> AnyLock<T> for parking_lot::Mutex<T> {
    fn around(value: T) -> Self {
        Self::new(value)
    }
    fn read<R>(&self, work: impl FnOnce(&T) -> R) -> R {
        work(&self.lock())
    }
    fn write<R>(&self, work: impl FnOnce(&mut T) -> R) -> R {
        work(&mut self.lock())
    }
}

impl<T: Send + Sync + 'static> AnyLock<T> for parking_lot::RwLock<T> {
    fn around(value: T) -> Self {
        Self::new(value)
    }
    fn read<R>(&self, work: impl FnOnce(&T) -> R) -> R {
        work(&Self::read(self))
    }
    fn write<R>(&self, work: impl FnOnce(&mut T) -> R) -> R {
        work(&mut Self::write(self))
    }
}

/// The main thread's side of the methods with one document in one lock.
struct SingleLockSharing<L> {
    lock: Arc<L>,
    originals: Vec<Arc<Take>>,
    skeleton: Arc<Skeleton>,
}

impl<L: AnyLock<SharedDocument>> SingleLockSharing<L> {
    fn start(
        start: SharingStart,
        viewing: impl FnOnce(Arc<L>) -> Box<dyn Viewing> + Send + 'static,
    ) -> SharingParts {
        let originals = start.document.originals();
        let skeleton = Arc::clone(&start.document.skeleton);
        let lock = Arc::new(L::around(start.document));
        let theirs = Arc::clone(&lock);
        let sharing = Box::new(Self { lock, originals, skeleton });
        SharingParts { sharing, viewing: Box::new(|_| viewing(theirs)) }
    }
}

impl<L: AnyLock<SharedDocument>> Sharing for SingleLockSharing<L> {
    fn edit(&mut self, edit: NumberedEdit, _begins: bool) {
        let ready = edit.prepare(&self.originals);
        // Replaced data is freed after the lock is released.
        let remains = self.lock.write(|document| document.apply(ready));
        drop(remains);
    }

    fn ask(&mut self, question: PoseQuestion, _main: &mut Captured) -> TimedAnswer {
        TimedAnswer::at_once(|| {
            self.lock.read(|document| question.answer(shown(&document.takes), &self.skeleton))
        })
    }

    fn document(&mut self, _main: &mut Captured) -> SharedDocument {
        self.lock.read(SharedDocument::clone)
    }
}

/// One lock, held for the whole frame.
pub fn held_for_frame<L: AnyLock<SharedDocument>>(start: SharingStart) -> SharingParts {
    struct LockedFrameViewing<L>(Arc<L>);
    impl<L: AnyLock<SharedDocument>> Viewing for LockedFrameViewing<L> {
        fn frame(&mut self, frame: &mut FrameWork) {
            self.0.read(|document| {
                frame.read(shown(&document.takes));
                frame.draw();
                frame.confirm(shown(&document.takes));
            });
        }
    }
    SingleLockSharing::start(start, |lock: Arc<L>| Box::new(LockedFrameViewing(lock)))
}

/// One lock, held while the poses of the bones are sampled.
pub fn sampled<L: AnyLock<SharedDocument>>(start: SharingStart) -> SharingParts {
    struct Sampled<L>(Arc<L>);
    impl<L: AnyLock<SharedDocument>> Viewing for Sampled<L> {
        fn frame(&mut self, frame: &mut FrameWork) {
            self.0.read(|document| frame.read(shown(&document.takes)));
            frame.draw();
        }
    }
    SingleLockSharing::start(start, |lock: Arc<L>| Box::new(Sampled(lock)))
}

/// One lock, held while the shown take is copied.
pub fn cloned<L: AnyLock<SharedDocument>>(start: SharingStart) -> SharingParts {
    struct Cloned<L>(Arc<L>);
    impl<L: AnyLock<SharedDocument>> Viewing for Cloned<L> {
        fn frame(&mut self, frame: &mut FrameWork) {
            let (mark, take) = self.0.read(|document| {
                let entry = shown(&document.takes);
                (frame.mark(entry), entry.copy_result())
            });
            frame.read_copy(mark, &take);
            frame.draw();
        }
    }
    SingleLockSharing::start(start, |lock: Arc<L>| Box::new(Cloned(lock)))
}

/// One lock, held while a reference to the document is cloned; an edit copies shared data before it changes it.
pub fn copied_on_write<L: AnyLock<Arc<SharedDocument>>>(start: SharingStart) -> SharingParts {
    struct CopyOnWriteSharing<L>(Arc<L>, Vec<Arc<Take>>);
    impl<L: AnyLock<Arc<SharedDocument>>> Sharing for CopyOnWriteSharing<L> {
        fn edit(&mut self, edit: NumberedEdit, _begins: bool) {
            let ready = edit.prepare(&self.1);
            let remains = self.0.write(|document| Arc::make_mut(document).apply(ready));
            drop(remains);
        }

        fn ask(&mut self, question: PoseQuestion, _main: &mut Captured) -> TimedAnswer {
            TimedAnswer::at_once(|| {
                let document = self.0.read(Arc::clone);
                question.answer(shown(&document.takes), &document.skeleton)
            })
        }

        fn document(&mut self, _main: &mut Captured) -> SharedDocument {
            self.0.read(|document| (**document).clone())
        }
    }

    struct CopyOnWriteViewing<L>(Arc<L>);
    impl<L: AnyLock<Arc<SharedDocument>>> Viewing for CopyOnWriteViewing<L> {
        fn frame(&mut self, frame: &mut FrameWork) {
            let document = self.0.read(Arc::clone);
            frame.read(shown(&document.takes));
            frame.draw();
            frame.confirm(shown(&document.takes));
        }
    }

    let originals = start.document.originals();
    let lock = Arc::new(L::around(Arc::new(start.document)));
    let theirs = Arc::clone(&lock);
    let viewing = Box::new(|_: &mut _| Box::new(CopyOnWriteViewing(theirs)) as Box<dyn Viewing>);
    SharingParts { sharing: Box::new(CopyOnWriteSharing(lock, originals)), viewing }
}

/// A lock for each take, held for the whole frame: the shown take is locked, and all others can be edited.
pub fn lock_per_take<L: AnyLock<TakeEntry>>(start: SharingStart) -> SharingParts {
    struct TakeLocksSharing<L> {
        takes: Arc<[L]>,
        originals: Vec<Arc<Take>>,
        skeleton: Arc<Skeleton>,
    }
    impl<L: AnyLock<TakeEntry>> Sharing for TakeLocksSharing<L> {
        fn edit(&mut self, edit: NumberedEdit, _begins: bool) {
            let take = edit.take;
            let ready = edit.prepare(&self.originals);
            let remains = self.takes[take].write(|entry| entry.apply(ready));
            drop(remains);
        }

        fn ask(&mut self, question: PoseQuestion, _main: &mut Captured) -> TimedAnswer {
            TimedAnswer::at_once(|| self.takes[SHOWN].read(|entry| question.answer(entry, &self.skeleton)))
        }

        fn document(&mut self, _main: &mut Captured) -> SharedDocument {
            let takes = self.takes.iter().map(|take| take.read(TakeEntry::clone)).collect();
            SharedDocument { skeleton: Arc::clone(&self.skeleton), takes }
        }
    }

    struct TakeLocksViewing<L>(Arc<[L]>);
    impl<L: AnyLock<TakeEntry>> Viewing for TakeLocksViewing<L> {
        fn frame(&mut self, frame: &mut FrameWork) {
            self.0[SHOWN].read(|entry| {
                frame.read(entry);
                frame.draw();
                frame.confirm(entry);
            });
        }
    }

    let originals = start.document.originals();
    let skeleton = start.document.skeleton;
    let takes: Arc<[L]> = start.document.takes.into_iter().map(L::around).collect();
    let theirs = Arc::clone(&takes);
    let viewing = Box::new(|_: &mut _| Box::new(TakeLocksViewing(theirs)) as Box<dyn Viewing>);
    SharingParts { sharing: Box::new(TakeLocksSharing { takes, originals, skeleton }), viewing }
}
