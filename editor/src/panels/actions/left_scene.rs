//! Leaving a scene and returning to it: its file is read again, or one of its models is edited.

use super::{keys, playback, scene};
use crate::panels::scene::LeftScene;
use crate::panels::workspace::Workspace;
use dragonfly_picture::between;

/// Notes the state of the scene that is shown; `None` while a model is, and for a scene without a file.
pub(super) fn leave(workspace: &Workspace) -> Option<LeftScene> {
    let view = workspace.model.view().filter(|view| view.scene.is_some())?;
    Some(LeftScene {
        path: view.file.path.clone()?,
        editing: workspace.scene.left(),
        time: workspace.player.time(),
        range: workspace.keys.range(),
        is_playing: workspace.player.is_playing(),
        camera: workspace.stage.is_framed().then(|| *workspace.camera.free()),
        through: workspace.camera.through().clone(),
        other: workspace.camera.other().cloned(),
    })
}

/// Returns whether it is the scene that is shown now.
pub(super) fn is_shown(left: &LeftScene, workspace: &Workspace) -> bool {
    let view = workspace.model.view().filter(|view| view.scene.is_some());
    view.is_some_and(|view| view.file.path.as_ref() == Some(&left.path))
}

/// Restores the state, after the scene was opened from its start. Things that are gone are not selected any more.
pub(super) fn restore(left: LeftScene, workspace: &mut Workspace) {
    workspace.scene.resume(left.editing);
    scene::follow(workspace, 0);
    if let Some(camera) = left.camera {
        workspace.stage.set_framed();
        workspace.camera.set_free(camera);
    }
    workspace.camera.set_through(left.through);
    workspace.camera.set_other(left.other);
    keys::set_range(workspace, left.range);
    let (start, length) = workspace.read().scene_bounds().unwrap_or((0.0, f32::MAX));
    playback::seek(workspace, between(left.time, start, start + length));
    workspace.player.set_playing(left.is_playing, workspace.settings.speed, workspace.settings.repeat);
}
