//! Gestures of the mouse in the timeline and the curves are listed where they are looked for.

use crate::panels::{Bench, harness};
use dragonfly_kit::document::fixture;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

/// Opens an overlay by its key and types a text into its search field.
fn search(key: egui::Key, field: &str, text: &str) -> Harness<'static, Bench> {
    let mut harness = harness(Bench::new(Some(fixture::full())));
    harness.run_steps(4);
    harness.key_press(key);
    harness.run_steps(4);
    harness.get_by_label(field).click();
    harness.run_steps(2);
    harness.get_by_label(field).type_text(text);
    harness.run_steps(4);
    harness
}

#[test]
fn the_palette_and_the_shortcut_sheet_list_the_gestures_of_keys() {
    for (text, gesture) in [
        ("ripple", "2 + drag keys"),
        ("break tangent", "Alt + drag a tangent"),
        ("zoom values", "Ctrl + wheel over the curves"),
        ("zoom time", "Wheel over the timeline or the curves"),
        ("playhead", "Click or drag on the ruler"),
        ("about the playhead", "Alt + drag the end of the bar"),
        ("pan the values", "Drag the values beside the curves"),
        ("motion path", "Drag a key of the motion path"),
        ("add a point", "Ctrl + click a selected path or line"),
        ("remove that point", "Click a point of a path or line, then Delete"),
        ("drawn line", "Click a drawn line"),
        ("precision", "Drag a number"),
        ("reset number", "Double-click a slider"),
        ("blend in", "Drag a pose of the library sideways"),
        ("selection set", "Click a selection set"),
        ("frame it", "Click a bone in the list"),
        ("fold", "Shift + click the eye or the arrow"),
        ("edit its name", "Double-click a take, layer, marker or event"),
        ("what is under", "Right-click"),
    ] {
        for (key, field) in
            [(egui::Key::F3, "Find a command or a take"), (egui::Key::F1, "Find a command or a key")]
        {
            let harness = search(key, field, text);
            let found = harness.query_all_by_label_contains(gesture).count();
            assert!(found > 0, "{text} in “{field}” lists “{gesture}”");
        }
    }
}

#[test]
fn enter_on_a_gesture_in_the_palette_shows_the_sheet_of_shortcuts() {
    let mut harness = search(egui::Key::F3, "Find a command or a take", "zoom the values");
    harness.key_press(egui::Key::Enter);
    harness.run_steps(4);
    assert_eq!(harness.state().state.read().overlay, Some(dragonfly::panels::prompts::Overlay::Shortcuts));
}

#[test]
fn tooltips_of_keys_name_the_gestures_of_the_mouse() {
    use dragonfly::panels::commands::{self, Id};
    for (id, part) in [(Id::RippleOpen, "hold 2"), (Id::InterpolateSpline, "Alt + drag")] {
        assert!(commands::get(id).help.contains(part), "{}", commands::get(id).help);
    }
    let mut harness = harness(Bench::new(Some(fixture::full())));
    harness.run_steps(4);
    for (button, part) in [("Fit the curves", "Ctrl + wheel"), ("Snap", "2 while dragging")] {
        harness.event(egui::Event::PointerMoved(harness.get_by_label(button).rect().center()));
        harness.run_steps(60);
        assert!(harness.query_all_by_label_contains(part).count() > 0, "{button}");
    }
}
