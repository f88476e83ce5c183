//! Commands for the things of a scene, the frame rate of its script, and steps of its playhead.

use crate::scene_bench::{FOXES, new_lines, scene, shared, text};
use crate::workbench::Window;
use dragonfly::panels::commands::{self, Id};
use dragonfly::panels::keys::TimeWindow;
use dragonfly::panels::prompts::Overlay;
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::{Effect, FileChoice, Request, State};
use dragonfly_document::View;
use dragonfly_document::bones::Choice;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT, Queryable};
use std::path::Path;
use std::time::Instant;

fn execute(window: &mut Window, request: Request) {
    if let Some(Effect::Change(change)) = window.state_mut().state.execute(request) {
        window.state_mut().change(change);
    }
    window.run_steps(3);
}

fn run(window: &mut Window, id: Id) {
    execute(window, Request::Command(id));
}

fn select(window: &mut Window, ids: &[&str]) {
    let ids = ids.iter().map(|id| (*id).into()).collect();
    execute(window, Request::Scene(SceneRequest::SelectThings(ids, Choice::Replace)));
}

fn selected(window: &Window) -> Vec<String> {
    window.state().state.read().scene_editing.things().iter().map(|id| id.to_string()).collect()
}

fn is_hidden(window: &Window, id: &str) -> bool {
    window.state().state.read().scene_editing.is_hidden(id)
}

#[test]
fn the_path_of_a_new_part_of_the_scene_begins_with_the_folder_of_the_scene() {
    for choice in [FileChoice::Role, FileChoice::Prop, FileChoice::SceneSound] {
        let mut window = scene(FOXES).window();
        window.state_mut().state.show_overlay(Some(Overlay::FilePath(choice)));
        window.run_steps(4);
        assert!(window.get_by_label("Choose").accesskit_node().is_disabled(), "{choice:?}: a folder is none");
        window.event(egui::Event::Text("other.glb".to_owned()));
        window.run_steps(2);
        let folder = Path::new("/scenes").join("");
        let path = window.get_by_label("Path").accesskit_node().value().unwrap_or_default();
        assert_eq!(path, format!("{}other.glb", folder.display()), "{choice:?}");
    }
}

#[test]
fn the_keys_that_hide_bones_hide_things_of_a_scene() {
    let mut window = scene(FOXES).window();
    select(&mut window, &["ben"]);
    window.key_press(Key::H);
    window.run_steps(2);
    assert!(is_hidden(&window, "ben") && !is_hidden(&window, "anna"));
    window.key_press_modifiers(Modifiers::ALT, Key::H);
    window.run_steps(2);
    assert!(!is_hidden(&window, "ben"));
    assert_eq!(selected(&window), ["ben"], "what is shown again is selected");
    select(&mut window, &["anna"]);
    window.key_press_modifiers(Modifiers::SHIFT, Key::H);
    window.run_steps(2);
    assert!(is_hidden(&window, "ben") && is_hidden(&window, "sun") && !is_hidden(&window, "anna"));
    run(&mut window, Id::LockBones);
    assert!(window.state().state.read().scene_editing.is_locked("anna"));
    run(&mut window, Id::LockBones);
    assert!(!window.state().state.read().scene_editing.is_locked("anna"));
    assert_eq!(text(&window), FOXES, "the script stays as it is");
}

#[test]
fn undo_after_hiding_or_locking_shows_and_unlocks_and_leaves_the_edit_before_it() {
    let mut window = scene(FOXES).window();
    run(&mut window, Id::AddMark);
    let edited = text(&window);
    select(&mut window, &["ben"]);
    run(&mut window, Id::HideSelected);
    run(&mut window, Id::LockBones);
    let is_locked = |window: &Window| window.state().state.read().scene_editing.is_locked("ben");
    assert!(is_hidden(&window, "ben") && is_locked(&window));
    run(&mut window, Id::Undo);
    assert!(is_hidden(&window, "ben") && !is_locked(&window));
    run(&mut window, Id::Undo);
    assert!(!is_hidden(&window, "ben"));
    assert_eq!(text(&window), edited, "the edit before it stays");
    for _ in 0..2 {
        run(&mut window, Id::Redo);
    }
    assert!(is_hidden(&window, "ben") && is_locked(&window));
    // Steps of the history and those between them are undone in their order.
    run(&mut window, Id::AddMark);
    for _ in 0..3 {
        run(&mut window, Id::Undo);
    }
    assert!(!is_hidden(&window, "ben") && text(&window) == edited);
    run(&mut window, Id::Undo);
    assert_eq!(text(&window), FOXES);
    // Undo of a new step does not show things that were hidden after a step that is gone.
    run(&mut window, Id::AddMark);
    run(&mut window, Id::Undo);
    assert!(!is_hidden(&window, "ben") && text(&window) == FOXES);
}

#[test]
fn the_menu_says_what_undo_is_about_after_hiding() {
    let mut window = scene(FOXES).window();
    select(&mut window, &["ben"]);
    run(&mut window, Id::HideSelected);
    let title = |window: &Window| commands::title(&window.state().state.read(), Id::Undo).into_owned();
    assert_eq!(title(&window), "Undo Hide");
    run(&mut window, Id::Undo);
    assert_eq!(title(&window), "Undo");
}

#[test]
fn hidden_and_locked_things_are_remembered_for_their_scene() {
    let mut window = scene(FOXES).window();
    select(&mut window, &["ben"]);
    run(&mut window, Id::HideSelected);
    select(&mut window, &["wide"]);
    run(&mut window, Id::LockBones);
    let marks = window.state_mut().state.side_files().unsaved_marks().expect("they changed");
    let view = window.state().state.read().view.expect("a scene").clone();
    let mut again = State::new(Default::default(), Instant::now());
    again.side_files().read_marks(&marks);
    again.show(View { generation: 77, ..view });
    assert!(again.read().scene_editing.is_hidden("ben") && !again.read().scene_editing.is_hidden("anna"));
    assert!(again.read().scene_editing.is_locked("wide"));
    assert_eq!(again.side_files().unsaved_marks(), None, "as it was read");
}

const SHORT: &str = r#"<script version="1" fps="24">
  <cast>
    <role id="anna" model="Fox.glb" scale="0.01"/>
    <role id="ben" model="Fox.glb" scale="0.01" at="2 0 0"/>
    <camera id="wide" at="0 1 5" look="0 0.5 0"/>
  </cast>
  <par>
    <seq>
      <play who="anna" take="Survey" to="1"/>
      <play who="ben" take="Walk"/>
      <play who="anna" take="Run"/>
    </seq>
    <look who="anna" at="ben" bones="b_Head_05" dur="1"/>
    <title text="Foxes" dur="2"/>
  </par>
</script>
"#;

#[test]
fn the_short_script_is_one() {
    let window = scene(SHORT).window();
    let read = window.state().state.read();
    let scene = read.scene().expect("a scene");
    assert!(scene.errors.is_empty(), "{:?}", scene.errors);
}

#[test]
fn a_thing_is_deleted_with_the_actions_that_name_it_in_one_step_and_the_rest_stays_where_it_is() {
    let mut window = scene(SHORT).window();
    let begin_of_run = |window: &Window| {
        let lanes = window.state().state.read().scene_editing.lanes().clone();
        let lane = lanes.list.iter().find(|lane| &*lane.name == "anna").expect("a lane");
        lane.bars.iter().filter(|bar| bar.kind == "play").map(|bar| bar.begin.seconds()).fold(0.0, f64::max)
    };
    let before = begin_of_run(&window);
    select(&mut window, &["ben"]);
    run(&mut window, Id::SceneDelete);
    let new = text(&window);
    assert!(!new.contains("ben") && new.contains("Survey") && new.contains("<title"), "{new}");
    assert!((begin_of_run(&window) - before).abs() < 2e-3, "{new}");
    assert_eq!(window.state().steps(), (1, 1));
    let lines = window
        .state()
        .state
        .read()
        .status
        .lines()
        .any(|message| message.text.contains("Deleted ben with 2 actions that name it"));
    assert!(lines, "it says so");
    execute(&mut window, Request::Command(Id::Undo));
    assert_eq!(text(&window), SHORT);
}

#[test]
fn a_thing_that_another_one_names_is_not_deleted() {
    let mut window = scene(FOXES).window();
    // A camera looks at it.
    select(&mut window, &["ben"]);
    run(&mut window, Id::SceneDelete);
    assert_eq!(text(&window), FOXES);
    // With that camera it is, but a shot of the camera begins relative to another action, which is no obstacle.
    select(&mut window, &["door"]);
    run(&mut window, Id::SceneDelete);
    assert_eq!(text(&window), FOXES.replace("    <mark   id=\"door\"  at=\"0.6 0 0.8\"/>\n", ""));
}

#[test]
fn a_copy_of_a_thing_is_selected() {
    let mut window = scene(FOXES).window();
    select(&mut window, &["ben", "door"]);
    run(&mut window, Id::SceneDuplicate);
    assert_eq!(selected(&window), ["ben-2", "door-2"]);
    assert_eq!(new_lines(FOXES, &text(&window)).len(), 2);
}

#[test]
fn the_frame_rate_is_changed_where_the_scene_states_it() {
    let mut window = scene(FOXES).window();
    assert!(window.query_by_label("24 fps").is_some());
    execute(&mut window, Request::FrameRate(30));
    assert_eq!(text(&window), FOXES.replace("fps=\"24\"", "fps=\"30\""));
    assert!(window.query_by_label("30 fps").is_some());
    // The project states it, the script does not.
    let project = "<project version=\"1\" fps=\"25\"><script id=\"main\" src=\"scene.xml\"/><script id=\"end\" src=\"end.xml\"/></project>";
    let script = FOXES.replace(" fps=\"24\"", "");
    let mut window = shared(project, &script, "<script version=\"1\"/>").window();
    assert!(window.query_by_label("25 fps").is_some());
    execute(&mut window, Request::FrameRate(50));
    assert_eq!(text(&window), script);
    let texts = |window: &Window| {
        let read = window.state().state.read();
        read.scene().expect("a scene").texts.main().expect("a project").to_string()
    };
    assert_eq!(texts(&window), project.replace("25", "50"));
}

#[test]
fn the_keys_for_keys_step_between_begins_and_ends_of_actions() {
    let mut window = scene(SHORT).window();
    let time = |window: &Window| (f64::from(window.state().state.read().time()) * 1000.0).round() / 1000.0;
    execute(&mut window, Request::Seek(0.0));
    run(&mut window, Id::NextKey);
    assert_eq!(time(&window), 1.0, "a play and a look end");
    run(&mut window, Id::NextKey);
    let next = time(&window);
    assert!(next > 1.0 && next < 2.0, "the walk ends at {next}");
    run(&mut window, Id::PreviousKey);
    assert_eq!(time(&window), 1.0);
    run(&mut window, Id::PreviousKey);
    assert_eq!(time(&window), 0.0);
    // Of the selected things only.
    select(&mut window, &["ben"]);
    run(&mut window, Id::NextKey);
    run(&mut window, Id::NextKey);
    assert_eq!(time(&window), next);
    assert_eq!(text(&window), SHORT);
}

#[test]
fn the_timeline_follows_the_playhead_that_leaves_it() {
    let mut window = scene(FOXES).window();
    let part = TimeWindow { start: 0.0, length: 1.0 };
    execute(&mut window, Request::Scene(SceneRequest::Window(Some(part))));
    run(&mut window, Id::End);
    let shown = window.state().state.read().scene_editing.window();
    let time = f64::from(window.state().state.read().time());
    assert!((shown.start..=shown.start + shown.length).contains(&time), "{time} is not in {shown:?}");
    assert_eq!(shown.length, 1.0);
    run(&mut window, Id::Start);
    let shown = window.state().state.read().scene_editing.window();
    assert!(shown.start <= 0.0 + 1e-6, "{shown:?}");
}

#[test]
fn the_switch_of_auto_key_is_shown_for_scenes() {
    let mut window = scene(FOXES).window();
    let before = window.state().state.read().settings.auto_key;
    window.get_by_label("Auto-key").click();
    window.run_steps(2);
    assert_eq!(window.state().state.read().settings.auto_key, !before);
}
