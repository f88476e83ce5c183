//! Promises, one module each.

mod commands;
mod fixture;
mod panels;
