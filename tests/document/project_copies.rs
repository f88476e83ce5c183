//! A save of a project in another folder reports how much is done, and removes what it wrote where it is stopped or fails.

use super::project_moved::{NEEDED, files, whole_project};
use super::projects::{END, is_read, replaced_in};
use super::save_in_background::{HeldSave, document};
use dragonfly_document::{
    DocumentMessage, DocumentReply, FaultPoint, LoadStage, NotSaved, SaveOrder, SaveTo,
};
use dragonfly_kit::document::test_document::TestDocument;
use dragonfly_kit::folder::Folder;
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

/// A project that is open, an empty folder for its copies, and a save that is held after this many copies.
struct Copying {
    folder: Folder,
    other: Folder,
    held: Arc<HeldSave>,
    document: TestDocument,
}

impl Copying {
    fn after(name: &str, copies: usize) -> Self {
        let folder = Folder::new(&format!("copies-{name}"));
        let other = Folder::new(&format!("copies-{name}-there"));
        let (path, held) = (whole_project(&folder), HeldSave::at(FaultPoint::CopiedFile(copies)));
        let mut document = document(&folder.join("autosave"), &held);
        document.open(&path);
        document.wait_for_view(is_read);
        Self { folder, other, held, document }
    }

    /// Returns the path of the project in the other folder.
    fn target(&self) -> PathBuf {
        self.other.join("foxes.meproj")
    }

    /// Releases the save. Returns why nothing was saved.
    fn not_saved(&mut self) -> NotSaved {
        self.held.release();
        self.document.wait_for_reply(|reply| match reply {
            DocumentReply::NotSaved(_, reason) => Some(reason.clone()),
            DocumentReply::Saved(saved) => panic!("{saved:?}"),
            _ => None,
        })
    }

    /// Returns whether the other folder contains neither files nor folders.
    fn is_empty_there(&self) -> bool {
        fs::read_dir(self.other.path()).expect("a folder").count() == 0
    }
}

#[test]
fn the_progress_of_a_save_grows_with_the_models_that_are_read_and_the_files_that_are_copied() {
    let mut save = Copying::after("progress", 1);
    save.held.hold_save(&save.document, SaveTo::As(save.target()));
    let mut last = 0.0;
    // The fox is the first copy and by far the largest one.
    for least in [0.0, 0.2, 0.9] {
        last = save.document.wait_for_reply(|reply| match reply {
            DocumentReply::Loading { progress, .. } if progress.stage == LoadStage::Copying => {
                (progress.done >= least && progress.done >= last).then_some(progress.done)
            }
            _ => None,
        });
    }
    assert!(last < 1.0, "{last}: it is held before the last copy");
    save.held.release();
    super::save_in_background::wait_until_saved(&mut save.document);
}

#[test]
fn a_save_that_is_stopped_between_two_copies_removes_those_that_it_made() {
    let mut save = Copying::after("stopped", 3);
    save.held.hold_save(&save.document, SaveTo::As(save.target()));
    assert_eq!(files(save.other.path()).len(), 3);
    save.document.send(DocumentMessage::CancelLoading);
    save.document.wait_for_warning("stops after the file");
    assert_eq!(save.not_saved(), NotSaved::Cancelled(Vec::new()));
    assert!(save.is_empty_there());
    assert_eq!(save.document.save(SaveTo::As(save.target())).beside, NEEDED.len());
}

#[test]
fn a_stopped_save_names_the_files_of_an_earlier_copy_that_it_replaced() {
    let mut save = Copying::after("replaced", 1);
    save.document.save(SaveTo::Copy(save.target()));
    let before = files(save.other.path());
    let fox = save.folder.join("own/models/Fox.glb");
    let newer = [&fs::read(&fox).expect("a file")[..], b"more"].concat();
    fs::write(&fox, &newer).expect("a file");
    save.held.hold();
    let order = SaveOrder { anyway: true, to: SaveTo::Copy(save.target()), ..SaveOrder::own(None) };
    save.document.send(DocumentMessage::Save(order));
    save.held.wait_until_reached();
    save.document.send(DocumentMessage::CancelLoading);
    save.document.wait_for_warning("stops after the file");
    let copy = save.other.join("models/Fox.glb");
    assert_eq!(save.not_saved(), NotSaved::Cancelled(vec![copy]));
    let after = files(save.other.path());
    assert_eq!(after["models/Fox.glb"], newer);
    for name in before.keys().filter(|name| *name != "models/Fox.glb") {
        assert_eq!(after.get(name), before.get(name), "{name}");
    }
}

#[test]
fn a_text_that_another_program_writes_while_files_are_copied_is_the_one_that_the_message_names() {
    let mut save = Copying::after("created", 1);
    save.held.hold_save(&save.document, SaveTo::As(save.target()));
    let text = save.other.join("end.xml");
    fs::write(&text, "of another program").expect("a file");
    let NotSaved::Failed(reason) = save.not_saved() else { panic!("a question about another file") };
    assert!(reason.starts_with(&text.display().to_string()), "{reason}");
    let there = files(save.other.path());
    assert_eq!(
        there.into_iter().collect::<Vec<_>>(),
        [("end.xml".to_owned(), b"of another program".to_vec())]
    );
}

#[test]
fn a_copied_text_that_another_program_changes_while_files_are_copied_again_is_named_and_kept() {
    let mut save = Copying::after("changed", 1);
    save.document.save(SaveTo::Copy(save.target()));
    let fox = save.folder.join("own/models/Fox.glb");
    fs::write(&fox, [&fs::read(&fox).expect("a file")[..], b"more"].concat()).expect("a file");
    save.document.edit(replaced_in("end.xml", END, "The End", "Fin"));
    save.document.wait_for_view(|view| view.history.done == 1);
    save.held.hold();
    let order = SaveOrder { anyway: true, to: SaveTo::Copy(save.target()), ..SaveOrder::own(None) };
    save.document.send(DocumentMessage::Save(order));
    save.held.wait_until_reached();
    let text = save.other.join("end.xml");
    fs::write(&text, "of another program").expect("a file");
    let NotSaved::Failed(reason) = save.not_saved() else { panic!("a question about another file") };
    assert!(reason.starts_with(&text.display().to_string()), "{reason}");
    let copy = save.other.join("models/Fox.glb").display().to_string();
    assert!(reason.contains(&copy), "the copy that it replaced is named: {reason}");
    assert_eq!(fs::read_to_string(&text).expect("a file"), "of another program");
}
