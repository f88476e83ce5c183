//! Round trips when both threads look for messages for a while before they sleep, and on how many cores.
//!
//! Crossbeam's channel always does that, for a few microseconds. Where both threads have only one core, spinning can
//! only keep the other from working.

use super::peer::{Dragonfly, wait_for};
use crate::runtime::peer::{Message, Peer, Take};
use crate::runtime::queue::channels::{Crossbeam, Kanal};
use crate::runtime::work::round_trip::{Plan, placed};
use crate::runtime::work::threads::{self, Place};
use crate::{Distribution, Measured, Mode, Study, Variant};
use dragonfly_runtime::{Address, Thread};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// For how long a thread looks before it sleeps.
pub const LIMIT: Duration = Duration::from_micros(50);

/// As [`Dragonfly`], spinning for [`LIMIT`].
pub struct Spinning;

impl Peer for Spinning {
    type Address<M: Message> = Address<M>;
    type Running = Thread;

    fn start<M: Message>(take: Take<M>) -> (Self::Address<M>, Self::Running) {
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

/// Two threads that hand a number to and fro and never sleep: the least that this machine allows, which is how long
/// the two cores need to show each other a change. It differs from hour to hour where a hypervisor moves cores about.
fn bare(plan: Plan, measured: &mut Measured) {
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
        let placed = threads::stay(Place::First);
        let other = threads::start("echo", echo);
        let placed = placed && threads::stay(Place::Last);
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

/// On two cores, and on one.
pub fn all(study: &mut Study) {
    let plan = Plan { trips: study.mode.pick(50, 2_000, 20_000), rest: None };
    let repeats = study.mode.pick(1, 3, 7);
    let mut on_two = variants(plan, [Place::First, Place::Last]);
    if study.mode != Mode::Check {
        // Pointless where two threads must share a core, as tests may have to.
        on_two.push(Variant::new("bare", move |measured| bare(plan, measured)));
    }
    study.compare("own/spin/two_cores", repeats, on_two);
    study.compare("own/spin/one_core", repeats, variants(plan, [Place::First, Place::First]));
    let rested = Plan { trips: study.mode.pick(10, 150, 500), rest: Some(Duration::from_micros(300)) };
    study.compare("own/spin/one_core_rested", repeats, variants(rested, [Place::First, Place::First]));
}

fn variants(plan: Plan, places: [Place; 2]) -> Vec<Variant<'static>> {
    vec![
        Variant::new("crossbeam", move |measured| placed::<Crossbeam>(plan, places, measured)),
        Variant::new("kanal", move |measured| placed::<Kanal>(plan, places, measured)),
        Variant::new("dragonfly", move |measured| placed::<Dragonfly>(plan, places, measured)),
        Variant::new("dragonfly, spinning", move |measured| placed::<Spinning>(plan, places, measured)),
    ]
}
