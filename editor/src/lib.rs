//! Dragonfly, the editor: everything but the few lines of `main.rs`, so that tests and benches can reach it.

pub mod app;
pub mod command;
pub mod control;
pub mod movie_render;
pub mod panels;
