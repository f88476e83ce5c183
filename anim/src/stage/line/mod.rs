//! Lines that were drawn: notes, and ways that roles follow.
//!
//! A line is a chain of cubic Bézier curves. [`fit`] makes it from the points of a stroke, [`LineSamples`] measures it and finds the place
//! under a pointer, and a file has one `<line>` for each ([`crate::stage::table::LINE_FILES`]):
//!
//! ```
//! use dragonfly_anim::stage::line::{DrawnLines, NewLine, fit};
//! use glam::DVec3;
//!
//! let stroke: Vec<DVec3> = (0..50).map(|at| DVec3::new(at as f64 * 0.1, 0.0, (at as f64 * 0.1).sin())).collect();
//! let line = NewLine { points: fit(&stroke, 0.01), id: Some("aisle".to_owned()), ..NewLine::default() };
//! let text = "<lines version=\"1\">\n</lines>\n";
//! let lines = DrawnLines::read(text).map_err(|errors| errors[0].in_file("duel.lines.xml"))?;
//! let text = lines.added(&line).expect("a place in the text").apply(text);
//! let lines = DrawnLines::read(text).map_err(|errors| errors[0].in_file("duel.lines.xml"))?;
//! assert!(lines.list()[0].samples().length() > 4.9);
//! # Ok::<(), String>(())
//! ```

mod course;
mod fit;
mod points;
mod read;
mod samples;
mod write;

pub use course::path_points;
pub use fit::fit;
pub use points::{line_place, with_line_point, without_line_point};
pub use read::{DrawnLine, DrawnLines};
pub use samples::LineSamples;
pub use write::{NewLine, points_text};
