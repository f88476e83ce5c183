//! Published figures: a bench measures them and writes files of results, and the tables of a page are made from these files
//! and from nothing else.
//!
//! - [`FigureBench`] measures, prints and records.
//! - [`Results`] is a file: the machine, the commit, the command, and a row for each number.
//! - [`FigurePage`] makes the tables of a page from the files. Its bench writes the page; a test makes it again and compares.

mod bench;
mod page;
mod results;
mod run;
mod table;

pub use bench::{FigureBench, percentile};
pub use page::{FigurePage, RecordedResults, typed_figure};
pub use results::{Figure, GOAL, Results};
pub use run::{description, root};
pub use table::{digits, filled, grouped, header, line};
