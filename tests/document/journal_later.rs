//! A journal that could not be created when a file was opened is created later, with all steps since then; the view has a mark as long
//! as there is none. The clock is that of the test.

use dragonfly_document::{
    Change, Decision, Document, DocumentHandle, DocumentMessage, DocumentReply, SaveOrder, Setup, View,
};
use dragonfly_kit::document::test_document::{
    TestDocument, autosave_in, copy_after_kill, fox, rename, same_takes, turn,
};
use dragonfly_kit::eventually;
use dragonfly_kit::folder::Folder;
use dragonfly_runtime::{Context, Receiver, Stage, ThreadHandle};
use std::cell::RefCell;
use std::path::Path;
use std::rc::Rc;
use std::time::Duration;

#[derive(Clone, Default)]
struct Replies(Rc<RefCell<Vec<DocumentReply>>>);

impl Receiver for Replies {
    type Message = DocumentReply;

    fn receive(&mut self, reply: DocumentReply, _: &mut Context) {
        self.0.borrow_mut().push(reply);
    }
}

struct NoPicture;

impl Receiver for NoPicture {
    type Message = View;

    fn receive(&mut self, _: View, _: &mut Context) {}
}

/// A document whose thread and clock the test runs.
struct StagedDocument {
    stage: Stage,
    main: ThreadHandle,
    thread: ThreadHandle,
    document: DocumentHandle,
    replies: Replies,
    view: Option<View>,
    texts: Vec<String>,
    /// Number of completed saves.
    saves: usize,
}

impl StagedDocument {
    /// Opens the file while the folder of journals cannot be created, because there is a file of its name.
    fn open(path: &Path, autosave: &Path) -> Self {
        std::fs::write(autosave, "no folder").expect("a file");
        let (mut stage, replies) = (Stage::default(), Replies::default());
        let [main, thread] = ["main", "document"].map(|name| stage.start(name));
        let shown = stage.context(&main).register_receiver(NoPicture);
        let to_main = stage.context(&main).register_receiver(replies.clone());
        let setup = Setup { autosave: Some(autosave_in(autosave)), ..Setup::default() };
        let document = Document::start_in(&thread, setup, to_main, shown);
        let mut staged =
            Self { stage, main, thread, document, replies, view: None, texts: Vec::new(), saves: 0 };
        staged.document.open(dragonfly_document::Source::File(path.to_owned()));
        eventually(Duration::from_secs(60), || {
            staged.turn();
            staged.view.is_some()
        });
        staged.turn();
        staged
    }

    /// Runs an iteration of both threads.
    fn turn(&mut self) {
        self.stage.iterate(&self.thread);
        self.stage.iterate(&self.main);
        for reply in self.replies.0.take() {
            match reply {
                DocumentReply::View(view) => self.view = Some(view),
                DocumentReply::Warning(text) | DocumentReply::Notice(text) => self.texts.push(text),
                DocumentReply::NotSaved(_, reason) => panic!("{reason:?}"),
                DocumentReply::Saved(_) => self.saves += 1,
                _ => {}
            }
        }
    }

    fn change(&mut self, change: Change) -> View {
        self.document.change(change);
        self.turn();
        self.view()
    }

    /// Saves, and waits for the end.
    fn save(&mut self) {
        self.document.send(DocumentMessage::Save(SaveOrder::own(None)));
        let saves = self.saves;
        eventually(Duration::from_secs(60), || {
            self.turn();
            self.saves > saves
        });
    }

    fn view(&self) -> View {
        self.view.clone().expect("a model is open")
    }

    fn has_said(&self, text: &str) -> usize {
        self.texts.iter().filter(|said| said.contains(text)).count()
    }
}

/// Asserts that a killed program would have lost nothing of `view`.
fn assert_recorded(folder: &Folder, path: &Path, view: &View) {
    let copy = folder.join(&format!("killed-{}", view.generation));
    copy_after_kill(&folder.join("autosave"), &copy);
    let mut after = TestDocument::new(&copy);
    after.open(path);
    let offer = after.wait_for_offers().remove(0);
    after.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
    let done = view.history.done;
    same_takes(&after.wait_for_view(|view| view.history.done == done), view);
}

const NOT_RECORDED: &str = "Unsaved work is not recorded";
const AGAIN: &str = "Unsaved work is recorded again";

#[test]
fn the_next_edit_creates_the_journal_that_could_not_be_created_with_all_steps_before_it() {
    let folder = Folder::new("journal-later-edit");
    let path = fox(&folder);
    let autosave = folder.join("autosave");
    let mut document = StagedDocument::open(&path, &autosave);
    assert_eq!(document.has_said(NOT_RECORDED), 1, "{:?}", document.texts);
    assert!(document.view().is_unrecorded);
    let first = document.change(Change::Edit(turn(0.3), None));
    assert!(first.is_unrecorded, "the file is still there: {:?}", document.texts);
    std::fs::remove_file(&autosave).expect("it is there");
    let second = document.change(Change::Edit(rename("Look around"), None));
    assert!(!second.is_unrecorded, "{:?}", document.texts);
    assert_eq!((document.has_said(NOT_RECORDED), document.has_said(AGAIN)), (1, 1), "{:?}", document.texts);
    assert_recorded(&folder, &path, &second);
    // Later edits are recorded one by one.
    let third = document.change(Change::Edit(turn(0.7), None));
    assert_recorded(&folder, &path, &third);
}

#[test]
fn a_journal_that_could_not_be_created_is_tried_again_after_a_while_without_an_edit() {
    let folder = Folder::new("journal-later-timer");
    let path = fox(&folder);
    let autosave = folder.join("autosave");
    let mut document = StagedDocument::open(&path, &autosave);
    let edited = document.change(Change::Edit(turn(0.3), None));
    assert!(edited.is_unrecorded && edited.history.done == 1);
    // The first attempt of the timer fails as well.
    document.stage.advance(Duration::from_secs(2));
    document.turn();
    assert!(document.view().is_unrecorded);
    std::fs::remove_file(&autosave).expect("it is there");
    document.stage.advance(Duration::from_secs(1));
    document.turn();
    assert!(document.view().is_unrecorded, "not before its time");
    document.stage.advance(Duration::from_secs(1));
    document.turn();
    document.turn();
    assert!(!document.view().is_unrecorded, "{:?}", document.texts);
    assert_recorded(&folder, &path, &document.view());
}

#[test]
fn edits_after_a_save_are_recorded_too_where_the_journal_came_later_than_the_save() {
    let folder = Folder::new("journal-later-save");
    let path = fox(&folder);
    let autosave = folder.join("autosave");
    let mut document = StagedDocument::open(&path, &autosave);
    document.change(Change::Edit(turn(0.3), None));
    document.save();
    std::fs::remove_file(&autosave).expect("it is there");
    let edited = document.change(Change::Edit(turn(0.9), None));
    assert!(!edited.is_unrecorded, "{:?}", document.texts);
    assert!(!edited.history.saved);
    assert_recorded(&folder, &path, &edited);
}

#[test]
fn a_drag_tries_to_create_the_journal_once() {
    let folder = Folder::new("journal-later-drag");
    let path = fox(&folder);
    let autosave = folder.join("autosave");
    let mut document = StagedDocument::open(&path, &autosave);
    let gesture = Some(dragonfly_document::history::Gesture(1));
    for step in 1..20 {
        document.change(Change::Edit(turn(step as f32 * 0.01), gesture));
        if step == 1 {
            std::fs::remove_file(&autosave).expect("it is there");
        }
    }
    assert!(document.view().is_unrecorded, "{:?}", document.texts);
    let next = document.change(Change::Edit(turn(0.9), None));
    assert!(!next.is_unrecorded, "{:?}", document.texts);
    assert_eq!(autosave_in(&autosave).recoverable().expect("a folder").len(), 1);
}
