//! The work that all peers do, written once.

pub mod burst;
pub mod late;
pub mod one_way;
pub mod round_trip;
pub mod threads;
