//! Helpers shared by the tests of all crates. Deliberately small: a test should show what it does.

pub mod bench;
pub mod counting;
mod eventually;
pub mod mutate;
pub mod process;
pub mod random;

pub use eventually::eventually;
