//! Scripts that include others, opened, followed, recovered, packed and asked about.

use super::scenes::{replaced, scene_of};
use super::scenes_kept::restored;
use dragonfly_document::archive::read_archive;
use dragonfly_document::protocol::Session;
use dragonfly_document::{
    Cancel, DocumentMessage, Editable, PackError, SaveTo, Source, View, check_scene, load_scene, pack,
};
use dragonfly_kit::document::test_document::{TestDocument, copy_after_kill, fox};
use dragonfly_kit::folder::Folder;
use serde_json::Value;
use std::fs;
use std::path::PathBuf;

const SCENE: &str = "<script version=\"1\">\n  <seq>\n    <include id=\"in\" src=\"parts/intro.xml\"/>\n    <wait dur=\"1\"/>\n  </seq>\n</script>\n";

/// In a folder of its own, with a model there.
const INTRO: &str = "<script version=\"1\" fps=\"10\">\n  <cast><role id=\"fox\" model=\"Fox.glb\" scale=\"0.01\"/></cast>\n  <wait dur=\"20f\"/>\n  \
    <play who=\"fox\" take=\"Walk\"/>\n  <include src=\"more.xml\" begin=\"1\"/>\n</script>\n";

const MORE: &str = "<script version=\"1\"><wait dur=\"0.5\"/></script>";

fn scene(folder: &Folder) -> PathBuf {
    fs::create_dir(folder.join("parts")).expect("a folder");
    fs::rename(fox(folder), folder.join("parts/Fox.glb")).expect("a file");
    for (name, text) in [("scene.xml", SCENE), ("parts/intro.xml", INTRO), ("parts/more.xml", MORE)] {
        fs::write(folder.join(name), text).expect("a file");
    }
    folder.join("scene.xml")
}

/// Returns the length of what plays; `None` while something is read or wrong.
fn length(view: &View) -> Option<f64> {
    let scene = view.scene.as_ref()?;
    let plan = scene
        .plan
        .as_ref()
        .filter(|plan| scene.is_current() && plan.things().iter().all(|thing| !thing.is_missing));
    plan.map(|plan| plan.length().seconds())
}

#[test]
fn a_script_plays_what_it_includes_with_models_from_the_folder_of_that_and_follows_other_programs() {
    let folder = Folder::new("include-open");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&scene(&folder));
    let view = document.wait_for_view(|view| length(view) == Some(3.0));
    let scene = scene_of(&view);
    let names: Vec<&str> = scene.includes.texts().map(|(name, _)| name).collect();
    assert_eq!(names, ["parts/intro.xml", "parts/more.xml"]);
    assert!(scene.notes.is_empty() && scene.models.contains_key("parts/Fox.glb"), "{:?}", scene.notes);
    assert_eq!(scene.texts.list().len(), 1, "an included file is no text of the document");
    // Another program makes the file two seconds longer, then breaks it, then removes it.
    let look = |document: &mut TestDocument, text: Option<String>| {
        match text {
            Some(text) => fs::write(folder.join("parts/intro.xml"), text).expect("a file"),
            None => fs::remove_file(folder.join("parts/intro.xml")).expect("a file"),
        }
        document.send(DocumentMessage::LookAtFile);
    };
    look(&mut document, Some(INTRO.replace("20f", "40f")));
    document.wait_for_view(|view| length(view) == Some(5.0));
    look(&mut document, Some(INTRO.replace("20f", "soon")));
    let view = document.wait_for_view(|view| !scene_of(view).errors.is_empty());
    let error = &scene_of(&view).errors[0];
    assert!(error.text().starts_with("parts/intro.xml:3:14: dur=\"soon\" is not a time"), "{error}");
    assert_eq!((error.place.line, &SCENE[error.range.clone()]), (3, "include"));
    assert_eq!(
        scene_of(&view).plan.as_ref().map(|plan| plan.length().seconds()),
        Some(5.0),
        "the last good one plays"
    );
    look(&mut document, None);
    let view = document
        .wait_for_view(|view| scene_of(view).errors.first().is_some_and(|error| error.inside.is_none()));
    let error = scene_of(&view).errors[0].text();
    assert_eq!(
        error,
        "parts/intro.xml cannot be read: there is no such file; did you mean \"parts/more.xml\"? (scripts: parts/more.xml)"
    );
    look(&mut document, Some(INTRO.to_owned()));
    document.wait_for_view(|view| length(view) == Some(3.0));
    // One that an included file includes.
    fs::write(folder.join("parts/more.xml"), MORE.replace("0.5", "4")).expect("a file");
    document.send(DocumentMessage::LookAtFile);
    document.wait_for_view(|view| length(view) == Some(6.0));
}

#[test]
fn edits_choose_other_files_and_are_recovered_after_a_kill() {
    let folder = Folder::new("include-recovered");
    let autosave = folder.join("autosave");
    let mut document = TestDocument::new(&autosave);
    let path = scene(&folder);
    document.open(&path);
    document.wait_for_view(|view| length(view) == Some(3.0));
    document.edit(replaced(SCENE, "parts/intro.xml", "parts/intr.xml"));
    let view = document
        .wait_for_view(|view| scene_of(view).errors.first().is_some_and(|error| !error.help.is_empty()));
    assert!(
        scene_of(&view).errors[0].text().contains("did you mean \"parts/intro.xml\"?"),
        "{}",
        scene_of(&view).errors[0]
    );
    document.edit(replaced(&scene_of(&view).text, "parts/intr.xml", "parts/more.xml"));
    document.wait_for_view(|view| length(view) == Some(1.5));
    copy_after_kill(&autosave, &folder.join("killed"));
    drop(document);
    let (mut document, _) = restored(&path, &folder.join("killed"), 2);
    let view = document.wait_for_view(|view| length(view) == Some(1.5));
    assert_eq!(*scene_of(&view).text, *SCENE.replace("intro", "more"));
    document.save(SaveTo::Own);
    assert_eq!(fs::read_to_string(path).expect("a file"), SCENE.replace("intro", "more"));
    assert_eq!(
        fs::read_to_string(folder.join("parts/intro.xml")).expect("a file"),
        INTRO,
        "no other file is written"
    );
}

#[test]
fn a_script_is_packed_with_what_it_includes_and_plays_as_before_where_it_is_unpacked() {
    let folder = Folder::new("include-pack");
    let path = scene(&folder);
    let bytes = pack(&path, &Cancel::default()).expect("an archive");
    let names: Vec<String> = read_archive(&bytes).expect("files").into_iter().map(|file| file.name).collect();
    assert_eq!(names, ["scene.xml", "parts/Fox.glb", "parts/intro.xml", "parts/more.xml"]);
    let scene = load_scene(&path, None, &Cancel::default()).expect("a scene");
    assert_eq!(scene.plan.length().seconds(), 3.0);
    fs::remove_file(folder.join("parts/more.xml")).expect("a file");
    let Err(PackError::Files(reasons)) = pack(&path, &Cancel::default()) else { panic!("it was packed") };
    assert!(
        reasons[0].starts_with("parts/intro.xml:5:17: parts/more.xml cannot be read: there is no such file"),
        "{reasons:?}"
    );
}

#[cfg(unix)]
#[test]
fn a_file_outside_of_the_folder_is_not_included_through_a_link() {
    let folder = Folder::new("include-outside");
    let path = scene(&folder);
    fs::create_dir(folder.join("in")).expect("a folder");
    fs::copy(&path, folder.join("in/scene.xml")).expect("a file");
    std::os::unix::fs::symlink(folder.join("parts"), folder.join("in/parts")).expect("a link");
    let error = load_scene(&folder.join("in/scene.xml"), None, &Cancel::default()).expect_err("it leads out");
    assert!(error.to_string().contains("scene.xml:3:27: parts/intro.xml cannot be read"), "{error}");
    assert!(error.to_string().contains("leads out of"), "{error}");
}

#[test]
fn the_protocol_says_in_which_file_an_error_and_an_action_are() {
    let folder = Folder::new("include-answers");
    let path = scene(&folder);
    let answer = |query: &str| -> Value {
        let editable = Editable::open(&Source::File(path.clone()), &Cancel::default()).expect("a script");
        let answer = Session::new(editable).answer(&format!("{{\"query\":\"{query}\"}}")).expect("an answer");
        serde_json::from_str::<Value>(&answer).expect("JSON")["ok"].clone()
    };
    let schedule = answer("schedule");
    let files: Vec<Option<&str>> =
        schedule["actions"].as_array().expect("actions").iter().map(|row| row["file"].as_str()).collect();
    let (intro, more) = (Some("parts/intro.xml"), Some("parts/more.xml"));
    assert_eq!(files, [None, None, None, intro, intro, intro, more, None]);
    assert_eq!((&schedule["length"], &schedule["actions"][5]["line"]), (&3.0.into(), &5.into()));
    fs::write(folder.join("parts/intro.xml"), INTRO.replace("Walk", "Fly")).expect("a file");
    let errors = answer("errors");
    let error = &errors["errors"][0];
    assert_eq!((&error["line"], &error["column"]), (&3.into(), &6.into()), "{errors}");
    let inside = &error["inside"];
    assert_eq!(
        (&inside["file"], &inside["line"], &inside["column"]),
        (&"parts/intro.xml".into(), &4.into(), &25.into()),
        "{errors}"
    );
}

#[test]
fn a_name_that_was_corrected_is_not_read_again_when_the_window_gets_the_focus() {
    let folder = Folder::new("include-corrected");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&scene(&folder));
    document.wait_for_view(|view| length(view) == Some(3.0));
    document.edit(replaced(SCENE, "parts/intro.xml", "parts/intr.xml"));
    let view = document
        .wait_for_view(|view| scene_of(view).errors.first().is_some_and(|error| !error.help.is_empty()));
    document.edit(replaced(&scene_of(&view).text, "parts/intr.xml", "parts/intro.xml"));
    document.wait_for_view(|view| length(view) == Some(3.0));
    let before = document.view();
    document.send(DocumentMessage::LookAtFile);
    let after = document.view();
    assert!(std::sync::Arc::ptr_eq(scene_of(&before), scene_of(&after)), "it was planned again");
}

/// Returns a script that includes `count` files of a folder.
fn hostile(count: usize) -> String {
    let includes: String =
        (0..count).map(|number| format!("  <include src=\"parts/f{number}.xml\"/>\n")).collect();
    format!("<script version=\"1\">\n{includes}</script>\n")
}

#[test]
fn of_many_files_that_are_missing_a_hundred_are_looked_for_and_a_check_of_them_is_cancelled() {
    let folder = Folder::new("include-many");
    let path = scene(&folder);
    fs::write(&path, hostile(150)).expect("a file");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let view = document.wait_for_view(|view| {
        let missing = |reason: &str| reason != "is being read";
        scene_of(view).includes.missing().any(|(_, file)| missing(&file.reason))
    });
    let files: Vec<_> = scene_of(&view).includes.missing().collect();
    let suggested = files.iter().filter(|(_, file)| !file.beside.is_empty()).count();
    assert_eq!((files.len(), suggested), (150, 100));
    assert_eq!(scene_of(&view).errors.len(), 100);
    // Nothing more is read for it.
    let (before, after) = (document.view(), document.view());
    assert!(std::sync::Arc::ptr_eq(scene_of(&before), scene_of(&after)));
    let cancelled = Cancel::default();
    cancelled.cancel();
    let error = check_scene(&path, &cancelled).expect_err("it was cancelled");
    assert_eq!(error.to_string(), "cancelled");
    assert!(pack(&path, &cancelled).is_err_and(|error| error.to_string() == "cancelled"));
}

#[test]
fn the_files_that_are_suggested_for_a_missing_one_are_the_first_in_alphabetical_order() {
    let folder = Folder::new("include-sorted");
    let path = scene(&folder);
    for number in 0..1500 {
        fs::write(folder.join(&format!("parts/b{number:04}.xml")), MORE).expect("a file");
    }
    fs::write(&path, SCENE.replace("intro", "b00")).expect("a file");
    let error = load_scene(&path, None, &Cancel::default()).expect_err("it is missing").to_string();
    assert!(error.contains("did you mean \"parts/b0000.xml\"?"), "{error}");
}
