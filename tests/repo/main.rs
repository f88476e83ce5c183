//! Rules about the files of the project, each a test. Most are told by absence, as ARCHITECTURE.md tells them.
//!
//! A rule is a function from files to complaints. Each is also run on planted files that break it, so that a rule which
//! never complains is noticed.

mod crates;
mod direction;
mod layout;
mod licences;
mod tree;
mod words;
