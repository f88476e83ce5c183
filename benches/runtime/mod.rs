//! Cost of a message: queues, actors, and the Savina suite, in our runtime and in other crates.

pub mod actor;
pub mod cases;
pub mod own;
pub mod peer;
pub mod queue;
pub mod savina;
pub mod work;

use crate::Study;

/// Measures every case.
pub fn all(study: &mut Study) {
    queue::all(study);
    actor::all(study);
    own::all(study);
    savina::all(study);
}
