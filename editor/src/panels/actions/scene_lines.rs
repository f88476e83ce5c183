//! Lines and paths of a scene: drawn, erased, followed.

use super::line_edit::{NO_PROJECT, lines_edit, lines_edit_of};
use super::scene_probe::{PointedSurface, pointer, surface_at};
use super::scene_text::{self, step};
use super::{motion_stroke, pose_line, tools};
use crate::control::line::{DrawnStroke, LineAnswer, LineSurface, LineUse};
use crate::control::{Button, InputEvent};
use crate::panels::request::Effect;
use crate::panels::scene::{
    ChangedThings, LINE_COLORS, LineEraser, LineRequest, NewThing, begin_text, color_text, line_name,
    line_named, no_place_text,
};
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::stage::gesture::{GestureRefusal, follow_path};
use dragonfly_anim::stage::line::{DrawnLine, DrawnLines, NewLine, path_points, points_text};
use dragonfly_anim::stage::splice::TextSplices;
use dragonfly_anim::stage::table::element;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_anim::stage::{PlannedThing, RigidPlace, StageTake};
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
        LineAnswer::Drawn(LineUse::Motion, stroke) => motion_stroke::draw(workspace, &stroke),
        LineAnswer::EraserDown(at) => {
            put_eraser(workspace, at);
            None
        }
        LineAnswer::EraserMoved(at) => {
            move_eraser(workspace, at);
            None
        }
        LineAnswer::EraserUp => erase(workspace),
        LineAnswer::NoPlace(surface) => {
            let text = no_place_text(surface, workspace.camera.camera().projection);
            workspace.say(MessageSeverity::Info, text);
            None
        }
    }
}

/// Executes a request about a line.
pub(super) fn perform(workspace: &mut Workspace, request: LineRequest) -> Option<Effect> {
    match request {
        LineRequest::Select(line) => {
            workspace.scene.select_line(line);
            None
        }
        LineRequest::Choose(lines, choice) => {
            workspace.scene.select_lines(&lines, choice);
            None
        }
        LineRequest::Rename(line) => {
            workspace.scene.lines_mut().rename(line);
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
            let effect = change_line(workspace, ScriptLabel::EraseLine, &line, DrawnLines::removed);
            if effect.is_some() && workspace.scene.lines().selected() == Some(&*line) {
                workspace.scene.select_line(None);
            }
            effect
        }
        LineRequest::UseAsPath(line) => {
            workspace.scene.select_line(Some(line));
            use_as_path(workspace)
        }
        LineRequest::NewColor(color) => {
            workspace.settings.tools.line_color = color;
            None
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
    let id = free_line_name(&scene)?;
    let mut points = stroke.control.clone();
    let on = |name: &str| ("on".to_owned(), name.to_owned());
    let mut attributes = match stroke.on {
        LineSurface::Ground => Vec::new(),
        LineSurface::View => vec![on("view")],
        LineSurface::Surface => vec![on("surface")],
        LineSurface::Bone => {
            let holder = workspace.stage.pressed_on().map(str::to_owned);
            let place = holder.as_deref().and_then(|of| place_of(workspace, of));
            let Some((of, place)) = holder.zip(place) else {
                let text = "Begin the line on the bone or thing with which it is to move";
                workspace.say(MessageSeverity::Info, text);
                return None;
            };
            let own = place.inverse();
            points.iter_mut().for_each(|point| *point = own.rotation * *point + own.position);
            vec![on("bone"), ("of".to_owned(), of)]
        }
    };
    let color = workspace.settings.tools.line_color;
    if color != LINE_COLORS[0].rgb {
        attributes.push(("color".to_owned(), color_text(color)));
    }
    let from = workspace.read().scene_time();
    let script = scene.script.as_ref().filter(|_| workspace.settings.tools.lines_from_playhead);
    let begin = script.filter(|_| from > StageTime::ZERO).map(|script| begin_text(from, script.rate()));
    attributes.extend(begin.iter().map(|begin| ("from".to_owned(), begin.clone())));
    let line = NewLine { id: Some(id.clone()), points, attributes };
    let effect = edit_lines(workspace, &scene, ScriptLabel::DrawLine, |lines| {
        // Notes of earlier times are shown up to this one.
        let is_before = |line: &DrawnLine| {
            begin.is_some() && line.shown[1].is_none() && line.shown[0].is_some_and(|start| start < from)
        };
        let before = lines.list().iter().enumerate().filter(|(_, line)| is_before(line));
        let ended = before.map(|(at, _)| lines.set(at, "to", begin.as_deref()));
        TextSplices::joined(ended.chain([lines.added(&line)]).collect::<Option<Vec<_>>>()?)
    });
    if effect.is_some() {
        workspace.scene.select_line(Some(id.into()));
    }
    effect
}

/// Notes what is under the pointer, for lines that follow it: when a button is pressed, and while a line on a surface is drawn. For all
/// lines, notes how high the ground is before they begin.
pub(super) fn follow_surface(workspace: &mut Workspace, event: InputEvent) {
    let line = workspace.tools.controls().line();
    let looks = matches!(event, InputEvent::MouseDown(Button::Left) | InputEvent::MouseMove(_));
    if line.use_of().is_some() && !line.is_drawing() && looks {
        let ground = workspace.read().scene().map_or(0.0, SceneView::ground);
        workspace.tools.controls_mut().line_mut().set_ground(ground);
    }
    let line = workspace.tools.controls().line();
    if line.use_of() != Some(LineUse::Note) || line.note_surface() == LineSurface::Ground {
        return;
    }
    let at = match event {
        InputEvent::MouseDown(Button::Left) if !line.is_drawing() || line.follows_surfaces() => {
            pointer(workspace)
        }
        InputEvent::MouseMove(to) if line.is_drawing() && line.follows_surfaces() => {
            Some(egui::pos2(to.x, to.y))
        }
        _ => return,
    };
    let surface = at.and_then(|at| surface_at(workspace, at, &[]));
    let is_first = !workspace.tools.controls().line().is_drawing();
    if is_first {
        workspace.stage.press_on(surface.as_ref().map(PointedSurface::name));
        let target = workspace.camera.camera().target.as_dvec3();
        workspace.tools.controls_mut().line_mut().set_pivot(target);
    }
    workspace.tools.controls_mut().line_mut().set_hit(surface.map(|surface| surface.place));
}

/// Returns the place of a thing or a bone at the time shown, by its name in scripts.
pub(super) fn place_of(workspace: &mut Workspace, name: &str) -> Option<RigidPlace> {
    let plan = workspace.model.view()?.scene.as_ref()?.plan.clone()?;
    let time = workspace.read().scene_time();
    plan.place_of_name(name, workspace.stage.things_at(&plan, time))
}

/// Returns the place of what the selected line moves with, at the time shown; `None` where it moves with nothing that is there.
pub(super) fn place_of_selected(workspace: &mut Workspace) -> Option<RigidPlace> {
    let scene = workspace.model.view()?.scene.clone()?;
    let lines = scene.lines.as_ref()?;
    let line = &lines.list()[line_named(lines, workspace.scene.lines().selected()?)?];
    let of = line.of.as_deref().filter(|of| !of.is_empty())?;
    place_of(workspace, of)
}

/// Begins to erase the lines that are shown now.
fn put_eraser(workspace: &mut Workspace, at: Vec2) {
    *workspace.scene.lines_mut().eraser_mut() = seen_lines(workspace, at);
    move_eraser(workspace, at);
}

/// Returns the lines that are not hidden, as they are seen from a position of the viewport; `None` where none are shown.
pub(super) fn seen_lines(workspace: &mut Workspace, at: Vec2) -> Option<LineEraser> {
    let lines = workspace.read().scene().and_then(|scene| scene.lines.clone());
    let view = GizmoView::new(workspace.camera.camera(), workspace.tools.controls().picture().size);
    lines.filter(|_| workspace.settings.look.lines).map(|lines| {
        let named = lines.list().iter().enumerate();
        let seen = named.filter(|(index, line)| !workspace.scene.lines().is_hidden(&line_name(*index, line)));
        let seen: Vec<usize> = seen.map(|(index, _)| index).collect();
        let placed = seen.into_iter().filter_map(|index| {
            match lines.list()[index].of.as_deref().filter(|of| !of.is_empty()) {
                Some(of) => Some((index, Some(place_of(workspace, of)?))),
                None => Some((index, None)),
            }
        });
        let placed: Vec<(usize, Option<RigidPlace>)> = placed.collect();
        LineEraser::new(lines, &placed, view, at.as_dvec2())
    })
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
            workspace.scene.select_line(new.map(Into::into));
            if let Some(new) = new {
                workspace.scene.lines_mut().renamed(old, new);
            }
            Some(Effect::Change(Change::Edit(Edit::EditScript(edit), None)))
        }
        Err(reason) => {
            workspace.say(MessageSeverity::Info, reason);
            None
        }
    }
}

/// Adds a copy of the selected line to the project, and selects it.
pub(super) fn duplicate(workspace: &mut Workspace) -> Option<Effect> {
    let scene = Arc::clone(workspace.model.view()?.scene.as_ref()?);
    let name = workspace.scene.lines().selected().map(str::to_owned)?;
    let id = free_line_name(&scene)?;
    let effect = edit_lines(workspace, &scene, ScriptLabel::Duplicate, |lines| {
        let own = &lines.list()[line_named(lines, &name)?];
        let written = lines.tree().elements()[own.element].attributes.iter();
        let others = written.filter(|attribute| !matches!(attribute.row.name, "id" | "points"));
        let attributes = others.map(|one| (one.row.name.to_owned(), one.value.to_string())).collect();
        lines.added(&NewLine { id: Some(id.clone()), points: own.points.clone(), attributes })
    });
    if effect.is_some() {
        workspace.scene.select_line(Some(id.into()));
    }
    effect
}

/// Returns a name that no line has.
fn free_line_name(scene: &SceneView) -> Option<String> {
    let taken = |id: &str| scene.lines.as_ref().is_some_and(|lines| lines.called(id).is_some());
    (1_u32..).map(|number| format!("line-{number}")).find(|id| !taken(id))
}

/// Deletes the selected lines.
pub(in crate::panels) fn delete(workspace: &mut Workspace) -> Option<Effect> {
    let names = workspace.scene.lines().selected_list().to_vec();
    if names.is_empty() {
        workspace.say(MessageSeverity::Info, "No line is selected");
        return None;
    }
    let scene = Arc::clone(workspace.model.view()?.scene.as_ref()?);
    let effect = edit_lines(workspace, &scene, ScriptLabel::EraseLine, |lines| {
        // A name may be gone, by undo or by the eraser.
        let there = names.iter().filter_map(|name| line_named(lines, name));
        TextSplices::joined(there.map(|line| lines.removed(line)).collect::<Option<Vec<_>>>()?)
    });
    if effect.is_some() {
        workspace.scene.select_line(None);
    }
    effect
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

/// Lets the selected role, camera or other thing that moves follow the selected path from the playhead on. Of several, those that were selected last.
pub(in crate::panels) fn walk_along(workspace: &mut Workspace) -> Option<Effect> {
    let at = workspace.read().scene_time();
    let selected = workspace.scene.things().to_vec();
    step(workspace, |base| {
        let found =
            selected.iter().rev().filter_map(|id| base.plan.things().get(base.plan.thing_called(id)?));
        let things: Vec<&PlannedThing> = found.collect();
        let path = things.iter().find(|thing| thing.kind == "path");
        let moves = |thing: &&&PlannedThing| element("move").is_some_and(|row| row.who.contains(&thing.kind));
        let (Some(path), Some(role)) = (path, things.iter().find(moves)) else {
            return Err(GestureRefusal(
                "Select a path, and a role or a camera that is to follow it".to_owned(),
            ));
        };
        let takes = role.model.as_ref().map_or(&[][..], |model| model.takes());
        let name = |take: &StageTake| take.name().to_owned();
        let walks = takes.iter().map(name).find(|name| name.to_lowercase().contains("walk"));
        let text = follow_path(&base.scene(), &role.id, &path.id, walks.as_deref(), at)?;
        Ok(base.step(text, ScriptLabel::AddMove, ChangedThings::Thing(&role.id)))
    })
}

/// Makes a project of the script that is open.
pub(in crate::panels) fn project_from_scene(workspace: &mut Workspace) -> Option<Effect> {
    let is_project = workspace.read().scene().is_some_and(|scene| scene.project.is_some());
    // The models that it lists are those of the file.
    let saved = workspace.model.view().filter(|view| view.history.saved);
    let path = saved.and_then(|view| view.file.path.clone());
    match path.filter(|_| !is_project) {
        Some(path) => Some(Effect::NewProject(path)),
        None => {
            let text = if is_project {
                "The scene belongs to a project already"
            } else {
                "Save the scene first: the project is made of its file"
            };
            workspace.say(MessageSeverity::Info, text);
            None
        }
    }
}
