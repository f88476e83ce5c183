//! What the tests of all crates share. Small on purpose: a test should show what it does.

pub mod bench;
pub mod counting;
mod eventually;
pub mod load;
pub mod mutate;
pub mod process;
pub mod random;
pub mod skip;

pub use eventually::eventually;
