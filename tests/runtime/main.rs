//! Promises of the crate, one module each.
