//! Undo and redo: of what is hidden and locked in a scene, of selections where that is wanted, and of steps of the history.

use crate::panels::request::Effect;
use crate::panels::selection_trail::WalkDirection;
use crate::panels::workspace::Workspace;
use dragonfly_document::Change;

/// Undoes what was hidden or locked since the last step, or the last selection, if undo includes selections and one was made since, otherwise the last step.
pub(in crate::panels) fn undo(workspace: &mut Workspace) -> Option<Effect> {
    if walk(workspace, WalkDirection::Back) { None } else { Some(Effect::Change(Change::Undo)) }
}

/// Redoes the selection or the step that was undone last.
pub(in crate::panels) fn redo(workspace: &mut Workspace) -> Option<Effect> {
    if walk(workspace, WalkDirection::Forward) { None } else { Some(Effect::Change(Change::Redo)) }
}

/// Switches whether undo includes selections.
pub(in crate::panels) fn toggle_selections(workspace: &mut Workspace) {
    workspace.settings.undo_selections ^= true;
    workspace.trail.clear();
}

/// Notes the present selection if it changed since the last frame. During a drag it is not noted.
pub(in crate::panels) fn follow_selection(workspace: &mut Workspace) {
    if !workspace.settings.undo_selections || workspace.dragging.is_open() || workspace.keys.is_dragging() {
        return;
    }
    let Some(done) = workspace.model.view().map(|view| view.history.done) else { return };
    if workspace.trail.last().is_some_and(|last| workspace.is_selected(last)) {
        workspace.trail.move_to(done);
    } else {
        let selection = workspace.selection_state();
        workspace.trail.note(done, selection);
    }
}

fn walk(workspace: &mut Workspace, direction: WalkDirection) -> bool {
    follow_selection(workspace);
    let Some(done) = workspace.model.view().map(|view| view.history.done) else { return false };
    if workspace.read().scene().is_some() && workspace.scene.walk_hiding(done, direction) {
        return true;
    }
    let Some(selection) = workspace.trail.walk(done, direction) else { return false };
    workspace.restore_selection(&selection);
    true
}
