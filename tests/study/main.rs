//! Every variant of every case of the study computes correct results: runs each once, with little data.

mod broken;
mod readme;

use dragonfly_kit::counting::CountingAllocator;
use dragonfly_study::{Study, graphical, runtime};
use std::collections::BTreeMap;

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

/// One test, and so one thread: one of the crates (stakker) is bound to one thread for the life of the process.
#[test]
fn queues_and_actors_deliver_all_messages_and_every_system_runs_the_savina_suite() {
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
        // In one system (tonari-actor) actors cannot create other actors, which two benchmarks need.
        let able = if ["savina/fork_join_creation", "savina/barber"].contains(&case) { 9 } else { 10 };
        assert_eq!(systems, able, "{case}");
    }
}

#[test]
fn no_frame_of_any_variant_sees_a_torn_or_stale_document() {
    graphical::all(&mut Study::check());
}
