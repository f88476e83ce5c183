//! A text that a gesture changes in steps, and the check of the last one.

use super::scene::{GestureRefusal, refused};
use crate::stage::schedule::resolve;
use crate::stage::script::{ScriptTree, StageScript};
use crate::stage::splice::{TextSplices, remove_attribute, set_attribute};

/// A text that changes in steps. A text is read when the next step needs its elements, so that one step reads nothing.
pub(super) struct ScriptDraft<'a> {
    before: &'a ScriptTree,
    /// The elements of a text after some steps.
    read: Option<ScriptTree>,
    /// The text after a step that was not read yet.
    text: Option<String>,
}

/// A change of an attribute: the element, the name, and the new value; `None` removes it.
pub(super) type AttributeChange<'a> = (usize, &'a str, Option<String>);

impl<'a> ScriptDraft<'a> {
    /// Begins with the text of `tree`, which is that of a script.
    pub(super) fn of(tree: &'a ScriptTree) -> Self {
        Self { before: tree, read: None, text: None }
    }

    /// Makes one step: `find` returns the splices of the text so far.
    pub(super) fn then(
        mut self,
        find: impl FnOnce(&ScriptTree) -> Option<TextSplices>,
    ) -> Result<Self, GestureRefusal> {
        if let Some(text) = self.text.take() {
            self.read = Some(ScriptTree::read(text)?);
        }
        let tree = self.read.as_ref().unwrap_or(self.before);
        let Some(splices) = find(tree) else {
            return refused("There is no place for it in the script");
        };
        if !splices.list().is_empty() {
            self.text = Some(splices.apply(tree.text()));
        }
        Ok(self)
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
        let text = match (self.text, self.read) {
            (Some(text), _) => text,
            (None, Some(read)) => read.text().to_string(),
            (None, None) => return Ok(self.before.text().to_string()),
        };
        let script = StageScript::read(text.as_str())?;
        // Whether times depend on themselves does not depend on how long anything is.
        resolve(&script, &[])?;
        Ok(text)
    }
}

/// Returns the text of `script` with replacements.
///
/// # Errors
///
/// The result would be no script, or its times would depend on themselves.
pub fn spliced_text(script: &StageScript, splices: TextSplices) -> Result<String, GestureRefusal> {
    ScriptDraft::of(script.tree()).then(|_| Some(splices))?.finish()
}
