//! The benchmarks: their actors, written once.
//!
//! This folder is compiled as a module of each system (`systems/*.rs`), where `Actor`, `Address`, `Cx` and `World` are
//! that system's own types. A trait with an implementation for each system would look the same, but could not be both
//! strict and fair: actors and messages of kameo must be `Send`, and stakker's addresses, which are sent in messages,
//! cannot be. So every system gets its actors with its own types, without a box or call that hand-written code would
//! not have.
//!
//! Where the original sends the sender's reference with a message and the receiver can have a list of its partners,
//! this version sends an index into that list: copying a reference costs nothing in the original, but several atomic
//! operations in some of these crates. Addresses are sent in `chameneos` and `barber`, whose purpose that is.

mod barber;
mod big;
mod bounded_buffer;
mod chameneos;
mod counting;
mod dictionary;
mod fork_join_creation;
mod fork_join_throughput;
mod philosophers;
mod ping_pong;
mod smokers;
mod thread_ring;

use super::World;
use crate::StudyMode;
use dragonfly_kit::random::Random;
use std::hint::black_box;

/// Creates the actors of a benchmark and starts them; one of them ends the run.
pub(super) fn start(benchmark: &str, world: &mut World, mode: StudyMode) {
    match benchmark {
        "ping_pong" => ping_pong::start(world, mode),
        "counting" => counting::start(world, mode),
        "fork_join_throughput" => fork_join_throughput::start(world, mode),
        "fork_join_creation" => fork_join_creation::start(world, mode),
        "thread_ring" => thread_ring::start(world, mode),
        "chameneos" => chameneos::start(world, mode),
        "big" => big::start(world, mode),
        "dictionary" => dictionary::start(world, mode),
        "bounded_buffer" => bounded_buffer::start(world, mode),
        "philosophers" => philosophers::start(world, mode),
        "barber" => barber::start(world, mode),
        "smokers" => smokers::start(world, mode),
        _ => unreachable!("the suite has no {benchmark}"),
    }
}

/// The computation for each message of the fork-join benchmarks, as in the original.
fn compute() {
    let sine = f64::sin(black_box(37.2));
    black_box(sine * sine);
}

/// Does `steps` steps of the generator as work.
fn work(random: &mut Random, steps: usize) {
    for _ in 0..steps {
        black_box(random.bits());
    }
}
