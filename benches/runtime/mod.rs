//! What a message costs: queues, actors, and the Savina suite, ours and others'.

use crate::Study;

/// Measures every case.
pub fn all(_study: &mut Study) {}
