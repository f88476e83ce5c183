//! Points of paths: moved, added, removed.

use super::cast::set_on_thing;
use super::draft::spliced_text;
use super::scene::{GestureRefusal, NO_PLACE, in_scene_texts, in_this_text, refused};
use crate::stage::line::points_text;
use crate::stage::script::{ElementOrigin, SHARED, StageScript};
use crate::stage::splice::{TextSplice, TextSplices};
use crate::stage::table::points;
use glam::DVec3;
use std::ops::Range;

/// Moves the point at `index` of a path of the cast to `position`, meters, to 0.1 mm. All other points stay as they are written.
///
/// # Errors
///
/// There is no such path, it has no such point of its own, or a number is not finite.
pub fn move_path_point(
    script: &StageScript,
    path: &str,
    index: usize,
    position: DVec3,
) -> Result<String, GestureRefusal> {
    let splices = path_point_splices(script, path, index, position)?;
    if let Some(element) = script.thing_element(path) {
        in_this_text(script.tree(), element)?;
    }
    spliced_text(script, splices)
}

/// Returns the replacements of [`move_path_point`]; also those of a path of the project. The new text is not checked.
///
/// # Errors
///
/// As [`move_path_point`].
pub fn path_point_splices(
    script: &StageScript,
    path: &str,
    index: usize,
    position: DVec3,
) -> Result<TextSplices, GestureRefusal> {
    let list = WrittenList::of(script, path)?;
    let Some(range) = list.point(index) else { return refused(format!("{path} has no such point")) };
    list.replaced(range, written(&[position])?)
}

/// Returns the replacements that give a path of the cast other points, meters, to 0.1 mm; also those of a path of the project.
///
/// # Errors
///
/// As [`move_path_point`].
pub fn path_points_splices(
    script: &StageScript,
    path: &str,
    points: &[DVec3],
) -> Result<TextSplices, GestureRefusal> {
    let Some(element) = script.thing_element(path).filter(|_| written_points(script, path).is_some()) else {
        return refused(format!("{path} has no points of its own: move those of its line"));
    };
    in_scene_texts(script.tree(), element)?;
    let splices = set_on_thing(script, element, "points", Some(&written(points)?));
    splices.ok_or_else(|| GestureRefusal(NO_PLACE.to_owned()))
}

/// Returns the points of a path of the cast as they are written, meters; `None` where there is no such path, and for one that follows a line.
pub fn written_points(script: &StageScript, path: &str) -> Option<Vec<DVec3>> {
    let element = &script.tree().elements()[script.thing_element(path)?];
    points(element.value("points").filter(|_| element.row.name == "path")?)
}

/// Returns the replacements that add a point at `position`, meters, to a path of the cast, before the point at `index`; all others stay as they are written.
/// The new text is not checked.
///
/// # Errors
///
/// As [`move_path_point`]; also where there is no point before that one, because a path does not get longer by this.
pub fn add_path_point_splices(
    script: &StageScript,
    path: &str,
    index: usize,
    position: DVec3,
) -> Result<TextSplices, GestureRefusal> {
    let list = WrittenList::of(script, path)?;
    let before = index.checked_sub(1).and_then(|before| list.point(before));
    let (Some(before), Some(next)) = (before, list.point(index)) else {
        return refused(format!("{path} has no such part"));
    };
    let point = written(&[position])?;
    // The blanks between the points are those between these two.
    let blanks = &list.text[before.end..next.start];
    list.replaced(before.end..before.end, format!("{blanks}{point}"))
}

/// Returns the replacements that remove a point of a path of the cast; all others stay as they are written. The new text is not checked.
///
/// # Errors
///
/// As [`move_path_point`]; also where only two points are left.
pub fn remove_path_point_splices(
    script: &StageScript,
    path: &str,
    index: usize,
) -> Result<TextSplices, GestureRefusal> {
    let list = WrittenList::of(script, path)?;
    let Some(own) = list.point(index) else { return refused(format!("{path} has no such point")) };
    if list.point(2).is_none() {
        return refused(format!("{path} has only two points: delete the path"));
    }
    let range = match index.checked_sub(1).and_then(|before| list.point(before)) {
        Some(before) => before.end..own.end,
        None => own.start..list.point(1).map_or(own.end, |next| next.start),
    };
    list.replaced(range, String::new())
}

/// Returns points as they are written.
fn written(points: &[DVec3]) -> Result<String, GestureRefusal> {
    if points.iter().any(|point| point.abs().max_element() >= 1e6) {
        return refused("The position is too far away");
    }
    points_text(points).ok_or_else(|| GestureRefusal("The position is not a number".to_owned()))
}

/// The list of numbers of a path of the cast, in the text that has it.
struct WrittenList<'a> {
    text: &'a str,
    list: Range<usize>,
    /// Difference between a position of the script and that in the text.
    offset: usize,
}

impl<'a> WrittenList<'a> {
    fn of(script: &'a StageScript, path: &str) -> Result<Self, GestureRefusal> {
        let tree = script.tree();
        let element =
            script.thing_element(path).filter(|&element| tree.elements()[element].row.name == "path");
        let Some(element) = element else {
            return refused(format!("No path of the cast has the id \"{path}\""));
        };
        in_scene_texts(tree, element)?;
        let Some(attribute) = tree.elements()[element].attribute("points") else {
            return refused(format!("{path} follows a line: its points are those of the line"));
        };
        let list = attribute.value_range.clone();
        let project = script.project().filter(|_| tree.elements()[element].origin == ElementOrigin::Project);
        Ok(match project {
            Some(project) => Self {
                text: project.tree().text(),
                list: list.start - SHARED..list.end - SHARED,
                offset: SHARED,
            },
            None => Self { text: tree.text(), list, offset: 0 },
        })
    }

    fn point(&self, index: usize) -> Option<Range<usize>> {
        point_range(self.text, self.list.clone(), index)
    }

    /// Returns the replacement of a part of the list, in the script.
    fn replaced(&self, range: Range<usize>, text: String) -> Result<TextSplices, GestureRefusal> {
        let range = range.start + self.offset..range.end + self.offset;
        TextSplices::new(vec![TextSplice { range, text }]).ok_or_else(|| GestureRefusal(NO_PLACE.to_owned()))
    }
}

/// Returns where the three numbers of a point are in `text`, which has a list of numbers with blanks between them at `list`. `None` where
/// there is no such point, and for a list with references such as `&#10;`.
fn point_range(text: &str, list: Range<usize>, index: usize) -> Option<Range<usize>> {
    let start_of = |number: &str| number.as_ptr() as usize - text.as_ptr() as usize;
    let list = text.get(list).filter(|list| !list.contains('&'))?;
    let mut numbers = list.split_ascii_whitespace().skip(index.checked_mul(3)?);
    let first = numbers.next()?;
    let last = numbers.nth(1)?;
    Some(start_of(first)..start_of(last) + last.len())
}
