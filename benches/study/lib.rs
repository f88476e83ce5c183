//! The parts that all measurements of the study share: planning, recording, and the report.
//!
//! A bench lists the *variants* of one *case* that it compares. [`Study::compare`] runs them several times in turn, in
//! shuffled order, so that a slow minute of the machine affects all of them equally. Each run records *metrics*: single
//! values, or whole distributions ([`Distribution`]). Every row goes into a CSV file together with the background load of
//! the machine during the run. [`report`] makes the tables and charts of `README.md` from these files alone.

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
pub use plan::{Study, StudyMode, Variant};
pub use record::{DataRow, RunValues};
