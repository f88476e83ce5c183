//! The scene around a model that is edited in it: the other things, as they are at the time of the scene that the take's time means.

use super::cast::PosedScene;
use dragonfly_document::SceneView;
use glam::Mat4;
use std::sync::Arc;

/// The scene in which a model is edited.
#[derive(Clone, Debug)]
pub struct SceneAround {
    /// The scene.
    pub view: Arc<SceneView>,
    /// The ids of the things that are not drawn: the one whose model is edited, and those that are hidden.
    pub left_out: Vec<Arc<str>>,
    /// Matrix from the space of the scene to that of the model.
    pub model_from_scene: Mat4,
    /// How the times of a take are times of the scene; without it, the scene is shown at [`Self::seconds`].
    pub clip: Option<AroundClip>,
    /// Time of the scene where no clip plays, seconds.
    pub seconds: f64,
}

impl PartialEq for SceneAround {
    /// Returns whether both are the same view of a scene in the same way.
    fn eq(&self, other: &Self) -> bool {
        let of = |around: &Self| (around.model_from_scene, around.clip, around.seconds);
        Arc::ptr_eq(&self.view, &other.view) && self.left_out == other.left_out && of(self) == of(other)
    }
}

/// A clip that plays the take that is edited.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AroundClip {
    /// Position of the take.
    pub take: usize,
    /// A time of the take, seconds.
    pub take_seconds: f64,
    /// The time of the scene at which the clip plays that, seconds.
    pub scene_seconds: f64,
    /// Seconds of the take in a second of the scene; not zero.
    pub speed: f64,
}

impl SceneAround {
    /// Returns the time of the scene that a time of a take means, seconds.
    pub fn time_of(&self, take: Option<usize>, take_seconds: f64) -> f64 {
        match self.clip {
            Some(clip) if take == Some(clip.take) => {
                (clip.scene_seconds + (take_seconds - clip.take_seconds) / clip.speed).max(0.0)
            }
            Some(_) | None => self.seconds,
        }
    }
}

/// The scene around the model, on the processor.
pub(super) struct PosedAround {
    around: Arc<SceneAround>,
    scene: PosedScene,
}

impl PosedAround {
    /// Returns the scene around a model, before its first time; `None` without a plan. What it has in common with the one `before` is kept.
    pub(super) fn new(around: &Arc<SceneAround>, before: Option<Self>) -> Option<Self> {
        let scene = PosedScene::new(&around.view, &around.left_out, before.map(|before| before.scene))?;
        Some(Self { around: Arc::clone(around), scene: scene.seen_from(around.model_from_scene) })
    }

    /// Returns the scene.
    pub(super) fn scene(&self) -> &PosedScene {
        &self.scene
    }

    pub(super) fn scene_mut(&mut self) -> &mut PosedScene {
        &mut self.scene
    }

    /// Computes the scene at the time that a time of a take means. Allocates nothing.
    pub(super) fn pose(&mut self, take: Option<usize>, take_seconds: f64) {
        self.scene.pose(self.around.time_of(take, take_seconds));
    }
}
