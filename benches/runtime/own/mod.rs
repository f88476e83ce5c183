//! What only our runtime has: kinds of addresses, registers, the trace, spinning.

pub mod peer;

use crate::Study;

/// Measures every case.
pub fn all(_study: &mut Study) {}
