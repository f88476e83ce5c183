//! Our runtime against actor crates.
//!
//! Between threads, each actor has one of its own, but where a variant says otherwise. On one thread (`chain`,
//! `creation`), all live on the thread that measures; those of tonari-actor cannot.

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
use super::peer::{Message, Words};
use super::work::round_trip::{self, placed};
use super::work::threads::Place;
use crate::{Study, Variant};
use chain::Plan;
use std::time::Duration;

/// Measures every case.
pub fn all(study: &mut Study) {
    let mut cases = Cases::new("actor", study);
    cases.add::<actix::Actix>("actix");
    cases.add::<kameo::CurrentThread>("kameo");
    cases.add::<kameo::TwoWorkers>("kameo, 2 workers");
    cases.add::<ractor::CurrentThread>("ractor");
    cases.add::<ractor::TwoWorkers>("ractor, 2 workers");
    cases.add_one_way::<stakker::Stakker>("stakker");
    cases.round_trips("stakker", stakker::round_trips);
    cases.add::<tonari::Tonari>("tonari-actor");
    cases.add::<Dragonfly>("dragonfly");
    cases.round_trips("dragonfly, spinning", round_trip::run::<Spinning>);
    cases::measure(study, cases);
    bound(study);
    on_one_thread(study);
}

/// Round trips with both ends bound to cores. Left to itself the system puts them on one core or on two as it likes,
/// which makes more difference than any crate.
fn bound(study: &mut Study) {
    let repeats = study.mode.pick(1, 3, 7);
    let at_once = round_trip::Plan { trips: study.mode.pick(50, 2_000, 20_000), rest: None };
    let rest = Some(Duration::from_micros(300));
    let rested = round_trip::Plan { trips: study.mode.pick(10, 150, 500), rest };
    let (one, two) = ([Place::First, Place::First], [Place::First, Place::Last]);
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
                Variant::new("kameo", move |out| placed::<kameo::CurrentThread>(plan, places, out)),
                Variant::new("ractor", move |out| placed::<ractor::CurrentThread>(plan, places, out)),
                Variant::new("stakker", move |out| stakker::placed(plan, places, out)),
                Variant::new("tonari-actor", move |out| placed::<tonari::Tonari>(plan, places, out)),
                Variant::new("dragonfly", move |out| placed::<Dragonfly>(plan, places, out)),
            ],
        );
    }
}

fn on_one_thread(study: &mut Study) {
    let repeats = study.mode.pick(1, 5, 11);
    let plan = Plan { batches: study.mode.pick(2, 100, 1_000), batch: 1_000 };
    study.compare("actor/chain/8_bytes", repeats, chains::<Words<1>>(plan));
    study.compare("actor/chain/64_bytes", repeats, chains::<Words<8>>(plan));
    let turns = Plan { batches: study.mode.pick(20, 20_000, 200_000), batch: 1 };
    study.compare("actor/chain/there_and_back", repeats, chains::<Words<1>>(turns));
    let count = study.mode.pick(10, 2_000, 10_000);
    let threads = study.mode.pick(2, 50, 200);
    let variants = vec![
        Variant::new("actix", move |measured| creation::run::<actix::Actix>(count, measured)),
        Variant::new("kameo", move |measured| creation::run::<kameo::CurrentThread>(count, measured)),
        Variant::new("ractor", move |measured| creation::run::<ractor::CurrentThread>(count, measured)),
        Variant::new("stakker", move |measured| stakker_local::creation(count, measured)),
        Variant::new("tonari-actor", move |measured| creation::threads(threads, measured)),
        Variant::new("dragonfly", move |measured| creation::run::<Dragonfly>(count, measured)),
    ];
    study.compare("actor/creation", repeats, variants);
}

fn chains<M: Message>(plan: Plan) -> Vec<Variant<'static>> {
    vec![
        Variant::new("actix", move |measured| chain::run::<actix::Actix, M>(plan, measured)),
        Variant::new("kameo", move |measured| chain::run::<kameo::CurrentThread, M>(plan, measured)),
        Variant::new("ractor", move |measured| chain::run::<ractor::CurrentThread, M>(plan, measured)),
        Variant::new("stakker", move |measured| stakker_local::chain::<M>(plan, measured)),
        Variant::new("dragonfly", move |measured| chain::run::<Dragonfly, M>(plan, measured)),
    ]
}
