//! A save into a folder that does not exist makes it, and removes it again where the save fails.

use super::project_moved::{NEEDED, files, not_saved, whole_project};
use super::projects::is_read;
use super::save_in_background::{HeldSave, document};
use dragonfly_document::{DocumentMessage, DocumentReply, FaultPoint, NotSaved, SaveTo};
use dragonfly_kit::document::test_document::{TestDocument, fox, turn};
use dragonfly_kit::folder::Folder;
use std::fs;
use std::path::{Path, PathBuf};

/// Returns the folders that a save into a folder would create.
fn created(document: &mut TestDocument, folder: PathBuf) -> Option<PathBuf> {
    document.send(DocumentMessage::LookAtFolder(folder.clone()));
    document.wait_for_reply(|reply| match reply {
        DocumentReply::NewFolders { folder: looked, created } if *looked == folder => Some(created.clone()),
        _ => None,
    })
}

#[test]
fn a_model_is_saved_in_folders_that_do_not_exist_and_the_question_knows_their_names() {
    let folder = Folder::new("new-folders-model");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&fox(&folder));
    document.edit(turn(0.5));
    assert_eq!(created(&mut document, folder.path().to_owned()), None);
    assert_eq!(created(&mut document, folder.join("a/b")).as_deref(), Some(Path::new("a/b")));
    let saved = document.save(SaveTo::As(folder.join("a/b/Vixen")));
    assert_eq!(saved.path, folder.join("a/b/Vixen.glb"));
    assert!(saved.path.is_file());
    assert_eq!(created(&mut document, folder.join("a/c")).as_deref(), Some(Path::new("c")));
    assert!(document.save(SaveTo::Copy(folder.join("a/c/Vixen.glb"))).copy);
    assert_eq!(document.view().file.path, Some(saved.path));
}

#[test]
fn a_project_is_saved_in_a_new_folder_with_everything_that_it_needs() {
    let folder = Folder::new("new-folders-project");
    let path = whole_project(&folder);
    let other = Folder::new("new-folders-project-there");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    document.wait_for_view(is_read);
    let saved = document.save(SaveTo::As(other.join("second/version/foxes.meproj")));
    assert_eq!((saved.beside, saved.notices.as_slice()), (NEEDED.len(), &[][..]));
    let mut wanted = [&NEEDED[..], &["foxes.meproj"]].concat();
    wanted.sort_unstable();
    assert_eq!(files(&other.join("second/version")).into_keys().collect::<Vec<_>>(), wanted);
    document.wait_for_view(|view| view.file.path.as_ref() == Some(&saved.path));
}

#[test]
fn a_new_folder_is_removed_again_where_the_save_fails_or_is_stopped() {
    let folder = Folder::new("new-folders-failed");
    let other = Folder::new("new-folders-failed-there");
    let is_empty = || fs::read_dir(other.path()).expect("a folder").count() == 0;
    // No file system has names of this length.
    let long = |ending: &str| other.join("a/b").join(format!("{}.{ending}", "x".repeat(300)));
    let mut model = TestDocument::new(&folder.join("autosave"));
    model.open(&fox(&folder));
    model.edit(turn(0.5));
    for to in [SaveTo::As(long("glb")), SaveTo::Copy(long("glb"))] {
        not_saved(&mut model, to);
        assert!(is_empty());
    }
    let (path, held) = (whole_project(&folder), HeldSave::at(FaultPoint::CopiedFile(3)));
    let mut project = document(&folder.join("autosave-of-project"), &held);
    project.open(&path);
    project.wait_for_view(is_read);
    not_saved(&mut project, SaveTo::As(long("meproj")));
    assert!(is_empty());
    held.hold_save(&project, SaveTo::As(other.join("a/b/foxes.meproj")));
    assert_eq!(files(&other.join("a/b")).len(), 3);
    project.send(DocumentMessage::CancelLoading);
    project.wait_for_warning("stops after the file");
    held.release();
    project.wait_for_reply(|reply| match reply {
        DocumentReply::NotSaved(_, reason) => {
            assert_eq!(*reason, NotSaved::Cancelled(Vec::new()));
            Some(())
        }
        _ => None,
    });
    assert!(is_empty());
}

#[test]
fn a_file_in_place_of_a_folder_is_an_error_and_a_path_back_out_of_a_missing_folder_makes_none() {
    let folder = Folder::new("new-folders-file");
    let path = fox(&folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    document.edit(turn(0.5));
    for (place, word) in [("Fox.glb/b/c.glb", "this is not a folder"), ("a/../b/c.glb", "does not exist")] {
        assert_eq!(created(&mut document, folder.join(place).parent().expect("a folder").to_owned()), None);
        let reason = not_saved(&mut document, SaveTo::As(folder.join(place)));
        assert!(reason.contains(word), "{reason}");
    }
    assert!(!folder.join("a").exists() && !folder.join("b").exists());
}
