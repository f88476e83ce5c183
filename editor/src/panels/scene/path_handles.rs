//! The points of the selected paths and of the selected line, which can be dragged in the viewport.

use super::line_editing::{line_name, line_named};
use crate::control::path_point::{PathPoint, PathPointOwner};
use dragonfly_anim::stage::gesture::written_points;
use dragonfly_anim::stage::line::{DrawnLine, DrawnLines};
use dragonfly_anim::stage::script::StageScript;
use std::sync::Arc;

/// Largest number of points that are shown.
const MOST: usize = 2_000;

/// Returns the points of paths of the cast with these ids, of the lines that such paths follow, and of the line called `line`. Lines that move with a thing have
/// none.
pub(super) fn path_handles<'a>(
    script: Option<&StageScript>,
    lines: Option<&DrawnLines>,
    paths: impl Iterator<Item = &'a str>,
    line: Option<&str>,
) -> Arc<[PathPoint]> {
    let mut found = Vec::new();
    let mut shown: Vec<usize> =
        line.zip(lines).and_then(|(name, lines)| line_named(lines, name)).into_iter().collect();
    for path in paths {
        let Some(script) = script else { break };
        if let Some(points) = written_points(script, path) {
            let owner = PathPointOwner::Path(path.into());
            found.extend(points.into_iter().enumerate().map(|(index, place)| PathPoint {
                owner: owner.clone(),
                index,
                place,
                arm: None,
            }));
            continue;
        }
        let element = script.thing_element(path).map(|element| &script.tree().elements()[element]);
        let source =
            element.filter(|element| element.row.name == "path").and_then(|element| element.value("line"));
        let of_path = source
            .zip(lines)
            .and_then(|(id, lines)| lines.list().iter().position(|line| line.id.as_deref() == Some(id)));
        shown.extend(of_path.filter(|at| !shown.contains(at)));
    }
    for (at, lines) in shown.into_iter().filter_map(|at| Some((at, lines?))) {
        let line = &lines.list()[at];
        if line.of.as_deref().is_none_or(str::is_empty) {
            found.extend(line_points(&line_name(at, line), line));
        }
    }
    found.truncate(MOST);
    found.into()
}

/// Returns the control points of a line. Those that give a curve its direction come last, so that they are in front where they cover others.
fn line_points(name: &str, line: &DrawnLine) -> Vec<PathPoint> {
    let owner = PathPointOwner::Line(name.into());
    let point = |index: usize| {
        let of = match index % 3 {
            0 => None,
            1 => Some(index - 1),
            _ => Some(index + 1),
        };
        PathPoint {
            owner: owner.clone(),
            index,
            place: line.points[index],
            arm: of.and_then(|of| line.points.get(of).copied()),
        }
    };
    let (on_line, arms): (Vec<PathPoint>, Vec<PathPoint>) =
        (0..line.points.len()).map(point).partition(|point| point.arm.is_none());
    on_line.into_iter().chain(arms).collect()
}
