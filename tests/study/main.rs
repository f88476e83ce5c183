//! Everything that the study measures does its work right, each variant of each case, once and with little data.

mod broken;
mod readme;

use dragonfly_kit::counting::CountingAllocator;
use dragonfly_study::{Study, graphical, runtime};
use std::collections::BTreeMap;

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

/// One test, and so one thread: a peer of ours lives in one thread for as long as the process does.
#[test]
fn queues_and_actors_deliver_what_they_were_given_and_every_system_plays_the_savina_suite() {
    let mut study = Study::check();
    runtime::all(&mut study);
    let mut totals = BTreeMap::<&str, usize>::new();
    let savina = study.rows().iter().filter(|row| row.case.starts_with("savina/"));
    for row in savina.filter(|row| row.metric == "total") {
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

#[test]
fn no_frame_of_any_variant_sees_a_torn_or_stale_document() {
    graphical::all(&mut Study::check());
}
