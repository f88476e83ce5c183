//! The panel with the differences between the take that is shown and another one.

use crate::workbench::{Window, Workbench, type_into};
use dragonfly::panels::Request;
use dragonfly::panels::commands::Id;
use dragonfly::panels::compared::CompareWith;
use egui::Key;
use egui_kittest::kittest::Queryable;

/// Opens a window with the panel, in which the take is compared with itself as it was opened.
fn window() -> Window {
    let mut bench = Workbench::full();
    bench.state.execute(Request::Select(Some(3)));
    let mut window = bench.window();
    window.get_by_label("Differences").click();
    window.run_steps(4);
    window.state_mut().state.execute(Request::CompareWith(CompareWith::Opened));
    window.run_steps(4);
    window
}

#[test]
fn a_moved_bone_is_listed_with_its_distance_and_a_click_selects_it() {
    let mut window = window();
    assert!(window.query_by_label("No difference").is_some());
    // The bone moves by exactly 0.25 m; it has no children that move further.
    let before = window.state().pose(3).translation.x;
    type_into(&mut window, "Translation result X", &format!("{}", before + 0.25), Key::Enter);
    window.run_steps(4);
    let row = "rib_00_left_middle, 250.00 mm   0.00°";
    assert!(window.query_by_label(row).is_some(), "the numbers are those of the edit");
    window.state_mut().state.execute(Request::Select(None));
    window.run_steps(2);
    window.get_by_label(row).click();
    window.run_steps(4);
    assert_eq!(window.state().state.read().selection.bones(), [3]);
    window.state_mut().state.execute(Request::CompareWith(CompareWith::Nothing));
    window.run_steps(4);
    assert!(window.query_by_label("Nothing is compared").is_some());
}

#[test]
fn undo_makes_the_takes_equal_again() {
    let mut window = window();
    type_into(&mut window, "Translation result X", "1", Key::Enter);
    window.run_steps(4);
    assert!(window.query_by_label("No difference").is_none());
    window.state_mut().change(dragonfly_document::Change::Undo);
    window.run_steps(4);
    assert!(window.query_by_label("No difference").is_some());
}

#[test]
fn a_click_into_the_strip_goes_to_that_time() {
    let mut window = window();
    type_into(&mut window, "Translation result X", "1", Key::Enter);
    window.run_steps(4);
    let rect = window.get_by_label("Differences over time").rect();
    for pressed in [true, false] {
        window.event(egui::Event::PointerMoved(rect.center()));
        let modifiers = egui::Modifiers::NONE;
        let button = egui::PointerButton::Primary;
        window.event(egui::Event::PointerButton { pos: rect.center(), button, pressed, modifiers });
        window.run_steps(2);
    }
    let context = window.state().state.read();
    let take = context.shown_take().expect("a take");
    let middle = f32::midpoint(take.start, take.end());
    assert!((context.time() - middle).abs() < 0.02 * take.length, "{} of {middle}", context.time());
}

#[test]
fn the_command_compares_with_the_take_as_opened_and_back() {
    let mut window = Workbench::full().window();
    for expected in [CompareWith::Opened, CompareWith::Nothing] {
        window.state_mut().state.execute(Request::Command(Id::CompareOpened));
        assert_eq!(window.state().state.read().compared, expected);
    }
    window.state_mut().state.execute(Request::ShowTake(None));
    window.state_mut().state.execute(Request::CompareWith(CompareWith::Opened));
    assert!(window.state().state.read().compared_take().is_none(), "the rest pose is no take");
}
