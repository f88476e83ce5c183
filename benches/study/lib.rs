//! What all measurements of the study share: how they are planned, counted, written down and drawn.
//!
//! A bench says which *variants* of one *case* it compares; [`Study::compare`] runs them in turns and in shuffled order,
//! several times, so that a slow minute of the machine hits all alike. Each run writes *metrics*: single values, or
//! whole distributions ([`Distribution`]). Every row goes into a CSV file with the load that other programs put on the
//! machine meanwhile. From these files, and from nothing else, [`report`] makes the tables and charts of `README.md`.

pub mod amount;
pub mod chart;
#[path = "../design/mod.rs"]
pub mod design;
pub mod distribution;
pub mod figures;
pub mod goal;
#[path = "../graphical/mod.rs"]
pub mod graphical;
pub mod machine;
pub mod plan;
pub mod record;
pub mod report;
#[path = "../runtime/mod.rs"]
pub mod runtime;
pub mod summary;
pub mod table;

pub use distribution::Distribution;
pub use plan::{Mode, Study, Variant};
pub use record::{Measured, Row};
