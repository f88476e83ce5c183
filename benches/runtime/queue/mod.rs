//! Our mailbox compared with channels, each with one consumer thread.

pub mod channels;
pub mod one_thread;

use super::cases::{self, Cases};
use super::own::peer::Dragonfly;
use super::own::spin::Spinning;
use super::work::round_trip;
use crate::Study;
use channels::{Crossbeam, Flume, FlumeDrained, Kanal, KanalDrained, Std};

/// Measures every case.
pub fn all(study: &mut Study) {
    let mut cases = Cases::new("queue", study);
    cases.add::<Std>("std");
    cases.add::<Crossbeam>("crossbeam");
    cases.add::<Flume>("flume");
    cases.add::<FlumeDrained>("flume, drained");
    cases.add::<Kanal>("kanal");
    cases.add::<KanalDrained>("kanal, drained");
    cases.add::<Dragonfly>("dragonfly");
    cases.round_trips("dragonfly, spinning", round_trip::run::<Spinning>);
    cases::measure(study, cases);
    one_thread::all(study);
}
