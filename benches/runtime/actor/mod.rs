//! Our runtime against actor crates.

use super::cases::{self, Cases};
use super::own::peer::Dragonfly;
use crate::Study;

/// Measures every case.
pub fn all(study: &mut Study) {
    let mut cases = Cases::new("actor", study);
    cases.add::<Dragonfly>("dragonfly");
    cases::measure(study, cases);
}
