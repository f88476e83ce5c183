//! Our runtime against actor crates.

pub mod actix;
pub mod kameo;
pub mod ractor;
pub mod stakker;
pub mod tonari;

use super::cases::{self, Cases};
use super::own::peer::Dragonfly;
use crate::Study;

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
    cases::measure(study, cases);
}
