//! Actions and things that cannot be deleted, and the selection after actions were added.

use crate::scene_bench::{FOXES, new_lines, scene, text};
use crate::scene_lines::run;
use crate::workbench::Window;
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::scene::SceneRequest;
use dragonfly::panels::status::MessageSeverity;
use dragonfly_document::bones::Choice;

const CLOSE: usize = 3;
const LOOKS: usize = 5;
const TITLE: usize = 10;

fn select_action(window: &mut Window, action: usize) {
    window.state_mut().state.execute(Request::Scene(SceneRequest::SelectAction(Some(action))));
    window.run_steps(2);
}

/// Returns the newest message, and whether it is a warning.
fn said(window: &Window) -> (String, bool) {
    let read = window.state().state.read();
    let message = read.status.last().expect("a message");
    (message.text.clone(), message.level == MessageSeverity::Warning)
}

/// Returns kinds and names of the selected bars.
fn selected(window: &Window) -> Vec<(&'static str, String)> {
    let editing = window.state().state.read().scene_editing;
    let bars = editing.actions().iter().map(|&action| editing.lanes().bar_of(action).expect("a bar").1);
    bars.map(|bar| (bar.kind, bar.label.to_string())).collect()
}

/// Selects an action, and returns the first words of its element.
fn selected_text(window: &mut Window, action: usize) -> &'static str {
    select_action(window, action);
    if action == TITLE { "<title text=\"The End\" begin=\"4\"" } else { "<play id=\"looks\"" }
}

#[test]
fn a_clip_on_which_a_shot_depends_is_not_deleted_and_the_shot_is_named_and_selected() {
    let mut window = scene(FOXES).window();
    select_action(&mut window, LOOKS);
    run(&mut window, Id::SceneDelete);
    assert_eq!(text(&window), FOXES);
    let (message, is_warning) = said(&window);
    assert!(
        is_warning && message.contains("the shot of close depends on Survey") && !message.contains('<'),
        "{message}"
    );
    assert_eq!(window.state().state.read().scene_editing.actions(), [CLOSE]);
}

#[test]
fn a_role_at_which_a_camera_looks_is_not_deleted_and_the_camera_is_named_and_selected() {
    let mut window = scene(FOXES).window();
    let ben = SceneRequest::SelectThings(vec!["ben".into()], Choice::Replace);
    window.state_mut().state.execute(Request::Scene(ben));
    run(&mut window, Id::SceneDelete);
    assert_eq!(text(&window), FOXES);
    let (message, is_warning) = said(&window);
    assert!(is_warning && message.contains("the camera close depends on ben"), "{message}");
    assert_eq!(window.state().state.read().scene_editing.things(), [Box::from("close")]);
}

#[test]
fn the_copy_of_an_action_is_selected_so_that_delete_removes_it() {
    let mut window = scene(FOXES).window();
    for (action, word) in [(TITLE, "The End"), (LOOKS, "Survey")] {
        let count = |window: &Window| text(window).matches(word).count();
        let before = selected_text(&mut window, action);
        run(&mut window, Id::SceneDuplicate);
        assert_eq!(count(&window), 2);
        assert_eq!(window.state().state.read().scene_editing.actions().len(), 1);
        run(&mut window, Id::SceneDelete);
        assert!(count(&window) == 1 && text(&window).contains(before), "the original is left");
        for _ in 0..2 {
            run(&mut window, Id::Undo);
        }
        assert_eq!(text(&window), FOXES);
    }
}

#[test]
fn a_shot_that_is_inserted_at_the_playhead_is_selected() {
    let mut window = scene(FOXES).window();
    select_action(&mut window, LOOKS);
    window.state_mut().state.execute(Request::Seek(1.0));
    run(&mut window, Id::CutHere);
    assert_eq!(new_lines(FOXES, &text(&window)), [r#"<shot who="close" begin="1"/>"#]);
    assert_eq!(selected(&window), [("shot", "close".to_owned())]);
}

#[test]
fn a_title_is_added_to_a_scene_that_has_none_and_is_selected() {
    let script = FOXES.replace("    <title text=\"The End\" begin=\"4\" dur=\"1\" fade-in=\"0.5\"/>\n", "");
    let mut window = scene(&script).window();
    window.state_mut().state.execute(Request::Seek(2.0));
    run(&mut window, Id::AddTitle);
    let line = r#"<title dur="2" text="Title" begin="2"/>"#;
    assert_eq!(new_lines(&script, &text(&window)), [line]);
    assert_eq!(selected(&window), [("title", "Title".to_owned())]);
    run(&mut window, Id::SceneDelete);
    assert_eq!(text(&window), script);
}
