//! Drawn lines that are selected by a click in the viewport.

use super::scene_lines::seen_lines;
use crate::panels::scene::line_name;
use crate::panels::workspace::Workspace;
use dragonfly_document::bones::Choice;
use egui::Pos2;
use glam::Vec2;

/// Selects the line under a click: replaces, adds or toggles it. Returns whether there is one. Lines are thin, so they are preferred to things that are farther away.
pub(super) fn pick(workspace: &mut Workspace, at: Pos2, choice: Choice) -> bool {
    let place = Vec2::new(at.x, at.y) - workspace.tools.controls().picture().corner;
    let time = workspace.read().scene_time();
    let name = seen_lines(workspace, place).and_then(|lines| {
        let index = lines.nearest(time)?;
        Some(line_name(index, lines.hits().0.list().get(index)?))
    });
    let Some(name) = name else { return false };
    workspace.stage.forget_click();
    workspace.scene.select_lines(&[name], choice);
    true
}
