//! Round trips between threads that spin for a while before they sleep, on two cores and on one.
//!
//! Crossbeam's channel always spins for a few microseconds. On a single core, spinning can only keep the other thread
//! from working.

use super::peer::{Dragonfly, wait_for};
use crate::runtime::peer::{Message, OnMessage, Peer};
use crate::runtime::queue::channels::{Crossbeam, Kanal};
use crate::runtime::work::round_trip::{RoundTripPlan, placed};
use crate::runtime::work::threads::{self, CoreChoice};
use crate::{Distribution, RunValues, Study, StudyMode, Variant};
use dragonfly_runtime::{Address, Thread};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Time for which a thread spins before it sleeps.
pub const LIMIT: Duration = Duration::from_micros(50);

/// Like [`Dragonfly`], spinning for [`LIMIT`].
pub struct Spinning;

impl Peer for Spinning {
    type Address<M: Message> = Address<M>;
    type Running = Thread;

    fn start<M: Message>(take: OnMessage<M>) -> (Self::Address<M>, Self::Running) {
        let (address, thread) = Dragonfly::start(take);
        thread.handle().set_spin(LIMIT);
        (address, thread)
    }

    fn send<M: Message>(address: &Self::Address<M>, message: M) {
        Dragonfly::send(address, message);
    }

    fn wait(running: Self::Running) {
        wait_for(running.handle());
    }
}

/// Measures two threads that pass a number back and forth and never sleep. That is the lower limit on this machine: the
/// time until a write of one core is visible to the other. It changes from hour to hour where a hypervisor moves cores.
fn bare(plan: RoundTripPlan, measured: &mut RunValues) {
    let turn = Arc::new(AtomicU64::new(0));
    let wait_for = |turn: &AtomicU64, number| while turn.load(Ordering::Acquire) != number {};
    let theirs = Arc::clone(&turn);
    let echo = move || {
        for trip in 0..plan.trips {
            wait_for(&theirs, 2 * trip + 1);
            theirs.store(2 * trip + 2, Ordering::Release);
        }
    };
    let all = threads::start("places", move || {
        let mut all = Distribution::new();
        let placed = threads::stay(CoreChoice::First);
        let other = threads::start("echo", echo);
        let placed = placed && threads::stay(CoreChoice::Last);
        let mut begin = Instant::now();
        for trip in 0..plan.trips {
            turn.store(2 * trip + 1, Ordering::Release);
            wait_for(&turn, 2 * trip + 2);
            let end = Instant::now();
            all.record(end - begin);
            begin = end;
        }
        threads::join(other);
        placed.then_some(all)
    });
    if let Some(all) = threads::join(all) {
        measured.distribution("trip", &all);
    }
}

/// Measures on two cores, and on one.
pub fn all(study: &mut Study) {
    let plan = RoundTripPlan { trips: study.mode.pick(50, 2_000, 20_000), rest: None };
    let repeats = study.mode.pick(1, 3, 7);
    let mut on_two = variants(plan, [CoreChoice::First, CoreChoice::Last]);
    if study.mode != StudyMode::Check {
        // The result is meaningless where both threads share a core, as they may in tests.
        on_two.push(Variant::new("bare", move |measured| bare(plan, measured)));
    }
    study.compare("own/spin/two_cores", repeats, on_two);
    study.compare("own/spin/one_core", repeats, variants(plan, [CoreChoice::First, CoreChoice::First]));
    let rested =
        RoundTripPlan { trips: study.mode.pick(10, 150, 500), rest: Some(Duration::from_micros(300)) };
    study.compare(
        "own/spin/one_core_rested",
        repeats,
        variants(rested, [CoreChoice::First, CoreChoice::First]),
    );
}

fn variants(plan: RoundTripPlan, places: [CoreChoice; 2]) -> Vec<Variant<'static>> {
    vec![
        Variant::new("crossbeam", move |measured| placed::<Crossbeam>(plan, places, measured)),
        Variant::new("kanal", move |measured| placed::<Kanal>(plan, places, measured)),
        Variant::new("dragonfly", move |measured| placed::<Dragonfly>(plan, places, measured)),
        Variant::new("dragonfly, spinning", move |measured| placed::<Spinning>(plan, places, measured)),
    ]
}
