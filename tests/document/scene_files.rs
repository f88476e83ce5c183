//! Files from outside of the folder of a scene are copied into it, and missing ones are named where they are found.

use super::projects::{MAIN, PROJECT, is_read, project, text_of};
use super::save_and_open::open;
use super::scenes::{replaced, scene_of};
use dragonfly_anim::stage::project::StageProject;
use dragonfly_document::edit::{EditScript, ScriptLabel};
use dragonfly_document::history::Edited;
use dragonfly_document::{
    Cancel, Change, FoundFiles, MissingFile, SceneFile, SceneFileKind, SceneFiles, SceneModel, View,
    listed_models, name_found_files,
};
use dragonfly_kit::document::test_document::{TestDocument, fox};
use dragonfly_kit::folder::{Folder, data};
use std::fs;
use std::path::{Path, PathBuf};

const BOX: &str = r#"{"asset":{"version":"2.0"},"buffers":[{"uri":"data/points.bin","byteLength":36}],
    "bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
    "min":[0,0,0],"max":[1,1,0]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],
    "scenes":[{"nodes":[0]}],"scene":0}"#;

/// Writes a model of two files and returns its path.
fn write_box(folder: &Path, height: f32) -> PathBuf {
    fs::create_dir_all(folder.join("data")).expect("a folder");
    let points = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, height, 0.0].map(f32::to_le_bytes).concat();
    fs::write(folder.join("data/points.bin"), points).expect("a file");
    fs::write(folder.join("box.gltf"), BOX).expect("a file");
    folder.join("box.gltf")
}

/// Looks at files for the scene in a folder.
fn looked(folder: &Path, paths: &[(SceneFileKind, PathBuf)]) -> Result<SceneFiles, String> {
    let file = |(kind, path): &(SceneFileKind, PathBuf)| SceneFile::new(*kind, path.clone());
    let mut files = SceneFiles { folder: folder.to_owned(), files: paths.iter().map(file).collect() };
    files.look(Vec::new(), &Cancel::default())?;
    Ok(files)
}

/// Copies a model into the folder of a scene. Returns its name there, and the number of files that were written.
fn copied(folder: &Path, path: &Path) -> (String, usize) {
    let mut files = looked(folder, &[(SceneFileKind::Model, path.to_owned())]).expect("it can be read");
    let written = files.copy(&Cancel::default()).expect("copies");
    (files.files.remove(0).name.expect("a name"), written)
}

#[test]
fn a_model_from_outside_is_copied_with_the_files_that_it_needs_and_nothing_is_overwritten() {
    let (scene, other) = (Folder::new("files-scene"), Folder::new("files-other"));
    let model = write_box(&other.join("a"), 1.0);
    let files = looked(scene.path(), &[(SceneFileKind::Model, model.clone())]).expect("it can be read");
    assert_eq!(
        (files.files[0].name.as_deref(), files.files[0].beside.as_slice()),
        (None, &["data/points.bin".to_owned()][..])
    );
    assert_eq!(copied(scene.path(), &model), ("models/box.gltf".to_owned(), 2));
    let same =
        |name: &str, of: &Path| fs::read(scene.join(name)).expect(name) == fs::read(of).expect("a file");
    assert!(
        same("models/box.gltf", &model) && same("models/data/points.bin", &other.join("a/data/points.bin"))
    );
    // The same files are used again.
    assert_eq!(copied(scene.path(), &model), ("models/box.gltf".to_owned(), 0));
    // Another model of the same name: the file next to it keeps the name that the model gives it.
    let second = write_box(&other.join("b"), 2.0);
    assert_eq!(copied(scene.path(), &second), ("models/box/box.gltf".to_owned(), 2));
    assert!(same("models/box/data/points.bin", &other.join("b/data/points.bin")));
    assert!(same("models/data/points.bin", &other.join("a/data/points.bin")), "it was not overwritten");
    // A model of one file gets a number.
    fs::copy(data("gltf/Fox.glb"), other.join("box.glb")).expect("a copy");
    fs::write(scene.join("models/box.glb"), "of another program").expect("a file");
    assert_eq!(copied(scene.path(), &other.join("box.glb")), ("models/box-2.glb".to_owned(), 1));
    assert_eq!(fs::read_to_string(scene.join("models/box.glb")).expect("a file"), "of another program");
    assert_eq!(copied(scene.path(), &other.join("box.glb")), ("models/box-2.glb".to_owned(), 0));
}

#[test]
fn sounds_go_into_their_own_folder_and_files_inside_keep_their_names() {
    let (scene, other) = (Folder::new("files-sound"), Folder::new("files-sound-other"));
    fs::write(other.join("step.wav"), "any bytes").expect("a file");
    fs::write(scene.join("in.wav"), "inside").expect("a file");
    let wanted =
        [(SceneFileKind::Sound, other.join("step.wav")), (SceneFileKind::Sound, scene.join("in.wav"))];
    let mut files = looked(scene.path(), &wanted).expect("they can be read");
    assert!(!files.are_inside() && files.outside().count() == 1);
    assert_eq!(files.copy(&Cancel::default()), Ok(1));
    let names: Vec<Option<&str>> = files.files.iter().map(|file| file.name.as_deref()).collect();
    assert_eq!(names, [Some("sound/step.wav"), Some("in.wav")]);
    // A file that is not there, and a model that cannot be read, change nothing.
    for (path, reason) in
        [(other.join("no.glb"), "no.glb does not exist"), (other.join("step.wav"), "step.wav")]
    {
        let error = looked(scene.path(), &[(SceneFileKind::Model, path)]).expect_err("no model");
        assert!(error.contains(reason), "{error}");
    }
    assert!(!scene.join("models").exists());
}

#[cfg(unix)]
#[test]
fn a_link_out_of_the_folder_is_outside_and_a_way_into_it_through_a_link_is_inside() {
    let (scene, other) = (Folder::new("files-links"), Folder::new("files-links-other"));
    fs::copy(data("gltf/Fox.glb"), other.join("Fox.glb")).expect("a copy");
    fs::copy(data("gltf/Fox.glb"), scene.join("own.glb")).expect("a copy");
    std::os::unix::fs::symlink(other.join("Fox.glb"), scene.join("linked.glb")).expect("a link");
    std::os::unix::fs::symlink(scene.path(), other.join("way")).expect("a link");
    let name = |path: PathBuf| {
        let files = looked(scene.path(), &[(SceneFileKind::Model, path)]).expect("it can be read");
        files.files[0].name.clone()
    };
    assert_eq!(name(scene.join("linked.glb")), None);
    assert_eq!(name(other.join("way/own.glb")).as_deref(), Some("own.glb"));
}

/// Returns the change that names missing files of the scene that is shown in new places.
fn found(view: &View, missing: &[(&str, &str)]) -> Result<Change, String> {
    let scene = scene_of(view);
    let found: Vec<(MissingFile, String)> =
        missing.iter().map(|(name, file)| (scene.missing_model(name), (*file).to_owned())).collect();
    let script = scene.script.as_ref().expect("a script");
    let FoundFiles { script: splices, others } = name_found_files(scene, script, &found)?;
    let own = EditScript::of(&scene.text, &splices, dragonfly_document::edit::ScriptLabel::FindFiles);
    let text = (scene.texts.list().len() > 1)
        .then(|| dragonfly_document::edit::TextRef::Name(scene.name.to_string()));
    let own = (!splices.list().is_empty()).then_some(EditScript { text, ..own });
    let mut parts = own.into_iter().chain(others);
    let first = parts.next().ok_or("nothing changes")?;
    Ok(Change::Edit(EditScript { also: parts.collect(), ..first }.into(), None))
}

#[test]
fn a_model_of_a_project_that_was_moved_is_named_there_in_one_step_and_its_edits_stay() {
    let folder = Folder::new("files-found-project");
    let path = project(&folder);
    fs::rename(folder.join("models"), folder.join("figures")).expect("a folder");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let view = document
        .wait_for_view(|view| matches!(scene_of(view).models.get("fox"), Some(SceneModel::Missing(_))));
    let missing: Vec<MissingFile> = scene_of(&view).missing_models().collect();
    assert_eq!((missing[0].name.as_str(), missing[0].file.as_str()), ("fox", "models/Fox.glb"));
    document.change(found(&view, &[("fox", "figures/Fox.glb")]).expect("an edit"));
    let view = document.wait_for_view(|view| is_read(view) && view.history.done == 1);
    assert_eq!(view.history.steps.as_slice(), ["Find files"]);
    assert_eq!(text_of(&view, "foxes.meproj"), PROJECT.replace("models/Fox.glb", "figures/Fox.glb"));
    assert_eq!(text_of(&view, "main.xml"), MAIN, "it means the model by its id");
}

#[test]
fn files_that_several_texts_name_are_named_in_all_of_them_in_one_step() {
    let folder = Folder::new("files-found-texts");
    let path = project(&folder);
    // The project has the model, and both scripts mean it by its file; one has another model, too.
    let role = |model: &str| format!("<role id=\"ann\" model=\"{model}\" scale=\"0.01\"/>");
    let main = MAIN
        .replace(&role("fox"), &role("models/Fox.glb"))
        .replace("</cast>", "  <prop id=\"b\" model=\"models/box.glb\"/>\n  </cast>");
    fs::write(folder.join("main.xml"), &main).expect("a file");
    let end = "<script version=\"1\"><cast><role id=\"e\" model=\"models/Fox.glb\"/></cast></script>\n";
    fs::write(folder.join("end.xml"), end).expect("a file");
    fs::rename(folder.join("models"), folder.join("new & old")).expect("a folder");
    fs::copy(data("gltf/Fox.glb"), folder.join("new & old/box.glb")).expect("a copy");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let is_missing = |view: &View| scene_of(view).missing_models().count() == 2;
    let view = document.wait_for_view(is_missing);
    let change =
        found(&view, &[("models/Fox.glb", "new & old/Fox.glb"), ("models/box.glb", "new & old/box.glb")]);
    document.change(change.expect("an edit"));
    let view = document.wait_for_view(|view| is_read(view) && view.history.done == 1);
    let new = |text: &str| text.replace("models/", "new &amp; old/");
    assert_eq!(text_of(&view, "main.xml"), new(&main));
    assert_eq!(text_of(&view, "end.xml"), new(end));
    assert_eq!(text_of(&view, "foxes.meproj"), new(PROJECT));
    document.change(Change::Undo);
    let view = document.wait_for_view(|view| view.history.done == 0);
    assert_eq!((text_of(&view, "main.xml"), text_of(&view, "foxes.meproj")), (main, PROJECT.to_owned()));
}

#[test]
fn a_file_that_only_an_included_script_names_is_not_changed_and_that_script_is_named() {
    let folder = Folder::new("files-found-included");
    fox(&folder);
    let path = folder.join("scene.xml");
    fs::write(&path, "<script version=\"1\"><include src=\"parts.xml\"/></script>").expect("a file");
    let parts = "<script version=\"1\"><cast><role id=\"a\" model=\"gone.glb\"/></cast></script>";
    fs::write(folder.join("parts.xml"), parts).expect("a file");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let view = document.wait_for_view(|view| scene_of(view).missing_models().count() == 1);
    let error = found(&view, &[("gone.glb", "Fox.glb")]).expect_err("it is no text of the document");
    assert_eq!(error, "gone.glb is named in parts.xml: open it to change it");
    let missing = scene_of(&view).missing_model("gone.glb");
    assert_eq!(scene_of(&view).included_place_of(&missing), Some("parts.xml"));
    document.edit(replaced(&scene_of(&view).text.clone(), "<include", "<wait dur=\"1\"/><include"));
    document.wait_for_view(|view| view.history.done == 1);
}

#[test]
fn other_missing_files_are_found_next_to_the_first_one_but_not_the_one_that_is_named_already() {
    let (scene, other) = (Folder::new("files-beside"), Folder::new("files-beside-other"));
    for name in ["a.glb", "b.glb", "here.glb"] {
        fs::copy(data("gltf/Fox.glb"), other.join(name)).expect("a copy");
    }
    fs::copy(data("gltf/Fox.glb"), scene.join("here.glb")).expect("a copy");
    let missing = |name: &str, file: &str| MissingFile {
        kind: SceneFileKind::Model,
        name: name.to_owned(),
        file: file.to_owned(),
    };
    let others =
        || vec![missing("b", "models/b.glb"), missing("c.glb", "c.glb"), missing("here.glb", "here.glb")];
    let found = |folder: &Path, path: PathBuf| {
        let file =
            SceneFile { replaces: Some(missing("a", "a.glb")), ..SceneFile::new(SceneFileKind::Model, path) };
        let mut files = SceneFiles { folder: folder.to_owned(), files: vec![file] };
        files.look(others(), &Cancel::default()).expect("they can be read");
        files.files.into_iter().filter_map(|file| Some(file.replaces?.name)).collect::<Vec<_>>()
    };
    assert_eq!(found(scene.path(), other.join("a.glb")), ["a", "b", "here.glb"]);
    fs::copy(data("gltf/Fox.glb"), scene.join("a.glb")).expect("a copy");
    assert_eq!(
        found(scene.path(), scene.join("a.glb")),
        ["a"],
        "the damaged one is not found in its own place"
    );
}

#[test]
fn models_of_a_scene_have_the_hashes_of_their_files_and_a_project_lists_them_once() {
    let (scene, other) = (Folder::new("files-hash"), Folder::new("files-hash-other"));
    fs::copy(data("gltf/Fox.glb"), scene.join("in.glb")).expect("a copy");
    let out = write_box(&other.join("a"), 1.0);
    let wanted = [(SceneFileKind::Model, scene.join("in.glb")), (SceneFileKind::Model, out.clone())];
    let mut files = looked(scene.path(), &wanted).expect("they can be read");
    files.copy(&Cancel::default()).expect("copies");
    let hash = |path: &Path| dragonfly_store::hash(&fs::read(path).expect("a file"));
    let [fox, crate_] = [hash(&scene.join("in.glb")), hash(&out)];
    let known: Vec<(Option<u64>, usize)> = files.files.iter().map(|file| (file.hash, file.written)).collect();
    assert_eq!(known, [(Some(fox), 0), (Some(crate_), 2)]);
    // The project has one of them without a hash.
    let models = [("models/Fox.glb", fox), ("models/box.gltf", crate_)];
    let path = project(&other);
    let mut edited = Edited::new(open(&path).adapter());
    let read = |text: &str| StageProject::read(text).expect("a project");
    let edit = listed_models(&read(PROJECT), models, ScriptLabel::AddRole).expect("an edit");
    edited.apply(edit.into(), None).expect("it fits");
    let text = edited.adapter().texts().list()[0].text.clone();
    assert!(
        text.contains(&format!("<model id=\"fox\" src=\"models/Fox.glb\" hash=\"{fox:016x}\"/>")),
        "{text}"
    );
    let new = format!("<model id=\"box\" src=\"models/box.gltf\" hash=\"{crate_:016x}\"/>");
    assert_eq!(text.matches(&new).count(), 1, "{text}");
    // A hash that is stated stays: the model may have changed since.
    let changed = models.map(|(file, hash)| (file, hash + 1));
    assert_eq!(listed_models(&read(&text), changed, ScriptLabel::AddRole), None);
}

#[cfg(unix)]
#[test]
fn a_link_out_of_the_folder_of_a_scene_gets_no_copies() {
    let (scene, other) = (Folder::new("files-link-out"), Folder::new("files-link-out-other"));
    fs::copy(data("gltf/Fox.glb"), other.join("knight.glb")).expect("a copy");
    fs::create_dir(other.join("outside")).expect("a folder");
    std::os::unix::fs::symlink(other.join("outside"), scene.join("models")).expect("a link");
    let wanted = [(SceneFileKind::Model, other.join("knight.glb"))];
    let mut files = looked(scene.path(), &wanted).expect("it can be read");
    let reason = files.copy(&Cancel::default()).expect_err("a link");
    assert!(reason.contains("leads out of the folder"), "{reason}");
    assert_eq!(fs::read_dir(other.join("outside")).expect("a folder").count(), 0);
}
