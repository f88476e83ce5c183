//! Everything that the study measures does its work right, each variant of each case, once and with little data.

use dragonfly_kit::counting::CountingAllocator;
use dragonfly_study::{Study, graphical, runtime};

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

#[test]
fn queues_and_actors_deliver_what_they_were_given() {
    runtime::all(&mut Study::check());
}

#[test]
fn no_frame_of_any_variant_sees_a_torn_or_stale_document() {
    graphical::all(&mut Study::check());
}

#[test]
fn every_system_plays_the_savina_suite_and_comes_to_the_right_result() {
    let mut study = Study::check();
    runtime::savina::all(&mut study);
    let mut totals = std::collections::BTreeMap::<&str, usize>::new();
    for row in study.rows().iter().filter(|row| row.metric == "total") {
        assert!(row.value > 0.0, "{row:?}");
        *totals.entry(&row.case).or_default() += 1;
    }
    assert_eq!(totals.len(), 12, "{totals:?}");
    for (case, systems) in totals {
        // One has no actors that create others, which two of the suite are about.
        let able = if ["savina/fork_join_creation", "savina/barber"].contains(&case) { 9 } else { 10 };
        assert_eq!(systems, able, "{case}");
    }
}
