//! The script and plan with which gestures in a scene begin.

use dragonfly_anim::stage::StagePlan;
use dragonfly_anim::stage::gesture::{GestureRefusal, GestureScene};
use dragonfly_anim::stage::script::StageScript;
use dragonfly_document::SceneView;
use std::sync::Arc;

/// The script and the plan of a scene whose text has no errors.
#[derive(Clone, Debug)]
pub struct SceneBase {
    /// The script.
    pub script: Arc<StageScript>,
    /// Its plan.
    pub plan: Arc<StagePlan>,
}

impl SceneBase {
    /// Returns what gestures begin with, if the newest text is `text` and a script that works.
    ///
    /// # Errors
    ///
    /// The reason why nothing can be moved now.
    pub fn of(scene: &SceneView, text: &Arc<str>) -> Result<Self, GestureRefusal> {
        let refused = |reason: &str| Err(GestureRefusal(reason.to_owned()));
        let (Some(script), Some(plan)) = (&scene.script, &scene.plan) else {
            return refused("The script has errors: correct it first");
        };
        if is_read(script, text) {
            return Ok(Self { script: Arc::clone(script), plan: Arc::clone(plan) });
        }
        refused(match scene.errors.is_empty() {
            true => "The script has just changed: try again",
            false => "The script has errors: correct it first",
        })
    }

    /// Returns whether the newest text is on its way through the document, which did not find errors in the one before.
    pub fn is_awaited(scene: &SceneView, text: &Arc<str>) -> bool {
        let is_read = scene.script.as_ref().is_some_and(|script| is_read(script, text));
        scene.plan.is_some() && scene.errors.is_empty() && !is_read
    }

    /// Returns the scene as gestures take it.
    pub fn scene(&self) -> GestureScene<'_> {
        GestureScene { script: &self.script, plan: &self.plan }
    }

    /// Returns the text.
    pub fn text(&self) -> &Arc<str> {
        self.script.tree().text()
    }
}

fn is_read(script: &StageScript, text: &Arc<str>) -> bool {
    let own = script.tree().text();
    Arc::ptr_eq(own, text) || **own == **text
}
