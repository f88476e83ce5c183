//! The scope of edits, and its falloff.

use crate::panels::edit_scope::{EditOver, EditScope, FalloffSettings, shape_title};
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;

/// Sets the scope of edits.
pub(in crate::panels) fn set(workspace: &mut Workspace, scope: EditScope) {
    workspace.over.scope = scope;
    let text = match scope {
        EditScope::Frame => "Edits apply to this frame",
        EditScope::Keys => "Edits apply to the selected keys",
        EditScope::Range if workspace.keys.range().is_none() => {
            "Edits apply to the play range, which is the whole take as long as none is set"
        }
        EditScope::Range => "Edits apply to the play range",
        EditScope::Take => "Edits apply to the whole take",
    };
    workspace.say(MessageSeverity::Info, text);
}

/// Sets the scope after the present one.
pub(in crate::panels) fn next(workspace: &mut Workspace) {
    set(workspace, workspace.over.scope.next());
}

/// Returns to this frame: another model is open.
pub(super) fn reset(workspace: &mut Workspace) {
    workspace.over = EditOver::default();
}

/// Turns the falloff on or off.
pub(in crate::panels) fn toggle_falloff(workspace: &mut Workspace) {
    workspace.over.falloff = !workspace.over.falloff;
    say_falloff(workspace);
}

/// Sets the size of the falloff.
pub(super) fn set_falloff(workspace: &mut Workspace, falloff: FalloffSettings) {
    workspace.settings.falloff = falloff.sanitized();
}

/// Makes the falloff wider or narrower by some frames.
pub(in crate::panels) fn widen(workspace: &mut Workspace, by: i64) {
    let frames = i64::from(workspace.settings.falloff.frames).saturating_add(by).max(1) as u32;
    set_falloff(workspace, FalloffSettings { frames, ..workspace.settings.falloff });
    say_falloff(workspace);
}

/// Switches to the next shape of the falloff.
pub(in crate::panels) fn next_shape(workspace: &mut Workspace) {
    set_falloff(workspace, workspace.settings.falloff.next_shape());
    say_falloff(workspace);
}

fn say_falloff(workspace: &mut Workspace) {
    let FalloffSettings { frames, shape } = workspace.settings.falloff;
    let size = format!("{frames} frames, {}", shape_title(shape).to_lowercase());
    let text = match (workspace.over.falloff, workspace.over.scope) {
        (false, _) => format!("Falloff is off ({size})"),
        (true, EditScope::Frame | EditScope::Take) => {
            format!("Falloff is on ({size}): it applies to edits of selected keys and of the play range")
        }
        (true, EditScope::Keys | EditScope::Range) => format!("Falloff is on: {size}"),
    };
    workspace.say(MessageSeverity::Info, text);
}
