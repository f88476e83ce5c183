//! Files dropped onto the window while a scene is open.

use crate::scene_bench::{FOXES, new_lines, scene, text};
use crate::workbench::Window;
use dragonfly::panels::request::FileAction;
use dragonfly::panels::{Effect, Request};
use dragonfly_document::{Change, Source, Then};
use std::path::{Path, PathBuf};

/// Drops files, and gives the change that follows to the document. Returns what else follows.
fn drop_files(window: &mut Window, files: &[&str]) -> Option<Effect> {
    let files = files.iter().map(PathBuf::from).collect();
    let effect = match window.state_mut().state.execute(Request::Dropped(files)) {
        Some(Effect::Change(change)) => {
            window.state_mut().change(change);
            None
        }
        other => other,
    };
    window.run_steps(2);
    effect
}

fn opened(path: &str) -> Option<Effect> {
    Some(Effect::File(FileAction::Leave(Then::Open(Source::File(path.into())))))
}

#[test]
fn several_dropped_models_are_added_in_one_step_and_selected() {
    let mut window = scene(FOXES).window();
    assert_eq!(
        drop_files(&mut window, &["/scenes/Fox.glb", "notes.txt", "/scenes/Fox.glb", "step.wav"]),
        None
    );
    let new = new_lines(FOXES, &text(&window));
    assert_eq!(new.len(), 2, "{new:?}");
    for (line, id) in new.iter().zip(["fox", "fox-2"]) {
        assert!(line.starts_with("<role") && line.contains("model=\"Fox.glb\""), "{line}");
        assert!(line.to_lowercase().contains(&format!("id=\"{id}\"")), "{line}");
    }
    assert_eq!(window.state().steps(), (1, 1));
    let read = window.state().state.read();
    assert_eq!(read.scene_editing.things().len(), 2, "{:?}", read.scene_editing.things());
    assert_eq!(read.sound.settings().file, Path::new("step.wav"), "the sound beside them is shown");
    let said = read.status.lines().any(|message| message.text.contains("notes.txt"));
    assert!(said, "a file that is no model is named");
    window.state_mut().change(Change::Undo);
    assert_eq!(text(&window), FOXES);
}

#[test]
fn a_dropped_sound_is_no_role() {
    let mut window = scene(FOXES).window();
    assert_eq!(drop_files(&mut window, &["music.flac"]), None);
    assert_eq!((text(&window).as_str(), window.state().steps()), (FOXES, (0, 0)));
    assert_eq!(window.state().state.read().sound.settings().file, Path::new("music.flac"));
}

#[test]
fn a_dropped_file_that_is_no_model_is_opened_and_so_is_a_scene_among_models() {
    let mut window = scene(FOXES).window();
    assert_eq!(drop_files(&mut window, &["notes.txt"]), opened("notes.txt"));
    assert_eq!(drop_files(&mut window, &["Fox.glb", "other.xml"]), opened("other.xml"));
    assert_eq!(text(&window), FOXES);
}
