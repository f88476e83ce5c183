//! Our runtime compared with actor crates.
//!
//! Between threads, each actor has one of its own, except in variants whose name contains a number of workers. In
//! `chain` and `creation`, all actors run on the measuring thread; those of tonari-actor cannot.

pub mod actix;
pub mod chain;
pub mod creation;
pub mod kameo;
pub mod local;
pub mod ractor;
pub mod stakker;
pub mod stakker_local;
pub mod tonari;

use super::cases::{self, Cases};
use super::own::peer::Dragonfly;
use super::own::spin::Spinning;
use super::peer::{Message, WordMessage};
use super::work::round_trip::{self, placed};
use super::work::threads::CoreChoice;
use crate::{Study, Variant};
use chain::ChainPlan;
use std::time::Duration;

/// Measures every case.
pub fn all(study: &mut Study) {
    let mut cases = Cases::new("actor", study);
    cases.add::<actix::Actix>("actix");
    cases.add::<kameo::KameoCurrentThread>("kameo");
    cases.add::<kameo::KameoTwoWorkers>("kameo, 2 workers");
    cases.add::<ractor::RactorCurrentThread>("ractor");
    cases.add::<ractor::RactorTwoWorkers>("ractor, 2 workers");
    cases.add_one_way::<stakker::Stakker>("stakker");
    cases.round_trips("stakker", stakker::round_trips);
    cases.add::<tonari::Tonari>("tonari-actor");
    cases.add::<Dragonfly>("dragonfly");
    cases.round_trips("dragonfly, spinning", round_trip::run::<Spinning>);
    cases::measure(study, cases);
    bound(study);
    on_one_thread(study);
}

/// Round trips with both threads bound to cores. Otherwise the system puts them on one core or on two, unpredictably,
/// which makes a larger difference than the crate.
fn bound(study: &mut Study) {
    let repeats = study.mode.pick(1, 3, 7);
    let at_once = round_trip::RoundTripPlan { trips: study.mode.pick(50, 2_000, 20_000), rest: None };
    let rest = Some(Duration::from_micros(300));
    let rested = round_trip::RoundTripPlan { trips: study.mode.pick(10, 150, 500), rest };
    let (one, two) = ([CoreChoice::First, CoreChoice::First], [CoreChoice::First, CoreChoice::Last]);
    for (case, plan, places) in [
        ("actor/round_trip_bound/two_cores", at_once, two),
        ("actor/round_trip_bound/two_cores_rested", rested, two),
        ("actor/round_trip_bound/one_core", at_once, one),
    ] {
        study.compare(
            case,
            repeats,
            vec![
                Variant::new("actix", move |out| placed::<actix::Actix>(plan, places, out)),
                Variant::new("kameo", move |out| placed::<kameo::KameoCurrentThread>(plan, places, out)),
                Variant::new("ractor", move |out| placed::<ractor::RactorCurrentThread>(plan, places, out)),
                Variant::new("stakker", move |out| stakker::placed(plan, places, out)),
                Variant::new("tonari-actor", move |out| placed::<tonari::Tonari>(plan, places, out)),
                Variant::new("dragonfly", move |out| placed::<Dragonfly>(plan, places, out)),
            ],
        );
    }
}

fn on_one_thread(study: &mut Study) {
    let repeats = study.mode.pick(1, 5, 11);
    let plan = ChainPlan { batches: study.mode.pick(2, 100, 1_000), batch: 1_000 };
    study.compare("actor/chain/8_bytes", repeats, chains::<WordMessage<1>>(plan));
    study.compare("actor/chain/64_bytes", repeats, chains::<WordMessage<8>>(plan));
    let turns = ChainPlan { batches: study.mode.pick(20, 20_000, 200_000), batch: 1 };
    study.compare("actor/chain/there_and_back", repeats, chains::<WordMessage<1>>(turns));
    let count = study.mode.pick(10, 2_000, 10_000);
    let threads = study.mode.pick(2, 50, 200);
    let variants = vec![
        Variant::new("actix", move |measured| creation::run::<actix::Actix>(count, measured)),
        Variant::new("kameo", move |measured| creation::run::<kameo::KameoCurrentThread>(count, measured)),
        Variant::new("ractor", move |measured| creation::run::<ractor::RactorCurrentThread>(count, measured)),
        Variant::new("stakker", move |measured| stakker_local::creation(count, measured)),
        Variant::new("tonari-actor", move |measured| creation::threads(threads, measured)),
        Variant::new("dragonfly", move |measured| creation::run::<Dragonfly>(count, measured)),
    ];
    study.compare("actor/creation", repeats, variants);
}

fn chains<M: Message>(plan: ChainPlan) -> Vec<Variant<'static>> {
    vec![
        Variant::new("actix", move |measured| chain::run::<actix::Actix, M>(plan, measured)),
        Variant::new("kameo", move |measured| chain::run::<kameo::KameoCurrentThread, M>(plan, measured)),
        Variant::new("ractor", move |measured| chain::run::<ractor::RactorCurrentThread, M>(plan, measured)),
        Variant::new("stakker", move |measured| stakker_local::chain::<M>(plan, measured)),
        Variant::new("dragonfly", move |measured| chain::run::<Dragonfly, M>(plan, measured)),
    ]
}
