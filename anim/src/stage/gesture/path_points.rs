//! Points of paths, moved.

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
    let tree = script.tree();
    let element = script.thing_element(path).filter(|&element| tree.elements()[element].row.name == "path");
    let Some(element) = element else { return refused(format!("No path of the cast has the id \"{path}\"")) };
    in_scene_texts(tree, element)?;
    let Some(attribute) = tree.elements()[element].attribute("points") else {
        return refused(format!("{path} follows a line: its points are those of the line"));
    };
    let written = attribute.value_range.clone();
    let range = match script.project().filter(|_| tree.elements()[element].origin == ElementOrigin::Project) {
        Some(project) => {
            let own = written.start - SHARED..written.end - SHARED;
            let range = point_range(project.tree().text(), own, index);
            range.map(|range| range.start + SHARED..range.end + SHARED)
        }
        None => point_range(tree.text(), written, index),
    };
    let Some(range) = range else {
        return refused(format!("{path} has no such point"));
    };
    if position.abs().max_element() >= 1e6 {
        return refused("The position is too far away");
    }
    let Some(point) = points_text(&[position]) else { return refused("The position is not a number") };
    TextSplices::new(vec![TextSplice { range, text: point }])
        .ok_or_else(|| GestureRefusal(NO_PLACE.to_owned()))
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
    if points.iter().any(|point| point.abs().max_element() >= 1e6) {
        return refused("The position is too far away");
    }
    let splices = points_text(points).and_then(|text| set_on_thing(script, element, "points", Some(&text)));
    splices.ok_or_else(|| GestureRefusal("The position is not a number".to_owned()))
}

/// Returns the points of a path of the cast as they are written, meters; `None` where there is no such path, and for one that follows a line.
pub fn written_points(script: &StageScript, path: &str) -> Option<Vec<DVec3>> {
    let element = &script.tree().elements()[script.thing_element(path)?];
    points(element.value("points").filter(|_| element.row.name == "path")?)
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
