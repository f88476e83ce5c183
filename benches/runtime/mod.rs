//! What a message costs: queues, actors, and the Savina suite, ours and others'.

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
