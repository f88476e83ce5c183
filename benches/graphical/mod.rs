//! An editor's threads over one document: with messages, and with locks.

use crate::Study;

/// Measures every case.
pub fn all(_study: &mut Study) {}
