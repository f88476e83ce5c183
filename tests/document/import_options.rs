//! Units, axes and frame rates that the user chose are those of the document as long as it is open: after saves, and in the journal.

use dragonfly_anim::format::{Conventions, Handedness, UpAxis};
use dragonfly_document::edit::Edit;
use dragonfly_document::{Decision, DocumentMessage, SaveTo, Source, View};
use dragonfly_kit::document::test_document::{TestDocument, copy_after_kill};
use dragonfly_kit::folder::{Folder, data};
use std::fs;
use std::path::{Path, PathBuf};

/// Conventions that differ from those of the file in everything.
const CHOSEN: Conventions = Conventions {
    meters_per_unit: Some(0.5),
    up: Some(UpAxis::Z),
    handedness: Some(Handedness::Left),
    frame_rate: None,
};

fn capture(folder: &Folder) -> PathBuf {
    let path = folder.join("capture.bvh");
    fs::copy(data("bvh/pybvh_example.bvh"), &path).expect("a copy");
    path
}

fn turn(view: &View) -> Edit {
    let bone = &view.loaded.model.animation.skeleton.bones[2].name;
    let json = format!(
        r#"{{"edit":"set","take":0,"time":0,"poses":[{{"bone":"{bone}","rotation":[0.1,0.2,0.3,0.9273618]}}]}}"#
    );
    serde_json::from_str(&json).expect("an edit")
}

fn rests(view: &View) -> Vec<glam::Vec3> {
    view.loaded.model.animation.skeleton.bones.iter().map(|bone| bone.rest.translation).collect()
}

fn chosen(path: &Path) -> Source {
    Source::of(path.to_owned(), CHOSEN)
}

#[test]
fn a_file_is_read_with_the_chosen_conventions_and_says_so() {
    let folder = Folder::new("import-options");
    let path = capture(&folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    let plain = document.open(&path);
    let view = document.open_source(chosen(&path));
    assert_eq!(view.loaded.conversion.chosen(), CHOSEN);
    // In the file, Z is up now, and its x axis stays: a length along it differs by the unit only.
    let unit = plain.loaded.conversion.meters_per_unit.value;
    for (plain, other) in rests(&plain).into_iter().zip(rests(&view)) {
        let expected = glam::Vec3::new(plain.x, plain.z, plain.y) * (0.5 / unit);
        assert!(
            (other - expected).length() < 1e-5 * (1.0 + expected.length()),
            "{other} instead of {expected}"
        );
    }
    assert!(rests(&view).iter().any(|rest| rest.length() > 0.0));
}

#[test]
fn a_save_and_the_edits_after_it_keep_the_chosen_conventions() {
    let folder = Folder::new("import-options-save");
    let path = capture(&folder);
    let before = fs::read_to_string(&path).expect("text");
    let mut document = TestDocument::new(&folder.join("autosave"));
    let view = document.open_source(chosen(&path));
    document.edit(turn(&view));
    document.wait_for_view(|view| view.history.done == 1);
    document.save(SaveTo::Own);
    let once = fs::read_to_string(&path).expect("text");
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    let differing = lines(&before).iter().zip(lines(&once)).filter(|(old, new)| **old != *new).count();
    assert_eq!(differing, 1, "one frame was edited");
    let of_edit = document.view();
    // A second save starts from the bytes of the first.
    document.change(dragonfly_document::Change::Undo);
    document.wait_for_view(|view| view.history.done == 0);
    document.save(SaveTo::Own);
    let mut other = TestDocument::new(&folder.join("other"));
    let back = other.open_source(chosen(&path));
    let first = view.takes[0].tracks[2].rotation.value(0).expect("a key");
    let read = back.takes[0].tracks[2].rotation.value(0).expect("a key");
    assert!(first.dot(read).abs() > 1.0 - 1e-6, "{first} was saved as {read}");
    fs::write(&path, once).expect("written");
    let read = other.open_source(chosen(&path)).takes[0].tracks[2].rotation.value(0).expect("a key");
    let edited = of_edit.takes[0].tracks[2].rotation.value(0).expect("a key");
    assert!(edited.dot(read).abs() > 1.0 - 1e-6, "{edited} was saved as {read}");
}

#[test]
fn work_of_a_killed_program_is_restored_with_the_chosen_conventions() {
    let folder = Folder::new("import-options-killed");
    let path = capture(&folder);
    let mut document = TestDocument::new(&folder.join("first"));
    let view = document.open_source(chosen(&path));
    document.edit(turn(&view));
    let before = document.wait_for_view(|view| view.history.done == 1);
    copy_after_kill(&folder.join("first"), &folder.join("second"));

    let mut document = TestDocument::new(&folder.join("second"));
    document.open_source(Source::BuiltIn);
    let [offer] = &document.wait_for_offers()[..] else { panic!("one document") };
    assert_eq!(offer.source, Some(chosen(&path)));
    document.send(DocumentMessage::Decide(Box::new(offer.clone()), Decision::Keep));
    let after = document.wait_for_view(|view| view.history.done == 1 && view.loaded.path.is_some());
    assert_eq!(after.loaded.conversion, before.loaded.conversion);
    assert_eq!(rests(&after), rests(&before));
    assert_eq!(after.takes[0].tracks, before.takes[0].tracks);
}
