//! The first look of a new user: a sheet of shortcuts that can be read while typing, notes that are no warnings, a ruler in
//! frames, messages in plain words.

use crate::panels::{Bench, harness};
use crate::workbench::Workbench;
use dragonfly::panels::commands::Id;
use dragonfly::panels::dialogs::{PlanQuestion, Question};
use dragonfly::panels::{Request, Settings, State};
use dragonfly_document::{Cancel, Source, load_model};
use dragonfly_kit::document::fixture;
use egui::{Key, Rect};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use std::sync::Arc;
use std::time::Instant;

const FIELD: &str = "Find a command or a key";

/// Opens the sheet of shortcuts and types a text into its search field.
fn sheet(text: &str) -> Harness<'static, Bench> {
    let mut harness = harness(Bench::new(Some(fixture::full())));
    harness.run_steps(4);
    harness.key_press(Key::F1);
    harness.run_steps(6);
    harness.get_by_label(FIELD).click();
    harness.run_steps(2);
    harness.get_by_label(FIELD).type_text(text);
    harness.run_steps(6);
    harness
}

#[test]
fn the_sheet_of_shortcuts_keeps_its_size_while_a_text_is_typed() {
    let places = |text| {
        let harness = sheet(text);
        [FIELD, "Close"].map(|label| harness.query_all_by_label(label).next_back().expect("shown").rect())
    };
    let all = places("");
    for text in ["u", "un", "undo", "no such thing"] {
        assert_eq!(places(text), all, "{text}");
    }
}

#[test]
fn the_sheet_of_shortcuts_says_when_it_has_no_hit() {
    assert_eq!(sheet("no such thing").query_all_by_label("No shortcut found").count(), 1);
    assert_eq!(sheet("undo").query_all_by_label("No shortcut found").count(), 0);
}

#[test]
fn a_single_hit_is_in_the_first_column_of_the_sheet_of_shortcuts() {
    let harness = sheet("About Dragonfly");
    let hit = harness.query_all_by_label("About Dragonfly").next_back().expect("a hit").rect();
    assert!(hit.right() < 640.0, "{hit:?}");
}

/// Returns the texts of all labels with their places.
fn labels<T>(harness: &egui_kittest::Harness<'_, T>) -> Vec<(String, Rect)> {
    let labels = harness.query_all(egui_kittest::kittest::By::new().role(egui::accesskit::Role::Label));
    labels.filter_map(|node| Some((node.accesskit_node().value()?, node.rect()))).collect()
}

#[test]
fn no_text_of_the_sheet_of_shortcuts_overprints_another() {
    // The panels behind the sheet have texts, too.
    let mut bare = harness(Bench::new(Some(fixture::full())));
    bare.run_steps(4);
    let behind = labels(&bare);
    for text in ["while dragging", "mouse", "over the timeline", "drag"] {
        let harness = sheet(text);
        let field = harness.get_by_label(FIELD).rect();
        let close = harness.query_all_by_label("Close").next_back().expect("a button").rect();
        let hint = harness.get_by_label("Click a shortcut to change it").rect();
        let (columns, rows) = (field.left() - 1.0..=close.right(), field.bottom()..=hint.top());
        let texts: Vec<(String, Rect)> = labels(&harness)
            .into_iter()
            .filter(|label| !behind.contains(label))
            .filter(|(_, rect)| columns.contains(&rect.left()) && columns.contains(&rect.right()))
            .filter(|(_, rect)| rows.contains(&rect.top()) && rows.contains(&rect.bottom()))
            .collect();
        assert!(texts.len() > 2, "{text}: {texts:?}");
        for (at, (name, rect)) in texts.iter().enumerate() {
            for (other, other_rect) in &texts[at + 1..] {
                let shared = rect.shrink(1.0).intersect(other_rect.shrink(1.0));
                assert!(!shared.is_positive(), "{text}: “{name}” {rect:?} over “{other}” {other_rect:?}");
            }
        }
    }
}

#[test]
fn what_changes_nothing_that_is_shown_is_a_note_and_no_warning() {
    let mut harness = harness(Bench::new(Some(fixture::full())));
    harness.run_steps(4);
    for label in ["1 warning", "1 note", "/meshes/0/primitives/0/attributes: TEXCOORD_2 is not used"] {
        assert_eq!(harness.query_all_by_label(label).count(), 1, "{label}");
    }
    let camera = br#"{"asset":{"version":"2.0"},"cameras":[{"type":"orthographic","orthographic":{"xmag":1,"ymag":1,"zfar":9,"znear":0}}],"nodes":[{"camera":0}],"scenes":[{"nodes":[0]}],"scene":0}"#;
    let folder = dragonfly_kit::folder::Folder::new("first-look");
    let path = folder.join("camera.gltf");
    std::fs::write(&path, camera).expect("written");
    let loaded = load_model(&Source::File(path), &mut |_| {}, &Cancel::default()).expect("read");
    assert_eq!(loaded.warnings, [""; 0]);
    assert!(loaded.notes.iter().any(|note| note.contains("camera is not used")), "{:?}", loaded.notes);
}

#[test]
fn a_folder_is_said_to_be_one() {
    let folder = std::path::absolute(env!("CARGO_MANIFEST_DIR")).expect("a path");
    let error = load_model(&Source::File(folder.clone()), &mut |_| {}, &Cancel::default()).unwrap_err();
    assert_eq!(error.to_string(), format!("{} is a folder", folder.display()));
}

#[test]
fn the_ruler_has_frames_until_seconds_are_chosen_which_is_remembered() {
    let mut state = State::new(Settings::default(), Instant::now());
    assert!(!state.read().keys.ruler_in_seconds());
    state.execute(Request::Command(Id::ToggleRulerSeconds));
    assert!(state.read().keys.ruler_in_seconds());
    let again = State::new(Settings::parse(&state.read().settings.to_text()), Instant::now());
    assert!(again.read().keys.ruler_in_seconds());
}

#[test]
fn what_will_be_saved_names_the_takes_and_lists_the_rest_under_details() {
    let lines = ["2 takes changed, 1 added", "3 channels of 2 bones in 3 takes", "/accessors/3: 21 → 93"];
    let lines: Arc<[String]> = lines.map(str::to_owned).into();
    let mut bench = Workbench::full();
    bench.state.ask(Question::from(PlanQuestion { lines, order: None }));
    let mut window = bench.window();
    window.run_steps(4);
    assert_eq!(window.query_all_by_label("2 takes changed, 1 added.").count(), 1);
    assert_eq!(window.query_all_by_label_contains("/accessors/3").count(), 0);
    window.get_by_label("Details").click();
    window.run_steps(30);
    assert_eq!(window.query_all_by_label_contains("/accessors/3").count(), 1);
}
