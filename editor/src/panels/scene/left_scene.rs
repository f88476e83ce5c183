//! A scene that was left.

use super::SceneEditing;
use crate::panels::camera_state::OtherView;
use dragonfly_picture::ThroughCamera;
use dragonfly_picture::camera::Camera;
use std::path::PathBuf;

/// The state of the panels when a scene was left. It is kept when its file is read again, and while one of its models is edited.
#[derive(Debug)]
pub struct LeftScene {
    /// The file of the scene.
    pub path: PathBuf,
    /// Selected, hidden and locked things, the part of time that is shown.
    pub editing: SceneEditing,
    /// Time of the playhead, seconds.
    pub time: f32,
    /// The part of time that plays, seconds; `None` for all.
    pub range: Option<[f32; 2]>,
    /// Whether it was playing.
    pub is_playing: bool,
    /// The free camera, if the scene had been framed.
    pub camera: Option<Camera>,
    /// The camera through which the viewport looked.
    pub through: ThroughCamera,
    /// The other one of two views; `None` while there was one.
    pub(in crate::panels) other: Option<OtherView>,
}
