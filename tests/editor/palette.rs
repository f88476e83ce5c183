//! The command palette runs commands and shows takes, found by what is typed.

use crate::panels::{Bench, harness};
use dragonfly::panels::style;
use dragonfly_kit::document::fixture;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

const PALETTE: &str = "Find a command or a take";

/// Opens the palette and types a text into it.
fn palette(text: &str) -> Harness<'static, Bench> {
    let mut harness = harness(Bench::new(Some(fixture::full())));
    harness.run_steps(4);
    harness.key_press(egui::Key::F3);
    harness.run_steps(4);
    harness.get_by_label(PALETTE).type_text(text);
    harness.run_steps(4);
    harness
}

#[test]
fn the_palette_runs_the_command_that_the_search_found() {
    let mut harness = palette("ground grid");
    harness.key_press(egui::Key::Enter);
    harness.run_steps(4);
    assert!(!harness.state().state.read().settings.look.grid);
    assert_eq!(harness.state().state.read().overlay, None);
}

#[test]
fn the_palette_shows_the_take_that_the_search_found() {
    let mut harness = palette("");
    assert!(harness.query_all_by_label("Walk").count() == 1, "in the list of takes alone");
    harness.get_by_label(PALETTE).type_text("walk");
    harness.run_steps(4);
    harness.key_press(egui::Key::Enter);
    harness.run_steps(4);
    assert_eq!(harness.state().state.read().playback.take, Some(1));
    assert_eq!(harness.state().state.read().overlay, None);
}

#[test]
fn the_palette_lists_title_matches_first_and_shows_every_row() {
    let harness = palette("local");
    let place = |label: &str| {
        let mut rows = harness.query_all_by_label(label);
        rows.next().unwrap_or_else(|| panic!("{label} is not listed")).rect()
    };
    let (called, about) = (place("Local axes"), place("Next gizmo axes"));
    assert!(called.top() < about.top(), "{called:?} {about:?}");
    let card = place(PALETTE);
    let rows = ((about.bottom() - card.bottom()) / style::ROW).floor();
    assert!(rows >= 2.0, "{rows} rows");
}

#[test]
fn titles_that_begin_with_the_word_come_first() {
    let mut harness = palette("ground");
    harness.key_press(egui::Key::Enter);
    harness.run_steps(4);
    assert!(!harness.state().state.read().settings.look.grid, "the ground grid is the first entry");
}

#[test]
fn a_plural_search_word_finds_a_title_in_the_singular() {
    let mut harness = palette("shortcuts");
    harness.key_press(egui::Key::Enter);
    harness.run_steps(4);
    assert_eq!(harness.state().state.read().overlay, Some(dragonfly::panels::prompts::Overlay::Shortcuts));
}
