//! The state of a scene that is kept when its file is read again, and while one of its models is edited.

use super::playback;
use crate::panels::scene::SceneEditing;
use crate::panels::workspace::Workspace;
use dragonfly_picture::ThroughCamera;
use dragonfly_picture::camera::Camera;
use std::path::PathBuf;

/// The state of the panels when a scene was left.
#[derive(Debug)]
pub(in crate::panels) struct LeftScene {
    /// The file of the scene.
    path: PathBuf,
    editing: SceneEditing,
    time: f32,
    is_playing: bool,
    /// The free camera, where the scene had been framed.
    camera: Option<Camera>,
    through: ThroughCamera,
}

impl LeftScene {
    /// Notes the state of the scene that is shown; `None` while a model is, and for a scene without a file.
    pub(super) fn of(workspace: &Workspace) -> Option<Self> {
        let view = workspace.model.view().filter(|view| view.scene.is_some())?;
        Some(Self {
            path: view.file.path.clone()?,
            editing: workspace.scene.left(),
            time: workspace.player.time(),
            is_playing: workspace.player.is_playing(),
            camera: workspace.stage.is_framed().then(|| *workspace.camera.free()),
            through: workspace.camera.through().clone(),
        })
    }

    /// Returns whether it is the scene that is shown now.
    pub(super) fn is_shown(&self, workspace: &Workspace) -> bool {
        let view = workspace.model.view().filter(|view| view.scene.is_some());
        view.is_some_and(|view| view.file.path.as_ref() == Some(&self.path))
    }

    /// Restores the state, after the scene was opened from its start. What is gone is not selected any more.
    pub(super) fn restore(self, workspace: &mut Workspace) {
        workspace.scene = self.editing;
        super::scene::follow(workspace, 0);
        if let Some(camera) = self.camera {
            workspace.stage.set_framed();
            workspace.camera.set_free(camera);
        }
        workspace.camera.set_through(self.through);
        let (start, length) = workspace.read().scene_bounds().unwrap_or((0.0, f32::MAX));
        playback::seek(workspace, self.time.clamp(start, start + length));
        workspace.player.set_playing(self.is_playing, workspace.settings.speed, workspace.settings.repeat);
    }
}
