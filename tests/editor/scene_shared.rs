//! The cast of a project is edited in the window as that of a script is: each gesture is one step, in the text that has the thing, and names
//! change in all scripts.

use crate::scene_bench::{named_text, new_lines, shared, text};
use crate::scene_script::type_text;
use crate::workbench::{Window, type_into};
use dragonfly::control::{InputEvent, Key as ToolKey};
use dragonfly::panels::commands::Id;
use dragonfly::panels::request::FileAction;
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::{Effect, Request};
use dragonfly_document::bones::Choice;
use dragonfly_document::{Change, DocumentMessage};
use egui::Key;
use egui::text::{CCursor, CCursorRange};
use egui::text_edit::TextEditState;
use egui_kittest::kittest::Queryable;

const PROJECT: &str = r#"<project version="1">
  <!-- What both scripts share. -->
  <cast>
    <camera id="wide"  at="0 1 5" look="door"/>
    <mark   id="door"  at="0.6 0 0.8"/>
    <mark   id="spot"  at="2 0 0"/>
    <path   id="aisle" points="-1 0 0  0 0 0.6  1 0 0"/>
  </cast>
  <script id="main" src="scene.xml"/>
  <script id="end" src="end.xml"/>
</project>
"#;

const SCRIPT: &str = r#"<script version="1">
  <cast>
    <role id="anna" model="Fox.glb" at="-1 0 0" facing="90" scale="0.01"/>
  </cast>
  <shot who="wide"/>
  <look who="anna" at="door" bones="b_Head_05" begin="1"/>
</script>
"#;

const END: &str = "<script version=\"1\">\n  <cast>\n    <mark id=\"gate\"/>\n  </cast>\n  <shot who=\"wide\"/>\n</script>\n";

fn window() -> Window {
    shared(PROJECT, SCRIPT, END).window()
}

fn execute(window: &mut Window, request: Request) -> Option<Effect> {
    let effect = match window.state_mut().state.execute(request) {
        Some(Effect::Change(change)) => {
            window.state_mut().change(change);
            None
        }
        other => other,
    };
    window.run_steps(3);
    effect
}

fn select(window: &mut Window, ids: &[&str]) {
    let ids = ids.iter().map(|id| (*id).into()).collect();
    execute(window, Request::Scene(SceneRequest::SelectThings(ids, Choice::Replace)));
}

fn keys(window: &mut Window, keys: &[ToolKey]) {
    for event in keys.iter().flat_map(|&key| [InputEvent::KeyDown(key), InputEvent::KeyUp(key)]) {
        let mut effects = Vec::new();
        window.state_mut().state.input(event, &mut effects);
        for effect in effects {
            if let Effect::Change(change) = effect {
                window.state_mut().change(change);
            }
        }
    }
    window.run_steps(2);
}

fn project(window: &Window) -> String {
    named_text(window, "scene.meproj")
}

fn undo(window: &mut Window) {
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    assert_eq!((project(window).as_str(), text(window).as_str()), (PROJECT, SCRIPT), "undone");
    assert_eq!(named_text(window, "end.xml"), END);
}

#[test]
fn a_shared_thing_is_moved_in_the_text_of_the_project_alone_and_with_one_of_the_script() {
    let mut window = window();
    execute(&mut window, Request::Command(Id::SpaceWorld));
    let letter = ToolKey::letter;
    select(&mut window, &["door"]);
    execute(&mut window, Request::Command(Id::MoveNow));
    keys(&mut window, &[letter('x'), letter('1'), letter('2')]);
    keys(&mut window, &[ToolKey::Backspace, ToolKey::Enter]);
    assert_eq!(new_lines(PROJECT, &project(&window)), [r#"<mark   id="door"  at="1.6 0 0.8"/>"#]);
    assert_eq!((text(&window).as_str(), window.state().steps().0), (SCRIPT, 1));
    undo(&mut window);
    // Both in one step.
    select(&mut window, &["anna", "door"]);
    execute(&mut window, Request::Command(Id::MoveNow));
    keys(&mut window, &[letter('z'), letter('2'), ToolKey::Enter]);
    assert_eq!(new_lines(PROJECT, &project(&window)), [r#"<mark   id="door"  at="0.6 0 2.8"/>"#]);
    assert!(text(&window).contains("at=\"-1 0 2\""), "{}", text(&window));
    assert_eq!(window.state().steps().0, 1);
    undo(&mut window);
    // A drag that is given up leaves nothing.
    execute(&mut window, Request::Command(Id::MoveNow));
    keys(&mut window, &[letter('x'), letter('3')]);
    assert_ne!(project(&window), PROJECT, "the drag is shown before it ends");
    keys(&mut window, &[ToolKey::Escape]);
    assert_eq!((project(&window).as_str(), text(&window).as_str()), (PROJECT, SCRIPT));
    assert_eq!(window.state().refused, [""; 0]);
}

#[test]
fn a_shared_thing_gets_its_new_name_in_all_scripts_in_one_step() {
    let mut window = window();
    window.get_by_label("wide, camera").click();
    window.run_steps(2);
    window.key_press(Key::F2);
    window.run_steps(2);
    type_into(&mut window, "Name of the thing", "front", Key::Enter);
    assert_eq!(project(&window), PROJECT.replace("\"wide\"", "\"front\""));
    assert_eq!(text(&window), SCRIPT.replace("\"wide\"", "\"front\""));
    assert_eq!(named_text(&window, "end.xml"), END.replace("\"wide\"", "\"front\""));
    assert_eq!(window.state().steps(), (1, 1));
    assert!(window.query_by_label("front, camera").is_some());
    undo(&mut window);
    // References in the project follow, too.
    window.get_by_label("door, mark").click();
    window.run_steps(2);
    window.key_press(Key::F2);
    window.run_steps(2);
    type_into(&mut window, "Name of the thing", "exit", Key::Enter);
    assert_eq!(project(&window), PROJECT.replace("\"door\"", "\"exit\""));
    assert_eq!(text(&window), SCRIPT.replace("\"door\"", "\"exit\""));
    undo(&mut window);
    // Another script has that name.
    window.get_by_label("door, mark").click();
    window.run_steps(2);
    window.key_press(Key::F2);
    window.run_steps(2);
    type_into(&mut window, "Name of the thing", "gate", Key::Enter);
    assert_eq!((project(&window).as_str(), window.state().steps().0), (PROJECT, 0));
}

#[test]
fn a_shared_thing_is_deleted_and_duplicated_in_the_project_unless_a_script_names_it() {
    let mut window = window();
    select(&mut window, &["spot"]);
    execute(&mut window, Request::Command(Id::SceneDelete));
    assert_eq!(project(&window), PROJECT.replace("    <mark   id=\"spot\"  at=\"2 0 0\"/>\n", ""));
    undo(&mut window);
    select(&mut window, &["spot"]);
    execute(&mut window, Request::Command(Id::SceneDuplicate));
    assert_eq!(new_lines(PROJECT, &project(&window)), [r#"<mark   id="spot-2"  at="2 0 0"/>"#]);
    assert_eq!(text(&window), SCRIPT);
    undo(&mut window);
    let other = shared(PROJECT, &SCRIPT.replace("  <shot who=\"wide\"/>\n", ""), END);
    let mut other = other.window();
    select(&mut other, &["wide"]);
    execute(&mut other, Request::Command(Id::SceneDelete));
    assert_eq!(project(&other), PROJECT, "end.xml names it");
}

#[test]
fn the_text_of_the_project_is_typed_in_the_script_panel_and_another_script_is_chosen_there() {
    let mut window = window();
    window.get_by_label("Text: scene.xml").click();
    window.run_steps(3);
    window.get_by_label("scene.meproj").click();
    window.run_steps(3);
    window.get_by_label("Text of the project").focus();
    window.run_steps(2);
    let id = egui::Id::unique("text of the project");
    let at = PROJECT.find("at=\"2 0 0").expect("a place") + "at=\"2".len();
    let mut state = TextEditState::load(&window.ctx, id).unwrap_or_default();
    state.cursor.set_char_range(Some(CCursorRange::one(CCursor::new(at))));
    state.store(&window.ctx, id);
    window.run_steps(2);
    type_text(&mut window, ".5");
    assert_eq!(project(&window), PROJECT.replace("at=\"2 0 0\"", "at=\"2.5 0 0\""));
    assert_eq!(text(&window), SCRIPT);
    let things: Vec<&str> = window
        .state()
        .state
        .read()
        .scene_editing
        .things()
        .iter()
        .map(|id| &**id)
        .collect::<Vec<_>>()
        .to_vec();
    assert_eq!(things, ["spot"], "what is at the cursor is selected");
    let steps = window.state().steps().0;
    for _ in 0..steps {
        window.state_mut().change(Change::Undo);
    }
    window.run_steps(2);
    assert_eq!(project(&window), PROJECT);
    // Words of projects are completed.
    let at = PROJECT.find("</cast>").expect("a cast");
    let mut state = TextEditState::load(&window.ctx, id).unwrap_or_default();
    state.cursor.set_char_range(Some(CCursorRange::one(CCursor::new(at))));
    state.store(&window.ctx, id);
    window.run_steps(2);
    type_text(&mut window, "<mar");
    window.key_press(Key::Tab);
    window.run_steps(3);
    assert_eq!(project(&window), PROJECT.replace("</cast>", "<mark id=\"\"/></cast>"));
    for _ in 0..window.state().steps().0 {
        window.state_mut().change(Change::Undo);
    }
    window.run_steps(2);
    window.get_by_label("Text: scene.meproj").click();
    window.run_steps(3);
    let request = Request::Scene(SceneRequest::ShowScript("end.xml".into()));
    window.get_by_label("end.xml").click();
    window.run_steps(3);
    assert!(window.query_by_label("Script of the scene").is_some());
    let effect = execute(&mut window, request);
    let Some(Effect::File(FileAction::Send(message))) = effect else { panic!("{effect:?}") };
    assert_eq!(message, DocumentMessage::ShowScript("end.xml".to_owned()));
}

#[test]
fn an_error_of_the_shared_cast_is_listed_with_the_project_and_a_click_goes_there() {
    let broken = PROJECT.replace("look=\"door\"", "look=\"anna.Hed\"");
    let mut window = shared(&broken, SCRIPT, END).window_of_any_text();
    window.run_steps(2);
    let error = window.get_by_label_contains("Error at scene.meproj, 4:41: ");
    error.click();
    window.run_steps(4);
    assert!(window.query_by_label("Text of the project").is_some());
    let state = TextEditState::load(&window.ctx, egui::Id::unique("text of the project")).expect("a field");
    let cursor = state.cursor.char_range().expect("a cursor").primary.index.0;
    assert_eq!(cursor, broken.find("anna.Hed").expect("a place"));
}
