//! A text that a gesture changes in steps, and the check of the last one.

use super::scene::{GestureRefusal, refused};
use crate::stage::schedule::resolve;
use crate::stage::script::{ScriptError, ScriptTree, StageScript};
use crate::stage::splice::{TextSplices, remove_attribute, set_attribute};

/// A text and its elements.
pub(super) struct ScriptDraft {
    tree: ScriptTree,
}

/// A change of an attribute: the element, the name, and the new value; `None` removes it.
pub(super) type AttributeChange<'a> = (usize, &'a str, Option<String>);

impl ScriptDraft {
    /// Begins with the text of `tree`.
    pub(super) fn of(tree: &ScriptTree) -> Self {
        Self { tree: tree.clone() }
    }

    /// Makes one step: `find` returns the splices of the text so far.
    pub(super) fn then(
        self,
        find: impl FnOnce(&ScriptTree) -> Option<TextSplices>,
    ) -> Result<Self, GestureRefusal> {
        let Some(splices) = find(&self.tree) else {
            return refused("There is no place for it in the script");
        };
        if splices.list().is_empty() {
            return Ok(self);
        }
        let text = splices.apply(self.tree.text());
        Ok(Self { tree: ScriptTree::read(text).map_err(|errors| first(&errors))? })
    }

    /// Changes attributes. Attributes that already have their values stay as they are written.
    pub(super) fn with(self, changes: &[AttributeChange<'_>]) -> Result<Self, GestureRefusal> {
        changes.iter().try_fold(self, |draft, (element, name, value)| {
            draft.then(|tree| match value {
                Some(value) => set_attribute(tree, *element, name, value),
                None => remove_attribute(tree, *element, name),
            })
        })
    }

    /// Returns the text, if it is a script that can be read and whose times do not depend on themselves.
    pub(super) fn finish(self) -> Result<String, GestureRefusal> {
        let text = self.tree.text().clone();
        let script = StageScript::read(text.clone()).map_err(|errors| first(&errors))?;
        // Whether times depend on themselves does not depend on how long anything is.
        resolve(&script, &[]).map_err(|errors| first(&errors))?;
        Ok(text.to_string())
    }
}

fn first(errors: &[ScriptError]) -> GestureRefusal {
    GestureRefusal(errors.first().map_or(String::new(), ScriptError::text))
}
