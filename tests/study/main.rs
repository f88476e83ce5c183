//! Everything that the study measures does its work right, each variant of each case, once and with little data.

mod readme;

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
