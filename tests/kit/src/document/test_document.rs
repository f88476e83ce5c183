//! A document in its thread, without a window: tests send messages to it and wait for its replies and views.

use super::received::Received;
use crate::folder::{Folder, data};
use dragonfly_document::edit::{BonePose, BoneRef, Edit, RenameTake, SetPose, TakeRef};
use dragonfly_document::{
    Change, Document, DocumentHandle, DocumentMessage, DocumentReply, Offer, SaveOrder, SaveTo, SavedFile,
    Setup, Source, View,
};
use dragonfly_runtime::{Captured, Context, Receiver, Thread};
use dragonfly_store::{Autosave, RealFiles, Vfs};
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

const SOON: Duration = Duration::from_secs(60);

#[derive(Clone, Default)]
struct LatestView(Rc<RefCell<Option<View>>>);

impl Receiver for LatestView {
    type Message = View;

    fn receive(&mut self, view: View, _thread: &mut Context) {
        *self.0.borrow_mut() = Some(view);
    }
}

/// A running document with the replies and views that it sent.
pub struct TestDocument {
    main: Captured,
    document: DocumentHandle,
    heard: Received<DocumentReply>,
    shown: LatestView,
}

/// Returns the autosave of a test in `folder`.
pub fn autosave_in(folder: &Path) -> Autosave {
    autosave_with(folder, RealFiles)
}

/// Returns the autosave of a test in `folder` on the file system `files`.
pub fn autosave_with(folder: &Path, files: impl Vfs + 'static) -> Autosave {
    Autosave::new(Arc::new(files), Some(folder.to_owned())).expect("the folder is given")
}

/// Copies Fox into a folder of the test and returns the path of the copy.
pub fn fox(folder: &Folder) -> PathBuf {
    let path = folder.join("Fox.glb");
    std::fs::copy(data("gltf/Fox.glb"), &path).expect("a file");
    path
}

/// Copies Fox to `path` unless there is a file already, and returns the path.
pub fn fox_at(path: &Path) -> PathBuf {
    if !path.exists() {
        let bytes = std::fs::read(data("gltf/Fox.glb")).expect("a file");
        // Synced to the disk, because the test may cut the power.
        dragonfly_store::replace(path, &bytes).expect("a file");
    }
    path.to_owned()
}

/// Simulates a killed program: copies its folders as they are at this moment to `to`. The file of the document itself
/// stays where it is.
pub fn copy_after_kill(autosave: &Path, to: &Path) {
    std::fs::create_dir_all(to).expect("a folder");
    for entry in std::fs::read_dir(autosave).expect("the autosave folder").flatten() {
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy_after_kill(&entry.path(), &target);
        } else {
            std::fs::copy(entry.path(), target).expect("a copy");
        }
    }
}

/// Returns an edit that rotates the head of the fox in its first take.
pub fn turn(angle: f32) -> Edit {
    let (sine, cosine) = (angle / 2.0).sin_cos();
    let pose = BonePose {
        bone: BoneRef::Name("b_Head_05".to_owned()),
        translation: None,
        rotation: Some([0.0, 0.0, sine, cosine]),
        scale: None,
    };
    Edit::SetPose(SetPose { take: TakeRef::Index(0), time: 0.5, poses: vec![pose], unstep: false })
}

/// Returns an edit that renames the first take.
pub fn rename(name: &str) -> Edit {
    Edit::RenameTake(RenameTake { take: TakeRef::Index(0), name: name.to_owned() })
}

impl TestDocument {
    /// Starts a document with its journals in `autosave`.
    pub fn new(autosave: &Path) -> Self {
        Self::with(Setup { autosave: Some(autosave_in(autosave)), ..Setup::default() })
    }

    /// Starts a document with `setup`.
    pub fn with(setup: Setup) -> Self {
        let (heard, shown) = (Received::default(), LatestView::default());
        let mut main = Thread::capture("main", || {});
        let replies = main.context().register_receiver(heard.clone());
        let picture = main.context().register_receiver(shown.clone());
        let document = Document::start_with(setup, replies, picture).expect("a thread");
        Self { main, document, heard, shown }
    }

    /// Waits for a reply for which `what` returns a value, and removes it from the unread replies.
    #[track_caller]
    pub fn wait_for_reply<T>(&mut self, mut what: impl FnMut(&DocumentReply) -> Option<T>) -> T {
        let mut found = None;
        let heard = Rc::clone(&self.heard.0);
        let deadline = Instant::now() + SOON;
        while found.is_none() {
            self.main.iterate();
            let mut heard = heard.borrow_mut();
            if let Some(place) = heard.iter().position(|reply| what(reply).is_some()) {
                found = what(&heard.remove(place));
            }
            drop(heard);
            assert!(found.is_some() || Instant::now() < deadline, "heard only {:#?}", self.unread_replies());
            std::thread::park_timeout(Duration::from_millis(1));
        }
        found.expect("found")
    }

    /// Returns whether there is a reply for which `what` returns true, without waiting, and removes it from the unread replies.
    pub fn has_reply(&mut self, mut what: impl FnMut(&DocumentReply) -> bool) -> bool {
        self.main.iterate();
        let mut heard = self.heard.0.borrow_mut();
        let place = heard.iter().position(&mut what);
        if let Some(place) = place {
            heard.remove(place);
        }
        place.is_some()
    }

    /// Returns all unread replies as text, without the large ones.
    pub fn unread_replies(&mut self) -> Vec<String> {
        self.main.iterate();
        let heard = self.heard.0.borrow();
        heard.iter().filter(|reply| !is_large(reply)).map(|reply| format!("{reply:?}")).collect()
    }

    /// Sends a message to the document.
    pub fn send(&self, message: DocumentMessage) {
        assert!(self.document.send(message));
    }

    /// Opens a file and waits until it is shown.
    #[track_caller]
    pub fn open(&mut self, path: &Path) -> View {
        self.open_source(Source::File(path.to_owned()))
    }

    /// Opens `source` and returns the view of it.
    #[track_caller]
    pub fn open_source(&mut self, source: Source) -> View {
        let before = self.shown.0.borrow().as_ref().map_or(0, |view| view.generation);
        self.send(DocumentMessage::Open { source, anyway: true });
        self.wait_for_reply(|reply| match reply {
            DocumentReply::Opened(_) => Some(()),
            DocumentReply::Failed { reason, .. } => panic!("{reason}"),
            _ => None,
        });
        self.wait_for_view(|view| view.generation > before)
    }

    /// Waits for a view for which `what` returns true.
    #[track_caller]
    pub fn wait_for_view(&mut self, what: impl Fn(&View) -> bool) -> View {
        let deadline = Instant::now() + SOON;
        while !self.shown.0.borrow().as_ref().is_some_and(&what) {
            self.main.iterate();
            assert!(Instant::now() < deadline, "it is not shown; heard {:#?}", self.unread_replies());
            std::thread::park_timeout(Duration::from_millis(1));
        }
        let view = self.shown.0.borrow().clone();
        view.expect("shown")
    }

    /// Returns the newest view, after all messages sent so far were processed.
    #[track_caller]
    pub fn view(&mut self) -> View {
        self.send(DocumentMessage::Plan(None));
        self.wait_for_reply(|reply| matches!(reply, DocumentReply::Plan(..)).then_some(()));
        // A view is sent at the end of the iteration, so a second request makes sure that it has arrived.
        self.send(DocumentMessage::Plan(None));
        self.wait_for_reply(|reply| matches!(reply, DocumentReply::Plan(..)).then_some(()));
        self.main.iterate();
        self.shown.0.borrow().clone().expect("something is open")
    }

    /// Sends a change to the document.
    pub fn change(&self, change: Change) {
        self.document.change(change);
    }

    /// Sends an edit as a step of its own.
    pub fn edit(&self, edit: Edit) {
        self.change(Change::Edit(edit, None));
    }

    /// Saves and waits for the result, which must be a success.
    #[track_caller]
    pub fn save(&mut self, to: SaveTo) -> SavedFile {
        self.send(DocumentMessage::Save(SaveOrder { to, ..SaveOrder::own(None) }));
        self.wait_for_reply(|reply| match reply {
            DocumentReply::Saved(saved) => Some(saved.clone()),
            DocumentReply::NotSaved(_, reason) => panic!("{reason:?}"),
            _ => None,
        })
    }

    /// Waits for the offers of unsaved work.
    #[track_caller]
    pub fn wait_for_offers(&mut self) -> Vec<Offer> {
        self.wait_for_reply(|reply| match reply {
            DocumentReply::Offers(offers) => Some(offers.clone()),
            _ => None,
        })
    }

    /// Returns the unsaved work offered so far, without waiting.
    pub fn offers_so_far(&mut self) -> Vec<Offer> {
        self.main.iterate();
        let mut heard = self.heard.0.borrow_mut();
        let place = heard.iter().position(|reply| matches!(reply, DocumentReply::Offers(_)));
        match place.map(|place| heard.remove(place)) {
            Some(DocumentReply::Offers(offers)) => offers,
            _ => Vec::new(),
        }
    }

    /// Waits for a warning or notice that contains `word`, and returns it.
    #[track_caller]
    pub fn wait_for_warning(&mut self, word: &str) -> String {
        self.wait_for_reply(|reply| match reply {
            DocumentReply::Warning(text) | DocumentReply::Notice(text) if text.contains(word) => {
                Some(text.clone())
            }
            _ => None,
        })
    }

    /// Asks the document to end, without waiting for it.
    pub fn stop(&self) {
        self.document.stop();
    }

    /// Ends the document normally.
    pub fn end(self) {
        drop(self);
    }
}

impl Drop for TestDocument {
    fn drop(&mut self) {
        self.document.stop();
        let ended = Thread::wait_for(&[self.document.thread().clone()], Instant::now() + SOON);
        assert!(ended.is_ok() || std::thread::panicking(), "{ended:?}");
    }
}

/// Returns whether the text of the reply is too long to print.
fn is_large(reply: &DocumentReply) -> bool {
    matches!(reply, DocumentReply::View(_) | DocumentReply::Opened(_) | DocumentReply::Loading { .. })
}

/// Asserts that the takes of two views are equal in all three versions, number by number.
#[track_caller]
pub fn same_takes(one: &View, other: &View) {
    assert_eq!(one.takes.len(), other.takes.len());
    for (one, other) in one.takes.iter().zip(other.takes.iter()) {
        assert!(one == other, "take {} is another one", one.name);
    }
}
