//! Changes of a file of lines, as splices of its text.

use super::read::DrawnLines;
use crate::stage::splice::{
    AttachedComments, ElementPlace, NewElement, TextSplices, delete, insert, remove_attribute, set_attribute,
};
use crate::stage::time_text::decimal_text;
use glam::DVec3;

/// A line to write. Attributes with their default value are left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NewLine {
    /// Name by which paths refer to it.
    pub id: Option<String>,
    /// Control points of cubic Bézier curves, meters, 3 n + 1 of them.
    pub points: Vec<DVec3>,
    /// Further attributes, by the names that [`crate::stage::table::LINE_FILES`] has for them.
    pub attributes: Vec<(String, String)>,
}

impl DrawnLines {
    /// Adds a line after the others. `None` for a number of points that no line has.
    pub fn added(&self, new: &NewLine) -> Option<TextSplices> {
        let mut element = NewElement::new("line");
        if let Some(id) = &new.id {
            element = element.with("id", id);
        }
        for (name, value) in &new.attributes {
            element = element.with(name, value);
        }
        let element = element.with("points", control_text(&new.points)?);
        let place = match self.list().last() {
            Some(last) => ElementPlace::After(last.element),
            None => ElementPlace::First(0),
        };
        insert(self.tree(), place, &element)
    }

    /// Replaces the points of the line at a position of [`Self::list`]. `None` where there is none, or for a number of points that no line
    /// has.
    pub fn reshaped(&self, line: usize, points: &[DVec3]) -> Option<TextSplices> {
        set_attribute(self.tree(), self.list().get(line)?.element, "points", &control_text(points)?)
    }

    /// Sets an attribute of the line at a position of [`Self::list`], or removes it. `None` where there is none.
    pub fn set(&self, line: usize, attribute: &str, value: Option<&str>) -> Option<TextSplices> {
        let element = self.list().get(line)?.element;
        match value {
            Some(value) => set_attribute(self.tree(), element, attribute, value),
            None => remove_attribute(self.tree(), element, attribute),
        }
    }

    /// Removes the line at a position of [`Self::list`]. `None` where there is none.
    pub fn removed(&self, line: usize) -> Option<TextSplices> {
        delete(self.tree(), self.list().get(line)?.element, AttachedComments::Stay)
    }
}

/// Returns control points as a file has them. `None` for a number of points that no line has.
fn control_text(points: &[DVec3]) -> Option<String> {
    if points.len() % 3 != 1 || points.len() < 4 { None } else { points_text(points) }
}

/// Returns points as files of lines and paths of scripts have them: meters, rounded to 0.1 mm. `None` where a number is not finite.
pub fn points_text(points: &[DVec3]) -> Option<String> {
    if !points.iter().all(|point| point.is_finite()) {
        return None;
    }
    let point = |point: &DVec3| point.to_array().map(|number| decimal_text(number, 4)).join(" ");
    Some(points.iter().map(point).collect::<Vec<_>>().join("  "))
}
