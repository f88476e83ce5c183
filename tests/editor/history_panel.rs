//! The history panel lists every undo step; a click on one goes to that state.

use crate::workbench::{Window, Workbench, type_into};
use dragonfly::panels::Request;
use egui::Key;
use egui_kittest::kittest::{NodeT, Queryable};

/// Opens a window with three undo steps of bone 3, and shows the history panel.
fn window() -> Window {
    let mut bench = Workbench::full();
    bench.state.execute(Request::Select(Some(3)));
    let mut window = bench.window();
    type_into(&mut window, "Translation result X", "1", Key::Enter);
    type_into(&mut window, "Translation result X", "1.5", Key::Enter);
    type_into(&mut window, "Scale result X", "3", Key::Enter);
    window.get_by_label("History").click();
    window.run_steps(4);
    window
}

const MOVE: &str = "Move X +0.5 m, rib_00_left_middle  ·  Survey  ·  frame 0";
const SCALE: &str = "Scale X ×3, rib_00_left_middle  ·  Survey  ·  frame 0";

#[test]
fn the_list_names_each_edit_its_amount_its_target_and_its_frame() {
    let mut window = window();
    assert_eq!(window.query_all_by_label(MOVE).count(), 1);
    assert!(
        window.get_by_label(SCALE).accesskit_node().is_selected() == Some(true)
            || window.get_by_label(SCALE).accesskit_node().toggled().is_some()
    );
    assert!(window.query_by_label("3 of 3 steps").is_some());
    window.get_by_label("Opened").click();
    window.run_steps(4);
    assert_eq!(window.state().steps(), (0, 3));
    assert!(
        window.query_by_label(&format!("{SCALE}, undone")).is_some(),
        "what can be done again is still there"
    );
    window.get_by_label(&format!("{SCALE}, undone")).click();
    window.run_steps(4);
    assert_eq!(window.state().steps(), (3, 3));
    assert_eq!(window.state().pose(3).scale.x, 3.0);
}

#[test]
fn the_saved_step_is_marked() {
    let mut window = window();
    window.state_mut().edited.as_mut().unwrap().mark_saved();
    window.state_mut().change(dragonfly_document::Change::Undo);
    window.run_steps(4);
    assert!(window.query_by_label(&format!("{SCALE}, undone, saved")).is_some());
}

#[test]
fn enter_on_a_focused_step_goes_to_that_step() {
    let mut window = window();
    window.get_by_label("Opened").focus();
    window.run_steps(2);
    window.key_press(Key::Enter);
    window.run_steps(3);
    assert_eq!(window.state().steps(), (0, 3));
    window.get_by_label("Redo").click();
    window.run_steps(3);
    assert_eq!(window.state().steps(), (1, 3));
}

#[test]
fn the_list_scrolls_to_the_current_step_and_draws_only_visible_rows() {
    let mut window = window();
    for step in 0..3000 {
        let name = format!("Take {step}");
        let edit = dragonfly_document::edit::Edit::RenameTake(dragonfly_document::edit::RenameTake {
            take: dragonfly_document::edit::TakeRef::Index(0),
            name,
        });
        // Without a frame in between, as a script does it.
        window.state_mut().edited.as_mut().unwrap().apply(edit, None).unwrap();
    }
    window.state_mut().change(dragonfly_document::Change::Undo);
    window.run_steps(4);
    assert!(window.query_by_label("Rename take, Take 2997 → Take 2998").is_some(), "the place is in sight");
    assert!(window.query_by_label("Opened").is_none());
    assert!(window.query_all_by_label_contains("Rename take").count() < 40);
}

#[test]
fn the_menu_names_the_step_to_undo() {
    let mut window = window();
    window.state_mut().change(dragonfly_document::Change::Undo);
    window.run_steps(2);
    window.get_by_label("Edit").click();
    window.run_steps(4);
    assert!(window.query_by_label_contains("Undo Move").is_some());
    assert!(window.query_by_label_contains("Redo Scale").is_some());
}
