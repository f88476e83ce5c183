//! Rules about the files of the project, each a test. Most forbid words or files that ARCHITECTURE.md excludes.
//!
//! A rule is a function from files to complaints. Each is also run on planted files that break it, so that a rule
//! that never reports anything is detected.

mod circles;
mod clamps;
mod crates;
mod direction;
mod figures;
mod imports;
mod layout;
mod licenses;
mod planted;
mod skips;
mod tokens;
mod tree;
mod trigonometry;
mod words;
