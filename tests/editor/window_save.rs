//! Saving, closing and recovering in the real window: nothing is lost, and nothing is overwritten without being asked.

use crate::program::run;
use crate::screen::{Screen, key};
use crate::window::{Editor, SOON, alone};
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::{Cancel, Editable, Source};
use dragonfly_kit::document::new_version::{new_version, rename_nodes, reverse};
use dragonfly_kit::document::test_document::fox;
use dragonfly_kit::eventually;
use dragonfly_kit::folder::{Folder, data};
use dragonfly_kit::mounted::{Mounted, may_mount};
use std::fs;
use std::path::{Path, PathBuf};

const EDITS: &str = r#"{"edit":"set","take":0,"time":0.5,"poses":[{"bone":"b_Head_05","rotation":[0,0,0.26,0.97]}]}
{"edit":"rename_take","take":1,"name":"Stroll"}
{"edit":"add_keys","take":0,"time":0.77,"bones":["b_Head_05"]}
"#;

/// A copy of Fox, edits for it, and an autosave folder.
struct Bench {
    folder: Folder,
    file: PathBuf,
    edits: String,
    autosave: String,
}

impl Bench {
    fn new(name: &str) -> Self {
        let folder = Folder::new(name);
        let edits = folder.join("edits.jsonl");
        fs::write(&edits, EDITS).unwrap();
        let [edits, autosave] = [edits, folder.join("autosave")].map(|path| path.display().to_string());
        Self { file: fox(&folder), folder, edits, autosave }
    }

    /// Opens the window with the file, unedited.
    fn open(&self, screen: &mut Screen) -> Editor {
        self.start(screen, &[])
    }

    /// Opens the window, and makes the edits in it.
    fn edit(&self, screen: &mut Screen, more: &[&str]) -> Editor {
        let mut editor = self.start(screen, &[&["--edits", self.edits.as_str()], more].concat());
        editor.window = screen.window("• Fox.glb", SOON);
        editor
    }

    fn start(&self, screen: &mut Screen, more: &[&str]) -> Editor {
        let arguments = [&["--autosave", self.autosave.as_str()], more].concat();
        // Without file dialogs, so that paths are typed.
        let environment = [
            ("DBUS_SESSION_BUS_ADDRESS", "unix:path=/nonexistent"),
            ("PATH", "/nonexistent"),
            ("HOME", self.folder.path().to_str().unwrap()),
        ];
        let mut editor = Editor::open_file(screen, &self.file, &arguments, &environment);
        let name = self.file.file_name().unwrap().to_str().unwrap();
        let name = if name == "demo:" { "Untitled" } else { name };
        if more.is_empty() {
            editor.window = screen.window(name, SOON);
            screen.focus(editor.window);
        } else {
            // A dot is put before the title as soon as there are unsaved changes.
            editor.window = screen.any_window(&[name, &format!("• {name}")], SOON);
            screen.focus(editor.window);
        }
        screen.point(i16::MAX, i16::MAX);
        editor
    }

    /// Returns the file that `dragonfly edit` makes from the current one.
    fn expected(&self) -> Vec<u8> {
        let out = self.folder.join("expected.glb");
        let arguments =
            ["edit", self.file.to_str().unwrap(), "--edits", &self.edits, "-o", out.to_str().unwrap()];
        run(arguments).expect(0);
        fs::read(out).unwrap()
    }
}

/// Presses Ctrl and a key.
fn control(screen: &mut Screen, key: u8) {
    screen.press_with(key::CONTROL, key);
}

fn takes(path: &Path) -> ModelAdapter {
    let editable = Editable::open(&Source::File(path.to_owned()), &Cancel::default()).unwrap();
    ModelAdapter::new(&editable.model.animation)
}

#[test]
fn a_killed_window_restores_its_work_and_saves_the_same_as_the_command_line() {
    let _one = alone();
    let bench = Bench::new("window-killed");
    let original = takes(&bench.file);
    let expected = bench.expected();
    let mut screen = Screen::new("killed", 1280, 800);
    let mut editor = bench.edit(&mut screen, &[]);
    editor.kill();
    drop(editor);
    assert_eq!(fs::read(&bench.file).unwrap(), fs::read(data("gltf/Fox.glb")).unwrap());

    let mut editor = bench.open(&mut screen);
    editor.wait_for_log("offered unsaved work", 1, SOON);
    screen.press(key::ENTER);
    editor.wait_for_log("Restored the unsaved work of Fox.glb: 3 steps", 1, SOON);
    screen.window("• Fox.glb", SOON);
    control(&mut screen, key::S);
    editor.wait_for_log("Saved Fox.glb", 1, SOON);
    screen.window("Fox.glb", SOON);
    assert!(fs::read(&bench.file).unwrap() == expected, "the same bytes as `dragonfly edit` writes");
    // Closed and opened again, everything can still be undone.
    screen.close(editor.window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
    drop(editor);
    let mut editor = bench.open(&mut screen);
    for _ in 0..3 {
        control(&mut screen, key::Z);
    }
    screen.window("• Fox.glb", SOON);
    control(&mut screen, key::S);
    editor.wait_for_log("Saved Fox.glb", 1, SOON);
    let now = takes(&bench.file);
    assert!(now.results().eq(original.results()), "the takes of the beginning");
    screen.close(editor.window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
}

#[test]
fn closing_with_unsaved_work_asks_and_follows_every_answer() {
    let _one = alone();
    let bench = Bench::new("window-closing");
    let before = fs::read(&bench.file).unwrap();
    let expected = bench.expected();
    let mut screen = Screen::new("closing", 1280, 800);
    // Cancel: the window stays open.
    let mut editor = bench.edit(&mut screen, &[]);
    screen.close(editor.window);
    editor.wait_for_log("asked what becomes of unsaved work", 1, SOON);
    screen.press(key::ESCAPE);
    // Don't save: the file stays as it is.
    control(&mut screen, key::Q);
    editor.wait_for_log("asked what becomes of unsaved work", 2, SOON);
    screen.press_with(key::SHIFT, key::TAB);
    screen.press(key::ENTER);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
    drop(editor);
    assert!(fs::read(&bench.file).unwrap() == before);
    // Discarded work is not offered again. Save: the file contains the edit.
    let mut editor = bench.edit(&mut screen, &[]);
    screen.close(editor.window);
    editor.wait_for_log("asked what becomes of unsaved work", 1, SOON);
    screen.press(key::ENTER);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
    assert!(!editor.log().contains("offered unsaved work"), "{}", editor.log());
    assert!(fs::read(&bench.file).unwrap() == expected);
}

#[test]
fn a_file_changed_by_another_program_is_noticed_and_not_overwritten() {
    let _one = alone();
    let bench = Bench::new("window-changed");
    let mut screen = Screen::new("changed", 1280, 800);
    let mut editor = bench.edit(&mut screen, &[]);
    let other = fs::read(data("gltf/Fox_skeleton.glb")).unwrap();
    fs::write(&bench.file, &other).unwrap();
    control(&mut screen, key::S);
    editor.wait_for_log("asked what becomes of a changed file", 1, SOON);
    screen.press(key::ESCAPE);
    assert!(fs::read(&bench.file).unwrap() == other, "it is as the other program wrote it");
    // The change is noticed once, as soon as the window has the focus again.
    fs::write(&bench.file, fs::read(data("gltf/Fox.glb")).unwrap()).unwrap();
    screen.leave();
    screen.focus(editor.window);
    fs::remove_file(&bench.file).unwrap();
    screen.leave();
    screen.focus(editor.window);
    editor.wait_for_log("asked what becomes of a changed file", 2, SOON);
    screen.press(key::ENTER);
    editor.wait_for_log("Saved Fox.glb", 1, SOON);
    assert!(takes(&bench.file).results().any(|take| take.name == "Stroll"));
    screen.close(editor.window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
}

#[test]
fn an_fbx_file_is_replaced_only_after_a_question_and_then_contains_the_edits() {
    let _one = alone();
    let mut bench = Bench::new("window-fbx");
    let before = fs::read(data("fbx/maya_blend_shape_cube_7700_binary.fbx")).unwrap();
    bench.file = bench.folder.join("Cube.fbx");
    fs::write(&bench.file, &before).unwrap();
    fs::write(&bench.edits, r#"{"edit":"rename_take","take":0,"name":"Stroll"}"#).unwrap();
    let mut screen = Screen::new("fbx", 1280, 800);
    let mut editor = bench.start(&mut screen, &["--edits", bench.edits.as_str()]);
    editor.window = screen.window("• Cube.fbx", SOON);
    control(&mut screen, key::S);
    editor.wait_for_log("asked whether the whole file is to be replaced", 1, SOON);
    screen.press(key::ESCAPE);
    control(&mut screen, key::S);
    editor.wait_for_log("asked whether the whole file is to be replaced", 2, SOON);
    assert!(fs::read(&bench.file).unwrap() == before, "nothing is written before the answer");
    screen.press_with(key::SHIFT, key::TAB);
    screen.press(key::ENTER);
    editor.wait_for_log("Saved Cube.fbx", 1, SOON);
    screen.window("Cube.fbx", SOON);
    let info = run(["info", bench.file.to_str().unwrap(), "--json"]).expect(0).json();
    assert_eq!(info["takes"][0]["name"], "Stroll", "{info}");
    // The decision holds as long as the file is open.
    control(&mut screen, key::Z);
    screen.window("• Cube.fbx", SOON);
    control(&mut screen, key::S);
    editor.wait_for_log("Saved Cube.fbx", 2, SOON);
    let again = run(["info", bench.file.to_str().unwrap(), "--json"]).expect(0).json();
    assert_ne!(again["takes"][0]["name"], "Stroll", "{again}");
    screen.close(editor.window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
}

#[test]
fn a_full_or_read_only_disk_is_reported_and_nothing_is_lost() {
    let _one = alone();
    if !may_mount("a_full_or_read_only_disk_is_reported_and_nothing_is_lost") {
        return;
    }
    let mut bench = Bench::new("window-full");
    let size = fs::metadata(&bench.file).unwrap().len() as usize;
    let Some(disk) = Mounted::in_memory(&bench.folder.join("disk"), size * 3) else { return };
    bench.file = disk.path().join("Fox.glb");
    fs::copy(data("gltf/Fox.glb"), &bench.file).unwrap();
    let before = fs::read(&bench.file).unwrap();
    let expected = bench.expected();
    let mut screen = Screen::new("full", 1280, 800);
    let mut editor = bench.edit(&mut screen, &[]);
    let filling = disk.path().join("filling");
    // The largest possible file.
    let _ = fs::write(&filling, vec![1; size * 3]);
    control(&mut screen, key::S);
    editor.wait_for_log("Not saved", 1, SOON);
    editor.wait_for_log("the disk is full", 1, SOON);
    assert!(fs::read(&bench.file).unwrap() == before);
    fs::remove_file(&filling).unwrap();
    disk.read_only(true);
    control(&mut screen, key::S);
    editor.wait_for_log("the disk is read-only", 1, SOON);
    // Closing asks, and asks again when the save failed.
    screen.close(editor.window);
    editor.wait_for_log("asked what becomes of unsaved work", 1, SOON);
    screen.press(key::ENTER);
    editor.wait_for_log("asked what becomes of unsaved work", 2, SOON);
    disk.read_only(false);
    screen.press(key::ENTER);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
    assert!(fs::read(&bench.file).unwrap() == expected);
    assert_eq!(fs::read_dir(disk.path()).unwrap().count(), 1, "no other file is left in the folder");
}

#[test]
fn a_panic_loses_no_work_and_the_window_continues() {
    let _one = alone();
    let bench = Bench::new("window-mistake");
    let mut screen = Screen::new("mistake", 1280, 800);
    let mut editor = bench.start(&mut screen, &["--edits", bench.edits.as_str(), "--fail-at", "3"]);
    editor.wait_for_log("An internal error closed the document", 1, SOON);
    editor.wait_for_log("offered unsaved work", 1, SOON);
    screen.press(key::ENTER);
    editor.wait_for_log("Restored the unsaved work of Fox.glb: 2 steps", 1, SOON);
    control(&mut screen, key::S);
    editor.wait_for_log("Saved Fox.glb", 1, SOON);
    assert!(takes(&bench.file).results().any(|take| take.name == "Stroll"));
    screen.close(editor.window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
}

#[test]
fn a_document_without_a_file_is_saved_where_the_user_chooses() {
    let _one = alone();
    let mut bench = Bench::new("window-where");
    bench.file = "demo:".into();
    fs::write(&bench.edits, r#"{"edit":"rename_take","take":0,"name":"Hover"}"#).unwrap();
    let mut screen = Screen::new("where", 1280, 800);
    let mut editor = bench.start(&mut screen, &["--edits", bench.edits.as_str()]);
    screen.window("• Untitled", SOON);
    control(&mut screen, key::S);
    editor.wait_for_log("asked where to save", 1, SOON);
    screen.press(key::ENTER);
    editor.wait_for_log("Saved Dragonfly.glb", 1, SOON);
    let path = bench.folder.join("Dragonfly.glb");
    eventually(SOON, || path.is_file());
    assert!(takes(&path).results().any(|take| take.name == "Hover"));
    screen.window("Dragonfly.glb", SOON);
    screen.close(editor.window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
}

#[test]
fn a_file_changed_by_another_program_is_loaded_with_the_unsaved_changes() {
    let _one = alone();
    let bench = Bench::new("window-reload");
    let mut screen = Screen::new("reload", 1280, 800);
    let mut editor = bench.edit(&mut screen, &[]);
    let [old, new] = ["old.glb", "new.glb"].map(|name| bench.folder.join(name));
    let bytes = fs::read(&bench.file).unwrap();
    fs::write(&old, &bytes).unwrap();
    let changed = new_version(&bytes, |json| {
        reverse(json);
        rename_nodes(json, "b_Head_05", "b_Face");
    });
    for path in [&new, &bench.file] {
        fs::write(path, &changed).unwrap();
    }
    screen.leave();
    screen.focus(editor.window);
    editor.wait_for_log("asked what becomes of a changed file", 1, SOON);
    screen.press(key::ENTER);
    editor.wait_for_log("showed which changes do not fit", 1, SOON);
    screen.press(key::ENTER);
    editor.window = screen.window("• Fox.glb", SOON);
    control(&mut screen, key::S);
    editor.wait_for_log("Saved Fox.glb", 1, SOON);
    let expected = bench.folder.join("expected.glb");
    let [old, new, out] = [&old, &new, &expected].map(|path| path.to_str().unwrap());
    run(["edit", new, "--rebase", old, "--edits", &bench.edits, "-o", out]).expect(1);
    assert!(fs::read(&bench.file).unwrap() == fs::read(&expected).unwrap(), "as `dragonfly edit --rebase`");
    screen.close(editor.window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
}
