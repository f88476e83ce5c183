//! Promises, one module each.

mod commands;
mod documents;
mod fixture;
mod life;
mod panels;
mod playback;
mod ruler;
mod settings;
mod viewport_control;
