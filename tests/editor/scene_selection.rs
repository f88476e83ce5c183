//! The selection of a scene: it stays what it was while the text changes, is one thing at a time, and survives a new name.

use crate::scene_bench::{FOXES, named_text, new_lines, project, scene, text};
use crate::workbench::{Window, type_into};
use dragonfly::panels::commands::Id;
use dragonfly::panels::scene::{LineRequest, SceneRequest, follow_actions};
use dragonfly::panels::{Effect, Request};
use dragonfly_anim::stage::script::StageScript;
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::{Edit, EditScript};
use dragonfly_kit::counting::count;
use dragonfly_picture::ThroughCamera;
use egui::Key;
use egui_kittest::kittest::Queryable;

const LINES: &str = "<lines version=\"1\">\n  <line id=\"arrow\" points=\"0 0 0  1 0 0  2 0 0  3 0 0\"/>\n  <line id=\"ring\" points=\"0 0 1  1 0 1  2 0 1  3 0 1\"/>\n</lines>\n";

fn execute(window: &mut Window, request: Request) {
    match window.state_mut().state.execute(request) {
        Some(Effect::Change(change)) | Some(Effect::Cut(_, change)) => window.state_mut().change(change),
        _ => {}
    }
    window.run_steps(3);
}

fn run(window: &mut Window, id: Id) {
    execute(window, Request::Command(id));
}

fn change(window: &mut Window, change: Change) {
    window.state_mut().change(change);
    window.run_steps(3);
}

/// Makes `new` the script, as an edit from elsewhere.
fn rewrite(window: &mut Window, new: &str) {
    let edit = EditScript::between(&text(window), new, None).expect("another text");
    change(window, Change::Edit(Edit::EditScript(edit), None));
    assert_eq!(text(window), new);
}

fn select_actions(window: &mut Window, actions: &[usize]) {
    execute(window, Request::Scene(SceneRequest::SelectActions(actions.to_vec(), Choice::Replace)));
}

fn select_things(window: &mut Window, things: &[&str]) {
    let things = things.iter().map(|id| (*id).into()).collect();
    execute(window, Request::Scene(SceneRequest::SelectThings(things, Choice::Replace)));
}

fn select_line(window: &mut Window, line: &str) {
    execute(window, Request::Scene(SceneRequest::Line(LineRequest::Select(Some(line.into())))));
}

fn actions(window: &Window) -> Vec<usize> {
    window.state().state.read().scene_editing.actions().to_vec()
}

fn things(window: &Window) -> Vec<String> {
    window.state().state.read().scene_editing.things().iter().map(|id| id.to_string()).collect()
}

fn line(window: &Window) -> Option<String> {
    window.state().state.read().scene_editing.lines().selected().map(str::to_owned)
}

/// Shots of two cameras in turn; `actions` is the part with the actions.
fn shots(actions: &str) -> String {
    let (head, _) = FOXES.split_once("  <par id").expect("a part with actions");
    format!("{head}  <seq>\n{actions}  </seq>\n</script>\n")
}

const WIDE: &str = "    <shot who=\"wide\" dur=\"1\"/>\n";
const CLOSE: &str = "    <shot who=\"close\" dur=\"1\"/>\n";

#[test]
fn nothing_is_selected_after_a_shot_was_deleted_and_a_second_delete_deletes_nothing() {
    let script = shots(&[WIDE, CLOSE, WIDE, CLOSE, WIDE].concat());
    for (action, left) in [
        (2, [CLOSE, WIDE, CLOSE, WIDE]),
        (3, [WIDE, WIDE, CLOSE, WIDE]),
        (4, [WIDE, CLOSE, CLOSE, WIDE]),
        (6, [WIDE, CLOSE, WIDE, CLOSE]),
    ] {
        let mut window = scene(&script).window();
        select_actions(&mut window, &[action]);
        // No thing is selected, which Delete would delete then.
        select_nothing_else(&mut window, action);
        run(&mut window, Id::SceneDelete);
        assert_eq!(text(&window), shots(&left.concat()), "{action}");
        assert_eq!(actions(&window), [0; 0], "{action}");
        run(&mut window, Id::SceneDelete);
        assert_eq!(text(&window), shots(&left.concat()), "a second time, after {action}");
        // Redone, it is gone again, and no other one is selected.
        change(&mut window, Change::Undo);
        select_actions(&mut window, &[action]);
        change(&mut window, Change::Redo);
        assert_eq!(actions(&window), [0; 0], "redo of {action}");
    }
    // Of two that are the same and next to each other.
    let mut window = scene(&shots(&[WIDE, WIDE, CLOSE].concat())).window();
    for action in [2, 3] {
        select_actions(&mut window, &[action]);
        run(&mut window, Id::SceneDelete);
        assert_eq!(actions(&window), [0; 0], "{action}");
        change(&mut window, Change::Undo);
        select_actions(&mut window, &[action]);
        change(&mut window, Change::Redo);
        assert_eq!(actions(&window), [0; 0], "redo of {action}");
        change(&mut window, Change::Undo);
    }
}

fn select_nothing_else(window: &mut Window, action: usize) {
    execute(window, Request::Scene(SceneRequest::SelectThings(Vec::new(), Choice::Replace)));
    select_actions(window, &[action]);
}

#[test]
fn a_selected_action_stays_selected_while_others_are_added_deleted_and_changed() {
    let script = shots(&[WIDE, CLOSE, WIDE, CLOSE, WIDE].concat());
    let cases = [
        // One more before it: the next one that is alike is not nearer.
        (4, [WIDE, WIDE, CLOSE, WIDE, CLOSE, WIDE].concat(), 5),
        (4, [CLOSE, WIDE, CLOSE, WIDE, CLOSE, WIDE].concat(), 5),
        (4, [WIDE, CLOSE, WIDE, CLOSE, WIDE, CLOSE].concat(), 4),
        (6, [CLOSE, WIDE, CLOSE, WIDE].concat(), 5),
        // Its attributes change, also who acts.
        (4, [WIDE, CLOSE, &WIDE.replace("\"1\"", "\"2\""), CLOSE, WIDE].concat(), 4),
        (4, [WIDE, CLOSE, CLOSE, CLOSE, WIDE].concat(), 4),
        // Those of all change.
        (5, [WIDE, CLOSE, WIDE, CLOSE, WIDE].concat().replace("\"1\"", "\"3\""), 5),
        // It went to another place.
        (3, [WIDE, &CLOSE.replace("close\" dur", "close\" id=\"x\" dur"), WIDE, CLOSE, WIDE].concat(), 3),
    ];
    for (action, new, wanted) in cases {
        let mut window = scene(&script).window();
        select_actions(&mut window, &[action]);
        rewrite(&mut window, &shots(&new));
        assert_eq!(actions(&window), [wanted], "{action} of {new}");
        change(&mut window, Change::Undo);
        assert_eq!(actions(&window), [action], "and back, {new}");
    }
    let moved = shots(&[WIDE, &CLOSE.replace("\"1\"", "\"2\""), WIDE].concat());
    let mut window = scene(&moved).window();
    select_actions(&mut window, &[3]);
    rewrite(&mut window, &shots(&[WIDE, WIDE, &CLOSE.replace("\"1\"", "\"2\"")].concat()));
    assert_eq!(actions(&window), [4], "it is after the others now");
}

#[test]
fn following_the_selection_of_a_long_script_allocates_in_proportion_to_what_changed() {
    let line = |at: usize| format!("    <title text=\"{}\" begin=\"{at}\" dur=\"1\"/>\n", at % 7);
    let lines: Vec<String> = (0..10_000).map(line).collect();
    let script = |lines: &[String]| {
        let text = format!("<script version=\"1\">\n  <par>\n{}  </par>\n</script>\n", lines.concat());
        StageScript::read(text).expect("a script")
    };
    let old = script(&lines);
    let all: Vec<usize> = (2..10_002).collect();
    let mut changed = lines.clone();
    changed[5_000] = changed[5_000].replace("dur=\"1\"", "dur=\"2\"");
    let mut fewer = lines.clone();
    fewer.remove(5_000);
    let more = [&lines[..5_000], &["    <wait dur=\"1\"/>\n".to_owned()], &lines[5_000..]].concat();
    // An unchanged one is found at once; a changed one needs a few lists and tables.
    for (new, selected, wanted, most) in [
        (script(&changed), vec![5_002], vec![5_002], 20),
        (script(&changed), all.clone(), all.clone(), 20),
        (script(&fewer), vec![5_002], vec![], 20),
        (script(&fewer), vec![9_000], vec![8_999], 1),
        (script(&fewer), all.clone(), [&all[..5_000], &all[5_000..9_999]].concat(), 20),
        (script(&more), vec![5_002], vec![5_003], 20),
        (script(&more), vec![4_000], vec![4_000], 1),
    ] {
        let (allocated, found) = count(|| follow_actions(&old, &new, &selected));
        assert!(found == wanted, "{} of {}", found.len(), selected.len());
        assert!(allocated.allocations <= most, "{allocated:?} for {} actions", selected.len());
    }
    // All of them at once: in proportion to their number, also where none is as it was.
    let shifted: Vec<String> = lines.iter().map(|line| line.replace("dur=\"1\"", "dur=\"2\"")).collect();
    let (allocated, found) = count(|| follow_actions(&old, &script(&shifted), &all));
    assert!(found == all);
    let (reading, _) = count(|| script(&shifted));
    assert!(allocated.bytes < 2 * reading.bytes, "{allocated:?}, {reading:?}");
}

#[test]
fn a_line_that_was_clicked_is_what_is_selected_and_what_delete_deletes() {
    let mut window = project(FOXES, LINES).window();
    select_things(&mut window, &["door"]);
    select_line(&mut window, "arrow");
    assert_eq!((things(&window), line(&window).as_deref()), (Vec::new(), Some("arrow")));
    run(&mut window, Id::DeleteKeys);
    assert_eq!(text(&window), FOXES, "the mark is still there");
    assert!(!named_text(&window, "scene.lines.xml").contains("arrow"));
    assert!(named_text(&window, "scene.lines.xml").contains("ring"));
    assert_eq!(window.state().steps(), (1, 1));
    // It is selected alone whatever was selected before, and gives way to everything else.
    select_actions(&mut window, &[7]);
    select_line(&mut window, "ring");
    assert_eq!((actions(&window), things(&window)), (Vec::new(), Vec::new()));
    select_things(&mut window, &["ben"]);
    assert_eq!((line(&window), things(&window)), (None, vec!["ben".to_owned()]));
    select_line(&mut window, "ring");
    select_actions(&mut window, &[7]);
    assert_eq!((line(&window), actions(&window)), (None, vec![7]));
    select_line(&mut window, "ring");
    execute(&mut window, Request::Scene(SceneRequest::Cursor(FOXES.find("<path").expect("a path") + 2)));
    assert_eq!((line(&window), things(&window)), (None, vec!["aisle".to_owned()]));
}

#[test]
fn escape_deselects_a_line_and_delete_deletes_nothing_then() {
    let mut window = project(FOXES, LINES).window();
    select_line(&mut window, "arrow");
    window.key_press(Key::Escape);
    window.run_steps(2);
    assert_eq!(line(&window), None);
    run(&mut window, Id::SceneDelete);
    assert_eq!((named_text(&window, "scene.lines.xml").as_str(), text(&window).as_str()), (LINES, FOXES));
}

#[test]
fn the_key_for_names_renames_the_selected_line() {
    let mut window = project(FOXES, LINES).window();
    select_line(&mut window, "arrow");
    window.key_press(Key::F2);
    window.run_steps(2);
    assert!(window.query_by_label("Name of the line").is_some());
    // The field has the focus; it may be below the part of the list that is in sight.
    window.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
    window.run_steps(1);
    window.event(egui::Event::Text("spear".to_owned()));
    window.run_steps(2);
    window.key_press(Key::Enter);
    window.run_steps(3);
    assert_eq!(named_text(&window, "scene.lines.xml"), LINES.replace("arrow", "spear"));
    assert_eq!(line(&window).as_deref(), Some("spear"));
}

#[test]
fn a_thing_with_a_new_name_stays_selected_hidden_locked_and_looked_through() {
    let mut window = scene(FOXES).window();
    let state = |window: &Window, id: &str| {
        let editing = window.state().state.read().scene_editing.clone();
        (editing.is_selected(id), editing.is_hidden(id), editing.is_locked(id))
    };
    let through = |window: &Window| window.state().state.read().through.clone();
    execute(&mut window, Request::Scene(SceneRequest::Through(ThroughCamera::Of("wide".into()))));
    select_things(&mut window, &["wide", "door"]);
    execute(&mut window, Request::Scene(SceneRequest::Hide(vec!["wide".into()], true)));
    execute(&mut window, Request::Scene(SceneRequest::Lock(vec!["wide".into()], true)));
    // Typed, as everything else that is locked can be.
    let renamed = FOXES.replace("\"wide\"", "\"total\"");
    rewrite(&mut window, &renamed);
    assert_eq!(things(&window), ["total", "door"]);
    assert_eq!(state(&window, "total"), (true, true, true));
    assert_eq!(state(&window, "wide"), (false, false, false));
    assert_eq!(through(&window), ThroughCamera::Of("total".into()));
    change(&mut window, Change::Undo);
    assert_eq!(things(&window), ["wide", "door"]);
    assert_eq!(state(&window, "wide"), (true, true, true));
    assert_eq!(through(&window), ThroughCamera::Of("wide".into()));
    // By the field of the list.
    select_things(&mut window, &["ben"]);
    execute(&mut window, Request::Scene(SceneRequest::Hide(vec!["ben".into()], true)));
    window.key_press(Key::F2);
    window.run_steps(2);
    type_into(&mut window, "Name of the thing", "bernard", Key::Enter);
    assert_eq!(
        (things(&window), state(&window, "bernard")),
        (vec!["bernard".to_owned()], (true, true, false))
    );
    // A new thing with the old name is as it was added.
    let with_ben = text(&window).replace("    <mark ", "    <mark   id=\"ben\" at=\"0 0 0\"/>\n    <mark ");
    rewrite(&mut window, &with_ben);
    assert_eq!(state(&window, "ben"), (false, false, false));
    assert_eq!(state(&window, "bernard"), (true, true, false));
    // A thing that is gone is not selected; the one at its place is another one.
    let without = with_ben.replace("    <mark   id=\"ben\" at=\"0 0 0\"/>\n", "");
    select_things(&mut window, &["ben"]);
    rewrite(&mut window, &without);
    assert_eq!(things(&window), Vec::<String>::new());
    assert_eq!(new_lines(&without, &text(&window)), Vec::<String>::new());
}
