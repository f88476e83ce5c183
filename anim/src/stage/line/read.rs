//! Files of drawn lines.

use super::samples::LineSamples;
use crate::stage::project::StageProject;
use crate::stage::script::{ErrorList, ScriptElement, ScriptError, ScriptTree, read_tree};
use crate::stage::table::{LINE_FILES, points};
use crate::stage::time::{Decimal, StageRate, StageTime, parse_time};
use glam::DVec3;
use std::collections::HashMap;
use std::sync::Arc;

/// Largest number of curves of a file: some thousand strokes of a pen. Each of them is sampled to be drawn and measured.
const MOST_CURVES: usize = 32_768;

/// A line of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnLine {
    /// Its element in [`DrawnLines::tree`].
    pub element: usize,
    /// Name by which paths refer to it.
    pub id: Option<Box<str>>,
    /// Control points of cubic Bézier curves, meters, 3 n + 1 of them.
    pub points: Vec<DVec3>,
    /// The surface that it was drawn on: `view`, `ground`, `surface` or `bone`.
    pub on: Box<str>,
    /// The thing, or the thing and bone, that it moves with.
    pub of: Option<Box<str>>,
    /// Whether its end is its start.
    pub is_closed: bool,
    /// Color, sRGB, from 0 to 255.
    pub color: [u8; 3],
    /// Width in pixels.
    pub width: f32,
    /// The time in which it is shown; always, or to the end, where `None`.
    pub shown: [Option<StageTime>; 2],
    /// Whether movies show it.
    pub is_in_movie: bool,
}

/// The lines of a file. Never changes.
#[derive(Clone, Debug)]
pub struct DrawnLines {
    tree: ScriptTree,
    lines: Vec<DrawnLine>,
    /// The positions of the lines that have an id.
    ids: HashMap<Box<str>, usize>,
}

impl DrawnLines {
    /// Reads a file of lines. Its frames are those of 24 per second.
    ///
    /// # Errors
    ///
    /// Everything that is wrong, in the order of the text, as [`crate::stage::script::StageScript::read`] reports it; more than
    /// 32,768 curves.
    pub fn read(text: impl Into<Arc<str>>) -> Result<Self, Vec<ScriptError>> {
        Self::read_of(text, None)
    }

    /// Reads the file of lines of a project, whose frame rate counts for times that are frames.
    ///
    /// # Errors
    ///
    /// As [`Self::read`].
    pub fn read_of(
        text: impl Into<Arc<str>>,
        project: Option<&StageProject>,
    ) -> Result<Self, Vec<ScriptError>> {
        let text = text.into();
        let rate = project.map_or_else(StageRate::default, StageProject::rate);
        let tree = read_tree(&text, &LINE_FILES)?;
        let index = tree.lines().clone();
        let mut errors = ErrorList::new(&index);
        let mut ids: HashMap<Box<str>, usize> = HashMap::new();
        let (mut lines, mut curves) = (Vec::<DrawnLine>::new(), 0);
        for (element, row) in tree.elements().iter().enumerate().skip(1) {
            let line = drawn(element, row, rate);
            curves += line.points.len() / 3;
            if curves > MOST_CURVES {
                let message = format!("the lines have more than {MOST_CURVES} curves together");
                errors.add(row.value_range("points"), message, "");
                break;
            }
            if line.points.len() % 3 != 1 || line.points.len() < 4 {
                let count = line.points.len();
                let message = format!("a line needs 3 n + 1 points, such as 4 or 7, not {count}");
                errors.add(row.value_range("points"), message, "");
            }
            if let Some(first) = line.id.clone().and_then(|id| ids.insert(id, lines.len())) {
                let first = tree.elements()[lines[first].element].range.start;
                let message = format!("the id is used at {} already", errors.place(first));
                errors.add(row.value_range("id"), message, "an id names one line");
            }
            lines.push(line);
        }
        if errors.is_empty() { Ok(Self { tree, lines, ids }) } else { Err(errors.sorted()) }
    }

    /// Returns the text and its elements.
    pub fn tree(&self) -> &ScriptTree {
        &self.tree
    }

    /// Returns the lines, in the order of the text.
    pub fn list(&self) -> &[DrawnLine] {
        &self.lines
    }

    /// Returns the line called `id`.
    pub fn called(&self, id: &str) -> Option<&DrawnLine> {
        self.lines.get(*self.ids.get(id)?)
    }
}

impl DrawnLine {
    /// Returns points along it, to measure it, to pick it, and for paths.
    pub fn samples(&self) -> LineSamples {
        LineSamples::new(&self.points, self.is_closed)
    }
}

/// Returns the line of an element whose values were checked.
fn drawn(element: usize, row: &ScriptElement, rate: StageRate) -> DrawnLine {
    let time = |name: &str| row.value(name).and_then(|text| parse_time(text, rate));
    let color = row.value("color").and_then(|text| u32::from_str_radix(text.get(1..)?, 16).ok()).unwrap_or(0);
    let [_, red, green, blue] = color.to_be_bytes();
    DrawnLine {
        element,
        id: row.value("id").map(Into::into),
        points: row.value("points").and_then(points).unwrap_or_default(),
        on: row.value("on").unwrap_or_default().into(),
        of: row.value("of").map(Into::into),
        is_closed: row.value("closed") == Some("yes"),
        color: [red, green, blue],
        width: row.value("width").and_then(Decimal::parse).map_or(3.0, |width| width.to_f64() as f32),
        shown: [time("from"), time("to")],
        is_in_movie: row.value("in-movie") == Some("yes"),
    }
}
