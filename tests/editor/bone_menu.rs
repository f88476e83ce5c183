//! The right button at a bone.

use crate::workbench::{Window, Workbench};
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
fn in_the_tree_it_is_about_the_bone_under_the_pointer() {
    let mut window = Workbench::full().window();
    window.state_mut().state.select(Some(0));
    window.run_steps(2);
    let name = window.state().state.bone_name(2);
    let row = window.get_by_label(&name).rect().center();
    right_click(&mut window, row);
    assert_eq!(window.state().state.selected(), Some(2));
    window.get_by_label_contains("Hide other bones").click();
    window.run_steps(3);
    assert!(!Popup::is_any_open(&window.ctx));
    assert!(window.state().state.hidden.is_hidden(0) && !window.state().state.hidden.is_hidden(2));
}

#[test]
fn in_the_picture_it_is_about_what_is_selected_and_escape_closes_it() {
    let mut window = Workbench::full().window();
    window.state_mut().state.select(Some(3));
    window.run_steps(2);
    let place = window.state().state.viewport.center();
    right_click(&mut window, place);
    assert!(Popup::is_any_open(&window.ctx));
    window.get_by_label_contains("Frame selected");
    window.key_press(Key::Escape);
    window.run_steps(3);
    assert!(!Popup::is_any_open(&window.ctx));
    assert!(window.state().state.selected().is_some(), "only the menu was meant");
}

#[test]
fn taking_a_drag_back_opens_no_menu() {
    let mut window = Workbench::full().window();
    let place = window.state().state.viewport.center();
    button(&mut window, place, PointerButton::Primary, true);
    right_click(&mut window, place);
    assert!(!Popup::is_any_open(&window.ctx));
    button(&mut window, place, PointerButton::Primary, false);
    assert!(!Popup::is_any_open(&window.ctx));
}

#[test]
fn a_menu_is_put_away_by_a_drag_beside_it_and_not_by_one_in_it() {
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
    let place = window.state().state.viewport.center();
    drag(&mut window, place);
    assert!(!Popup::is_any_open(&window.ctx), "while the button is still held");
    button(&mut window, place, PointerButton::Primary, false);
}
