//! A project or a script that is saved in another folder takes along what it needs, and nothing that is there is overwritten.

use super::projects::{END, LINES, MAIN, PROJECT, is_read, project, replaced_in};
use super::save_in_background::{HeldSave, document, restored};
use super::scenes::{replaced, scene_of};
use dragonfly_document::protocol::Session;
use dragonfly_document::{
    Cancel, DocumentMessage, DocumentReply, Editable, FaultPoint, NotSaved, SaveOrder, SaveTo, SceneModel,
    Source, check_scene,
};
use dragonfly_kit::document::test_document::TestDocument;
use dragonfly_kit::folder::Folder;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

const BOX: &str = r#"{"asset":{"version":"2.0"},"buffers":[{"uri":"data/points.bin","byteLength":36}],
    "bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
    "min":[0,0,0],"max":[1,1,0]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],
    "scenes":[{"nodes":[0]}],"scene":0}"#;

/// The edit of the fox that the project keeps.
const EDITS: &str = "{\"edit\":\"rename_take\",\"take\":0,\"name\":\"Look around\"}\n";

/// Writes a sound of a tenth of a second.
fn write_sound(path: &Path) {
    let samples = [0_u8; 1600];
    let mut bytes = b"RIFF".to_vec();
    bytes.extend((36 + samples.len() as u32).to_le_bytes());
    bytes.extend(b"WAVEfmt \x10\0\0\0\x01\0\x01\0");
    bytes.extend(8000_u32.to_le_bytes());
    bytes.extend(16000_u32.to_le_bytes());
    bytes.extend(b"\x02\0\x10\0data");
    bytes.extend((samples.len() as u32).to_le_bytes());
    bytes.extend(samples);
    fs::write(path, bytes).expect("a file");
}

/// Writes a project that needs files of every kind, into the folder `own`, and returns its path.
pub(super) fn whole_project(folder: &Folder) -> PathBuf {
    let made = project(folder);
    for inside in ["own", "own/props/data", "own/parts", "own/sound", "own/sky", "own/foxes.edits"] {
        fs::create_dir_all(folder.join(inside)).expect("a folder");
    }
    for name in ["models", "foxes.meproj", "main.xml", "end.xml", "foxes.lines.xml"] {
        fs::rename(folder.join(name), folder.join("own").join(name)).expect("a file");
    }
    let own = |name: &str| folder.join("own").join(name);
    let text = PROJECT
        .replace("</models>", "<edits of=\"fox\" src=\"foxes.edits/fox.jsonl\"/>\n  </models>")
        .replace("  <cast>", "  <scene sky=\"sky/dusk.png\"/>\n  <cast>");
    fs::write(own("foxes.meproj"), text).expect("a file");
    fs::write(own("foxes.edits/fox.jsonl"), EDITS).expect("a file");
    let script =
        MAIN.replace("</cast>", "  <prop id=\"crate\" model=\"props/box.gltf\"/>\n  </cast>").replace(
            "<!-- she walks -->",
            "<include src=\"parts/more.xml\"/>\n  <sound src=\"sound/step.wav\"/>",
        );
    fs::write(own("main.xml"), script).expect("a file");
    fs::write(own("parts/more.xml"), "<script version=\"1\">\n  <wait dur=\"1\"/>\n</script>\n")
        .expect("a file");
    fs::write(own("props/box.gltf"), BOX).expect("a file");
    let points = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat();
    fs::write(own("props/data/points.bin"), points).expect("a file");
    write_sound(&own("sound/step.wav"));
    fs::write(own("sky/dusk.png"), "a picture").expect("a file");
    fs::write(own("notes.txt"), "not needed").expect("a file");
    own(made.file_name().and_then(|name| name.to_str()).expect("a name"))
}

/// The names of the files that the project needs, apart from itself.
pub(super) const NEEDED: [&str; 10] = [
    "end.xml",
    "foxes.edits/fox.jsonl",
    "foxes.lines.xml",
    "main.xml",
    "models/Fox.glb",
    "parts/more.xml",
    "props/box.gltf",
    "props/data/points.bin",
    "sky/dusk.png",
    "sound/step.wav",
];

/// Returns the files below a folder, by their names relative to it.
pub(super) fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    fn add(found: &mut BTreeMap<String, Vec<u8>>, root: &Path, folder: &Path) {
        for entry in fs::read_dir(folder).expect("a folder").flatten() {
            let path = entry.path();
            if path.is_dir() {
                add(found, root, &path);
                continue;
            }
            let name = path.strip_prefix(root).expect("inside").to_string_lossy().replace('\\', "/");
            found.insert(name, fs::read(&path).expect("a file"));
        }
    }
    let mut found = BTreeMap::new();
    add(&mut found, folder, folder);
    found
}

/// Returns what is wrong with a scene.
fn errors(path: &Path) -> Vec<String> {
    let checked = check_scene(path, &Cancel::default()).expect("it can be read");
    checked.iter().flat_map(|text| text.errors.iter().chain(&text.unfit)).map(ToString::to_string).collect()
}

/// Saves, and returns the reason why it failed.
pub(super) fn not_saved(document: &mut TestDocument, to: SaveTo) -> String {
    document.send(DocumentMessage::Save(SaveOrder { to, anyway: true, ..SaveOrder::own(None) }));
    document.wait_for_reply(|reply| match reply {
        DocumentReply::NotSaved(_, NotSaved::Failed(reason)) => Some(reason.clone()),
        DocumentReply::NotSaved(_, other) => panic!("{other:?}"),
        DocumentReply::Saved(saved) => panic!("{saved:?}"),
        _ => None,
    })
}

#[test]
fn a_project_that_is_saved_in_another_folder_takes_along_everything_that_it_needs() {
    let folder = Folder::new("moved-all");
    let path = whole_project(&folder);
    assert_eq!(errors(&path), [""; 0]);
    let before = files(&folder.join("own"));
    let other = Folder::new("moved-all-there");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    document.wait_for_view(is_read);
    document.edit(replaced_in("end.xml", END, "The End", "Fin"));
    let saved = document.save(SaveTo::As(other.join("moved.meproj")));
    assert_eq!((saved.notices.as_slice(), saved.beside), (&[][..], NEEDED.len()));
    let there = files(other.path());
    let names: Vec<&str> = there.keys().map(String::as_str).filter(|name| *name != "moved.meproj").collect();
    assert_eq!(names, NEEDED);
    for name in NEEDED.iter().filter(|name| **name != "end.xml") {
        assert_eq!(there[*name], before[*name], "{name}");
    }
    assert_eq!(there["end.xml"], END.replace("The End", "Fin").into_bytes());
    assert_eq!(there["moved.meproj"], before["foxes.meproj"]);
    assert!(files(&folder.join("own")) == before, "the original folder is as it was");
    // Nothing is missing there, although the original is gone.
    fs::remove_dir_all(folder.join("own")).expect("a folder");
    assert_eq!(errors(&other.join("moved.meproj")), [""; 0]);
    document.send(DocumentMessage::LookAtFile);
    let view = document.wait_for_view(|view| is_read(view) && view.history.saved);
    assert!(scene_of(&view).notes.is_empty(), "{:?}", scene_of(&view).notes);
    // Later saves go to the new place, also of a text that did not change on the way.
    let main = String::from_utf8(there["main.xml"].clone()).expect("text");
    document.edit(replaced_in("main.xml", &main, "speed=\"1\"", "speed=\"2\""));
    document.save(SaveTo::Own);
    assert_eq!(
        fs::read_to_string(other.join("main.xml")).expect("a file"),
        main.replace("speed=\"1\"", "speed=\"2\"")
    );
}

#[test]
fn a_script_alone_takes_its_models_along_too_and_a_copy_leaves_the_document_where_it_is() {
    let folder = Folder::new("moved-script");
    whole_project(&folder);
    let path = folder.join("own/scene.xml");
    let text = "<script version=\"1\"><cast><role id=\"a\" model=\"models/Fox.glb\"/></cast>\
                <include src=\"parts/more.xml\"/></script>";
    fs::write(&path, text).expect("a file");
    let other = Folder::new("moved-script-there");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    document.wait_for_view(is_read);
    assert!(document.save(SaveTo::Copy(other.join("copy.xml"))).copy);
    assert_eq!(
        files(other.path()).into_keys().collect::<Vec<_>>(),
        ["copy.xml", "models/Fox.glb", "parts/more.xml"]
    );
    assert_eq!(document.view().file.path.as_deref(), Some(&*path));
    // A name that something needed has is no name for the script.
    fs::create_dir(folder.join("there")).expect("a folder");
    let text = text.replace("parts/more.xml", "more.xml");
    fs::write(folder.join("own/more.xml"), "<script version=\"1\"><wait dur=\"1\"/></script>")
        .expect("a file");
    let view = document.view();
    document.edit(replaced(&scene_of(&view).text, "parts/more.xml", "more.xml"));
    document.wait_for_view(|view| *scene_of(view).text == *text);
    let reason = not_saved(&mut document, SaveTo::As(folder.join("there/more.xml")));
    assert!(reason.contains("more.xml") && reason.contains("another name"), "{reason}");
    assert!(files(&folder.join("there")).is_empty());
}

#[test]
fn a_file_that_is_there_already_must_be_the_one_that_is_needed_or_nothing_is_written() {
    let folder = Folder::new("moved-there");
    let path = whole_project(&folder);
    let other = Folder::new("moved-there-other");
    fs::create_dir_all(other.join("props/data")).expect("a folder");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    document.wait_for_view(is_read);
    let target = || SaveTo::As(other.join("foxes.meproj"));
    for name in ["props/data/points.bin", "end.xml"] {
        fs::write(other.join(name), "of another program").expect("a file");
        let reason = not_saved(&mut document, target());
        assert!(reason.starts_with(&other.join(name).display().to_string()), "{reason}");
        assert_eq!(files(other.path()).into_keys().collect::<Vec<_>>(), [name]);
        assert_eq!(fs::read_to_string(other.join(name)).expect("a file"), "of another program");
        fs::remove_file(other.join(name)).expect("it is there");
    }
    // A file of the same length is compared, too.
    fs::write(other.join("end.xml"), END.replace("The End", "The Ent")).expect("a file");
    not_saved(&mut document, target());
    // The same files are no obstacle, and are texts of the project from then on.
    fs::write(other.join("end.xml"), END).expect("a file");
    fs::copy(folder.join("own/props/data/points.bin"), other.join("props/data/points.bin")).expect("a copy");
    let saved = document.save(target());
    assert_eq!((saved.notices.as_slice(), saved.beside), (&[][..], NEEDED.len() - 2));
    document.edit(replaced_in("end.xml", END, "The End", "Fin"));
    document.save(SaveTo::Own);
    assert_eq!(fs::read_to_string(other.join("end.xml")).expect("a file"), END.replace("The End", "Fin"));
    fs::write(other.join("end.xml"), "of another program").expect("a file");
    document.send(DocumentMessage::LookAtFile);
    document.wait_for_reply(|reply| matches!(reply, DocumentReply::FileChanged(_)).then_some(()));
}

#[test]
fn a_missing_model_stays_missing_and_is_named_and_so_is_a_file_that_a_model_lacks() {
    let folder = Folder::new("moved-missing");
    let path = whole_project(&folder);
    fs::remove_file(folder.join("own/models/Fox.glb")).expect("a file");
    fs::remove_file(folder.join("own/props/data/points.bin")).expect("a file");
    let other = Folder::new("moved-missing-there");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let saved = document.save(SaveTo::As(other.join("foxes.meproj")));
    let all = saved.notices.join("\n");
    assert!(all.contains("models/Fox.glb does not exist; it was not copied"), "{all}");
    assert!(all.contains("props/box.gltf: box.gltf") && all.contains("points.bin"), "{all}");
    document.wait_for_view(|view| {
        let is_missing = matches!(scene_of(view).models.get("fox"), Some(SceneModel::Missing(_)));
        is_missing && view.file.path.as_deref() == Some(&*other.join("foxes.meproj"))
    });
    assert!(other.join("sound/step.wav").exists() && other.join("foxes.lines.xml").exists());
    assert_eq!(fs::read_to_string(other.join("foxes.lines.xml")).expect("a file"), LINES);
}

#[test]
fn what_a_script_with_an_error_names_is_copied_too() {
    let folder = Folder::new("moved-error");
    let path = whole_project(&folder);
    let main = fs::read_to_string(folder.join("own/main.xml")).expect("a file");
    let wrong = main.replace("who=\"ann\"", "who=\"nobody\"");
    fs::write(folder.join("own/main.xml"), &wrong).expect("a file");
    let other = Folder::new("moved-error-there");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let saved = document.save(SaveTo::As(other.join("foxes.meproj")));
    assert!(saved.notices[0].starts_with("main.xml:") && saved.notices[0].contains("nobody"), "{saved:?}");
    let there: Vec<String> = files(other.path()).into_keys().filter(|name| name != "foxes.meproj").collect();
    assert_eq!(there, NEEDED);
}

#[test]
fn a_session_that_saves_in_another_folder_takes_the_same_files_along() {
    let folder = Folder::new("moved-session");
    let path = whole_project(&folder);
    let other = Folder::new("moved-session-there");
    let editable = Editable::open(&Source::File(path), &Cancel::default()).expect("a project");
    let mut session = Session::new(editable);
    let mut save = || -> Value {
        let request = json!({"do": "save", "to": other.join("copy.meproj")});
        serde_json::from_str(&session.answer(&request.to_string()).expect("an answer")).expect("JSON")
    };
    let answer = save();
    assert_eq!(answer["ok"]["written"].as_array().map(Vec::len), Some(NEEDED.len() + 1), "{answer}");
    assert_eq!(errors(&other.join("copy.meproj")), [""; 0]);
    // Again: only the project itself is written.
    assert_eq!(save()["ok"]["written"], json!([other.join("copy.meproj")]));
    fs::write(other.join("models/Fox.glb"), "another").expect("a file");
    assert!(save()["error"].as_str().is_some_and(|reason| reason.contains("models/Fox.glb")));
}

/// Saves in place of a file that is there.
fn saved_over(document: &mut TestDocument, to: SaveTo) {
    document.send(DocumentMessage::Save(SaveOrder { to, anyway: true, ..SaveOrder::own(None) }));
    document.wait_for_reply(|reply| match reply {
        DocumentReply::Saved(_) => Some(()),
        DocumentReply::NotSaved(_, reason) => panic!("{reason:?}"),
        _ => None,
    });
}

#[test]
fn errors_of_a_text_are_not_counted_among_the_files_that_were_not_copied() {
    let folder = Folder::new("moved-errors");
    let path = whole_project(&folder);
    fs::remove_file(folder.join("own/models/Fox.glb")).expect("a file");
    let main = fs::read_to_string(folder.join("own/main.xml")).expect("a file");
    let wrong: String = (0..8).map(|_| "<play who=\"nobody\" take=\"Run\"/>\n").collect();
    fs::write(folder.join("own/main.xml"), main.replace("</script>", &format!("{wrong}</script>")))
        .expect("a file");
    let other = Folder::new("moved-errors-there");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let notices = document.save(SaveTo::As(other.join("foxes.meproj"))).notices;
    assert_eq!(notices[0], "models/Fox.glb does not exist; it was not copied");
    assert!(notices[1..6].iter().all(|notice| notice.starts_with("main.xml:")), "{notices:#?}");
    assert_eq!(
        notices[6..],
        ["files that are needed may not be known because of these errors and 3 more".to_owned()]
    );
}

#[test]
fn a_second_copy_replaces_the_files_of_the_first_one_unless_another_program_changed_them() {
    let folder = Folder::new("moved-twice");
    let path = whole_project(&folder);
    let other = Folder::new("moved-twice-there");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    document.wait_for_view(is_read);
    let target = || SaveTo::Copy(other.join("foxes.meproj"));
    document.save(target());
    document.edit(replaced_in("end.xml", END, "The End", "Fin"));
    let fox = fs::read(folder.join("own/models/Fox.glb")).expect("a file");
    fs::write(folder.join("own/models/Fox.glb"), [&fox[..], b"more"].concat()).expect("a file");
    saved_over(&mut document, target());
    let fin = END.replace("The End", "Fin");
    assert_eq!(fs::read_to_string(other.join("end.xml")).expect("a file"), fin);
    assert_eq!(fs::read(other.join("models/Fox.glb")).expect("a file").len(), fox.len() + 4);
    // Under another name in the same folder, after another edit: the project that is there keeps its texts.
    document.edit(replaced_in("end.xml", &fin, "Fin", "Ende"));
    let reason = not_saved(&mut document, SaveTo::Copy(other.join("again.meproj")));
    assert!(reason.contains("end.xml") && !other.join("again.meproj").exists(), "{reason}");
    assert_eq!(fs::read_to_string(other.join("end.xml")).expect("a file"), fin);
    saved_over(&mut document, target());
    assert!(fs::read_to_string(other.join("end.xml")).expect("a file").contains("Ende"));
    // Another program changes one of them.
    fs::write(other.join("end.xml"), "of another program").expect("a file");
    document.edit(replaced_in("end.xml", &fin.replace("Fin", "Ende"), "Ende", "Out"));
    let reason = not_saved(&mut document, target());
    assert!(reason.contains("end.xml"), "{reason}");
    assert_eq!(fs::read_to_string(other.join("end.xml")).expect("a file"), "of another program");
}

#[test]
fn a_scene_is_not_saved_in_place_of_a_script_that_it_includes() {
    let folder = Folder::new("moved-include");
    whole_project(&folder);
    let path = folder.join("own/scene.xml");
    fs::write(&path, "<script version=\"1\"><include src=\"more.xml\"/></script>").expect("a file");
    let more = "<script version=\"1\"><wait dur=\"1\"/></script>";
    let other = Folder::new("moved-include-there");
    for place in [folder.join("own/more.xml"), other.join("more.xml")] {
        fs::write(&place, more).expect("a file");
    }
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    for place in [other.join("more.xml"), folder.join("own/more.xml")] {
        for to in [SaveTo::As(place.clone()), SaveTo::Copy(place.clone())] {
            let reason = not_saved(&mut document, to);
            assert!(reason.contains("more.xml") && reason.contains("another name"), "{reason}");
        }
        assert_eq!(fs::read_to_string(&place).expect("a file"), more);
    }
}

#[cfg(unix)]
#[test]
fn a_folder_whose_links_lead_elsewhere_gets_no_copies_through_them() {
    let folder = Folder::new("moved-link");
    let path = whole_project(&folder);
    let (other, outside) = (Folder::new("moved-link-there"), Folder::new("moved-link-outside"));
    std::os::unix::fs::symlink(outside.path(), other.join("models")).expect("a link");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let reason = not_saved(&mut document, SaveTo::As(other.join("foxes.meproj")));
    assert!(reason.contains("models") && reason.contains("leads out of the folder"), "{reason}");
    assert!(files(outside.path()).is_empty());
    assert!(!other.join("foxes.meproj").exists());
}

#[test]
fn copying_is_cancelled_between_two_files_and_can_be_done_again() {
    for at in [FaultPoint::PrepareSave, FaultPoint::WriteSave] {
        let folder = Folder::new(&format!("moved-cancel-{at:?}"));
        let (path, held) = (whole_project(&folder), HeldSave::at(at));
        let other = Folder::new(&format!("moved-cancel-there-{at:?}"));
        let mut document = document(&folder.join("autosave"), &held);
        document.open(&path);
        let target = || SaveTo::As(other.join("foxes.meproj"));
        held.hold_save(&document, target());
        document.wait_for_reply(|reply| matches!(reply, DocumentReply::Loading { .. }).then_some(()));
        // The program is about to end, which waits for the end of the save.
        document.send(DocumentMessage::Quit);
        document.send(DocumentMessage::CancelLoading);
        document.wait_for_warning("stops after the file");
        held.release();
        let reason = document.wait_for_reply(|reply| match reply {
            DocumentReply::NotSaved(_, reason) => Some(reason.clone()),
            DocumentReply::Saved(saved) => panic!("{saved:?}"),
            _ => None,
        });
        assert_eq!(reason, NotSaved::Cancelled(Vec::new()));
        assert!(files(other.path()).is_empty());
        assert_eq!(document.view().file.path.as_deref(), Some(&*path));
        assert_eq!(document.save(target()).beside, NEEDED.len());
    }
}

#[test]
fn a_document_that_ends_stops_copying_and_its_unsaved_work_is_offered() {
    let folder = Folder::new("moved-end");
    let (path, held) = (whole_project(&folder), HeldSave::at(FaultPoint::PrepareSave));
    let other = Folder::new("moved-end-there");
    let mut document = document(&folder.join("autosave"), &held);
    document.open(&path);
    document.edit(replaced_in("end.xml", END, "The End", "Fin"));
    document.wait_for_view(|view| view.history.done == 1);
    held.hold_save(&document, SaveTo::As(other.join("foxes.meproj")));
    document.stop();
    held.release();
    document.end();
    assert!(files(other.path()).is_empty());
    assert_eq!(restored(&folder.join("autosave"), &path).0, 1);
}

#[test]
fn a_text_that_changes_between_the_comparison_and_the_save_is_not_taken_for_the_own_one() {
    let folder = Folder::new("moved-between");
    let (path, held) = (whole_project(&folder), HeldSave::at(FaultPoint::WriteSave));
    let other = Folder::new("moved-between-there");
    fs::write(other.join("end.xml"), END).expect("a file");
    let mut document = document(&folder.join("autosave"), &held);
    document.open(&path);
    held.hold_save(&document, SaveTo::As(other.join("foxes.meproj")));
    fs::write(other.join("end.xml"), END.replace("The End", "The Ent")).expect("a file");
    held.release();
    let reason = document.wait_for_reply(|reply| match reply {
        DocumentReply::NotSaved(_, NotSaved::Failed(reason)) => Some(reason.clone()),
        DocumentReply::Saved(saved) => panic!("{saved:?}"),
        _ => None,
    });
    assert!(reason.contains("end.xml") && reason.contains("not the one that is needed"), "{reason}");
    assert!(!other.join("foxes.meproj").exists());
}
