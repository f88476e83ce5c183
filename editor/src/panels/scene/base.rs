//! The script and plan with which gestures in a scene begin.

use super::{ChangedThings, ScriptChange};
use dragonfly_anim::stage::StagePlan;
use dragonfly_anim::stage::gesture::{GestureRefusal, GestureScene, spliced_script};
use dragonfly_anim::stage::script::StageScript;
use dragonfly_anim::stage::splice::TextSplices;
use dragonfly_document::SceneView;
use dragonfly_document::edit::{EditScript, ScriptLabel};
use dragonfly_document::history::Gesture;
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

    /// Returns the change by replacements: of the script, and of the cast of its project.
    ///
    /// # Errors
    ///
    /// The result would be no script or no project.
    pub fn spliced(
        &self,
        splices: &TextSplices,
        label: ScriptLabel,
        gesture: Option<Gesture>,
        things: ChangedThings<'_>,
    ) -> Result<ScriptChange, GestureRefusal> {
        Ok(self.change(&spliced_script(&self.script, splices)?, label, gesture, things))
    }

    /// Returns the change that makes `script` the script, and its project the project.
    pub fn change(
        &self,
        script: &StageScript,
        label: ScriptLabel,
        gesture: Option<Gesture>,
        things: ChangedThings<'_>,
    ) -> ScriptChange {
        let projects = self.script.project().zip(script.project());
        let also = projects
            .and_then(|(old, new)| EditScript::between(old.tree().text(), new.tree().text(), Some(label)));
        let (from, text) = (Arc::clone(self.text()), script.tree().text().to_string());
        let things = things.ids(&self.script);
        ScriptChange { from, text, also: also.into_iter().collect(), label, gesture, things }
    }

    /// Returns the step that makes `text` the text of the script.
    pub fn step(&self, text: String, label: ScriptLabel, things: ChangedThings<'_>) -> ScriptChange {
        let (from, things) = (Arc::clone(self.text()), things.ids(&self.script));
        ScriptChange { from, text, also: Vec::new(), label, gesture: None, things }
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
