//! What the tests of all crates share. Small on purpose: a test should show what it does.

pub mod counting;
pub mod random;
