//! Devices and pictures for tests.

pub mod complaints;
pub mod images;
pub mod studio;
