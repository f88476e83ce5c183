//! Everything that the study measures does its work right, each variant of each case, once and with little data.

mod readme;

use dragonfly_kit::counting::CountingAllocator;
use dragonfly_study::{Study, graphical, report, runtime};

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

#[test]
fn queues_and_actors_deliver_what_they_were_given() {
    let mut study = Study::check();
    runtime::all(&mut study);
    shows_all("runtime", &study);
}

#[test]
fn no_frame_of_any_variant_sees_a_torn_or_stale_document() {
    let mut study = Study::check();
    graphical::all(&mut study);
    shows_all("graphical", &study);
}

/// Every table and chart finds what it shows among the cases that were measured.
fn shows_all(file: &'static str, study: &Study) {
    if !study.rows().is_empty() {
        report::is_complete(file, study.rows()).unwrap();
    }
}
