//! The tree of bones: a search keeps all parents of what it finds, and long names can be read.

use crate::workbench::{Window, Workbench, type_into};
use dragonfly::panels::Request;
use dragonfly_kit::document::fixture;
use egui::{Key, vec2};
use egui_kittest::kittest::Queryable;

fn window(vertebrae: u32) -> Window {
    Workbench::new(Some(fixture::view("Deep.glb", fixture::skeleton(vertebrae), &[("Walk", 1.0, 5)])))
        .window_of(vec2(1280.0, 1600.0), egui::Theme::Dark)
}

/// Returns whether the tree shows a row of this bone: each has a button that hides the bone.
fn has_row(window: &Window, bone: &str) -> bool {
    window.query_by_label(&format!("Hide {bone}")).is_some()
}

#[test]
fn a_search_lists_every_parent_of_every_match() {
    let mut window = window(2);
    type_into(&mut window, "Find a bone", "tip", Key::Tab);
    for bone in ["root", "spine_00", "spine_01"] {
        assert!(has_row(&window, bone), "{bone}");
    }
    for side in ["00_left", "00_right", "01_left", "01_right"] {
        for part in ["inner", "middle", "tip"] {
            assert!(has_row(&window, &format!("rib_{side}_{part}")), "{side} {part}");
        }
    }
    type_into(&mut window, "Find a bone", "00_right_middle", Key::Tab);
    assert!(has_row(&window, "rib_00_right_inner") && !has_row(&window, "rib_00_left_inner"));
}

#[test]
fn the_tree_scrolls_to_the_bone_that_was_chosen_when_the_search_is_cleared() {
    let mut window = window(40);
    assert!(!has_row(&window, "rib_35_left_tip"));
    type_into(&mut window, "Find a bone", "rib_35_left_tip", Key::Enter);
    window.get_by_label("Clear search").click();
    window.run_steps(8);
    assert!(has_row(&window, "rib_35_left_tip"), "the bone");
    assert!(has_row(&window, "spine_35"), "the bone above");
}

#[test]
fn a_name_that_is_cut_is_a_tooltip_in_full() {
    let mut window = window(40);
    let bench = window.state_mut();
    bench.state.execute(Request::Select(Some(7 * 30 + 1)));
    let long = "rib_29_right_tip";
    for (name, cut) in [(long, true), ("spine_30", false)] {
        window.run_steps(4);
        let row = window.get_by_label(&format!("Hide {name}")).rect().left_center();
        let times = |window: &Window| window.query_all_by_label(name).count();
        let before = times(&window);
        window.event(egui::Event::PointerMoved(row - egui::vec2(20.0, 0.0)));
        window.run_steps(90);
        assert_eq!(times(&window) - before, usize::from(cut), "{name}");
    }
}
