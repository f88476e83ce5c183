//! Files for the scene from anywhere: those outside are copied if the user agrees, and missing ones are found.

use crate::scene_bench::{FOXES, named_text, new_lines, project, scene, scene_without, text};
use crate::scene_sounds::{forwarding, move_to, thunder};
use crate::workbench::{Window, Workbench};
use dragonfly::app::scene_files::{self, SceneFilesAnswer};
use dragonfly::panels::dialogs::Question;
use dragonfly::panels::dropped_files::{
    DropPlace, DroppedModel, DroppedModels, ModelForm, UnknownModels, WantedFiles,
};
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::{Effect, FileChoice, Request};
use dragonfly_anim::bounds::AxisBox;
use dragonfly_anim::stage::script::{IncludedScripts, ScriptContext, StageScript};
use dragonfly_document::{
    Cancel, Change, DocumentMessage, LoadedModel, OutdatedEdits, OutdatedEditsChoice, SavedFile,
    SceneFileKind, SceneView, Source, View, load_model,
};
use dragonfly_kit::folder::{Folder, data};
use dragonfly_runtime::{Address, Job};
use egui::Key;
use egui_kittest::kittest::Queryable;
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// Carries a job out, and returns its answer.
pub(super) fn done(
    start: fn(Box<WantedFiles>, &Address<SceneFilesAnswer>) -> std::io::Result<Job>,
    wanted: Box<WantedFiles>,
) -> SceneFilesAnswer {
    let (_thread, address, answers) = forwarding();
    let _job = start(wanted, &address).expect("a job");
    answers.recv_timeout(Duration::from_secs(60)).expect("an answer")
}

/// Executes a request, with everything that follows without a question. Returns the effect that remains.
fn execute(window: &mut Window, request: Request) -> Option<Effect> {
    let mut effect = window.state_mut().state.execute(request);
    loop {
        let answer = match effect {
            Some(Effect::Change(change)) => {
                window.state_mut().change(change);
                effect = None;
                break;
            }
            Some(Effect::LookAtFiles(wanted)) => done(scene_files::look, wanted),
            Some(Effect::CopyFiles(wanted)) => done(scene_files::copy, wanted),
            Some(Effect::LookAtModels(unknown)) => {
                let UnknownModels { models, is_role, place, sounds, hashes, copied, target } = *unknown;
                let read = |(file, name)| {
                    let read = load_model(&Source::File(file), &mut |_| {}, &Cancel::default());
                    DroppedModel::of(name, &read.expect("a model"), is_role)
                };
                let models = models.into_iter().map(read).collect();
                let dropped = DroppedModels { models, place, sounds, hashes, copied, target };
                let state = &mut window.state_mut().state;
                effect = state.execute(Request::DroppedModels(Box::new(dropped)));
                continue;
            }
            Some(_) | None => break,
        };
        let (wanted, copied) = answer.unwrap_or_else(|reason| panic!("{reason}"));
        effect = window.state_mut().state.files_answered(wanted, copied);
    }
    window.run_steps(3);
    effect
}

/// Opens a scene as if it were in a folder.
pub(super) fn window_in(folder: &Folder, mut bench: Workbench) -> Window {
    move_to(&mut bench, folder);
    bench.window()
}

pub(super) fn said(window: &Window, word: &str) -> bool {
    let read = window.state().state.read();
    read.status.lines().any(|message| message.text.contains(word))
}

#[test]
fn a_dropped_model_from_outside_is_copied_after_a_question_and_added_and_undo_leaves_the_copy() {
    let (folder, other) = (Folder::new("window-files"), Folder::new("window-files-other"));
    fs::copy(data("gltf/Fox.glb"), other.join("knight.glb")).expect("a copy");
    let mut window = window_in(&folder, scene(FOXES));
    assert_eq!(execute(&mut window, Request::AddRole(other.join("knight.glb"))), None);
    assert!(window.query_by_label("Copy knight.glb into models/?").is_some());
    assert!(!folder.join("models").exists(), "nothing is copied before the answer");
    let question = window.state().state.read().question().cloned();
    let Some(Question::Copy(question)) = question else { panic!("{question:?}") };
    assert_eq!(execute(&mut window, Request::CopyFiles(question.wanted)), None);
    assert_eq!(window.state().state.read().question(), None);
    let new = new_lines(FOXES, &text(&window));
    assert_eq!(new.len(), 1, "{new:?}");
    assert!(new[0].starts_with("<role") && new[0].contains("model=\"models/knight.glb\""), "{new:?}");
    assert!(said(&window, "Copied models/knight.glb into the folder of the scene; Undo leaves the copies"));
    window.state_mut().change(Change::Undo);
    assert_eq!(text(&window), FOXES);
    let copy = fs::read(folder.join("models/knight.glb")).expect("a file");
    assert_eq!(copy, fs::read(data("gltf/Fox.glb")).expect("a file"));
}

#[test]
fn sounds_and_models_that_are_dropped_together_are_asked_about_together_and_a_cancel_changes_nothing() {
    let (folder, other) = (Folder::new("window-files-many"), Folder::new("window-files-many-other"));
    for name in ["a.glb", "b.glb"] {
        fs::copy(data("gltf/Fox.glb"), other.join(name)).expect("a copy");
    }
    fs::write(other.join("step.wav"), "a sound").expect("a file");
    let mut window = window_in(&folder, scene(FOXES));
    let paths: Vec<PathBuf> = ["a.glb", "b.glb", "step.wav"].map(|name| other.join(name)).into();
    execute(&mut window, Request::Dropped(paths.clone()));
    assert!(window.query_by_label("Copy 3 files into the project's folder?").is_some());
    window.key_press(Key::Escape);
    window.run_steps(3);
    assert_eq!((window.state().state.read().question(), text(&window).as_str()), (None, FOXES));
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0);
    execute(&mut window, Request::Dropped(paths));
    let question = window.state().state.read().question().cloned();
    let Some(Question::Copy(question)) = question else { panic!("{question:?}") };
    // Whether they are figures is known once they were read.
    assert_eq!(execute(&mut window, Request::CopyFiles(question.wanted)), None);
    let new = new_lines(FOXES, &text(&window));
    for part in ["<role id=\"a\" model=\"models/a.glb\"", "model=\"models/b.glb\"", "src=\"sound/step.wav\""]
    {
        assert_eq!(new.iter().filter(|line| line.contains(part)).count(), 1, "{part} in {new:?}");
    }
    assert!(folder.join("models/a.glb").exists() && folder.join("sound/step.wav").exists());
}

#[test]
fn an_answer_about_files_of_another_scene_is_not_used() {
    let (folder, other) = (Folder::new("window-files-late"), Folder::new("window-files-late-other"));
    fs::copy(data("gltf/Fox.glb"), other.join("knight.glb")).expect("a copy");
    let mut window = window_in(&folder, scene(FOXES));
    let effect = window.state_mut().state.execute(Request::AddRole(other.join("knight.glb")));
    let Some(Effect::LookAtFiles(wanted)) = effect else { panic!("{effect:?}") };
    move_to(window.state_mut(), &other);
    let (wanted, copied) = done(scene_files::look, wanted).expect("it can be read");
    assert_eq!(window.state_mut().state.files_answered(wanted, copied), None);
    assert_eq!(window.state().state.read().question(), None);
    assert!(said(&window, "not open any more"));
}

/// The foxes with two models that are missing.
fn with_missing() -> String {
    FOXES.replace("  </cast>", "    <role   id=\"cat\" model=\"old/cat.glb\"/>\n    <prop   id=\"box\" model=\"old/box.glb\"/>\n  </cast>")
}

const MISSING: [&str; 2] = ["old/cat.glb", "old/box.glb"];

#[test]
fn a_missing_model_is_found_from_its_row_and_those_next_to_it_in_the_same_step() {
    let folder = Folder::new("window-find");
    let before = with_missing();
    let mut window = window_in(&folder, scene_without(&before, &MISSING));
    assert!(window.query_by_label("Find the model of anna").is_none(), "it is there");
    window.get_by_label("Find the model of cat").click();
    window.run_steps(3);
    let finding = window.state().state.read().scene_editing.finding().cloned().expect("a file");
    assert_eq!((finding.name.as_str(), finding.kind), ("old/cat.glb", SceneFileKind::Model));
    // The row opens the dialog for files.
    let effect = window.state_mut().state.execute(Request::Scene(SceneRequest::Find(finding)));
    assert_eq!(effect, Some(Effect::Choose(FileChoice::MissingModel, Some(folder.path().to_owned()))));
    fs::create_dir(folder.join("new")).expect("a folder");
    for name in ["cat.glb", "box.glb"] {
        fs::copy(data("gltf/Fox.glb"), folder.join("new").join(name)).expect("a copy");
    }
    assert_eq!(execute(&mut window, Request::FileFound(folder.join("new/cat.glb"))), None);
    assert_eq!((text(&window), window.state().steps()), (before.replace("old/", "new/"), (1, 1)));
    assert!(said(&window, "Found 2 files"));
    window.state_mut().change(Change::Undo);
    assert_eq!(text(&window), before);
}

#[test]
fn a_missing_file_that_is_found_outside_is_copied_after_the_question() {
    let (folder, other) = (Folder::new("window-find-out"), Folder::new("window-find-out-other"));
    let before = with_missing();
    let mut window = window_in(&folder, scene_without(&before, &MISSING));
    fs::copy(data("gltf/Fox.glb"), other.join("cat.glb")).expect("a copy");
    window.get_by_label("Find the model of cat").click();
    window.run_steps(3);
    // A desktop without a dialog: the path is typed.
    assert_eq!(execute(&mut window, Request::TypeFoundFile), None);
    assert!(window.query_by_label("Where is old/cat.glb now?").is_some());
    assert_eq!(execute(&mut window, Request::FileFound(other.join("cat.glb"))), None);
    let question = window.state().state.read().question().cloned();
    let Some(Question::Copy(question)) = question else { panic!("{question:?}") };
    execute(&mut window, Request::CopyFiles(question.wanted));
    assert_eq!(text(&window), before.replace("old/cat.glb", "models/cat.glb"));
    assert_eq!(window.state().state.read().prompts.questions().len(), 0);
}

#[test]
fn the_note_of_a_missing_model_and_of_a_missing_sound_offers_to_find_it() {
    let folder = Folder::new("window-find-note");
    let before = thunder();
    let mut window = window_in(&folder, scene(&before));
    window.state_mut().state.scene_sounds().receive("none.wav", Err("none.wav does not exist".to_owned()));
    window.run_steps(3);
    assert!(window.query_by_label_contains("none.wav does not exist").is_some());
    window.get_by_label("Find none.wav").click();
    window.run_steps(3);
    let finding = window.state().state.read().scene_editing.finding().cloned().expect("a file");
    assert_eq!((finding.name.as_str(), finding.kind), ("none.wav", SceneFileKind::Sound));
    fs::create_dir(folder.join("sounds")).expect("a folder");
    fs::write(folder.join("sounds/boom.wav"), "a sound").expect("a file");
    execute(&mut window, Request::FileFound(folder.join("sounds/boom.wav")));
    assert_eq!(text(&window), before.replace("none.wav", "sounds/boom.wav"));
    // The note of a model.
    let script = with_missing();
    let mut window = window_in(&folder, scene_without(&script, &MISSING));
    let view = window.state().state.read().view.cloned().expect("a view");
    let scene = view.scene.clone().expect("a scene");
    let tree = scene.script.as_ref().expect("a script").tree();
    let cat = tree.elements().iter().find(|element| element.value("id") == Some("cat")).expect("a cat");
    let note = tree.error(cat.value_range("model"), "does not exist".to_owned(), "");
    let scene = SceneView { notes: [note].into(), ..SceneView::clone(&scene) };
    window.state_mut().state.show(View {
        generation: view.generation + 1,
        scene: Some(Arc::new(scene)),
        ..view
    });
    window.run_steps(3);
    window.get_by_label("Find old/cat.glb").click();
    window.run_steps(3);
    let finding = window.state().state.read().scene_editing.finding().cloned().expect("a file");
    assert_eq!(finding.name, "old/cat.glb");
}

#[test]
fn the_menu_of_a_thing_decides_about_the_edits_of_its_model() {
    let edits = OutdatedEdits { model: "fox".to_owned(), title: "Fox.glb".to_owned(), hash: 7 };
    let mut window = scene(FOXES).window();
    let request = Request::Scene(SceneRequest::Settle(edits.clone(), OutdatedEditsChoice::Remove));
    let effect = window.state_mut().state.execute(request);
    let Some(Effect::File(dragonfly::panels::FileAction::Send(message))) = effect else {
        panic!("{effect:?}")
    };
    assert_eq!(message, DocumentMessage::DecideAllOutdated(vec![edits], OutdatedEditsChoice::Remove));
}

/// Shows the same view as that of another document.
pub(super) fn open_another(window: &mut Window) {
    let view = window.state().state.read().view.cloned().expect("a view");
    let opened = Arc::new(LoadedModel::clone(&view.opened));
    window.state_mut().state.show(View {
        loaded: Arc::clone(&opened),
        opened,
        generation: view.generation + 1,
        ..view
    });
    window.run_steps(2);
}

#[test]
fn files_for_a_script_are_not_added_to_another_one_of_the_same_folder() {
    let folder = Folder::new("window-files-other-script");
    fs::copy(data("gltf/Fox.glb"), folder.join("knight.glb")).expect("a copy");
    let mut window = window_in(&folder, scene(FOXES));
    let effect = window.state_mut().state.execute(Request::Dropped(vec![folder.join("knight.glb")]));
    let Some(Effect::LookAtFiles(wanted)) = effect else { panic!("{effect:?}") };
    let target = wanted.target.clone();
    let (wanted, copied) = done(scene_files::look, wanted).expect("it can be read");
    open_another(&mut window);
    assert_eq!(window.state_mut().state.files_answered(wanted, copied), None);
    assert!(said(&window, "not open any more"));
    // Models that were read in between are not added either.
    let form = ModelForm::Figure;
    let (name, around) = ("knight.glb".to_owned(), AxisBox::EMPTY);
    let models = vec![DroppedModel { name, form, scale: 1.0, around }];
    let place = DropPlace::Nowhere;
    let (sounds, hashes, copied) = (Vec::new(), Vec::new(), None);
    let dropped = DroppedModels { models, place, sounds, hashes, copied, target };
    assert_eq!(execute(&mut window, Request::DroppedModels(Box::new(dropped))), None);
    assert_eq!(text(&window), FOXES);
}

/// Copies the files that the question is about.
fn agree(window: &mut Window) -> Option<Effect> {
    let question = window.state().state.read().question().cloned();
    let Some(Question::Copy(question)) = question else { panic!("{question:?}") };
    execute(window, Request::CopyFiles(question.wanted))
}

#[test]
fn the_note_about_copies_names_only_what_was_copied_and_says_why_it_was_not_used() {
    let (folder, other) = (Folder::new("window-files-note"), Folder::new("window-files-note-other"));
    fs::write(folder.join("here.wav"), "a sound").expect("a file");
    fs::write(other.join("there.wav"), "a sound").expect("a file");
    let mut window = window_in(&folder, scene(FOXES));
    execute(&mut window, Request::Dropped(vec![folder.join("here.wav"), other.join("there.wav")]));
    agree(&mut window);
    assert!(said(&window, "Copied sound/there.wav into the folder of the scene; Undo leaves the copies"));
    // A script with errors gets nothing, and the message has the reason.
    let mut window = window_in(&folder, scene(&FOXES.replace("who=\"ben\"", "who=\"nobody\"")));
    fs::write(other.join("again.wav"), "a sound").expect("a file");
    execute(&mut window, Request::Dropped(vec![other.join("again.wav")]));
    agree(&mut window);
    let last = window.state().state.read().status.last().cloned().expect("a message").text;
    let expected = "Copied sound/again.wav into the folder of the scene, but the scene was not changed: The script has errors";
    assert!(last.starts_with(expected), "{last}");
}

#[test]
fn the_message_of_a_save_tells_about_files_that_were_not_copied() {
    let mut window = scene(FOXES).window();
    let notices = vec!["models/Fox.glb does not exist; it was not copied".to_owned(), "another".to_owned()];
    let saved = |notices: &[String]| SavedFile {
        path: "/other/scene.xml".into(),
        bytes: 9,
        beside: 3,
        copy: true,
        notices: notices.to_vec(),
        then: None,
    };
    let mut last = |notices: &[String]| {
        window.state_mut().state.saved(&saved(notices));
        window.state().state.read().status.last().cloned().expect("a message").text
    };
    let text = "Saved a copy as scene.xml and 3 further files";
    assert_eq!(last(&[]), text);
    assert_eq!(last(&notices[..1]), format!("{text}, with a warning: {}", notices[0]));
    let both = last(&notices);
    assert!(both.starts_with(&format!("{text}, with 2 warnings: {}", notices[0])), "{both}");
}

#[cfg(unix)]
#[test]
fn a_link_in_the_folder_that_leads_out_of_it_is_asked_about_as_a_file_from_outside() {
    let (folder, other) = (Folder::new("window-files-link"), Folder::new("window-files-link-other"));
    fs::copy(data("gltf/Fox.glb"), other.join("knight.glb")).expect("a copy");
    std::os::unix::fs::symlink(other.join("knight.glb"), folder.join("linked.glb")).expect("a link");
    let mut window = window_in(&folder, scene(FOXES));
    execute(&mut window, Request::AddRole(folder.join("linked.glb")));
    assert!(window.query_by_label("Copy linked.glb into models/?").is_some());
    assert_eq!(text(&window), FOXES);
    agree(&mut window);
    let new = new_lines(FOXES, &text(&window));
    assert!(new.len() == 1 && new[0].contains("model=\"models/linked.glb\""), "{new:?}");
    assert!(!folder.join("models/linked.glb").is_symlink());
}

#[test]
fn a_model_that_a_project_gets_is_listed_with_the_hash_of_its_file_in_the_same_step() {
    let folder = Folder::new("window-files-hash");
    let fox = fs::read(data("gltf/Fox.glb")).expect("a file");
    fs::write(folder.join("knight.glb"), &fox).expect("a file");
    let lines = "<lines version=\"1\"/>";
    let mut window = window_in(&folder, project(FOXES, lines));
    let before = named_text(&window, "scene.meproj");
    let listed = |src: &str, id: &str| {
        format!("<model id=\"{id}\" src=\"{src}\" hash=\"{:016x}\"/>", dragonfly_store::hash(&fox))
    };
    assert_eq!(execute(&mut window, Request::AddProp(folder.join("knight.glb"))), None);
    let after = named_text(&window, "scene.meproj");
    assert!(after.contains(&listed("knight.glb", "knight")), "{after}");
    assert_eq!(window.state().steps(), (1, 1));
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    assert_eq!((named_text(&window, "scene.meproj"), text(&window)), (before, FOXES.to_owned()));
    // A dropped one, too, which the scene knows already.
    fs::write(folder.join("Fox.glb"), &fox).expect("a file");
    execute(&mut window, Request::Dropped(vec![folder.join("Fox.glb")]));
    let after = named_text(&window, "scene.meproj");
    assert!(after.contains(&listed("Fox.glb", "fox")), "{after}");
}

#[test]
fn a_missing_model_that_only_an_included_script_names_is_not_offered_to_be_found() {
    let folder = Folder::new("window-find-included");
    let script = FOXES.replace("  <par id", "  <include src=\"parts.xml\"/>\n  <par id");
    let mut window = window_in(&folder, scene_without(FOXES, &["gone.glb"]));
    let parts = "<script version=\"1\"><cast><role id=\"cat\" model=\"gone.glb\"/></cast></script>";
    let files = IncludedScripts::default().collected("scene.xml", &script, |_| Ok(parts.into()));
    let context = ScriptContext { name: "scene.xml".into(), project: None, files };
    let read = StageScript::read_in(script.as_str(), &context).expect("a script");
    let view = window.state().state.read().view.cloned().expect("a view");
    let scene = view.scene.clone().expect("a scene");
    let tree = read.tree();
    let cat = tree.elements().iter().find(|element| element.value("id") == Some("cat")).expect("a cat");
    let note = tree.error(cat.value_range("model"), "does not exist".to_owned(), "");
    let missing = scene.missing_model("gone.glb");
    let scene = SceneView {
        notes: [note].into(),
        text: script.as_str().into(),
        script: Some(Arc::new(read)),
        ..SceneView::clone(&scene)
    };
    window.state_mut().state.show(View {
        generation: view.generation + 1,
        scene: Some(Arc::new(scene)),
        ..view
    });
    window.run_steps(3);
    assert!(window.query_by_label("Find the model of cat").is_none());
    assert!(window.query_by_label("Find gone.glb").is_none());
    let sentence = "gone.glb is named in parts.xml: open it to change it";
    assert!(window.query_all_by_label_contains("parts.xml").next().is_some(), "the note names the file");
    assert_eq!(execute(&mut window, Request::Scene(SceneRequest::Find(missing))), None);
    assert!(said(&window, sentence));
}
