//! Keys of commands for models that run commands of scenes while a scene is open.

use crate::scene_bench::{FOXES, new_lines, scene, text};
use crate::workbench::Window;
use dragonfly::panels::Request;
use dragonfly::panels::commands::{Id, shortcut_text};
use dragonfly::panels::scene::SceneRequest;
use dragonfly_document::bones::Choice;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;

fn press(window: &mut Window, modifiers: Modifiers, key: Key) {
    window.key_press_modifiers(modifiers, key);
    window.run_steps(3);
}

fn time(window: &Window) -> f32 {
    window.state().state.read().time()
}

#[test]
fn the_keys_of_markers_go_from_shot_to_shot_and_those_of_takes_from_action_to_action() {
    let mut window = scene(FOXES).window();
    press(&mut window, Modifiers::SHIFT, Key::PageDown);
    assert_eq!(time(&window), 2.0);
    press(&mut window, Modifiers::SHIFT, Key::PageUp);
    assert_eq!(time(&window), 0.0);
    press(&mut window, Modifiers::NONE, Key::PageDown);
    let first = window.state().state.read().scene_editing.action().expect("an action");
    press(&mut window, Modifiers::NONE, Key::PageDown);
    assert!(window.state().state.read().scene_editing.action().is_some_and(|next| next > first));
    press(&mut window, Modifiers::NONE, Key::PageUp);
    assert_eq!(window.state().state.read().scene_editing.action(), Some(first));
}

#[test]
fn k_cuts_the_key_of_markers_cuts_to_the_selected_camera_and_that_of_the_rest_position_drops_things() {
    let script = FOXES.replace("at=\"1 0 0\"", "at=\"1 0.5 0\"");
    let mut window = scene(&script).window();
    let select = |window: &mut Window, id: &str| {
        let things = SceneRequest::SelectThings(vec![id.into()], Choice::Replace);
        window.state_mut().state.execute(Request::Scene(things));
        window.run_steps(2);
    };
    window.state_mut().state.execute(Request::Seek(1.0));
    press(&mut window, Modifiers::NONE, Key::K);
    assert_eq!(new_lines(&script, &text(&window)), [r#"<shot who="close" begin="1"/>"#]);
    window.state_mut().state.execute(Request::Seek(1.5));
    select(&mut window, "wide");
    press(&mut window, Modifiers::ALT, Key::M);
    assert_eq!(new_lines(&script, &text(&window))[1], r#"<shot who="wide" begin="1.5"/>"#);
    // Later it follows a path.
    window.state_mut().state.execute(Request::Seek(0.0));
    select(&mut window, "ben");
    press(&mut window, Modifiers::ALT, Key::G);
    let new = new_lines(&script, &text(&window));
    assert!(new[0].contains("id=\"ben\"") && new[0].contains("at=\"1 0 0\""), "{new:?}");
    assert_eq!(window.state().steps(), (3, 3));
}

#[test]
fn menus_show_the_keys_of_commands_of_scenes() {
    let window = scene(FOXES).window();
    for (own, of) in [
        (Id::SceneDelete, Id::DeleteKeys),
        (Id::SceneDuplicate, Id::DuplicateKeys),
        (Id::CutHere, Id::Key),
        (Id::CutToCamera, Id::AddMarker),
        (Id::PreviousShot, Id::PreviousMarker),
        (Id::NextShot, Id::NextMarker),
        (Id::DropToGround, Id::RestTranslation),
        (Id::LookThroughShot, Id::RestPose),
    ] {
        let [own, of] = [own, of].map(|id| shortcut_text(&window.ctx, id));
        assert!(!of.is_empty() && own == of, "{own:?} {of:?}");
    }
    assert_eq!(shortcut_text(&window.ctx, Id::AddLight), "");
}

#[test]
fn the_sheet_of_shortcuts_shows_the_keys_of_commands_of_scenes() {
    let mut window = scene(FOXES).window();
    window.key_press(Key::F1);
    window.run_steps(4);
    for shown in ["Rename: F2", "Hide things: H", "Hide other things: Shift+H", "Drop to the ground: Alt+G"] {
        assert!(window.query_all_by_label(shown).next().is_some(), "{shown}");
    }
}
