//! The scale of the window's content.

use crate::panels::settings::SCALES;
use crate::panels::workspace::Workspace;

/// Sets the scale of the window's content, in steps of a twentieth.
pub(in crate::panels) fn set_scale(workspace: &mut Workspace, scale: f32) {
    let steps = (scale * 20.0).round() / 20.0;
    workspace.settings.scale = steps.clamp(*SCALES.start(), *SCALES.end());
}

/// Changes the scale of the window's content.
pub(in crate::panels) fn scale_by(workspace: &mut Workspace, by: f32) {
    let scale = workspace.settings.scale + by;
    set_scale(workspace, scale);
}
