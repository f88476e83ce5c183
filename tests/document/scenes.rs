//! A script of a scene is a document: it is opened, edited as text, undone and saved. Its models are read in the background.

use dragonfly_document::edit::{Edit, EditScript, ScriptSplice};
use dragonfly_document::history::Gesture;
use dragonfly_document::{
    Change, DocumentMessage, DocumentReply, NotSaved, SaveOrder, SaveTo, SceneModel, SceneView, SoundSource,
    View,
};
use dragonfly_kit::document::test_document::{TestDocument, fox};
use dragonfly_kit::folder::Folder;
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

/// A script with a comment, a role whose model is there, a prop whose model is not, and CR LF ends of lines.
pub(super) const SCENE: &str = "<?xml version=\"1.0\"?>\r\n<script version=\"1\">\r\n  <!-- Füchse -->\r\n  <cast>\r\n    \
    <role id=\"fox\" model=\"Fox.glb\" scale='0.01'/>\r\n    <prop id=\"ball\" model=\"props/ball.glb\"/>\r\n  </cast>\r\n  \
    <play who=\"fox\" take=\"Walk\"/>\r\n  <play who=\"ball\" take=\"Roll\" begin=\"1\"/>\r\n</script>\r\n";

/// Writes the script and its one model, and returns the path of the script.
pub(super) fn scene(folder: &Folder) -> PathBuf {
    fox(folder);
    let path = folder.join("scene.xml");
    fs::write(&path, SCENE).expect("a file");
    path
}

/// Returns an edit that replaces the first `old` in `text`.
pub(super) fn replaced(text: &str, old: &str, new: &str) -> Edit {
    let splice = ScriptSplice { at: text.find(old).expect(old), old: old.to_owned(), new: new.to_owned() };
    EditScript { text: None, create: false, splices: vec![splice], label: None, also: Vec::new() }.into()
}

pub(super) fn scene_of(view: &View) -> &Arc<SceneView> {
    view.scene.as_ref().expect("a scene")
}

/// Returns whether no model is being read.
fn is_settled(view: &View) -> bool {
    let models = &scene_of(view).models;
    !models.is_empty() && !models.values().any(|model| matches!(model, SceneModel::Loading))
}

#[test]
fn a_script_is_opened_with_its_models_and_the_rest_plays_while_one_is_missing() {
    let folder = Folder::new("scene-open");
    let mut document = TestDocument::new(&folder.join("autosave"));
    let path = scene(&folder);
    let first = document.open(&path);
    assert_eq!(&*scene_of(&first).text, SCENE);
    assert!(first.loaded.format.is_none() && first.takes.is_empty() && first.history.saved);
    let view = document.wait_for_view(is_settled);
    let scene = scene_of(&view);
    assert!(scene.errors.is_empty() && scene.is_current());
    assert!(
        matches!(&scene.models["Fox.glb"], SceneModel::Loaded(fox) if fox.model.animation.takes.len() == 3)
    );
    assert!(
        matches!(&scene.models["props/ball.glb"], SceneModel::Missing(reason) if reason.contains("ball.glb: does not exist"))
    );
    assert_eq!(scene.notes.len(), 1);
    assert_eq!((scene.notes[0].place.line, &SCENE[scene.notes[0].range.clone()]), (6, "props/ball.glb"));
    let plan = scene.plan.as_ref().expect("a plan");
    let [fox, ball] = [0, 1].map(|thing| &plan.things()[thing]);
    assert!(fox.model.is_some() && !fox.is_missing && ball.model.is_none() && ball.is_missing);
    // Walk takes 0.708 s; the unknown take counts as one second from 1 s on.
    assert_eq!(plan.length().seconds(), 2.0);
}

#[test]
fn a_model_that_is_there_later_is_read_when_the_files_are_looked_at() {
    let folder = Folder::new("scene-later");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&scene(&folder));
    document.wait_for_view(is_settled);
    fs::create_dir(folder.join("props")).expect("a folder");
    fs::copy(folder.join("Fox.glb"), folder.join("props/ball.glb")).expect("a file");
    document.send(DocumentMessage::LookAtFile);
    let view = document.wait_for_view(|view| !scene_of(view).errors.is_empty());
    assert_eq!(
        scene_of(&view).errors[0].message,
        "\"ball\" has no take \"Roll\"",
        "now that its takes are known"
    );
    assert!(matches!(scene_of(&view).models["props/ball.glb"], SceneModel::Loaded(_)));
}

#[test]
fn a_sound_ends_with_its_file_once_its_length_is_known_and_before_that_with_the_scene() {
    let folder = Folder::new("scene-sound-length");
    let mut document = TestDocument::new(&folder.join("autosave"));
    let path = scene(&folder);
    let sound = "<sound src=\"thunder.wav\" begin=\"0.25\" repeat=\"2\"/>";
    fs::write(&path, SCENE.replace("</script>", &format!("{sound}</script>"))).expect("a file");
    document.open(&path);
    let stop = |view: &View| scene_of(view).plan.as_ref().map(|plan| plan.sounds()[0].stop().seconds());
    let view = document.wait_for_view(is_settled);
    assert_eq!(stop(&view), Some(2.0), "it may be as long as the scene");
    let read = |folder: &Folder, name: &str| {
        let source = SoundSource::Below { folder: folder.path().to_owned(), name: name.to_owned() };
        DocumentMessage::SoundsRead(vec![(source, Some(0.5))])
    };
    document.send(read(&Folder::new("scene-sound-other"), "thunder.wav"));
    let file = SoundSource::File(folder.join("thunder.wav"));
    document.send(DocumentMessage::SoundsRead(vec![(file, Some(0.5))]));
    document.edit(replaced(&scene_of(&view).text, "0.25", "0.5"));
    let view = document.wait_for_view(|view| view.history.done == 1);
    assert_eq!(stop(&view), Some(2.0), "sounds of another folder, and those of a take, are others");
    document.send(read(&folder, "thunder.wav"));
    let view = document.wait_for_view(|view| stop(view) != Some(2.0));
    assert_eq!((stop(&view), view.history.done), (Some(1.5), 1), "half a second, twice");
    // In another folder there may be another file of this name.
    let other = Folder::new("scene-sound-moved");
    document.save(SaveTo::As(other.join("moved.xml")));
    let view = document.wait_for_view(|view| stop(view) != Some(1.5));
    assert_eq!(stop(&view), Some(2.0), "its length is not known there");
}

#[cfg(unix)]
#[test]
fn a_link_that_leads_out_of_the_folder_is_not_followed() {
    let folder = Folder::new("scene-outside");
    fox(&folder);
    fs::create_dir(folder.join("in")).expect("a folder");
    std::os::unix::fs::symlink(folder.join("Fox.glb"), folder.join("in/a.glb")).expect("a link");
    let path = folder.join("in/scene.xml");
    let text = "<script version=\"1\"><cast><role id=\"a\" model=\"a.glb\"/></cast></script>";
    fs::write(&path, text).expect("a file");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let view = document.wait_for_view(is_settled);
    assert!(
        matches!(&scene_of(&view).models["a.glb"], SceneModel::Missing(reason) if reason.contains("leads out")),
        "{:?}",
        scene_of(&view).notes
    );
}

#[test]
fn an_edit_of_the_text_moves_the_scene_and_undo_leads_back_byte_for_byte() {
    let folder = Folder::new("scene-edit");
    let mut document = TestDocument::new(&folder.join("autosave"));
    let path = scene(&folder);
    document.open(&path);
    document.wait_for_view(is_settled);
    document.edit(replaced(SCENE, "\"Walk\"", "\"Survey\""));
    let view = document.wait_for_view(|view| view.history.done == 1);
    let plan = scene_of(&view).plan.as_ref().expect("a plan");
    assert!((plan.length().seconds() - 3.416_666).abs() < 1e-3, "{:?}", plan.length());
    assert_eq!(view.history.labels(), [Some("Edit script"), None]);
    // A broken text keeps the plan, and its errors have places.
    let text = scene_of(&view).text.to_string();
    document.edit(replaced(&text, "take=\"Survey\"", "tak=\"Survey\""));
    let view = document.wait_for_view(|view| view.history.done == 2);
    assert!(
        Arc::ptr_eq(scene_of(&view).plan.as_ref().expect("a plan"), plan) && !scene_of(&view).is_current()
    );
    assert_eq!(scene_of(&view).errors[0].place.line, 8);
    document.change(Change::GoTo(0));
    let view = document.wait_for_view(|view| view.history.done == 0);
    assert_eq!(&*scene_of(&view).text, SCENE);
    assert!(view.history.saved && scene_of(&view).is_current());
    document.change(Change::GoTo(2));
    let view = document.wait_for_view(|view| view.history.done == 2);
    assert_eq!(
        *scene_of(&view).text,
        *text.replace("take=", "tak=").replacen("tak=\"Roll", "take=\"Roll", 1)
    );
}

#[test]
fn all_edits_of_a_gesture_are_one_step_and_each_is_relative_to_the_text_before_it() {
    let folder = Folder::new("scene-gesture");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&scene(&folder));
    for begin in ["1.1", "1.25", "2.5"] {
        let at = SCENE.find("begin=\"1\"").expect("a begin") + 7;
        let splices = vec![ScriptSplice { at, old: "1".to_owned(), new: begin.to_owned() }];
        let edit = EditScript {
            text: None,
            create: false,
            splices,
            label: Some("Move clip".to_owned()),
            also: Vec::new(),
        };
        document.change(Change::Edit(edit.into(), Some(Gesture(7))));
    }
    document.change(Change::Release(Gesture(7)));
    let view = document.wait_for_view(|view| scene_of(view).text.contains("2.5"));
    assert_eq!((view.history.steps.as_slice(), view.history.done), (&["Move clip"][..], 1));
    assert_eq!(*scene_of(&view).text, *SCENE.replace("begin=\"1\"", "begin=\"2.5\""));
    document.change(Change::Undo);
    assert_eq!(&*scene_of(&document.wait_for_view(|view| view.history.done == 0)).text, SCENE);
}

#[test]
fn an_edit_that_does_not_fit_the_text_is_refused_with_its_place_and_changes_nothing() {
    let folder = Folder::new("scene-refused");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&scene(&folder));
    let inside = SCENE.find('ü').expect("a letter of two bytes") + 1;
    for (edit, said) in [
        (r#"{"edit":"script","splices":[{"at":3,"old":"XML"}]}"#.to_owned(), "Byte 3 of scene.xml: the text there is not \"XML\""),
        (format!(r#"{{"edit":"script","splices":[{{"at":{inside},"new":"x"}}]}}"#), "the text there is not \"\""),
        (r#"{"edit":"script","splices":[{"at":99999,"new":"x"}]}"#.to_owned(), "Byte 99999 of"),
        (r#"{"edit":"script","splices":[]}"#.to_owned(), "would not change the text"),
        (r#"{"edit":"script","splices":[{"at":0,"old":"<?xml","new":"a"},{"at":2,"old":"xml","new":"b"}]}"#.to_owned(), "overlap"),
        (r#"{"edit":"script","text":"other.xml","splices":[{"at":0,"new":"a"}]}"#.to_owned(), "no text \"other.xml\""),
        (r#"{"edit":"script","text":1,"splices":[{"at":0,"new":"a"}]}"#.to_owned(), "no text 1"),
        (r#"{"edit":"create_take","name":"a"}"#.to_owned(), "have no takes"),
    ] {
        let edit: Edit = serde_json::from_str(&edit).expect("an edit");
        document.edit(edit);
        let reason = document.wait_for_reply(|reply| match reply {
            DocumentReply::Refused(reason) => Some(reason.clone()),
            _ => None,
        });
        assert!(reason.contains(said), "{reason}");
    }
    assert_eq!(&*scene_of(&document.view()).text, SCENE);
}

#[test]
fn a_saved_script_has_only_the_edited_bytes_changed_and_a_script_without_edits_is_written_as_it_was() {
    let folder = Folder::new("scene-save");
    let mut document = TestDocument::new(&folder.join("autosave"));
    let path = scene(&folder);
    document.open(&path);
    document.save(SaveTo::Own);
    assert_eq!(fs::read(&path).expect("a file"), SCENE.as_bytes());
    document.edit(replaced(SCENE, "Walk", "Run"));
    document.save(SaveTo::Own);
    let run = SCENE.replace("Walk", "Run");
    assert_eq!(fs::read_to_string(&path).expect("a file"), run);
    assert!(document.view().history.saved);
    let copy = folder.join("copy");
    document.edit(replaced(&run, "Run", "Survey"));
    document.save(SaveTo::As(copy));
    let view = document.view();
    assert_eq!(view.file.path.as_deref(), Some(&*folder.join("copy.xml")));
    assert_eq!(fs::read_to_string(folder.join("copy.xml")).expect("a file"), SCENE.replace("Walk", "Survey"));
    assert_eq!(fs::read_to_string(&path).expect("a file"), run, "the old file stays");
}

#[test]
fn a_script_that_another_program_changed_is_not_overwritten_without_a_question() {
    let folder = Folder::new("scene-changed");
    let mut document = TestDocument::new(&folder.join("autosave"));
    let path = scene(&folder);
    document.open(&path);
    document.edit(replaced(SCENE, "Walk", "Run"));
    fs::write(&path, "another").expect("a file");
    document.send(DocumentMessage::Save(SaveOrder::own(None)));
    let reason = document.wait_for_reply(|reply| match reply {
        DocumentReply::NotSaved(_, reason) => Some(reason.clone()),
        _ => None,
    });
    assert!(matches!(reason, NotSaved::Changed(_)));
    assert_eq!(fs::read_to_string(&path).expect("a file"), "another");
    document.send(DocumentMessage::Save(SaveOrder { anyway: true, ..SaveOrder::own(None) }));
    document.wait_for_reply(|reply| matches!(reply, DocumentReply::Saved(_)).then_some(()));
    assert_eq!(fs::read_to_string(&path).expect("a file"), SCENE.replace("Walk", "Run"));
}
