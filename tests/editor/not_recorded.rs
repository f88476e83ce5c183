//! The status line shows that unsaved work is not recorded, for as long as that is so.

use crate::panels::{Bench, harness_of};
use dragonfly_document::View;
use dragonfly_kit::document::fixture;
use egui_kittest::kittest::Queryable;

#[test]
fn the_status_line_shows_that_nothing_is_recorded_until_it_is() {
    let view = View { is_unrecorded: true, ..fixture::full() };
    let bench = Bench::new(Some(view.clone()));
    let mut harness = harness_of(bench, egui::vec2(1280.0, 720.0), 1.0, egui::Theme::Dark);
    harness.run_steps(4);
    assert!(harness.query_by_label("Not recorded").is_some());
    let generation = view.generation + 1;
    harness.state_mut().state.show(View { is_unrecorded: false, generation, ..view });
    harness.run_steps(2);
    assert!(harness.query_by_label("Not recorded").is_none());
}
