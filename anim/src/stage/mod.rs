//! Scenes of several roles, driven by a script in XML.

mod moment;
pub mod schedule;
pub mod script;
pub mod table;
pub mod time;
