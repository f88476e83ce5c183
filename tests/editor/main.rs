//! Promises, one module each.
