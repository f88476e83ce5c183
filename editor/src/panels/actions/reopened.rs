//! The state that is kept when the file of the open model is read again: the take by its name, the playhead, the selected bones by their names, and the camera.

use super::playback;
use crate::panels::workspace::Workspace;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::View;
use dragonfly_document::bones::Choice;
use dragonfly_picture::camera::Camera;

/// The state of the panels before the open file was read again.
#[derive(Debug)]
pub(super) struct BeforeReload {
    /// Name of the take that was shown; `None` for the rest pose.
    take: Option<String>,
    time: f32,
    is_playing: bool,
    /// Names of the selected bones, in the order of selection.
    bones: Vec<String>,
    /// `None` where the file is read with other units or axes, so that the model is elsewhere.
    camera: Option<Camera>,
}

impl BeforeReload {
    /// Notes the state before `view` is shown; `None` where it is of another file than the one that is open, and for a scene.
    pub(super) fn of(workspace: &Workspace, view: &View) -> Option<Self> {
        let before = workspace.model.view().filter(|before| before.scene.is_none())?;
        let is_same = before.file.path.is_some() && before.file.path == view.file.path;
        if !is_same {
            return None;
        }
        let take = workspace.player.take().and_then(|take| before.takes.get(take));
        let bones = &before.loaded.model.animation.skeleton.bones;
        let name = |&bone: &BoneIndex| bones.get(bone as usize).map(|bone| bone.name.clone());
        let same_space = before.loaded.conversion == view.loaded.conversion;
        Some(Self {
            take: take.map(|take| take.name.clone()),
            time: workspace.player.time(),
            is_playing: workspace.player.is_playing(),
            bones: workspace.bones.bones().iter().filter_map(name).collect(),
            camera: same_space.then(|| *workspace.camera.camera()),
        })
    }

    /// Restores the state in the model that is shown now. A take that is gone is replaced by the one that a new file would show, and
    /// bones that are gone are not selected.
    pub(super) fn restore(self, workspace: &mut Workspace) {
        let Some(view) = workspace.model.view() else { return };
        let skeleton = &view.loaded.model.animation.skeleton;
        let bones: Vec<BoneIndex> = self.bones.iter().filter_map(|name| skeleton.find(name)).collect();
        let take = self.take.as_ref().map(|name| view.takes.iter().position(|take| take.name == *name));
        workspace.bones.choose(&bones, Choice::Replace);
        match take {
            Some(None) => {}
            Some(take @ Some(_)) => {
                playback::show_take(workspace, take);
                let (start, length) = workspace.read().take_bounds();
                workspace.player.seek(self.time.max(start).min(start + length));
            }
            None => playback::show_take(workspace, None),
        }
        workspace.player.set_playing(self.is_playing, workspace.settings.speed, workspace.settings.repeat);
        if let Some(camera) = self.camera {
            workspace.camera.set_camera(camera);
        }
    }
}
