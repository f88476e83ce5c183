//! The systems that run the suite: ours and its peers. Each file says how its system is run.
//!
//! All offer the suite the same names, and compile it as a module of their own (`suite/mod.rs` says why):
//!
//! * `Actor`: `receive(&mut self, message, cx)`, with one type of message;
//! * `Address<A>`: the system's own, as a program would use it;
//! * `World`: creates the first actors and sends them their first messages, from outside of the system;
//! * `Cx`: what an actor asks of its system: its own address, sending, creating an actor, stopping itself, and
//!   saying that the run is over.
//!
//! The *place* of a new actor is a number; a system with several threads takes it modulo their number. A system
//! that moves actors between threads itself pays no heed to it.

mod actix;
mod dragonfly;
mod kameo;
mod ractor;
mod stakker;
mod tokio;
mod tonari;

use super::run::Finish;
use crate::Mode;

/// A system, run in one way.
pub(super) struct System {
    /// What it is called in the results.
    pub(super) label: &'static str,
    /// Can its actors create others, and end one by one?
    pub(super) creates: bool,
    /// Plays the benchmark of this name once. `Err` says what went wrong.
    pub(super) play: fn(&'static str, Mode) -> Result<Finish, String>,
}

impl System {
    const fn new(label: &'static str, play: fn(&'static str, Mode) -> Result<Finish, String>) -> Self {
        Self { label, creates: true, play }
    }
}

/// Every system, in every way that it is run.
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
