//! The menu of scenes: all entries are seen at once in a small window, and each command is in it or in a menu of it.

use crate::scene_bench::{FOXES, scene};
use crate::workbench::Window;
use dragonfly::panels::commands::{self, Category, Id};
use egui::Theme;
use egui_kittest::kittest::Queryable;

/// The menus in the menu.
const MENUS: [&str; 5] = ["Add", "Things", "Camera", "Lines", "Timeline"];

/// Opens the menu in a window of 720 points.
fn menu() -> Window {
    let mut window = scene(FOXES).window_of(egui::vec2(1280.0, 720.0), Theme::Dark);
    // The title of a panel is the same word, and below.
    let titles = window.get_all_by_label("Scene").map(|node| node.rect());
    let bar = titles.min_by(|one, other| one.top().total_cmp(&other.top())).expect("the menu");
    click(&mut window, bar.center());
    window
}

fn click(window: &mut Window, at: egui::Pos2) {
    window.hover_at(at);
    window.run_steps(1);
    crate::workbench::press(window, at);
    crate::workbench::release(window, at);
    window.run_steps(3);
}

/// Returns the place of an entry of an open menu, which is on top of what is drawn with the same words in a panel.
fn entry(window: &Window, title: &str) -> egui::Rect {
    let found = window.get_all_by_label_contains(title).map(|node| node.rect());
    found.min_by(|one, other| one.top().total_cmp(&other.top())).expect(title)
}

#[test]
fn the_menu_of_scenes_is_not_higher_than_a_window_of_720_points() {
    let window = menu();
    for title in ["Add action", "Duplicate", "Delete and leave a gap", "New project from this scene"] {
        let rect = entry(&window, title);
        assert!(rect.top() > 0.0 && rect.bottom() < 720.0, "{title}: {rect}");
    }
}

#[test]
fn every_command_for_scenes_is_in_the_menu_or_in_a_menu_of_it() {
    let listed =
        |window: &Window, id: Id| window.query_all_by_label_contains(commands::get(id).title).count() > 0;
    let mut window = menu();
    let mut left: Vec<Id> = commands::of(Category::Scene).iter().map(|command| command.id).collect();
    left.retain(|&id| !listed(&window, id));
    for title in MENUS {
        // The entry "Add action" is above "Add".
        let at = window
            .get_all_by_label_contains(title)
            .map(|node| node.rect())
            .filter(|rect| rect.left() > entry(&window, "Add action").left() - 1.0)
            .filter(|rect| rect.right() < entry(&window, "Add action").right() + 1.0)
            .find(|rect| title != "Add" || rect.top() > entry(&window, "Add action").bottom() - 1.0);
        click(&mut window, at.expect(title).center());
        left.retain(|&id| !listed(&window, id));
    }
    assert!(left.is_empty(), "{left:?}");
}

#[test]
fn the_entries_of_the_choice_of_a_camera_are_each_on_one_line() {
    let mut window = scene(FOXES).window();
    let button = window.get_by_label("Look through").rect().center();
    click(&mut window, button);
    let height = |title: &str| entry(&window, title).height();
    assert_eq!(height("Look through the free camera"), height("Look through the shot"));
}
