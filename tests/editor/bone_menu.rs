//! The menu that a click on a bone with the right button opens.

use crate::workbench::{Window, Workbench};
use dragonfly::panels::Request;
use dragonfly_document::Change;
use dragonfly_document::edit::{Edit, RenameTake, TakeRef};
use egui::{Event, Key, Modifiers, PointerButton, Popup, Pos2};
use egui_kittest::kittest::Queryable;

fn button(window: &mut Window, pos: Pos2, button: PointerButton, pressed: bool) {
    window.event(Event::PointerMoved(pos));
    window.event(Event::PointerButton { pos, button, pressed, modifiers: Modifiers::NONE });
    window.run_steps(3);
}

fn right_click(window: &mut Window, pos: Pos2) {
    button(window, pos, PointerButton::Secondary, true);
    button(window, pos, PointerButton::Secondary, false);
}

#[test]
fn the_menu_in_the_tree_acts_on_the_bone_under_the_pointer() {
    let mut window = Workbench::full().window();
    window.state_mut().state.execute(Request::Select(Some(0)));
    window.run_steps(2);
    let name = window.state().state.read().bone_name(2);
    let row = window.get_by_label(&name).rect().center();
    right_click(&mut window, row);
    assert_eq!(window.state().state.read().selected(), Some(2));
    window.get_by_label_contains("Hide other bones").click();
    window.run_steps(3);
    assert!(!Popup::is_any_open(&window.ctx));
    assert!(
        window.state().state.read().hidden.is_hidden(0) && !window.state().state.read().hidden.is_hidden(2)
    );
}

#[test]
fn the_tree_keeps_its_scroll_position_under_a_menu_and_stays_folded_after_an_edit() {
    let mut window = Workbench::full().window_of(egui::vec2(1280.0, 500.0), egui::Theme::Dark);
    window.state_mut().state.execute(Request::Select(Some(0)));
    window.run_steps(3);
    window.get_by_label("Collapse rib_00_left_inner").click();
    window.run_steps(3);
    let rows =
        |window: &Window| ["Collapse root", "Collapse spine_00"].map(|name| window.get_by_label(name).rect());
    let before = rows(&window);
    assert!(window.query_by_label("rib_00_left_tip").is_none());
    // The last visible row.
    let area = window.get_by_label("Takes").rect();
    let names: Vec<String> = (0..20).map(|bone| window.state().state.read().bone_name(bone)).collect();
    let seen = names.iter().flat_map(|name| window.query_all_by_label(name)).map(|row| row.rect());
    let rows_above = seen.filter(|row| row.left() < area.right() && row.bottom() < area.top());
    let last = rows_above.max_by(|a, b| a.top().total_cmp(&b.top()));
    right_click(&mut window, last.expect("a row").center());
    assert!(Popup::is_any_open(&window.ctx));
    assert!(window.state().state.read().selected() != Some(0), "the row was selected");
    assert_eq!(rows(&window), before, "and did not go away under the menu");
    window.key_press(Key::Escape);
    window.run_steps(3);
    window.state_mut().state.execute(Request::Select(Some(0)));
    window.run_steps(3);
    let generation = window.state().state.read().view.map(|view| view.generation);
    window.state_mut().change(Change::Edit(
        Edit::RenameTake(RenameTake { take: TakeRef::Index(0), name: "Look around".to_owned() }),
        None,
    ));
    window.run_steps(3);
    assert_ne!(window.state().state.read().view.map(|view| view.generation), generation);
    assert!(window.query_by_label("rib_00_left_tip").is_none(), "the branch is still folded");
}

#[test]
fn the_menu_in_the_viewport_acts_on_the_selection_and_escape_closes_it() {
    let mut window = Workbench::full().window();
    window.state_mut().state.execute(Request::Select(Some(3)));
    window.run_steps(2);
    let place = window.state().state.read().viewport.center();
    right_click(&mut window, place);
    assert!(Popup::is_any_open(&window.ctx));
    window.get_by_label_contains("Frame selected");
    window.key_press(Key::Escape);
    window.run_steps(3);
    assert!(!Popup::is_any_open(&window.ctx));
    assert!(window.state().state.read().selected().is_some(), "only the menu was meant");
}

#[test]
fn cancelling_a_drag_opens_no_menu() {
    let mut window = Workbench::full().window();
    let place = window.state().state.read().viewport.center();
    button(&mut window, place, PointerButton::Primary, true);
    right_click(&mut window, place);
    assert!(!Popup::is_any_open(&window.ctx));
    button(&mut window, place, PointerButton::Primary, false);
    assert!(!Popup::is_any_open(&window.ctx));
}

#[test]
fn a_drag_outside_a_menu_closes_it_and_one_inside_does_not() {
    let mut window = Workbench::full().window();
    window.run_steps(2);
    let drag = |window: &mut Window, from: Pos2| {
        button(window, from, PointerButton::Primary, true);
        for step in 1..5 {
            window.event(Event::PointerMoved(from + egui::vec2(6.0, 4.0) * step as f32));
            window.run_steps(1);
        }
    };
    window.get_by_label("View").click();
    window.run_steps(3);
    assert!(Popup::is_any_open(&window.ctx));
    let entry = window.get_by_label_contains("Full screen").rect().center();
    drag(&mut window, entry);
    assert!(Popup::is_any_open(&window.ctx), "the drag began in the menu");
    button(&mut window, entry, PointerButton::Primary, false);
    window.key_press(Key::Escape);
    window.run_steps(3);
    window.get_by_label("View").click();
    window.run_steps(3);
    assert!(Popup::is_any_open(&window.ctx));
    let place = window.state().state.read().viewport.center();
    drag(&mut window, place);
    assert!(!Popup::is_any_open(&window.ctx), "while the button is still held");
    button(&mut window, place, PointerButton::Primary, false);
}
