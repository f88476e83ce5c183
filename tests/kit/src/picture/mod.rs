//! Graphics devices and images for tests.

pub mod complaints;
pub mod images;
pub mod studio;
