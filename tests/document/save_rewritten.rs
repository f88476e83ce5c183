//! A format of which a save writes the whole file: the user is asked before the file of the document is replaced, and only then.

use dragonfly_anim::format::{Format, NoFiles, ReadOptions};
use dragonfly_document::protocol::Session;
use dragonfly_document::{
    Cancel, DocumentMessage, DocumentReply, LoadError, NotSaved, OpenedModel, Progress, SaveOrder, SaveTo,
    SavedFile, Setup, Source, load_model,
};
use dragonfly_fbx::{FBX, read_in_process};
use dragonfly_kit::document::test_document::{TestDocument, rename};
use dragonfly_kit::folder::{Folder, data};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Opens FBX files with a parser in this process: the program starts itself as the parser, and these tests are another program.
fn opened(
    source: &Source,
    progress: &mut dyn FnMut(Progress),
    cancel: &Cancel,
) -> Result<OpenedModel, LoadError> {
    let path = source.path().expect("a file");
    let bytes = fs::read(path).expect("a file");
    let here = Format { read: read_in_process, ..FBX };
    let mut imported = here.import(&bytes, &NoFiles, &ReadOptions::default()).expect("a model");
    // Something that the format does not store.
    imported.model.materials.first_mut().expect("a material").unlit = true;
    let mut loaded = load_model(&Source::BuiltIn, progress, cancel)?;
    (loaded.title, loaded.path, loaded.format) = (source.title(), Some(path.to_owned()), Some(FBX));
    (loaded.model, loaded.conversion) = (Arc::new(imported.model), imported.conversion);
    Ok(OpenedModel::of_bytes(loaded, source, bytes))
}

/// Opens a copy of an FBX file in a folder of the test.
fn cube(folder: &Folder) -> (TestDocument, PathBuf, Vec<u8>) {
    let path = folder.join("Cube.fbx");
    let bytes = fs::read(data("fbx/maya_blend_shape_cube_7700_binary.fbx")).expect("a file");
    fs::write(&path, &bytes).expect("a file");
    let mut document = TestDocument::with(Setup { load: opened, ..Setup::default() });
    document.open(&path);
    (document, path, bytes)
}

fn save(document: &mut TestDocument, to: SaveTo, rewrite: bool) -> Result<SavedFile, NotSaved> {
    document.send(DocumentMessage::Save(SaveOrder { to, rewrite, ..SaveOrder::own(None) }));
    document.wait_for_reply(|reply| match reply {
        DocumentReply::Saved(saved) => Some(Ok(saved.clone())),
        DocumentReply::NotSaved(_, reason) => Some(Err(reason.clone())),
        _ => None,
    })
}

/// Returns how many of the sentences are about what the format does not store.
fn losses<'a>(sentences: impl IntoIterator<Item = &'a str>) -> usize {
    sentences.into_iter().filter(|text| text.contains("that it is not lit is not stored")).count()
}

#[test]
fn what_a_save_of_the_whole_file_loses_is_reported_once_for_each_file() {
    let folder = Folder::new("rewritten-lost");
    let (mut document, _, _) = cube(&folder);
    let mut save = |edit: &str, to: SaveTo| {
        document.edit(rename(edit));
        let saved = save(&mut document, to, true).expect("the user has decided");
        losses(saved.notices.iter().map(String::as_str))
    };
    let [copy, other] = ["Copy.fbx", "Other.fbx"].map(|name| folder.join(name));
    assert_eq!(save("Stroll", SaveTo::Copy(copy)), 1);
    assert_eq!(save("Jog", SaveTo::Own), 1);
    assert_eq!(save("Run", SaveTo::Own), 0, "the file has lost it already");
    assert_eq!(save("Sprint", SaveTo::As(other)), 1);
}

#[test]
fn a_session_answers_what_its_save_of_the_whole_file_lost() {
    let folder = Folder::new("rewritten-session");
    let path = folder.join("Cube.fbx");
    fs::copy(data("fbx/maya_blend_shape_cube_7700_binary.fbx"), &path).expect("a file");
    let opened = opened(&Source::File(path), &mut |_| {}, &Cancel::default()).expect("a model");
    let mut session = Session::new(opened.editable.expect("it can be saved"));
    let lost = |session: &mut Session| {
        let answer = session.answer(r#"{"do":"save"}"#).expect("an answer");
        let answer: Value = serde_json::from_str(&answer).expect("JSON");
        assert_eq!(answer["ok"]["written"].as_array().map(Vec::len), Some(1), "{answer}");
        let lost = answer["ok"]["lost"].as_array().cloned().unwrap_or_default();
        losses(lost.iter().filter_map(Value::as_str))
    };
    assert_eq!(lost(&mut session), 0, "nothing was edited, so the file keeps its bytes");
    session.answer(&serde_json::json!({"do": "edit", "edit": rename("Stroll")}).to_string());
    assert_eq!(lost(&mut session), 1);
}

/// Returns the name of the first take of an FBX file.
fn first_take(path: &Path) -> String {
    let bytes = fs::read(path).expect("a file");
    let here = Format { read: read_in_process, ..FBX };
    let read = here.import(&bytes, &NoFiles, &ReadOptions::default()).expect("a model");
    read.model.animation.takes[0].name.clone()
}

#[test]
fn a_copy_replaces_nothing_and_does_not_decide_about_the_file_of_the_document() {
    let folder = Folder::new("rewritten-copy");
    let (mut document, path, bytes) = cube(&folder);
    document.edit(rename("Stroll"));
    // Neither a copy without the decision nor one with it, which an older dialog may have left in the order.
    for (name, rewrite) in [("a.fbx", false), ("b.fbx", true)] {
        let copy = folder.join(name);
        let saved = save(&mut document, SaveTo::Copy(copy.clone()), rewrite).expect("no question");
        assert!(saved.copy);
        assert_eq!(first_take(&copy), "Stroll");
    }
    // Nor a decision about another file, which was then not written.
    let there = folder.join("a.fbx");
    assert_eq!(save(&mut document, SaveTo::As(there.clone()), true), Err(NotSaved::Exists(there)));
    assert_eq!(save(&mut document, SaveTo::Own, false), Err(NotSaved::Rewritten));
    assert!(fs::read(&path).expect("a file") == bytes, "nothing is written before the answer");
    save(&mut document, SaveTo::Own, true).expect("the user has decided");
    assert_eq!(first_take(&path), "Stroll");
    // The decision holds as long as the file is open.
    document.edit(rename("Run"));
    save(&mut document, SaveTo::Own, false).expect("no second question");
    assert_eq!(first_take(&path), "Run");
}

#[test]
fn a_file_without_edits_keeps_its_bytes_and_nothing_is_asked() {
    let folder = Folder::new("rewritten-same");
    let (mut document, path, bytes) = cube(&folder);
    save(&mut document, SaveTo::Own, false).expect("no question");
    assert!(fs::read(&path).expect("a file") == bytes);
    // An edit that is undone is none.
    document.edit(rename("Stroll"));
    document.change(dragonfly_document::Change::Undo);
    save(&mut document, SaveTo::Own, false).expect("no question");
    assert!(fs::read(&path).expect("a file") == bytes);
    let other = folder.join("Other.fbx");
    save(&mut document, SaveTo::As(other.clone()), false).expect("no question");
    assert!(fs::read(&other).expect("a file") == bytes);
    document.edit(rename("Stroll"));
    assert_eq!(save(&mut document, SaveTo::Own, false), Err(NotSaved::Rewritten));
    assert_eq!(
        save(&mut document, SaveTo::As(folder.join("Third.fbx")), false),
        Err(NotSaved::Rewritten),
        "the new file would be the document"
    );
}
