//! A thing of a scene whose model is edited in it.

use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::SceneView;
use dragonfly_picture::camera::Camera;
use std::sync::Arc;

/// A thing whose takes and bones are opened, and the scene as it was then.
#[derive(Clone, Debug)]
pub struct EnteredThing {
    /// The scene.
    pub scene: Arc<SceneView>,
    /// The thing, by its position in the plan.
    pub thing: usize,
    /// The ids of the things that are hidden.
    pub hidden: Vec<Arc<str>>,
    /// Time of the playhead.
    pub time: StageTime,
    /// The take that plays there.
    pub clip: Option<EnteredClip>,
    /// The free camera, if the scene had been framed and was seen through it.
    pub camera: Option<Camera>,
}

/// The take that a thing plays at the playhead.
#[derive(Clone, Debug, PartialEq)]
pub struct EnteredClip {
    /// Its name.
    pub take: String,
    /// Seconds after its start.
    pub after: f64,
    /// Seconds of the take in a second of the scene; not zero.
    pub speed: f64,
}
