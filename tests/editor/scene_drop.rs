//! Files dropped onto the window while a scene is open.

use crate::scene_bench::{FOXES, looked, new_lines, scene, text};
use crate::workbench::Window;
use dragonfly::panels::request::FileAction;
use dragonfly::panels::scene::{NewThing, with_new_thing};
use dragonfly::panels::{Effect, Request};
use dragonfly_anim::stage::script::StageScript;
use dragonfly_document::{Change, SceneFileKind, Source, Then};
use dragonfly_kit::counting::count;
use std::path::{Path, PathBuf};

/// Drops files, and gives the change that follows to the document. Returns what else follows.
fn drop_files(window: &mut Window, files: &[&str]) -> Option<Effect> {
    let files = files.iter().map(PathBuf::from).collect();
    let effect = window.state_mut().state.execute(Request::Dropped(files));
    let effect = match looked(window, effect) {
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
    assert_eq!(drop_files(&mut window, &["/scenes/Fox.glb", "notes.txt", "/scenes/Fox.glb"]), None);
    let new = new_lines(FOXES, &text(&window));
    assert_eq!(new.len(), 2, "{new:?}");
    for (line, id) in new.iter().zip(["fox", "fox-2"]) {
        assert!(line.starts_with("<role") && line.contains("model=\"Fox.glb\""), "{line}");
        assert!(line.to_lowercase().contains(&format!("id=\"{id}\"")), "{line}");
    }
    assert_eq!(window.state().steps(), (1, 1));
    let read = window.state().state.read();
    assert_eq!(read.scene_editing.things().len(), 2, "{:?}", read.scene_editing.things());
    let is_named = |text: &str| text.contains("notes.txt") && text.contains("Not added");
    assert!(read.status.lines().any(|message| is_named(&message.text)));
    window.state_mut().change(Change::Undo);
    assert_eq!(text(&window), FOXES);
}

#[test]
fn a_dropped_sound_is_no_role_and_files_outside_of_the_folder_are_looked_at_first() {
    let mut window = scene(FOXES).window();
    let Some(Effect::LookAtFiles(wanted)) = drop_files(&mut window, &["music.flac"]) else {
        panic!("another effect")
    };
    assert_eq!(
        (wanted.files.files[0].kind, wanted.files.files[0].name.as_deref()),
        (SceneFileKind::Sound, None)
    );
    assert_eq!(wanted.files.folder, Path::new("/scenes"));
    assert_eq!((text(&window).as_str(), window.state().steps()), (FOXES, (0, 0)));
    let read = window.state().state.read();
    assert_eq!(read.sound.settings().file, Path::new(""), "scenes do not show the sound of a model");
}

#[test]
fn a_sound_from_the_folder_of_the_scene_begins_at_the_playhead_and_is_added_in_one_step_with_models() {
    let mut window = scene(FOXES).window();
    window.state_mut().state.execute(Request::Seek(1.5));
    window.run_steps(2);
    assert_eq!(drop_files(&mut window, &["/scenes/sounds/thunder.wav"]), None);
    let sound = r#"<sound src="sounds/thunder.wav" begin="1.5"/>"#;
    assert_eq!((new_lines(FOXES, &text(&window)), window.state().steps()), (vec![sound.to_owned()], (1, 1)));
    let read = window.state().state.read();
    let plan = read.scene().and_then(|scene| scene.plan.clone()).expect("a plan");
    assert_eq!(plan.sounds().len(), 1, "the sound is a part of the scene");
    // By its path it is opened like that, too.
    let open = Request::Open(Source::File("/scenes/rain.ogg".into()));
    let effect = window.state_mut().state.execute(open);
    let effect = looked(&mut window, effect);
    assert!(matches!(effect, Some(Effect::Change(_))), "{effect:?}");
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    assert_eq!(text(&window), FOXES);
    drop_files(&mut window, &["/scenes/rain.ogg", "/scenes/Fox.glb"]);
    let new = new_lines(FOXES, &text(&window));
    assert_eq!((new.len(), window.state().steps()), (2, (1, 1)), "{new:?}");
    assert!(new[0].starts_with("<role") && new[1].contains("rain.ogg"), "{new:?}");
}

#[test]
fn a_new_thing_costs_one_reading_of_the_script() {
    let marks: String = (0..2_000).map(|at| format!("    <mark id=\"m{at}\" at=\"{at} 0 0\"/>\n")).collect();
    let text = FOXES.replace("  </cast>\n", &format!("{marks}  </cast>\n"));
    let read = || StageScript::read(text.as_str()).expect("a script");
    let (once, script) = count(read);
    let (added, new) = count(|| with_new_thing(&script, &NewThing::Mark));
    let (script, id) = new.expect("a script");
    assert_eq!((&*id, script.things().len()), ("mark", 2_008));
    assert!(added.allocations < once.allocations * 5 / 4, "{added:?}, of one reading {once:?}");
}

#[test]
fn a_dropped_file_that_is_no_model_is_opened_and_so_is_a_scene_among_models() {
    let mut window = scene(FOXES).window();
    assert_eq!(drop_files(&mut window, &["notes.txt"]), opened("notes.txt"));
    assert_eq!(drop_files(&mut window, &["Fox.glb", "other.xml"]), opened("other.xml"));
    assert_eq!(text(&window), FOXES);
}
