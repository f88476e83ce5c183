//! Captures of other skeletons that are dropped on a model in the real window, saved, and read by other programs.

use crate::drag::{Drag, address};
use crate::program::run;
use crate::screen::{Screen, key};
use crate::window::{Editor, SOON, alone};
use crate::window_bone_rotation::shown;
use dragonfly_kit::folder::{Folder, data, takes_long};
use dragonfly_kit::skip::{TestNeed, evaluators, models, skip};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

/// Files of the collection with a human: skeletons of different names, rest poses and sizes.
const CLIPS: [&str; 7] = [
    "fbx/pab_run.fbx",
    "fbx/maya_kenney_character_7700_binary.fbx",
    "fbx/quaternius_Knight.fbx",
    "bvh/cmu_01_01.bvh",
    "bvh/fair1_dab.bvh",
    "bvh/pybvh_example.bvh",
    "bvh/pybvh_test2.bvh",
];

/// Number of takes in these files.
const TAKES: usize = 18;

/// Time in which all files are read and retargeted on a busy machine.
const PATIENCE: Duration = Duration::from_secs(300);

/// Drops all clips on the model, and saves it. Returns the file.
fn dropped_and_saved(folder: &Folder, models: &Path) -> PathBuf {
    let model = folder.join("person.glb");
    std::fs::copy(data("collection/quaternius_Character4skins.glb"), &model).expect("a file");
    let clips = CLIPS.map(|clip| {
        let path = models.join(clip);
        assert!(path.is_file(), "{} is missing", path.display());
        address(&path)
    });
    let mut screen = Screen::new("clips", 1280, 800);
    let mut editor = Editor::open_file(&mut screen, &model, &[], &[]);
    editor.window = screen.window("person.glb", SOON);
    screen.focus(editor.window);
    let mut drag = Drag::new(&screen);
    assert!(drag.hold(editor.window, &clips), "the window does not take files");
    drag.drop(editor.window);
    editor.wait_for_log(&format!("Added {TAKES} takes of {} files", CLIPS.len()), 1, PATIENCE);
    editor.window = screen.window("• person.glb", SOON);
    screen.focus(editor.window);
    screen.press_with(key::CONTROL, key::S);
    editor.wait_for_log("Saved person.glb", 1, PATIENCE);
    screen.close(editor.window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
    assert!(!editor.log().contains("ERROR"), "{}", editor.log());
    model
}

#[test]
fn clips_that_are_dropped_on_a_model_are_in_the_saved_file_where_other_programs_expect_them() {
    let Some(models) = models() else { return };
    let _one = alone();
    let folder = Folder::new("dropped-clips");
    let model = dropped_and_saved(&folder, &models);
    let own =
        run(["info", "--json", data("collection/quaternius_Character4skins.glb").to_str().expect("UTF-8")]);
    let count = |info: &serde_json::Value| info["takes"].as_array().map_or(0, Vec::len);
    let saved = run(["info", "--json", model.to_str().expect("UTF-8")]).expect(0).json();
    assert_eq!(count(&saved), count(&own.expect(0).json()) + TAKES);
    let Some(evaluators) = evaluators() else { return };
    let validated =
        Command::new("node").arg(evaluators.join("validate.mjs")).arg(&model).output().expect("node runs");
    assert!(validated.status.success(), "{}", String::from_utf8_lossy(&validated.stdout));
    let Some(python) = std::env::var_os("DRAGONFLY_BPY") else {
        return skip(TestNeed::Evaluators, "DRAGONFLY_BPY names no Python with Blender's module");
    };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/judges/merged.py");
    let mut judge = Command::new(python);
    judge
        .arg(script)
        .arg(&model)
        .env("DRAGONFLY", env!("CARGO_BIN_EXE_dragonfly"))
        .env("PYTHONDONTWRITEBYTECODE", "1");
    judge.env("DRAGONFLY_EVALUATORS", evaluators);
    // The table in the tree is made again by this test.
    if std::env::var_os("DRAGONFLY_RECORD").is_some() {
        judge.arg("--record");
    }
    let judged = judge.output().expect("Python runs");
    println!("{}", String::from_utf8_lossy(&judged.stdout));
    assert!(judged.status.success(), "{}", String::from_utf8_lossy(&judged.stderr));
}

/// Longest time between a key and the picture that shows its effect, while files are read and retargeted.
const ANSWER: Duration = Duration::from_secs(2);

/// Writes a capture of `frames` frames, the frames of another one over and over, and returns its address.
fn capture(text: &str, frames: usize, path: &Path) -> String {
    let (skeleton, motion) = text.split_once("Frames:").expect("a motion");
    let mut lines = motion.lines().skip(1);
    let rate = lines.next().expect("a frame time");
    let poses: Vec<&str> = lines.filter(|line| !line.trim().is_empty()).collect();
    let repeated: Vec<&str> = poses.iter().copied().cycle().take(frames).collect();
    let whole = format!("{skeleton}Frames: {frames}\n{rate}\n{}\n", repeated.join("\n"));
    std::fs::write(path, whole).expect("written");
    address(path)
}

#[test]
fn keys_are_answered_while_captures_of_a_minute_are_added() {
    let Some(models) = models() else { return };
    let _one = alone();
    let folder = Folder::new("many-clips");
    let model = folder.join("person.glb");
    std::fs::copy(data("collection/quaternius_Character4skins.glb"), &model).expect("a file");
    let text = std::fs::read_to_string(models.join("bvh/cmu_01_01.bvh")).expect("a capture");
    // 120 frames a second.
    let (files, frames) = if takes_long() { (30, 7_200) } else { (4, 2_400) };
    let place = |file: usize| folder.join(&format!("walk{file:02}.bvh"));
    let clips: Vec<String> = (0..files).map(|file| capture(&text, frames, &place(file))).collect();
    let mut screen = Screen::new("many-clips", 1280, 800);
    let log = ("DRAGONFLY_LOG", "error,dragonfly=info,dragonfly::shown=debug");
    let mut editor = Editor::open_file(&mut screen, &model, &[], &[log]);
    editor.window = screen.window("person.glb", SOON);
    screen.focus(editor.window);
    screen.press(key::SPACE);
    screen.press(key::HOME);
    let mut drag = Drag::new(&screen);
    assert!(drag.hold(editor.window, &clips), "the window does not take files");
    drag.drop(editor.window);
    let (mut longest, mut keys) = (Duration::ZERO, 0);
    let end = Instant::now() + PATIENCE;
    let done = format!("Added {files} takes of {files} files");
    while !editor.log().contains(&done) {
        assert!(Instant::now() < end, "{}", editor.log());
        let before = shown(&mut editor, "time");
        let pressed = Instant::now();
        screen.press(if keys % 2 == 0 { key::RIGHT } else { key::LEFT });
        while shown(&mut editor, "time") == before {
            assert!(pressed.elapsed() < ANSWER, "key {keys} has no effect\n{}", editor.log());
            std::thread::park_timeout(Duration::from_millis(5));
        }
        longest = longest.max(pressed.elapsed());
        keys += 1;
    }
    println!("{files} captures of {frames} frames: {keys} keys, the slowest after {longest:?}");
    assert!(keys > 3, "the files were added before a key could be pressed");
    screen.press_with(key::CONTROL, key::Z);
    editor.wait_for_log("Undone: Add takes", 1, SOON);
    editor.window = screen.window("person.glb", SOON);
    screen.close(editor.window);
    assert_eq!(editor.ends(SOON).code(), Some(0), "{}", editor.log());
}
