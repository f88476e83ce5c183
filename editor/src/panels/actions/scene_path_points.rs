//! Points of paths and lines that are added and removed.

use super::line_edit::reshaped_edit;
use super::scene_lines::place_of;
use super::scene_points::open_scene;
use super::scene_text::step;
use crate::control::path_point::{PathPoint, PathPointOwner};
use crate::panels::request::Effect;
use crate::panels::scene::{ChangedThings, line_named, nearest_on_piece};
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::stage::gesture::{
    GestureRefusal, add_path_point_splices, remove_path_point_splices, written_points,
};
use dragonfly_anim::stage::line::{line_place, with_line_point, without_line_point};
use dragonfly_document::Change;
use dragonfly_document::edit::{Edit, EditScript, ScriptLabel};
use dragonfly_picture::between;
use dragonfly_picture::gizmo::GizmoView;
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// Distance from the pointer within which a point is added on a path, points of the screen.
const REACH: f64 = 8.0;

/// Number of places between two points of a path or a line that are compared with the pointer, and the largest number of all of them.
const PLACES: usize = 48;
const MOST_PLACES: usize = 20_000;

/// A place on a path or a line at which a point is added.
#[derive(Clone, Debug, PartialEq)]
enum NewPoint {
    /// On a path of the cast, before the point with this number.
    OnPath(Arc<str>, usize, DVec3),
    /// On a line of the project: on one of its curves, at a share from 0 to 1.
    OnLine(Arc<str>, usize, f64),
}

/// Returns whether a press adds a point: Ctrl is held, and nothing that can be dragged is under the pointer.
pub(super) fn is_add(workspace: &Workspace) -> bool {
    let controls = workspace.tools.controls();
    let held = controls.modifiers();
    held.ctrl
        && !held.shift
        && !held.alt
        && controls.over_ground()
        && controls.picture().armed().is_none()
        && !controls.points().points().is_empty()
        && workspace.read().scene().is_some()
}

/// Adds a point to the selected path or line under the pointer, and selects it. Returns whether there is one.
pub(super) fn add(workspace: &mut Workspace, effects: &mut Vec<Effect>) -> bool {
    let Some(point) = point_under_pointer(workspace) else { return false };
    let (effect, (owner, index, more)) = match point {
        NewPoint::OnPath(path, index, place) => {
            let effect = step(workspace, |base| {
                let splices = add_path_point_splices(&base.script, &path, index, place)?;
                base.spliced(&splices, ScriptLabel::AddPoint, None, ChangedThings::Thing(&path))
            });
            (effect, (PathPointOwner::Path(path), index, 1))
        }
        NewPoint::OnLine(line, curve, share) => {
            let effect = reshape(workspace, ScriptLabel::AddPoint, &line, |control| {
                with_line_point(control, curve, share)
            });
            (effect, (PathPointOwner::Line(line), 3 * curve + 3, 3))
        }
    };
    if effect.is_some() {
        workspace.scene.lines_mut().select_added_point(owner, index, more);
    }
    effects.extend(effect);
    true
}

/// Returns the selected point; `None` where the paths and lines that are selected do not have it.
fn selected(workspace: &Workspace) -> Option<&PathPoint> {
    let lines = workspace.scene.lines();
    lines.points().iter().find(|point| lines.is_point_selected(point))
}

/// Returns whether a point is selected.
pub(super) fn is_any_selected(workspace: &Workspace) -> bool {
    selected(workspace).is_some()
}

/// Removes the selected point.
pub(super) fn remove(workspace: &mut Workspace) -> Option<Effect> {
    let PathPoint { owner, index, .. } = selected(workspace)?.clone();
    let effect = match &owner {
        PathPointOwner::Path(path) => step(workspace, |base| {
            let splices = remove_path_point_splices(&base.script, path, index)?;
            base.spliced(&splices, ScriptLabel::RemovePoint, None, ChangedThings::Thing(path))
        }),
        PathPointOwner::Line(line) => {
            let is_short = control_of(workspace, line).is_some_and(|(points, _)| points.len() < 7);
            if is_short {
                let text = format!("{line} has only two points: delete the line");
                workspace.say(MessageSeverity::Info, text);
                return None;
            }
            reshape(workspace, ScriptLabel::RemovePoint, line, |control| without_line_point(control, index))
        }
    };
    if effect.is_some() {
        workspace.scene.lines_mut().deselect_point();
    }
    effect
}

/// Gives a line of the project other control points.
fn reshape(
    workspace: &mut Workspace,
    label: ScriptLabel,
    line: &str,
    change: impl FnOnce(&[DVec3]) -> Option<Vec<DVec3>>,
) -> Option<Effect> {
    let edit: Result<EditScript, GestureRefusal> = open_scene(workspace).and_then(|scene| {
        reshaped_edit(&scene, label, line, |own| change(&own.points)).map_err(GestureRefusal)
    });
    match edit {
        Ok(edit) => Some(Effect::Change(Change::Edit(Edit::EditScript(edit), None))),
        Err(refusal) => {
            workspace.say(MessageSeverity::Info, refusal.to_string());
            None
        }
    }
}

/// Returns the control points of a line, and the name of what it moves with.
fn control_of(workspace: &Workspace, name: &str) -> Option<(Vec<DVec3>, Option<Box<str>>)> {
    let lines = workspace.model.view()?.scene.as_ref()?.lines.as_ref()?;
    let line = &lines.list()[line_named(lines, name)?];
    Some((line.points.clone(), line.of.clone().filter(|of| !of.is_empty()).map(|of| of.to_string().into())))
}

/// Returns the place on a selected path or line that is under the pointer.
fn point_under_pointer(workspace: &mut Workspace) -> Option<NewPoint> {
    let picture = workspace.tools.controls().picture();
    let view = GizmoView::new(workspace.camera.camera(), picture.size);
    let at = (workspace.tools.controls().pointer()? - picture.corner).as_dvec2();
    let mut owners: Vec<PathPointOwner> = Vec::new();
    for point in workspace.scene.lines().points().iter() {
        if owners.last() != Some(&point.owner) && !owners.contains(&point.owner) {
            owners.push(point.owner.clone());
        }
    }
    let mut found: Option<(f64, NewPoint)> = None;
    for owner in owners {
        let near = match owner {
            PathPointOwner::Path(path) => near_on_path(workspace, path, &view, at),
            PathPointOwner::Line(line) => near_on_line(workspace, line, &view, at),
        };
        let best = found.as_ref().map_or(REACH, |(distance, _)| *distance);
        found = near.filter(|(distance, _)| *distance <= best).or(found);
    }
    found.map(|(_, point)| point)
}

fn near_on_path(workspace: &Workspace, id: Arc<str>, view: &GizmoView, at: DVec2) -> Option<(f64, NewPoint)> {
    let scene = workspace.model.view()?.scene.as_ref()?;
    let plan = scene.plan.as_ref()?;
    let path = plan.things().get(plan.thing_called(&id)?)?.path.as_ref()?;
    let points = written_points(scene.script.as_ref()?, &id)?;
    let count = between(points.len() * PLACES, PLACES, MOST_PLACES);
    let along = |place: f64| path.length() * place / count as f64;
    let places = (0..=count).map(|place| path.at(along(place as f64)).position);
    let (distance, place) = nearest(view, at, places)?;
    // Points at the place of the one before are none of the path.
    let mut part = path.part_at(along(place));
    let next = points.windows(2).position(|pair| {
        let is_part = pair[0] != pair[1];
        let is_found = is_part && part == 0;
        part -= usize::from(is_part && part > 0);
        is_found
    })?;
    Some((distance, NewPoint::OnPath(id, next + 1, path.at(along(place)).position)))
}

fn near_on_line(
    workspace: &mut Workspace,
    name: Arc<str>,
    view: &GizmoView,
    at: DVec2,
) -> Option<(f64, NewPoint)> {
    let (control, of) = control_of(workspace, &name)?;
    let of = match of {
        Some(of) => Some(place_of(workspace, &of)?),
        None => None,
    };
    let curves = control.len() / 3;
    let pieces = between(MOST_PLACES / curves.max(1), 4, PLACES);
    let place = |piece: usize| {
        let (curve, share) = (piece / pieces, (piece % pieces) as f64 / pieces as f64);
        let last = || control.last().copied().unwrap_or_default();
        let place = line_place(&control, curve, share).unwrap_or_else(last);
        of.map_or(place, |of| of.rotation * place + of.position)
    };
    let (distance, piece) = nearest(view, at, (0..=curves * pieces).map(place))?;
    let curve = ((piece / pieces as f64) as usize).min(curves.checked_sub(1)?);
    Some((distance, NewPoint::OnLine(name, curve, piece / pieces as f64 - curve as f64)))
}

/// Returns the distance of a position from the nearest one of the straight pieces between places, points of the screen, and which it is with the share along it.
fn nearest(view: &GizmoView, at: DVec2, places: impl Iterator<Item = DVec3>) -> Option<(f64, f64)> {
    let mut before: Option<DVec2> = None;
    let mut found: Option<(f64, f64)> = None;
    for (index, place) in places.enumerate() {
        let place = view.to_screen(place);
        if let Some((from, to)) = before.zip(place) {
            let (distance, share) = nearest_on_piece(at, [from, to]);
            if found.is_none_or(|(least, _)| distance < least) {
                found = Some((distance, index as f64 - 1.0 + share));
            }
        }
        before = place;
    }
    found
}
