//! The script and plan that gestures apply to, and the reasons for refusals.

use super::begin::ends_with_another;
use crate::stage::schedule::{ActionTimes, Schedule};
use crate::stage::script::{ElementOrigin, ScriptElement, ScriptError, ScriptTree, StageScript};
use crate::stage::time::{StageTime, TICKS_PER_SECOND};
use crate::stage::{StagePlan, StageTake};
use std::fmt;

/// A script with its plan, as it was when a gesture began.
#[derive(Clone, Copy, Debug)]
pub struct GestureScene<'a> {
    /// The script.
    pub script: &'a StageScript,
    /// The plan of this script.
    pub plan: &'a StagePlan,
}

/// The treatment of the actions after one in a `seq`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Followers {
    /// They move along, by the rules of the script: the gesture changes one line.
    Follow,
    /// They stay at their times: the next one gets another `begin`.
    Stay,
}

/// The reason why a gesture is refused, as a sentence without a full stop.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GestureRefusal(pub String);

impl fmt::Display for GestureRefusal {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(&self.0)
    }
}

impl std::error::Error for GestureRefusal {}

/// The first error of a text as the reason.
impl From<Vec<ScriptError>> for GestureRefusal {
    fn from(errors: Vec<ScriptError>) -> Self {
        Self(errors.first().map_or(String::new(), ScriptError::text))
    }
}

/// Shortest duration of a clip that has one: a 240th of a second.
pub(super) const SHORTEST: StageTime = StageTime::from_ticks(TICKS_PER_SECOND / 240);

/// The reason why an action is not cut down to nothing.
pub(super) const NO_LENGTH: &str = "It would have no length";

/// The reason why a change has no place in the text.
pub(super) const NO_PLACE: &str = "There is no place for it in the script";

/// Refuses an element that is in another text than the script: that of its project, or of a file that it includes.
///
/// # Errors
///
/// The reason, with the name of that text.
pub fn in_this_text(tree: &ScriptTree, element: usize) -> Result<(), GestureRefusal> {
    let Some(element) = tree.elements().get(element) else { return Ok(()) };
    let id =
        element.value("id").map_or_else(|| format!("This <{}>", element.row.name), |id| format!("\"{id}\""));
    match element.origin {
        ElementOrigin::Text => Ok(()),
        ElementOrigin::Project => refused(format!("{id} belongs to the project: change it there")),
        ElementOrigin::Included(_) => {
            let file = tree.file_of(element).unwrap_or_default();
            refused(format!("{id} is in {file}: open it to change it"))
        }
    }
}

/// Refuses an element that is in neither text of the scene, the script or its project: one of an included file.
///
/// # Errors
///
/// The reason, with the name of the file.
pub fn in_scene_texts(tree: &ScriptTree, element: usize) -> Result<(), GestureRefusal> {
    match tree.elements().get(element).map(|element| element.origin) {
        Some(ElementOrigin::Included(_)) => in_this_text(tree, element),
        Some(ElementOrigin::Text | ElementOrigin::Project) | None => Ok(()),
    }
}

/// Returns a refusal.
pub(super) fn refused<T>(reason: impl Into<String>) -> Result<T, GestureRefusal> {
    Err(GestureRefusal(reason.into()))
}

impl<'a> GestureScene<'a> {
    /// Returns the element of an action. Refuses one of an included file.
    pub(super) fn element(&self, action: usize) -> Result<&'a ScriptElement, GestureRefusal> {
        if action == 0 || action >= self.script.actions().len() || action >= self.schedule().times().len() {
            return refused("There is no such action");
        }
        in_this_text(self.script.tree(), self.script.actions()[action].element)?;
        Ok(self.script.element(action))
    }

    /// Returns the times of all actions.
    pub(super) fn schedule(&self) -> &'a Schedule {
        self.plan.schedule()
    }

    /// Returns the times of an action; zeros where there is no such action.
    pub(super) fn times(&self, action: usize) -> ActionTimes {
        self.schedule().times().get(action).copied().unwrap_or_default()
    }

    /// Returns the duration of one repetition of each action.
    pub(super) fn lengths(&self) -> Vec<StageTime> {
        self.schedule().times().iter().map(|times| times.once).collect()
    }

    /// Refuses times after which an action that ends with another one would take no time, unless it does now; it is the action `new` of the
    /// changed script.
    pub(super) fn keeps_length(
        &self,
        action: usize,
        changed: &Schedule,
        new: usize,
    ) -> Result<(), GestureRefusal> {
        let lasts = |times: &ActionTimes| times.end - times.begin >= SHORTEST;
        match changed.times().get(new) {
            Some(times) if ends_with_another(self, action) && lasts(&self.times(action)) && !lasts(times) => {
                refused(NO_LENGTH)
            }
            Some(_) | None => Ok(()),
        }
    }

    /// Returns the take that an action plays; `None` for other actions, and while the model is missing.
    pub(super) fn take(&self, element: &ScriptElement) -> Option<&'a StageTake> {
        let who = self.plan.thing_called(element.value("who")?)?;
        let model = self.plan.things().get(who)?.model.as_ref()?;
        model.takes().get(model.take_called(element.value("take")?)?)
    }
}
