//! Dragonfly, the editor: everything but the few lines of `main.rs`, so that tests and benches can reach it.

pub mod app;
pub mod camera;
pub mod command;
pub mod control;
pub mod demo;
pub mod document;
pub mod graphics;
pub mod panels;
pub mod playback;
pub mod posing;
pub mod protocol;
pub mod store;
pub mod text;
