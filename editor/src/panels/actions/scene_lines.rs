//! Lines and paths of a scene: drawn, erased, followed.

use super::line_edit::{NO_PROJECT, lines_edit, lines_edit_of};
use super::scene_text::{self, gesture};
use super::{pose_line, tools};
use crate::control::line::{DrawnStroke, LineAnswer, LineSurface, LineUse};
use crate::panels::request::Effect;
use crate::panels::scene::{LineEraser, LineRequest, NewThing, line_name, line_named};
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::stage::gesture::{GestureRefusal, follow_path};
use dragonfly_anim::stage::line::{DrawnLine, DrawnLines, NewLine, path_points, points_text};
use dragonfly_anim::stage::splice::TextSplices;
use dragonfly_anim::stage::{PlannedThing, StageTake};
use dragonfly_document::edit::{Edit, EditScript, ScriptLabel};
use dragonfly_document::{Change, SceneView, paths_of_renamed_line};
use dragonfly_picture::gizmo::GizmoView;
use glam::Vec2;
use std::sync::Arc;

/// Least distance by which a path may differ from the stroke, meters.
const PATH_TOLERANCE: f64 = 0.01;

/// Begins to draw lines or paths; a second time ends it.
pub(in crate::panels) fn choose(workspace: &mut Workspace, use_of: LineUse) {
    let is_on = workspace.tools.controls().line().use_of() == Some(use_of);
    if is_on {
        return workspace.tools.controls_mut().line_mut().choose(None);
    }
    let has_project = workspace.read().scene().is_some_and(|scene| scene.project.is_some());
    if use_of == LineUse::Note && !has_project {
        let text = format!("{NO_PROJECT}. A path can be drawn without one");
        return workspace.say(MessageSeverity::Info, text);
    }
    let target = workspace.camera.camera().target.as_dvec3();
    let line = workspace.tools.controls_mut().line_mut();
    line.set_pivot(target);
    line.choose(Some(use_of));
    tools::sync_gizmo(workspace);
}

/// Carries out what the tool that draws lines asks for.
pub(super) fn answered(workspace: &mut Workspace, answer: LineAnswer) -> Option<Effect> {
    match answer {
        LineAnswer::Drawn(LineUse::Path, stroke) => draw_path(workspace, &stroke),
        LineAnswer::Drawn(LineUse::Note, stroke) => draw_note(workspace, &stroke),
        LineAnswer::Drawn(LineUse::Pose, stroke) => pose_line::pose(workspace, &stroke),
        LineAnswer::EraserDown(at) => {
            put_eraser(workspace, at);
            None
        }
        LineAnswer::EraserMoved(at) => {
            move_eraser(workspace, at);
            None
        }
        LineAnswer::EraserUp => erase(workspace),
        LineAnswer::NoGround => {
            workspace.say(MessageSeverity::Info, "There is no ground above the horizon");
            None
        }
    }
}

/// Executes a request about a line.
pub(super) fn perform(workspace: &mut Workspace, request: LineRequest) -> Option<Effect> {
    match request {
        LineRequest::Select(line) => {
            workspace.scene.lines_mut().select(line);
            None
        }
        LineRequest::Hide(line, hide) => {
            workspace.scene.lines_mut().hide(line, hide);
            None
        }
        LineRequest::Set(line, attribute, value) => {
            if attribute == "id" {
                return rename(workspace, &line, value.as_deref());
            }
            change_line(workspace, ScriptLabel::ChangeValue, &line, |lines, at| {
                lines.set(at, attribute, value.as_deref())
            })
        }
        LineRequest::Delete(line) => {
            change_line(workspace, ScriptLabel::EraseLine, &line, DrawnLines::removed)
        }
        LineRequest::UseAsPath(line) => {
            workspace.scene.lines_mut().select(Some(line));
            use_as_path(workspace)
        }
    }
}

/// Adds a path along a stroke to the cast.
fn draw_path(workspace: &mut Workspace, stroke: &DrawnStroke) -> Option<Effect> {
    let is_smooth = stroke.corners.is_empty();
    let points = match is_smooth {
        true => path_points(&stroke.control, PATH_TOLERANCE.max(2.0 * stroke.unit)),
        false => stroke.corners.clone(),
    };
    scene_text::add(workspace, &NewThing::DrawnPath(points_text(&points)?, is_smooth && points.len() > 2))
}

/// Adds a line to the project.
fn draw_note(workspace: &mut Workspace, stroke: &DrawnStroke) -> Option<Effect> {
    let scene = Arc::clone(workspace.model.view()?.scene.as_ref()?);
    let taken = |id: &str| scene.lines.as_ref().is_some_and(|lines| lines.called(id).is_some());
    let id = (1_u32..).map(|number| format!("line-{number}")).find(|id| !taken(id))?;
    let attributes = match stroke.on {
        LineSurface::Ground => Vec::new(),
        LineSurface::View => vec![("on".to_owned(), "view".to_owned())],
    };
    let line = NewLine { id: Some(id.clone()), points: stroke.control.clone(), attributes };
    let effect = edit_lines(workspace, &scene, ScriptLabel::DrawLine, |lines| lines.added(&line));
    if effect.is_some() {
        workspace.scene.lines_mut().select(Some(id.into()));
    }
    effect
}

/// Begins to erase the lines that are shown now.
fn put_eraser(workspace: &mut Workspace, at: Vec2) {
    let lines = workspace.read().scene().and_then(|scene| scene.lines.clone());
    let view = GizmoView::new(workspace.camera.camera(), workspace.tools.controls().picture().size);
    let is_hidden = |index, line: &DrawnLine| workspace.scene.lines().is_hidden(&line_name(index, line));
    let eraser = lines
        .filter(|_| workspace.settings.look.lines)
        .map(|lines| LineEraser::new(lines, is_hidden, view, at.as_dvec2()));
    *workspace.scene.lines_mut().eraser_mut() = eraser;
    move_eraser(workspace, at);
}

/// Notes the lines that the eraser touches on its way to a position.
fn move_eraser(workspace: &mut Workspace, at: Vec2) {
    let view = GizmoView::new(workspace.camera.camera(), workspace.tools.controls().picture().size);
    let time = workspace.read().scene_time();
    if let Some(eraser) = workspace.scene.lines_mut().eraser_mut() {
        eraser.move_to(at.as_dvec2(), &view, time);
    }
}

/// Removes the lines that the eraser touched.
fn erase(workspace: &mut Workspace) -> Option<Effect> {
    let eraser = workspace.scene.lines_mut().eraser_mut().take()?;
    let scene = Arc::clone(workspace.model.view()?.scene.as_ref()?);
    let (lines, found) = eraser.hits();
    if found.is_empty() {
        return None;
    }
    if !scene.lines.as_ref().is_some_and(|now| Arc::ptr_eq(now, lines)) {
        workspace.say(MessageSeverity::Info, "The lines have changed meanwhile: try again");
        return None;
    }
    edit_lines(workspace, &scene, ScriptLabel::EraseLine, |lines| {
        let all: Option<Vec<TextSplices>> = found.iter().map(|&at| lines.removed(at)).collect();
        TextSplices::joined(all?)
    })
}

/// Changes the line with this name.
fn change_line(
    workspace: &mut Workspace,
    label: ScriptLabel,
    name: &str,
    change: impl FnOnce(&DrawnLines, usize) -> Option<TextSplices>,
) -> Option<Effect> {
    let scene = Arc::clone(workspace.model.view()?.scene.as_ref()?);
    edit_lines(workspace, &scene, label, |lines| change(lines, line_named(lines, name)?))
}

/// Gives a line another name, and the paths that follow it too.
fn rename(workspace: &mut Workspace, old: &str, new: Option<&str>) -> Option<Effect> {
    const LABEL: ScriptLabel = ScriptLabel::Rename;
    let scene = Arc::clone(workspace.model.view()?.scene.as_ref()?);
    // Without a name it cannot be followed.
    let renamed = new.map(|_| old);
    let edit = lines_edit_of(&scene, LABEL, renamed, |lines| lines.set(line_named(lines, old)?, "id", new));
    let also = new.map_or(Ok(Vec::new()), |new| paths_of_renamed_line(&scene, old, new, LABEL));
    match edit.and_then(|edit| Ok(EditScript { also: also?, ..edit })) {
        Ok(edit) => {
            workspace.scene.lines_mut().select(new.map(Into::into));
            Some(Effect::Change(Change::Edit(Edit::EditScript(edit), None)))
        }
        Err(reason) => {
            workspace.say(MessageSeverity::Info, reason);
            None
        }
    }
}

/// Deletes the selected line.
pub(in crate::panels) fn delete(workspace: &mut Workspace) -> Option<Effect> {
    match workspace.scene.lines().selected().map(Box::from) {
        Some(line) => perform(workspace, LineRequest::Delete(line)),
        None => {
            workspace.say(MessageSeverity::Info, "No line is selected");
            None
        }
    }
}

/// Returns the edit of the file of lines; a project without one gets it in the same step.
fn edit_lines(
    workspace: &mut Workspace,
    scene: &SceneView,
    label: ScriptLabel,
    change: impl FnOnce(&DrawnLines) -> Option<TextSplices>,
) -> Option<Effect> {
    match lines_edit(scene, label, change) {
        Ok(edit) => Some(Effect::Change(Change::Edit(Edit::EditScript(edit), None))),
        Err(reason) => {
            workspace.say(MessageSeverity::Info, reason);
            None
        }
    }
}

/// Adds a path along the selected line to the cast, and selects it.
pub(in crate::panels) fn use_as_path(workspace: &mut Workspace) -> Option<Effect> {
    let scene = Arc::clone(workspace.model.view()?.scene.as_ref()?);
    let selected = workspace.scene.lines().selected().map(str::to_owned);
    let line = selected.and_then(|name| {
        let lines = scene.lines.as_ref()?;
        Some(lines.list()[line_named(lines, &name)?].id.as_deref().map(str::to_owned))
    });
    match line {
        Some(Some(id)) => scene_text::add(workspace, &NewThing::LinePath(id)),
        Some(None) => {
            workspace.say(MessageSeverity::Info, "The line needs a name first: rename it in the list");
            None
        }
        None => {
            workspace.say(MessageSeverity::Info, "No line is selected");
            None
        }
    }
}

/// Lets the selected role follow the selected path from the playhead on. Of several roles or paths, those that were selected last.
pub(in crate::panels) fn walk_along(workspace: &mut Workspace) -> Option<Effect> {
    let at = workspace.read().scene_time();
    let selected = workspace.scene.things().to_vec();
    gesture(workspace, ScriptLabel::AddClip, |base| {
        let found =
            selected.iter().rev().filter_map(|id| base.plan.things().get(base.plan.thing_called(id)?));
        let things: Vec<&PlannedThing> = found.collect();
        let path = things.iter().find(|thing| thing.kind == "path");
        let role = things.iter().find(|thing| matches!(thing.kind, "role" | "prop"));
        let (Some(path), Some(role)) = (path, role) else {
            return Err(GestureRefusal("Select a role and a path".to_owned()));
        };
        let takes = role.model.as_ref().map_or(&[][..], |model| model.takes());
        let name = |take: &StageTake| take.name().to_owned();
        let walks = takes.iter().map(name).find(|name| name.to_lowercase().contains("walk"));
        follow_path(&base.scene(), &role.id, &path.id, walks.as_deref(), at)
    })
}

/// Makes a project of the script that is open.
pub(in crate::panels) fn project_from_scene(workspace: &mut Workspace) -> Option<Effect> {
    let is_project = workspace.read().scene().is_some_and(|scene| scene.project.is_some());
    let path = workspace.model.view().and_then(|view| view.file.path.clone());
    match path.filter(|_| !is_project) {
        Some(path) => Some(Effect::NewProject(path)),
        None => {
            let text =
                if is_project { "The scene belongs to a project already" } else { "Save the scene first" };
            workspace.say(MessageSeverity::Info, text);
            None
        }
    }
}
