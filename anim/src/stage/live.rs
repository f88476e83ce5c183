//! A script while someone writes it.

use super::assets::StageAssets;
use super::plan::StagePlan;
use super::script::{ScriptContext, ScriptError, StageScript};
use std::sync::Arc;

/// The newest plan of a script that worked, and what is wrong with its newest text.
#[derive(Clone, Debug, Default)]
pub struct LiveStage {
    plan: Option<Arc<StagePlan>>,
    script: Option<Arc<StageScript>>,
    errors: Vec<ScriptError>,
}

impl LiveStage {
    /// Reads and plans a new text. Returns whether it worked; otherwise the plan stays the one before, and [`Self::errors`] has the reasons.
    pub fn update(&mut self, text: impl Into<Arc<str>>, assets: &StageAssets) -> bool {
        self.update_in(text, &ScriptContext::default(), assets)
    }

    /// Reads and plans a new text of a script of a project, or one that includes others, as [`Self::update`] does.
    pub fn update_in(
        &mut self,
        text: impl Into<Arc<str>>,
        context: &ScriptContext,
        assets: &StageAssets,
    ) -> bool {
        let planned = StageScript::read_in(text, context).and_then(|script| {
            let plan = StagePlan::after(self.plan.as_deref(), &script, assets)?;
            Ok((script, plan))
        });
        match planned {
            Ok((script, plan)) => {
                *self =
                    Self { plan: Some(Arc::new(plan)), script: Some(Arc::new(script)), errors: Vec::new() };
                true
            }
            Err(errors) => {
                self.errors = errors;
                false
            }
        }
    }

    /// Returns the plan of the last text that worked; `None` before the first one.
    pub fn plan(&self) -> Option<&Arc<StagePlan>> {
        self.plan.as_ref()
    }

    /// Returns the script of that plan.
    pub fn script(&self) -> Option<&Arc<StageScript>> {
        self.script.as_ref()
    }

    /// Returns what is wrong with the newest text, in its order; empty if it worked.
    pub fn errors(&self) -> &[ScriptError] {
        &self.errors
    }
}
