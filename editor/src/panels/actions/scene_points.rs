//! A drag of a point of a path or a line: a new text of the script, or of the file of lines.

use super::line_edit::reshaped_edit;
use super::scene_gizmo::gesture_base;
use super::scene_lines::place_of;
use super::scene_text::change_text;
use crate::control::path_point::{PathPoint, PathPointOwner};
use crate::panels::request::Effect;
use crate::panels::scene::{ChangedThings, ScriptChange, directed_point, line_named};
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::stage::gesture::{GestureRefusal, path_point_splices};
use dragonfly_anim::stage::line::DrawnLine;
use dragonfly_document::Change;
use dragonfly_document::SceneView;
use dragonfly_document::edit::{Edit, EditScript, ScriptLabel};
use dragonfly_document::history::Gesture;
use glam::DVec3;
use std::sync::Arc;

/// Sends the text in which a point is where the pointer put it, unless the text has that place already.
pub(super) fn send(workspace: &mut Workspace, point: &PathPoint, effects: &mut Vec<Effect>) {
    if !workspace.stage.is_new_place(point) {
        return;
    }
    let gesture = workspace.tools.drag().gesture().unwrap_or_else(|| workspace.dragging.new_gesture());
    let effect = match &point.owner {
        PathPointOwner::Path(path) => {
            let change = path_change(workspace, path, point, gesture);
            change.map(|change| change_text(workspace, &change))
        }
        PathPointOwner::Line(line) => {
            let edit = line_edit(workspace, line, point);
            edit.map(|edit| Some(Effect::Change(Change::Edit(Edit::EditScript(edit), Some(gesture)))))
        }
    };
    match effect {
        Ok(effect) => {
            workspace.tools.drag_mut().begin(gesture);
            effects.extend(effect);
        }
        Err(refusal) => workspace.say(MessageSeverity::Warning, refusal.to_string()),
    }
}

fn path_change(
    workspace: &mut Workspace,
    path: &str,
    point: &PathPoint,
    gesture: Gesture,
) -> Result<ScriptChange, GestureRefusal> {
    let scene = open_scene(workspace)?;
    let base = gesture_base(workspace, &scene)?;
    let splices = path_point_splices(&base.script, path, point.index, point.place)?;
    base.spliced(&splices, ScriptLabel::MovePoint, Some(gesture), ChangedThings::Thing(path))
}

/// Returns the edit of the file of lines as it was when the drag began.
fn line_edit(workspace: &mut Workspace, line: &str, point: &PathPoint) -> Result<EditScript, GestureRefusal> {
    let scene = match workspace.stage.line_base() {
        Some(scene) => Arc::clone(scene),
        None => {
            let scene = open_scene(workspace)?;
            workspace.stage.set_line_base(Arc::clone(&scene));
            scene
        }
    };
    let of = scene.lines.as_ref().and_then(|lines| {
        let own = &lines.list()[line_named(lines, line)?];
        own.of.clone().filter(|of| !of.is_empty())
    });
    // A line that moves with a thing has its points relative to that.
    let place = match of {
        None => point.place,
        Some(of) => {
            let of = place_of(workspace, &of).ok_or_else(|| GestureRefusal(format!("There is no {of}")))?;
            let own = of.inverse();
            own.rotation * point.place + own.position
        }
    };
    let point = PathPoint { place, ..point.clone() };
    reshaped_edit(&scene, ScriptLabel::MovePoint, line, |line| moved(line, &point)).map_err(GestureRefusal)
}

pub(super) fn open_scene(workspace: &Workspace) -> Result<Arc<SceneView>, GestureRefusal> {
    let scene = workspace.model.view().and_then(|view| view.scene.clone());
    scene.ok_or_else(|| GestureRefusal("No scene is open".to_owned()))
}

/// Cosine of the angle between two directions at a point of a line from which on the line is smooth there.
const SMOOTH: f64 = -0.999;

/// Returns the control points of a line after one of them was moved. The two that give the curve its direction at a point of the line move along with it.
/// One of these two turns the other one where the line is smooth, unless it is moved alone: a line without a corner gets none.
fn moved(line: &DrawnLine, point: &PathPoint) -> Option<Vec<DVec3>> {
    let mut points = line.points.clone();
    let by = point.place - *points.get(point.index)?;
    let reach = if point.index.is_multiple_of(3) { 1 } else { 0 };
    let last = (point.index + reach).min(points.len() - 1);
    for own in &mut points[point.index.saturating_sub(reach)..=last] {
        *own += by;
    }
    let (old, new) = (line.points[point.index], point.place);
    if !point.alone
        && let Some(at) = directed_point(point.index)
        && let Some(other) = (2 * at).checked_sub(point.index).filter(|other| *other < points.len())
    {
        let [old, new, opposite] = [old, new, points[other]].map(|place| place - points[at]);
        if old.normalize_or_zero().dot(opposite.normalize_or_zero()) < SMOOTH {
            let direction = new.try_normalize().unwrap_or(-opposite.normalize());
            points[other] = points[at] - direction * opposite.length();
        }
    }
    Some(points)
}
