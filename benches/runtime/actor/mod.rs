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
use super::work::round_trip;
use crate::{Study, Variant};
use chain::Plan;

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
    on_one_thread(study);
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
