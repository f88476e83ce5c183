//! A model whose edits the project keeps has no journal until it is edited. A save creates it, so that nothing is lost while it runs.

use super::projects::{is_read, project};
use super::save_in_background::{HeldSave, POINTS, document, restored, wait_until_saved};
use super::scene_models::enter;
use super::scene_models_later::keep_rename;
use dragonfly_document::SaveTo;
use dragonfly_kit::document::test_document::{copy_after_kill, same_takes, turn};
use dragonfly_kit::folder::Folder;

#[test]
fn an_edit_during_the_first_save_of_a_model_with_kept_edits_survives_a_kill_and_nothing_is_applied_twice() {
    for at in POINTS {
        let folder = Folder::new(&format!("save-kept-{at:?}"));
        let (path, held) = (project(&folder), HeldSave::at(at));
        let (fox, autosave) = (folder.join("models/Fox.glb"), folder.join("autosave"));
        let mut document = document(&autosave, &held);
        document.open(&path);
        document.wait_for_view(is_read);
        keep_rename(&mut document);
        document.save(SaveTo::Own);
        assert_eq!(enter(&mut document).history.done, 1);
        held.hold_save(&document, SaveTo::Own);
        document.edit(turn(0.4));
        let before = document.wait_for_view(|view| view.history.done == 2);
        copy_after_kill(&autosave, &folder.join("during"));
        let (steps, view) = restored(&folder.join("during"), &fox);
        assert_eq!((steps, view.history.done), (2, 2), "{at:?}: the file is the old one");
        same_takes(&view, &before);

        held.release();
        wait_until_saved(&mut document);
        copy_after_kill(&autosave, &folder.join("after"));
        let (steps, view) = restored(&folder.join("after"), &fox);
        assert_eq!((steps, view.history.done), (1, 2), "{at:?}: the file has the kept edit");
        assert_eq!(view.history.saved_at, Some(1));
        same_takes(&view, &before);
    }
}
