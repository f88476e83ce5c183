//! The points of the selected paths and of the selected line, which can be dragged in the viewport.

use super::line_editing::{line_name, line_named};
use crate::control::path_point::{PathPoint, PathPointOwner};
use dragonfly_anim::stage::RigidPlace;
use dragonfly_anim::stage::gesture::written_points;
use dragonfly_anim::stage::line::{DrawnLine, DrawnLines};
use dragonfly_anim::stage::script::StageScript;
use glam::DVec3;
use std::sync::Arc;

/// Largest number of points that are shown.
const MOST: usize = 2_000;

/// Returns the points of paths of the cast with these ids, of the lines that such paths follow, and of the line called `line`; `of` is the place of what that
/// moves with.
pub(super) fn path_handles<'a>(
    script: Option<&StageScript>,
    lines: Option<&DrawnLines>,
    paths: impl Iterator<Item = &'a str>,
    line: Option<&str>,
    of: Option<RigidPlace>,
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
                alone: false,
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
        let own = &lines.list()[at];
        let name = line_name(at, own);
        if own.of.as_deref().is_none_or(str::is_empty) {
            found.extend(line_points(&name, own, None));
        } else if line == Some(&*name) && of.is_some() {
            found.extend(line_points(&name, own, of));
        }
    }
    found.truncate(MOST);
    found.into()
}

/// Returns the paths whose points are shown while these things are selected: the selected ones, and those along which selected cameras move.
pub(super) fn edited_paths<'a>(
    script: Option<&'a StageScript>,
    selected: impl Iterator<Item = &'a str>,
) -> Vec<&'a str> {
    let mut paths: Vec<&str> = selected.collect();
    let Some(script) = script else { return paths };
    let elements = script.tree().elements();
    let is_camera = |id: &&str| script.thing_element(id).is_some_and(|at| elements[at].row.name == "camera");
    for camera in paths.clone().into_iter().filter(is_camera) {
        let actions = script.actions().iter().map(|action| &elements[action.element]);
        let moves = actions
            .filter(|own| !own.is_included() && own.row.name == "move" && own.value("who") == Some(camera));
        for path in moves.filter_map(|own| own.value("path")) {
            if !paths.contains(&path) {
                paths.push(path);
            }
        }
    }
    paths
}

/// Returns the number of the point of a line to which a control point gives a direction; `None` for a point of the line.
pub(in crate::panels) fn directed_point(index: usize) -> Option<usize> {
    match index % 3 {
        0 => None,
        1 => Some(index - 1),
        _ => Some(index + 1),
    }
}

/// Returns the control points of a line. Those that give a curve its direction come last, so that they are in front where they cover others.
fn line_points(name: &str, line: &DrawnLine, of: Option<RigidPlace>) -> Vec<PathPoint> {
    let place = |point: DVec3| of.map_or(point, |of| of.rotation * point + of.position);
    let owner = PathPointOwner::Line(name.into());
    let point = |index: usize| PathPoint {
        owner: owner.clone(),
        index,
        place: place(line.points[index]),
        arm: directed_point(index).and_then(|point| line.points.get(point).copied()).map(place),
        alone: false,
    };
    let (on_line, arms): (Vec<PathPoint>, Vec<PathPoint>) =
        (0..line.points.len()).map(point).partition(|point| point.arm.is_none());
    on_line.into_iter().chain(arms).collect()
}
