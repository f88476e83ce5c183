//! The systems that run the suite: our runtime and other crates. Each file documents how its system is used.
//!
//! Each of them defines the same names for the suite and compiles it as a module of its own (`suite/mod.rs` explains
//! why):
//!
//! * `Actor`: `receive(&mut self, message, cx)`, with one type of message;
//! * `Address<A>`: the system's own address, as a program would use it;
//! * `World`: creates the first actors and sends them their first messages, from outside of the system;
//! * `Cx`: used by an actor inside a call: its own address, sending, creating an actor, stopping itself, and ending the
//!   run.
//!
//! The *placement* of a new actor is a number; a system with several threads uses it modulo the number of threads. A
//! system that moves actors between threads itself ignores it.

mod actix;
mod dragonfly;
mod kameo;
mod ractor;
mod stakker;
mod tokio;
mod tonari;

use super::run::Finish;
use crate::StudyMode;

/// A system in one configuration.
pub(super) struct System {
    /// Name of the variant in the results.
    pub(super) label: &'static str,
    /// Whether its actors can create other actors, and end one by one.
    pub(super) creates: bool,
    /// Runs the benchmark of this name once. Returns the reason if it fails.
    pub(super) play: fn(&'static str, StudyMode) -> Result<Finish, String>,
}

impl System {
    const fn new(label: &'static str, play: fn(&'static str, StudyMode) -> Result<Finish, String>) -> Self {
        Self { label, creates: true, play }
    }
}

/// All systems, in all configurations.
pub(super) const SYSTEMS: &[System] = &[
    System::new("dragonfly 1 thread", |benchmark, mode| dragonfly::play(1, benchmark, mode)),
    System::new("dragonfly 2 threads", |benchmark, mode| dragonfly::play(2, benchmark, mode)),
    System::new("actix 1 thread", |benchmark, mode| actix::play(1, benchmark, mode)),
    System::new("actix 2 threads", |benchmark, mode| actix::play(2, benchmark, mode)),
    System::new("kameo 1 thread", |benchmark, mode| kameo::play(1, benchmark, mode)),
    System::new("kameo 2 threads", |benchmark, mode| kameo::play(2, benchmark, mode)),
    System::new("ractor 1 thread", |benchmark, mode| ractor::play(1, benchmark, mode)),
    System::new("ractor 2 threads", |benchmark, mode| ractor::play(2, benchmark, mode)),
    System::new("stakker", stakker::play),
    System { creates: false, ..System::new("tonari-actor", tonari::play) },
];
