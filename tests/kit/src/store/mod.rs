//! File systems that fail on demand, and journals made by hand.

pub mod faulty_files;
pub mod forged;
