//! Every menu and small card that a button opens.

use super::panels::only;
use super::series::{self, Crop, PictureCase};
use super::states::Fullness::{self, Crowded, Empty, Typical};
use crate::workbench::Window;
use dragonfly::panels::VIEWPORT;
use egui::{Event, Modifiers, Order, PointerButton, Pos2, vec2};
use egui_kittest::Node;
use egui_kittest::kittest::Queryable;

/// How a menu is opened.
#[derive(Clone, Copy)]
enum Opening {
    /// A click at a label, and one at an entry of the menu that this opens.
    Click(&'static [&'static str]),
    /// A click of the right button at the node with this label.
    Right(&'static str),
}

use Opening::{Click, Right};

/// Name, the only panel that is shown, how the menu is opened, in which states, and why not in others.
type MenuRow = (&'static str, &'static str, Opening, &'static [Fullness], &'static str);

/// The reason of most rows: a crowded model has the same commands.
const SAME: &str = "a crowded model has the same entries as a usual one";
/// The reason of menus at something in a model.
const NOTHING: &str = "without a model there is nothing to click at, and a crowded one has the same entries";
/// The reason of menus that do not depend on the model.
const FIXED: &str = "the entries are the same whatever is open";

const TABLE: &[MenuRow] = &[
    ("file", VIEWPORT, Click(&["File"]), &[Empty, Typical], SAME),
    ("edit", VIEWPORT, Click(&["Edit"]), &[Empty, Typical], SAME),
    ("pose", VIEWPORT, Click(&["Pose"]), &[Empty, Typical, Crowded], ""),
    ("pose-scope", VIEWPORT, Click(&["Pose", "Edits apply to"]), &[Typical], FIXED),
    ("tools", VIEWPORT, Click(&["Tools"]), &[Empty, Typical], SAME),
    ("play", VIEWPORT, Click(&["Play"]), &[Empty, Typical], SAME),
    ("keys", VIEWPORT, Click(&["Keys"]), &[Empty, Typical], SAME),
    ("take", VIEWPORT, Click(&["Take"]), &[Empty, Typical], SAME),
    ("view", VIEWPORT, Click(&["View"]), &[Empty, Typical], SAME),
    ("help", VIEWPORT, Click(&["Help"]), &[Typical], FIXED),
    (
        "open-recent",
        VIEWPORT,
        Click(&["File", "Open recent"]),
        &[Empty, Crowded],
        "the list is empty as without a model",
    ),
    ("panels", VIEWPORT, Click(&["View", "Panels"]), &[Typical], FIXED),
    ("camera", VIEWPORT, Click(&["View", "Camera"]), &[Empty, Typical], SAME),
    ("bones", VIEWPORT, Click(&["View", "Bones"]), &[Typical], FIXED),
    ("ghosts", VIEWPORT, Click(&["View", "Ghosts"]), &[Typical], FIXED),
    ("shading", VIEWPORT, Click(&["View", "Shading"]), &[Typical], FIXED),
    ("effects", VIEWPORT, Click(&["View", "Effects"]), &[Typical], FIXED),
    ("theme", VIEWPORT, Click(&["View", "Theme"]), &[Typical], FIXED),
    ("interface-size", VIEWPORT, Click(&["View", "Interface size"]), &[Typical], FIXED),
    ("messages", VIEWPORT, Click(&["Messages: "]), &[Empty, Crowded], "a usual list is a short crowded one"),
    ("views", VIEWPORT, Click(&["Views"]), &[Typical], NOTHING),
    ("axes", VIEWPORT, Click(&["Axes: "]), &[Typical], NOTHING),
    ("pivot", VIEWPORT, Click(&["Pivot: "]), &[Typical], NOTHING),
    ("ik", VIEWPORT, Click(&["IK", "IK chain: "]), &[Typical], NOTHING),
    ("bone", "hierarchy", Right("antenna_left"), &[Typical], NOTHING),
    ("take-row", "takes", Right("hover"), &[Typical], NOTHING),
    (
        "take-times",
        "takes",
        Click(&["Start and length"]),
        &[Typical, Crowded],
        "without a model the button is disabled",
    ),
    ("key", "timeline", Right("Keys, "), &[Typical], NOTHING),
    ("time-track", "timeline", Right("Time track"), &[Typical], NOTHING),
    ("edit-scope", "timeline", Click(&["Edits apply to: This frame"]), &[Typical], NOTHING),
    ("frame-rate", "timeline", Click(&["30 fps"]), &[Typical], FIXED),
    ("curve-form", "curves", Click(&["Euler XYZ"]), &[Typical], FIXED),
    ("rotation-order", "properties", Click(&["Order of rotation: "]), &[Typical], NOTHING),
];

/// Returns the middle of the node with this label, in a menu if one is open; a label that ends with a space is the start of
/// the whole one.
fn place(window: &Window, label: &str) -> Pos2 {
    let middle = |node: Node<'_>| node.rect().center();
    let places: Vec<Pos2> = if label.ends_with(' ') {
        window.query_all_by_label_contains(label).map(middle).collect()
    } else {
        window.query_all_by_label(label).map(middle).collect()
    };
    let in_menu =
        |place: &&Pos2| window.ctx.layer_id_at(**place).is_some_and(|layer| layer.order == Order::Foreground);
    let place = places.iter().find(in_menu).or(places.first());
    *place.unwrap_or_else(|| panic!("nothing is labeled {label:?}"))
}

fn click(window: &mut Window, pos: Pos2, button: PointerButton) {
    window.event(Event::PointerMoved(pos));
    window.run_steps(1);
    for pressed in [true, false] {
        window.event(Event::PointerButton { pos, button, pressed, modifiers: Modifiers::NONE });
        window.run_steps(2);
    }
}

fn open(window: &mut Window, opening: Opening) {
    match opening {
        Click(labels) => {
            for label in labels {
                let at = place(window, label);
                click(window, at, PointerButton::Primary);
            }
        }
        Right(label) => {
            let at = place(window, label);
            click(window, at, PointerButton::Secondary);
        }
    }
    // No tooltip, and no entry under the pointer.
    window.event(Event::PointerGone);
    window.run_steps(2);
}

pub(super) fn cases() -> Vec<PictureCase> {
    // The states differ in which entries are enabled, so one of them is enough at 2x.
    let case = |&(name, panel, opening, states, _): &MenuRow, fullness: Fullness| PictureCase {
        name: format!("menus/{name}-{}", fullness.word()),
        size: vec2(800.0, 640.0),
        crop: Crop::Newest,
        bench: Box::new(move || only(panel, fullness)),
        act: Box::new(move |window| open(window, opening)),
        twice: states.last() == Some(&fullness),
    };
    TABLE.iter().flat_map(|row| row.3.iter().map(move |fullness| case(row, *fullness))).collect()
}

/// Draws every fourth case, so that four tests share the work.
#[track_caller]
fn compare_quarter(number: usize) {
    series::compare(cases().into_iter().skip(number).step_by(4));
}

#[test]
fn the_menus_look_as_stored_first_quarter() {
    compare_quarter(0);
}

#[test]
fn the_menus_look_as_stored_second_quarter() {
    compare_quarter(1);
}

#[test]
fn the_menus_look_as_stored_third_quarter() {
    compare_quarter(2);
}

#[test]
fn the_menus_look_as_stored_last_quarter() {
    compare_quarter(3);
}

#[test]
fn every_menu_is_drawn_in_three_states_or_there_is_a_reason() {
    for (name, _, _, states, reason) in TABLE {
        assert!(states.len() == 3 || (!states.is_empty() && !reason.is_empty()), "{name}");
    }
}
