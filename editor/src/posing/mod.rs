//! Posing by hand: pure functions from a skeleton and its poses to the poses that a hand wants.

pub mod clipboard;
pub mod mirror;
