//! A thing of a scene whose model is edited in it.

use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::SceneView;
use dragonfly_picture::camera::Camera;
use std::path::Path;
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

impl EnteredThing {
    /// Returns whether a file is the model of the thing.
    pub fn is_model(&self, path: &Path) -> bool {
        let element = self.scene.script.as_ref().zip(self.scene.plan.as_ref()).and_then(|(script, plan)| {
            let id = &plan.things().get(self.thing)?.id;
            Some(&script.tree().elements()[script.thing_element(id)?])
        });
        let model = element.and_then(|element| element.value("model"));
        model.is_some_and(|model| path.file_name() == Path::new(model).file_name())
    }
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
