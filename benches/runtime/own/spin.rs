//! Round trips when both threads look for messages for a while before they sleep, and on how many cores.
//!
//! Crossbeam's channel always does that, for a few microseconds. Where both threads have only one core, spinning can
//! only keep the other from working.

use super::peer::{Dragonfly, wait_for};
use crate::runtime::peer::{Message, Peer, Take};
use crate::runtime::queue::channels::{Crossbeam, Kanal};
use crate::runtime::work::round_trip::{self, Plan};
use crate::runtime::work::threads::{self, Place};
use crate::{Measured, Study, Variant};
use dragonfly_runtime::{Address, Thread};
use std::time::Duration;

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

/// On two cores, and on one.
pub fn all(study: &mut Study) {
    let plan = Plan { trips: study.mode.pick(50, 2_000, 20_000), rest: None };
    let repeats = study.mode.pick(1, 3, 7);
    study.compare("own/spin/two_cores", repeats, variants(plan, [Place::First, Place::Last]));
    study.compare("own/spin/one_core", repeats, variants(plan, [Place::First, Place::First]));
    let rested = Plan { trips: study.mode.pick(10, 200, 2_000), rest: Some(Duration::from_micros(300)) };
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

/// Each consumer on its core. Measures nothing where threads cannot be bound to cores.
fn placed<P: Peer>(plan: Plan, places: [Place; 2], measured: &mut Measured) {
    // A thread starts where the one is that starts it; this one ends with the measurement.
    let trips = threads::start("places", move || {
        let mut places = places.into_iter();
        round_trip::trips::<P>(plan, || places.next().is_some_and(threads::stay))
    });
    if let Some(all) = threads::join(trips) {
        measured.distribution("trip", &all);
    }
}
