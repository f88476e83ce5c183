//! The attributes of a selected thing: plain numbers have number fields, which are typed into and dragged.

use crate::scene_bench::{FOXES, new_lines, scene, text};
use crate::workbench::{Window, drag, type_into};
use dragonfly::panels::Request;
use dragonfly::panels::scene::SceneRequest;
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable;

fn window_of(thing: &str) -> Window {
    let mut window = scene(FOXES).window();
    let select = SceneRequest::SelectThings(vec![thing.into()], Choice::Replace);
    window.state_mut().state.execute(Request::Scene(select));
    window.run_steps(3);
    window
}

#[test]
fn each_number_of_a_place_has_a_field_of_its_own() {
    let mut window = window_of("anna");
    type_into(&mut window, "at z", "0.5", Key::Enter);
    type_into(&mut window, "facing", "45", Key::Enter);
    type_into(&mut window, "scale", "0.02", Key::Enter);
    assert_eq!(
        new_lines(FOXES, &text(&window)),
        [r#"<role   id="anna"  model="Fox.glb" at="-1 0 0.5" facing="45" scale="0.02"/>"#]
    );
    assert_eq!(window.state().steps(), (3, 3));
    // A field of a default number that is not written yet.
    let mut window = window_of("door");
    type_into(&mut window, "facing", "90", Key::Enter);
    assert_eq!(new_lines(FOXES, &text(&window)), [r#"<mark   id="door"  at="0.6 0 0.8" facing="90"/>"#]);
}

#[test]
fn a_drag_of_a_number_is_one_step_and_leaves_the_other_numbers_as_they_are_written() {
    let mut window = window_of("door");
    drag(&mut window, "at y", vec2(40.0, 0.0), Modifiers::NONE);
    window.run_steps(2);
    let [line] = &new_lines(FOXES, &text(&window))[..] else { panic!("{}", text(&window)) };
    let at = line.split("at=\"").nth(1).and_then(|rest| rest.split('"').next()).expect("a place");
    let numbers: Vec<&str> = at.split(' ').collect();
    assert_eq!((numbers.len(), numbers[0], numbers[2]), (3, "0.6", "0.8"), "{at}");
    let height: f64 = numbers[1].parse().expect("a number");
    assert!(height > 0.0, "{at}");
    assert_eq!(window.state().steps(), (1, 1));
    window.state_mut().change(Change::Undo);
    window.run_steps(2);
    assert_eq!(text(&window), FOXES);
}

#[test]
fn a_right_click_on_a_number_or_on_its_name_restores_the_default() {
    for label in ["facing", "scale"] {
        let mut window = window_of("anna");
        let at = window.get_by_role_and_label(egui::accesskit::Role::SpinButton, label).rect().center();
        window.event(egui::Event::PointerMoved(at));
        for pressed in [true, false] {
            let (button, modifiers) = (egui::PointerButton::Secondary, Modifiers::NONE);
            window.event(egui::Event::PointerButton { pos: at, button, pressed, modifiers });
            window.run_steps(2);
        }
        window.get_by_label("Reset to the default").click();
        window.run_steps(3);
        let [line] = &new_lines(FOXES, &text(&window))[..] else { panic!("{}", text(&window)) };
        assert!(line.contains("anna") && !line.contains(&format!("{label}=")), "{line}");
    }
}

#[test]
fn values_that_are_no_plain_numbers_and_paths_stay_texts() {
    let window = window_of("aisle");
    assert!(window.query_by_label("points").is_some() && window.query_by_label("points x").is_none());
    // A camera looks at a thing or at a point.
    let window = window_of("close");
    assert!(window.query_by_label("look").is_some() && window.query_by_label("look x").is_none());
    assert!(window.query_by_label("at x").is_some());
}

#[test]
fn the_heading_calls_an_action_that_plays_a_take_a_clip() {
    let mut window = scene(FOXES).window();
    for (action, heading) in [(5, "clip looks"), (7, "move ben")] {
        let select = SceneRequest::SelectAction(Some(action));
        window.state_mut().state.execute(Request::Scene(select));
        window.run_steps(3);
        assert!(window.query_by_label(heading).is_some(), "{heading}");
    }
}
