//! What a message costs: queues, actors, and the Savina suite, ours and others'.

pub mod savina;

use crate::Study;

/// Measures every case.
pub fn all(study: &mut Study) {
    savina::all(study);
}
