//! The benchmarks themselves: their actors, written once.
//!
//! This folder is compiled as a module of each system (`systems/*.rs`), where `Actor`, `Address`, `Cx` and `World` are
//! that system's own. A trait with an implementation for each system would read the same, but could not be both
//! strict and fair: actors and messages of kameo must be `Send`, and stakker's addresses, which travel in messages,
//! cannot be. So every system gets its actors with its own types in them, no box or call more than by hand.
//!
//! What the original passes along as the sender's reference is here, where the receiver can have a list of its
//! partners, a number in that list: copying a reference costs the original nothing, but some of the peers several
//! atomic operations. Addresses travel in chameneos and the barber's shop, which are about that.

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
use crate::Mode;
use dragonfly_kit::random::Random;
use std::hint::black_box;

/// Creates the actors of a benchmark and gets them going; one of them will say when the run is over.
pub(super) fn start(benchmark: &str, world: &mut World, mode: Mode) {
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

/// What a message of the fork-join benchmarks is computed with, as in the original.
fn compute() {
    let sine = f64::sin(black_box(37.2));
    black_box(sine * sine);
}

/// Work of so many steps of the generator.
fn work(random: &mut Random, steps: usize) {
    for _ in 0..steps {
        black_box(random.bits());
    }
}
