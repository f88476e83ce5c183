//! The toolbar of a narrow viewport: what does not fit is in a menu, and nothing covers the name of the camera.

use crate::scene_bench::{FOXES, scene};
use crate::scene_lines::run;
use crate::workbench::{Window, Workbench, press, release};
use dragonfly::panels::commands::{self, Id};
use dragonfly::panels::{self, VIEWPORT};
use dragonfly_picture::Shading;
use egui::{Rect, Theme, vec2};
use egui_kittest::kittest::Queryable;

const MORE: &str = "More view options";

/// The buttons that run commands, and those that open menus.
const COMMANDS: [Id; 13] = [
    Id::ToggleProjection,
    Id::FrameAll,
    Id::ToggleHelpers,
    Id::ToggleGrid,
    Id::ToggleXRay,
    Id::ToggleSkeleton,
    Id::BonesLines,
    Id::BonesSticks,
    Id::BonesOctahedra,
    Id::ShadeUnlit,
    Id::ShadeClay,
    Id::ShadeMaterial,
    Id::ToggleSurface,
];
const MENUS: [&str; 2] = ["Views", "Look through"];

/// Opens a scene in a window of this width in which only the viewport is shown.
fn window(width: f32, second_view: bool) -> Window {
    let mut bench: Workbench = scene(FOXES);
    for other in panels::all().iter().filter(|other| other.id() != VIEWPORT) {
        bench.desk.toggle_panel(other.id());
    }
    let mut window = bench.window_of(vec2(width, 700.0), Theme::Dark);
    if second_view {
        run(&mut window, Id::ToggleSecondView);
        window.run_steps(3);
    }
    window
}

fn click(window: &mut Window, at: Rect) {
    window.hover_at(at.center());
    window.run_steps(1);
    press(window, at.center());
    release(window, at.center());
    window.run_steps(4);
}

/// Returns the place of an entry of an open menu.
fn entry(window: &Window, title: &str) -> Rect {
    window.query_all_by_label_contains(title).map(|node| node.rect()).next().expect(title)
}

/// Returns the titles of everything that the toolbar offers.
fn titles() -> Vec<&'static str> {
    COMMANDS.iter().map(|id| commands::get(*id).title).chain(MENUS).collect()
}

/// Returns the buttons in the bar, with their titles.
fn buttons(window: &Window) -> Vec<(&'static str, Rect)> {
    let lower = window.state().state.read().viewport.top() + 44.0;
    let bar = |title: &'static str| {
        let found = window.query_all_by_label(title).map(|node| node.rect());
        found.filter(|rect| rect.bottom() < lower).map(|rect| (title, rect)).next()
    };
    titles().into_iter().chain([MORE]).filter_map(bar).collect()
}

#[test]
fn every_button_is_in_the_toolbar_or_in_its_menu_and_the_name_of_the_camera_is_free() {
    for (width, second_view) in
        [(300.0, false), (500.0, false), (900.0, false), (300.0, true), (500.0, true), (900.0, true)]
    {
        let case = format!("{width} points, two views: {second_view}");
        let mut window = window(width, second_view);
        let buttons = buttons(&window);
        let right = window.state().state.read().viewport.right();
        let name = window.get_by_label_contains("Shown scene: ").rect();
        for (index, (title, rect)) in buttons.iter().enumerate() {
            assert!(rect.left() >= 0.0 && rect.right() <= right, "{case}: {title} is cut: {rect}");
            assert!(!rect.intersects(name), "{case}: {title} covers the name: {rect} {name}");
            for (other, beside) in &buttons[index + 1..] {
                assert!(!rect.shrink(0.5).intersects(*beside), "{case}: {title} covers {other}");
            }
        }
        assert!(name.width() > 40.0, "{case}: {name}");
        let hidden: Vec<&str> =
            titles().into_iter().filter(|title| !buttons.iter().any(|(own, _)| own == title)).collect();
        let more = buttons.iter().find(|(title, _)| *title == MORE).map(|(_, rect)| *rect);
        assert_eq!(more.is_none(), hidden.is_empty(), "{case}: {hidden:?}");
        assert_eq!(more.is_none(), width == 900.0 && !second_view, "{case}: {hidden:?}");
        let Some(more) = more else { continue };
        click(&mut window, more);
        for title in hidden {
            let entries = window.query_all_by_label_contains(title).count();
            assert!(entries > 0, "{case}: {title} cannot be reached");
        }
    }
}

#[test]
fn the_menu_has_its_entries_in_the_order_of_the_toolbar_from_the_left() {
    let mut window = window(300.0, true);
    let more = window.get_by_label(MORE).rect();
    click(&mut window, more);
    let top = |id: Id| {
        let mut found =
            window.query_all_by_label_contains(commands::get(id).title).map(|node| node.rect().top());
        found.find(|top| *top > more.bottom()).expect("an entry")
    };
    let tops =
        [Id::ShadeMaterial, Id::ShadeClay, Id::ShadeUnlit, Id::BonesOctahedra, Id::BonesSticks].map(top);
    assert!(tops.is_sorted_by(|one, other| one < other), "{tops:?}");
}

#[test]
fn an_entry_of_the_menu_does_what_its_button_does() {
    let mut window = window(300.0, true);
    let more = window.get_by_label(MORE).rect();
    click(&mut window, more);
    let clay = entry(&window, commands::get(Id::ShadeClay).title);
    click(&mut window, clay);
    assert_eq!(window.state().state.read().settings.look.shading, Shading::Clay);
    click(&mut window, more);
    let views = entry(&window, "Views");
    click(&mut window, views);
    let top = entry(&window, commands::get(Id::ViewTop).title);
    click(&mut window, top);
    assert!(window.state().state.read().camera.back().y > 0.99, "it looks down");
}
