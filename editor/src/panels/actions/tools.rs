//! The tools of the viewport: which one is active, where the gizmo is, the motion path.

use super::{ik, locks, playback, scene_gizmo};
use crate::control::Catch;
use crate::panels::motion_path::PathOf;
use crate::panels::overlay::Overlay;
use crate::panels::status::MessageSeverity;
use crate::panels::tool_state::PlacedGizmo;
use crate::panels::workspace::Workspace;
use dragonfly_anim::motion::guess_hips;
use dragonfly_picture::gizmo::{GizmoSettings, GizmoSpace, Tool};
use std::sync::Arc;
use std::time::Instant;

/// Chooses the transformation of the gizmo, or only to select. Drawing lines ends.
pub(in crate::panels) fn choose(workspace: &mut Workspace, tool: Option<Tool>) {
    workspace.tools.controls_mut().line_mut().choose(None);
    workspace.settings.tools.tool = tool;
}

/// Switches to the next axes: the bone's, its parent's, the scene's, the view's.
pub(in crate::panels) fn next_space(workspace: &mut Workspace) {
    let space = &mut workspace.settings.tools.space;
    *space = match *space {
        GizmoSpace::Local => GizmoSpace::Parent,
        GizmoSpace::Parent => GizmoSpace::World,
        GizmoSpace::World => GizmoSpace::View,
        GizmoSpace::View => GizmoSpace::Local,
    };
}

/// Selects in a box or lasso with the next drag.
pub(in crate::panels) fn arm(workspace: &mut Workspace, catch: Catch) {
    workspace.tools.controls_mut().picture_mut().arm(catch);
}

/// Begins to drag from where the mouse is, without a button.
pub(in crate::panels) fn drag_now(workspace: &mut Workspace, tool: Tool) {
    if workspace.tools.controls().is_busy() {
        return;
    }
    workspace.settings.tools.tool = Some(tool);
    let time = workspace.player.time();
    playback::stop_at(workspace, time);
    sync_gizmo(workspace);
    workspace.tools.controls_mut().look(workspace.camera.camera());
    if !workspace.tools.controls().gizmo().editable {
        workspace.tools.refuse_drag(Instant::now());
        return say_refused(workspace);
    }
    if !workspace.tools.controls_mut().begin_by_key() {
        workspace.say(MessageSeverity::Info, "The selection is behind the camera");
    }
    // Nothing is changed before the mouse moves.
    workspace.tools.controls_mut().gizmo_mut().take_answer();
    if workspace.tools.controls().edits() {
        begin_following(workspace);
    }
}

/// Places the gizmo at the selected bones, in the pose that is shown. Does nothing if nothing changed; a drag keeps its
/// place.
pub(super) fn sync_gizmo(workspace: &mut Workspace) {
    workspace.tools.controls_mut().look(workspace.camera.camera());
    let mut bones = workspace.tools.spare_list();
    let panels = workspace.read();
    bones.extend(panels.bones_to_pose());
    let Some(view) = workspace.model.view() else { return };
    let hand = &panels.settings.tools;
    let settings = GizmoSettings {
        space: hand.space,
        pivot: hand.pivot,
        curl: hand.curl,
        ..panels.tools.controls().gizmo().gizmo.settings
    };
    let (take, active, flags) = (panels.playback.take, panels.selected(), panels.keys.flags());
    let refused = panels.scope_refusal().is_some();
    let editable = take.is_some() && !panels.selection_is_locked() && !refused;
    let free = active.is_none_or(|bone| !flags.locked(bone));
    let placement = PlacedGizmo {
        generation: view.generation,
        take,
        time: panels.time(),
        tool: hand.tool,
        settings,
        bones,
        active,
        flags: flags.version(),
        refused,
    };
    let path_editable = take.is_some() && free && !refused;
    if view.scene.is_some() {
        return scene_gizmo::sync(workspace, placement);
    }
    workspace.tools.sync_gizmo(view, &mut workspace.posed, placement, editable, path_editable);
}

/// Computes the motion path again where something changed that it is computed from.
pub(super) fn update_path(workspace: &mut Workspace) {
    // The dialog for root motion shows the way of the hips on the ground.
    let ground = workspace.prompts.overlay() == Some(Overlay::RootMotion);
    let view = workspace.model.view();
    let bone = match view.filter(|_| ground) {
        Some(view) => guess_hips(&view.loaded.model.animation.skeleton),
        None => workspace.bones.active(),
    };
    let source = view.zip(workspace.player.take()).zip(bone);
    let changed = match source.filter(|_| ground || workspace.settings.tools.path) {
        Some(((view, take), bone)) => {
            let (rate, flags) = (workspace.frame_rate.get(), workspace.keys.flags());
            workspace.tools.path_mut().update(view, take, PathOf { bone, ground }, rate, flags)
        }
        None => workspace.tools.path_mut().clear(),
    };
    if changed {
        workspace.tools.show_path_keys();
    }
}

/// Gives the points of selected paths and lines to the control that drags them; none while lines are hidden.
pub(super) fn show_points(workspace: &mut Workspace) {
    let points = match workspace.settings.look.lines {
        true => Arc::clone(workspace.scene.lines().points()),
        false => Arc::default(),
    };
    workspace.tools.controls_mut().points_mut().show_points(&points);
}

/// Reports why a pose cannot be changed.
pub(super) fn say_refused(workspace: &mut Workspace) {
    if workspace.read().scene().is_some() {
        return scene_gizmo::say_refused(workspace);
    }
    if let Some(bone) = workspace.bones.active().filter(|_| workspace.player.take().is_some()) {
        return match workspace.read().scope_refusal().filter(|_| !workspace.read().selection_is_locked()) {
            Some(reason) => workspace.say(MessageSeverity::Warning, reason),
            None => locks::say_locked(workspace, bone),
        };
    }
    workspace.say(MessageSeverity::Info, "The rest pose cannot be edited: show a take first");
}

/// Records the poses at the start of a drag of the gizmo. Does nothing during the drag.
pub(super) fn begin_following(workspace: &mut Workspace) {
    if workspace.tools.drag().is_undecided() {
        let hold = if workspace.read().bones_follow() { ik::hold(workspace) } else { None };
        workspace.tools.drag_mut().follow(hold);
    }
}
