//! What the tests of all crates share. Small on purpose: a test should show what it does.

pub mod bench;
pub mod counting;
mod eventually;
pub mod mutate;
pub mod process;
pub mod random;

pub use eventually::eventually;
